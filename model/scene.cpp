// SPDX-License-Identifier: MIT
#include "model/scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <utility>

#include "model/compressible.hpp"

namespace sphstab {
namespace {

/// Calls visit(item, i) for every item of a list; errors name the item by the table and its number, from 1.
template <class List, class Visit>
void for_each_of(std::string_view table, const List& list, const Visit& visit) {
  for (int i = 0; i < static_cast<int>(list.size()); ++i)
    in_context(fmt::format("{} {}", table, i + 1), [&] { visit(list[i], i); });
}

/// Volume of the ball of radius 1 in `dimension` dimensions.
double unit_ball(int dimension) {
  constexpr double pi = std::numbers::pi;
  return dimension == 1 ? 2.0 : dimension == 2 ? pi : 4.0 / 3.0 * pi;
}

/// Y(x) of a cantilever's first mode, x from its root in lengths: Eq. 7.3 of Gray et al. over its value at the tip.
double cantilever_deflection(double x) {
  constexpr double kL = 1.8751040687119611;  // cos kL cosh kL = −1, the first root
  const double M = std::sin(kL) + std::sinh(kL), N = std::cos(kL) + std::cosh(kL);
  const double Q = 2.0 * (std::cos(kL) * std::sinh(kL) - std::sin(kL) * std::cosh(kL));
  return (M * (std::cos(kL * x) - std::cosh(kL * x)) - N * (std::sin(kL * x) - std::sinh(kL * x))) / Q;
}

/// Assembles the scene of a description.
template <int Dim>
class Builder {
 public:
  explicit Builder(const SceneDescription<Dim>& description)
      : description_(description), lattice_(description.problem.lattice) {}

  Scene<Dim> scene() {
    if (description_.periodic_cells)
      place_patch(*description_.periodic_cells);
    else
      place_parts();
    for_each_of("clamp", description_.clamps, [&](const auto& clamp, int) { hold(clamp); });
    if (!description_.gravity.isZero(0.0)) body_.load.assign(body_.size(), description_.gravity);
    for_each_of("traction", description_.tractions, [&](const auto& traction, int) { load(traction); });
    for_each_of("velocity", description_.velocities, [&](const auto& start, int) { move(start); });
    std::vector<Probe> probes;
    for_each_of("probe", description_.probes, [&](const auto& site, int) {
      for (const auto& other : probes)
        if (other.name == site.name) throw InvalidInput(fmt::format("name: '{}' is given twice", site.name));
      probes.push_back({site.name, nearest_particle(site.position)});
    });
    return {description_.name, description_.problem, std::move(body_),
            std::move(probes), std::move(velocity_), description_.periodic_cells};
  }

 private:
  void place_parts() {
    if (description_.parts.empty()) throw InvalidInput("body: missing (or patch)");
    for_each_of("body", description_.parts, [&](const auto& part, int i) { add(part, i); });
    find_sites();
    find_neighbours();
  }

  void place_patch(const LatticeIndex<Dim>& cells) {
    if (!description_.parts.empty()) throw InvalidInput("patch: cannot be given with bodies");
    if (const double size = cells.template cast<double>().prod(); size > static_cast<double>(most_particles))
      throw InvalidInput(
          fmt::format("patch: {} particles are more than the {} that are allowed", size, most_particles));
    if (!description_.tractions.empty()) throw InvalidInput("traction: a periodic patch has no surface");
    body_ = periodic_patch(description_.problem, cells);
  }

  void add(const ScenePart<Dim>& part, int i) {
    const auto particles = place_particles(part.placement, lattice_);
    const std::size_t size = body_.position.size() + particles.position.size();
    if (size > most_particles)
      throw InvalidInput(
          fmt::format("shape: makes {} particles in all, more than the {} that are allowed", size, most_particles));
    body_.position.insert(body_.position.end(), particles.position.begin(), particles.position.end());
    body_.volume.insert(body_.volume.end(), particles.volume.begin(), particles.volume.end());
    body_.material.resize(size, material_index(part.material));
    part_.resize(size, i);
    layer_.push_back(particles.layer);
  }

  /// The index in the body of a material of the description, which the body takes over when it is first used.
  int material_index(int material) {
    const auto found = std::find(materials_.begin(), materials_.end(), material);
    const int index = static_cast<int>(found - materials_.begin());
    if (found != materials_.end()) return index;
    const Material& taken = description_.materials[material];
    in_context("material", [&] {
      if (!is_total_lagrangian(description_.problem.scheme.formulation))
        require_compressible(taken);
      else
        taken.lame(description_.problem.plane);  // refuses ν = 0.5 in plane strain
    });
    materials_.push_back(material);
    body_.materials.push_back(taken);
    return index;
  }

  /// Coordinates on the lattice through the first particle, if all particles are cells of it.
  void find_sites() {
    const double margin = placement_tolerance * lattice_.spacing();
    const Tensor<Dim> inverse = lattice_.primitive_vectors().inverse();
    for (int a = 0; a < body_.size(); ++a) {
      const Vector<Dim> apart = body_.position[a] - body_.position[0];
      const Vector<Dim> site = (inverse * apart).array().round();
      if ((lattice_.primitive_vectors() * site - apart).norm() > margin ||
          site.cwiseAbs().maxCoeff() > std::numeric_limits<int>::max() || body_.volume[a] != lattice_.cell_volume())
        return body_.site.clear();
      body_.site.push_back(site.template cast<int>());
    }
  }

  double reach() const {
    const double support = description_.problem.kernel.support();
    if (description_.problem.neighbour_rule == NeighbourRule::support) return support;
    if (body_.site.empty()) throw InvalidInput("neighbours: nearest is for particles on one lattice, not for these");
    return lattice_neighbours(lattice_, support, NeighbourRule::nearest).front().distance * (1.0 + placement_tolerance);
  }

  void find_neighbours() {
    const double support = reach();
    double pairs = 0.0;
    for (const double volume : body_.volume) pairs += unit_ball(Dim) * std::pow(support, Dim) / volume;
    pairs = std::min(pairs, static_cast<double>(body_.size()) * body_.size());
    if (pairs > most_pairs)
      throw InvalidInput(
          fmt::format("body: has about {:.2g} pairs of neighbours, more than the {:.2g} that are allowed; "
                      "fewer particles or a smaller support make fewer",
                      pairs, most_pairs));
    body_.pairs = find_pairs(body_.position, support);
    for (int a = 0; a < body_.size(); ++a) check_neighbours(a);
  }

  void check_neighbours(int a) const {
    const int begin = body_.pairs.first[a], end = body_.pairs.first[a + 1];
    if (begin == end)
      throw InvalidInput(fmt::format("{} has no neighbour within the support, {}", name_of_particle(a),
                                     description_.problem.kernel.support()));
    for (int entry = begin; entry < end; ++entry)
      if (body_.pairs.separation[entry].norm() < placement_tolerance * lattice_.spacing())
        throw InvalidInput(fmt::format("{} is in the same place as {}", name_of_particle(a),
                                       name_of_particle(body_.pairs.neighbour[entry])));
  }

  std::string name_of_particle(int a) const {
    const auto& x = body_.position[a];
    return fmt::format("particle {} of body {} ('{}') at [{}]", a, part_[a] + 1, description_.parts[part_[a]].name,
                       fmt::join(x.data(), x.data() + Dim, ", "));
  }

  std::vector<int> particles_in(const Shape<Dim>& region) const {
    in_context("region", [&] { check_shape(region); });
    std::vector<int> found;
    for (int a = 0; a < body_.size(); ++a)
      if (contains(region, body_.position[a], placement_tolerance * lattice_.spacing())) found.push_back(a);
    if (found.empty()) throw InvalidInput("region: holds no particle");
    return found;
  }

  void hold(const Clamp<Dim>& clamp) {
    body_.clamped.resize(body_.size(), Directions<Dim>::Constant(false));
    for (const int a : particles_in(clamp.region)) body_.clamped[a] = body_.clamped[a] || clamp.directions;
  }

  void load(const Traction<Dim>& traction) {
    if (traction.layer) require_positive("layer", *traction.layer);
    body_.load.resize(body_.size(), Vector<Dim>::Zero());
    const std::vector<int> loaded = particles_in(traction.region);
    if (const auto* total = std::get_if<TotalForce<Dim>>(&traction.stress)) return share(total->force, loaded);
    for (const int a : loaded) {
      const auto* field = std::get_if<AffineField<Dim>>(&traction.stress);
      const Vector<Dim> stress =
          field ? value_at(*field, a) : stress_at(std::get<CentredTraction<Dim>>(traction.stress), a);
      body_.load[a] += stress / (body_.material_of(a).density() * traction.layer.value_or(layer_[part_[a]]));
    }
  }

  void share(const Vector<Dim>& force, const std::vector<int>& particles) {
    double mass = 0.0;
    for (const int a : particles) mass += body_.mass(a);
    for (const int a : particles) body_.load[a] += force / mass;
  }

  Vector<Dim> value_at(const AffineField<Dim>& field, int a) const {
    return field.value + field.gradient * (body_.position[a] - field.origin);
  }

  Vector<Dim> stress_at(const CentredTraction<Dim>& traction, int a) const {
    if (traction.at_radius) require_positive("at_radius", *traction.at_radius);
    const Vector<Dim> arm = body_.position[a] - traction.centre;
    const double radius = arm.norm();
    if (!(radius > placement_tolerance * lattice_.spacing()))
      throw InvalidInput(fmt::format("centre: {} lies on it", name_of_particle(a)));
    const double ratio = traction.at_radius.value_or(radius) / radius;
    Vector<Dim> stress = traction.radial * std::pow(ratio, Dim - 1) * arm / radius;
    if constexpr (Dim == 2) stress += traction.shear * ratio * ratio * Vector<2>(-arm[1], arm[0]) / radius;
    if (Dim != 2 && traction.shear != 0.0)
      throw InvalidInput(fmt::format("shear: about a centre is for 2 dimensions, not {}", Dim));
    return stress;
  }

  void move(const InitialVelocity<Dim>& start) {
    velocity_.resize(body_.size(), Vector<Dim>::Zero());
    for (const int a : particles_in(start.region))
      velocity_[a] += std::visit([&](const auto& kind) { return velocity_at(kind, a); }, start.velocity);
    for (std::size_t a = 0; a < body_.clamped.size(); ++a)
      velocity_[a] = body_.clamped[a].select(Vector<Dim>::Zero().array(), velocity_[a].array());
  }

  Vector<Dim> velocity_at(const AffineField<Dim>& field, int a) const { return value_at(field, a); }

  Vector<Dim> velocity_at(const CantileverMode& mode, int a) const {
    if constexpr (Dim != 2) throw InvalidInput(fmt::format("cantilever: is for 2 dimensions, not {}", Dim));
    require_positive("length", mode.length);
    return mode.tip * cantilever_deflection((body_.position[a][0] - mode.root) / mode.length) *
           Vector<Dim>::Unit(Dim - 1);
  }

  int nearest_particle(const Vector<Dim>& position) const {
    const auto distance = [&](int a) { return (body_.position[a] - position).norm(); };
    int nearest = 0;
    for (int a = 1; a < body_.size(); ++a)
      if (distance(a) < distance(nearest) - placement_tolerance * lattice_.spacing()) nearest = a;
    return nearest;
  }

  const SceneDescription<Dim>& description_;
  const Lattice<Dim>& lattice_;
  Body<Dim> body_;
  std::vector<Vector<Dim>> velocity_;
  std::vector<int> materials_;  ///< of the description, those of the body
  std::vector<int> part_;       ///< of each particle
  std::vector<double> layer_;   ///< of each part
};

}  // namespace

template <int Dim>
Scene<Dim> make_scene(const SceneDescription<Dim>& description) {
  return Builder<Dim>(description).scene();
}

template Scene<1> make_scene(const SceneDescription<1>&);
template Scene<2> make_scene(const SceneDescription<2>&);
template Scene<3> make_scene(const SceneDescription<3>&);

}  // namespace sphstab
