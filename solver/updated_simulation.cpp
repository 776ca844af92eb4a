// SPDX-License-Identifier: MIT
#include "solver/updated_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/compressible.hpp"
#include "solver/stress.hpp"
#include "solver/updated_stepper.hpp"
#include "solver/updated_stress.hpp"
#include "solver/updated_weights.hpp"

namespace sphstab::solver {
namespace {

template <int Dim>
void require_updated_lagrangian(const Problem<Dim>& problem) {
  if (problem.scheme.formulation != Formulation::updated_lagrangian)
    throw InvalidInput("scheme: this run is for ul, not " + std::string(name_of(problem.scheme.formulation)));
  if (problem.neighbour_rule != NeighbourRule::support)
    throw InvalidInput("neighbours: a run of ul needs support, not " + std::string(name_of(problem.neighbour_rule)));
  if (problem.plane != Plane::strain)
    throw InvalidInput("plane: a run of ul needs strain, not " + std::string(name_of(problem.plane)));
}

/// The periods of a box of these cells, in columns.
template <int Dim>
std::optional<Tensor<Dim>> periods(const Lattice<Dim>& lattice, const std::optional<LatticeIndex<Dim>>& cells) {
  if (!cells) return std::nullopt;
  return Tensor<Dim>(lattice.primitive_vectors() * cells->template cast<double>().asDiagonal());
}

template <class Scalar>
bool all_finite(const Scalar* numbers, int count) {
  using std::isfinite;
  bool finite = true;
  for (int i = 0; i < count; ++i) finite = finite && isfinite(numbers[i]);
  return finite;
}

/// The first number of a state that is not finite, or a density that is not positive.
template <int Dim, class Scalar>
std::optional<NotFinite> not_finite(const UpdatedState<Dim, Scalar>& state, long step) {
  for (int a = 0; a < state.particles(); ++a) {
    const auto lost = [&](UpdatedQuantity quantity) { return NotFinite{step, a, quantity}; };
    if (!all_finite(state.position[a].data(), Dim)) return lost(UpdatedQuantity::position);
    if (!all_finite(state.velocity[a].data(), Dim)) return lost(UpdatedQuantity::velocity);
    if (!all_finite(&state.density[a], 1) || !(state.density[a] > Scalar(0))) return lost(UpdatedQuantity::density);
    if (!all_finite(state.deviatoric_stress[a].data(), Dim * Dim)) return lost(UpdatedQuantity::deviatoric_stress);
  }
  return std::nullopt;
}

}  // namespace

UpdatedTerm maker_of(UpdatedQuantity quantity) {
  switch (quantity) {
    case UpdatedQuantity::position:
      return UpdatedTerm::drift;
    case UpdatedQuantity::velocity:
      return UpdatedTerm::momentum;
    case UpdatedQuantity::density:
      return UpdatedTerm::continuity;
    case UpdatedQuantity::deviatoric_stress:
      return UpdatedTerm::deviatoric_stress_rate;
  }
  return {};
}

/// A system of solver/updated_stepper.hpp that makes the steps of a simulation and keeps the first term that broke.
template <int Dim, class Scalar>
class UpdatedSimulation<Dim, Scalar>::Observed {
 public:
  explicit Observed(UpdatedSimulation& simulation) : simulation_(simulation) {}

  const std::optional<BrokenTerm>& broken() const { return broken_; }

  /// What came out of terms that were finite.
  void look_at(const UpdatedState<Dim, Scalar>& state) {
    if (broken_) return;
    if (const auto lost = not_finite(state, 0)) broken_ = {maker_of(lost->quantity), lost->particle};
  }

  void place(const Field<Dim, Scalar>& position) {
    simulation_.place(position);
    look_at_pairs(UpdatedTerm::pair_distance, [&](int, int, int pair) { return simulation_.F_[pair]; });
  }

  void forces(const UpdatedState<Dim, Scalar>& state, Field<Dim, Scalar>& acceleration) {
    look_at(state);
    simulation_.forces(state, acceleration);
    look_at(UpdatedTerm::equation_of_state, simulation_.stress_);
    look_at(UpdatedTerm::artificial_stress, simulation_.artificial_stress_);
    if (simulation_.scheme_.viscosity) {
      const ViscousConstants constants = simulation_.viscous_constants();
      look_at_pairs(UpdatedTerm::viscosity, [&](int a, int b, int pair) {
        return viscous_pair_term<Scalar, Dim>(state.velocity[a] - state.velocity[b], simulation_.separation_[pair],
                                              state.density[a], state.density[b], constants.alpha_h_c0,
                                              constants.eta_h_squared);
      });
    }
    look_at(UpdatedTerm::momentum, acceleration);
  }

  const Field<Dim, Scalar>& smoothed(const UpdatedState<Dim, Scalar>& state) {
    look_at(state);
    const auto& smoothed = simulation_.smoothed(state);
    look_at(UpdatedTerm::xsph, smoothed);
    return smoothed;
  }

  void rates(const UpdatedState<Dim, Scalar>& state, const Field<Dim, Scalar>& smoothed,
             UpdatedRates<Dim, Scalar>& rates) {
    simulation_.rates(state, smoothed, rates);
    look_at(UpdatedTerm::continuity, rates.density);
    look_at(UpdatedTerm::deviatoric_stress_rate, rates.deviatoric_stress);
  }

  bool force_feels_velocity() const { return simulation_.force_feels_velocity(); }

 private:
  static bool is_finite(const Scalar& number) { return all_finite(&number, 1); }
  template <int Rows, int Columns>
  static bool is_finite(const Eigen::Matrix<Scalar, Rows, Columns>& numbers) {
    return all_finite(numbers.data(), Rows * Columns);
  }

  template <class Values>
  void look_at(UpdatedTerm term, const Values& values) {
    for (int a = 0; a < static_cast<int>(values.size()) && !broken_; ++a)
      if (!is_finite(values[a])) broken_ = {term, a};
  }

  template <class NumberOf>
  void look_at_pairs(UpdatedTerm term, const NumberOf& number_of) {
    for (int a = 0; a < simulation_.particles() && !broken_; ++a)
      for (int pair = simulation_.first_[a]; pair < simulation_.first_[a + 1] && !broken_; ++pair)
        if (!is_finite(number_of(a, simulation_.neighbour_[pair], pair))) broken_ = {term, a};
  }

  UpdatedSimulation& simulation_;
  std::optional<BrokenTerm> broken_;
};

template <int Dim, class Scalar>
UpdatedSimulation<Dim, Scalar>::UpdatedSimulation(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells)
    : UpdatedSimulation(problem, periodic_patch(problem, cells), cells) {}

template <int Dim, class Scalar>
UpdatedSimulation<Dim, Scalar>::UpdatedSimulation(const Problem<Dim>& problem, const Body<Dim>& body,
                                                  const std::optional<LatticeIndex<Dim>>& periodic_cells)
    : scheme_(problem.scheme),
      integrator_(problem.integrator),
      kernel_(problem.kernel),
      spacing_(problem.lattice.spacing()),
      sound_speed_(std::sqrt(problem.material.bulk_modulus() / problem.material.density())),
      material_(body.material),
      neighbours_(problem.kernel.support(), periods(problem.lattice, periodic_cells)),
      first_(body.size() + 1, 0),
      stress_(body.size()),
      artificial_stress_(scheme_.artificial_stress ? body.size() : 0),
      smoothed_(scheme_.xsph ? body.size() : 0),
      gradient_(body.size()),
      rates_(body.size()),
      next_rates_(body.size()) {
  require_updated_lagrangian(problem);
  for (const auto& material : body.materials) {
    require_compressible(material);
    substances_.push_back({static_cast<Scalar>(material.density()),
                           static_cast<Scalar>(material.bulk_modulus() / material.density()),
                           static_cast<Scalar>(material.shear_modulus())});
  }
  for (const auto& load : body.load) load_.push_back(load.template cast<Scalar>());
  for (int a = 0; a < static_cast<int>(body.clamped.size()); ++a)
    for (int axis = 0; axis < Dim; ++axis)
      if (body.clamped[a][axis]) held_.push_back({a, axis});
  for (int a = 0; a < body.size(); ++a) {
    const Material& material = body.material_of(a);
    const double density = material.density() * (1.0 + problem.pressure / material.bulk_modulus());
    mass_.push_back(static_cast<Scalar>(density * body.volume[a]));
    base_state_.position.push_back(body.position[a].template cast<Scalar>());
    base_state_.density.push_back(static_cast<Scalar>(density));
  }
  base_state_.velocity.assign(body.size(), Vector<Dim, Scalar>::Zero());
  base_state_.deviatoric_stress.assign(body.size(), problem.deviatoric_stress.template cast<Scalar>());
}

template <int Dim, class Scalar>
void UpdatedSimulation<Dim, Scalar>::hold(Field<Dim, Scalar>& field) const {
  for (const auto& [a, axis] : held_) field[a][axis] = Scalar(0);
}

template <int Dim, class Scalar>
std::optional<NotFinite> UpdatedSimulation<Dim, Scalar>::advance(UpdatedState<Dim, Scalar>& state, double time_step,
                                                                 long steps) {
  hold(state);
  std::optional<NotFinite> lost = not_finite(state, 0);
  if (lost) return lost;
  store_first_rates(*this, state);
  const auto go_on = [&](long step) { return !(lost = not_finite(state, step)); };
  solver::advance(integrator_, *this, static_cast<Scalar>(time_step), steps, state, rates_, next_rates_, go_on);
  return lost;
}

template <int Dim, class Scalar>
template <class System>
void UpdatedSimulation<Dim, Scalar>::store_first_rates(System& system, UpdatedState<Dim, Scalar>& state) const {
  if (integrator_ != Integrator::predictor_corrector_pec || !state.stored.density.empty()) return;
  state.stored = UpdatedRates<Dim, Scalar>(particles());
  system.place(state.position);
  solver::evaluate(system, state, state.stored);
}

template <int Dim, class Scalar>
std::optional<BrokenTerm> UpdatedSimulation<Dim, Scalar>::broken_term(UpdatedState<Dim, Scalar> state,
                                                                      double time_step) {
  hold(state);
  Observed observed(*this);
  observed.look_at(state);
  store_first_rates(observed, state);
  const auto stop = [](long) { return false; };
  solver::advance(integrator_, observed, static_cast<Scalar>(time_step), 1, state, rates_, next_rates_, stop);
  observed.look_at(state);
  return observed.broken();
}

template <int Dim, class Scalar>
void UpdatedSimulation<Dim, Scalar>::place(const Field<Dim, Scalar>& position) {
  if (neighbours_.update(position)) {
    ++work_.list_builds;
    neighbour_.resize(neighbours_.size());
    separation_.resize(neighbours_.size());
    F_.resize(neighbours_.size());
    if (scheme_.xsph) W_.resize(neighbours_.size());
    if (scheme_.artificial_stress) phi_.resize(neighbours_.size());
  }
  ++work_.placements;
  const Scalar support = static_cast<Scalar>(kernel_.support() * (1.0 - tie_margin));
  const Scalar limit = support * support;
  int pair = 0;
  for (int a = 0; a < particles(); ++a) {
    first_[a] = pair;
    for (const auto& [b, image] : neighbours_.candidates(a)) {
      const Vector<Dim, Scalar> r_ab = position[a] - position[b] - neighbours_.shift(image).template cast<Scalar>();
      const Scalar distance_squared = r_ab.squaredNorm();
      neighbour_[pair] = b;
      separation_[pair] = r_ab;
      F_[pair] = distance_squared;  // until the pair is weighed
      pair += distance_squared < limit ? 1 : 0;
    }
  }
  first_.back() = pair;
  for (int begin = 0; begin < pair; begin += pairs_a_block) weigh_pairs(begin, std::min(pairs_a_block, pair - begin));
}

template <int Dim, class Scalar>
void UpdatedSimulation<Dim, Scalar>::weigh_pairs(int begin, int size) {
  using Block = PairBlock<Scalar>;
  const auto part = [&](std::vector<Scalar>& numbers) {
    return Eigen::Map<Eigen::Array<Scalar, Eigen::Dynamic, 1>>(numbers.data() + begin, size);
  };
  const Block r = part(F_).template cast<Wide<Scalar>>().sqrt();
  const auto [W, dW] = kernel_block(kernel_, r);
  part(F_) = (dW / r).template cast<Scalar>();
  if (scheme_.xsph) part(W_) = W.template cast<Scalar>();
  if (scheme_.artificial_stress)
    part(phi_) = artificial_stress_weights(*scheme_.artificial_stress, kernel_, spacing_, r, W).template cast<Scalar>();
}

template <int Dim, class Scalar>
void UpdatedSimulation<Dim, Scalar>::store_stresses(const UpdatedState<Dim, Scalar>& state) {
  const auto& artificial = scheme_.artificial_stress;
  if (artificial) ++work_.artificial_stresses;
  for (int a = 0; a < particles(); ++a) {
    const Tensor<Dim, Scalar> sigma = stress(state, a);
    const Scalar& rho = state.density[a];
    stress_[a] = sigma / (rho * rho);
    if (artificial)
      artificial_stress_[a] = artificial_stress<Scalar, Dim>(sigma, rho, static_cast<Scalar>(artificial->epsilon));
  }
}

template <int Dim, class Scalar>
void UpdatedSimulation<Dim, Scalar>::forces(const UpdatedState<Dim, Scalar>& state, Field<Dim, Scalar>& acceleration) {
  ++work_.forces;
  store_stresses(state);
  const bool artificial = scheme_.artificial_stress.has_value();
  const Viscous viscous = !scheme_.viscosity                              ? Viscous::none
                          : scheme_.viscosity->pairs == ViscousPairs::all ? Viscous::all
                                                                          : Viscous::approaching;
  switch (viscous) {
    case Viscous::none:
      artificial ? sum_forces<true, Viscous::none>(state, acceleration)
                 : sum_forces<false, Viscous::none>(state, acceleration);
      break;
    case Viscous::all:
      artificial ? sum_forces<true, Viscous::all>(state, acceleration)
                 : sum_forces<false, Viscous::all>(state, acceleration);
      break;
    case Viscous::approaching:
      artificial ? sum_forces<true, Viscous::approaching>(state, acceleration)
                 : sum_forces<false, Viscous::approaching>(state, acceleration);
      break;
  }
  for (std::size_t a = 0; a < load_.size(); ++a) acceleration[a] += load_[a];
  hold(acceleration);
}

template <int Dim, class Scalar>
typename UpdatedSimulation<Dim, Scalar>::ViscousConstants UpdatedSimulation<Dim, Scalar>::viscous_constants() const {
  const double h = kernel_.smoothing_length();
  const Viscosity viscosity = scheme_.viscosity.value_or(Viscosity{0.0, 0.0});
  return {static_cast<Scalar>(viscosity.alpha * h * sound_speed_),
          static_cast<Scalar>(viscosity.eta * h * viscosity.eta * h)};
}

template <int Dim, class Scalar>
template <bool artificial, typename UpdatedSimulation<Dim, Scalar>::Viscous viscous>
void UpdatedSimulation<Dim, Scalar>::sum_forces(const UpdatedState<Dim, Scalar>& state,
                                                Field<Dim, Scalar>& acceleration) {
  const auto [alpha_h_c0, eta_h_squared] = viscous_constants();
  std::fill(acceleration.begin(), acceleration.end(), Vector<Dim, Scalar>::Zero());
  for (int a = 0; a < particles(); ++a) {
    Vector<Dim, Scalar> sum = Vector<Dim, Scalar>::Zero();
    for (int pair = first_[a]; pair < first_[a + 1]; ++pair) {
      const int b = neighbour_[pair];
      const Vector<Dim, Scalar>& r_ab = separation_[pair];
      const Vector<Dim, Scalar> g_ab = F_[pair] * r_ab;
      Vector<Dim, Scalar> term = stress_pair_term<Scalar, Dim>(stress_[a], stress_[b], g_ab);
      if constexpr (artificial)
        term += artificial_pair_term<Scalar, Dim>(artificial_stress_[a], artificial_stress_[b], phi_[pair], g_ab);
      if constexpr (viscous != Viscous::none) {
        const Scalar Pi = viscous_pair_term<Scalar, Dim>(state.velocity[a] - state.velocity[b], r_ab, state.density[a],
                                                         state.density[b], alpha_h_c0, eta_h_squared);
        if (viscous == Viscous::all || Pi < Scalar(0)) term += Pi * g_ab;
      }
      sum += mass_[b] * term;
      acceleration[b] -= mass_[a] * term;
    }
    acceleration[a] += sum;
  }
}

template <int Dim, class Scalar>
const Field<Dim, Scalar>& UpdatedSimulation<Dim, Scalar>::smoothed(const UpdatedState<Dim, Scalar>& state) {
  if (!scheme_.xsph) return state.velocity;
  ++work_.smoothings;
  const Scalar epsilon = static_cast<Scalar>(scheme_.xsph->epsilon);
  smoothed_ = state.velocity;
  for (int a = 0; a < particles(); ++a) {
    Vector<Dim, Scalar> sum = Vector<Dim, Scalar>::Zero();
    for (int pair = first_[a]; pair < first_[a + 1]; ++pair) {
      const int b = neighbour_[pair];
      const Vector<Dim, Scalar> term =
          epsilon * smoothing_pair_term<Scalar, Dim>(state.velocity[a] - state.velocity[b], state.density[a],
                                                     state.density[b], W_[pair]);
      sum += mass_[b] * term;
      smoothed_[b] -= mass_[a] * term;
    }
    smoothed_[a] += sum;
  }
  hold(smoothed_);
  return smoothed_;
}

template <int Dim, class Scalar>
void UpdatedSimulation<Dim, Scalar>::rates(const UpdatedState<Dim, Scalar>& state, const Field<Dim, Scalar>& smoothed,
                                           UpdatedRates<Dim, Scalar>& rates) {
  ++work_.rates;
  switch (scheme_.density_rate) {
    case DensityRate::masses:
      sum_gradients<DensityRate::masses>(state, smoothed, rates.density);
      break;
    case DensityRate::volumes:
      sum_gradients<DensityRate::volumes>(state, smoothed, rates.density);
      break;
  }
  for (int a = 0; a < particles(); ++a)
    rates.deviatoric_stress[a] =
        jaumann_rate<Scalar, Dim>(gradient_[a], state.deviatoric_stress[a], substances_[material_[a]].shear_modulus);
}

template <int Dim, class Scalar>
template <DensityRate density_rate>
void UpdatedSimulation<Dim, Scalar>::sum_gradients(const UpdatedState<Dim, Scalar>& state,
                                                   const Field<Dim, Scalar>& smoothed,
                                                   std::vector<Scalar>& density_rates) {
  std::fill(gradient_.begin(), gradient_.end(), Tensor<Dim, Scalar>::Zero());
  std::fill(density_rates.begin(), density_rates.end(), Scalar(0));
  for (int a = 0; a < particles(); ++a) {
    const Scalar volume_a = mass_[a] / state.density[a];
    Tensor<Dim, Scalar> gradient = Tensor<Dim, Scalar>::Zero();
    Scalar divergence(0);  // weighted with masses
    for (int pair = first_[a]; pair < first_[a + 1]; ++pair) {
      const int b = neighbour_[pair];
      const Vector<Dim, Scalar> g_ab = F_[pair] * separation_[pair];
      const Tensor<Dim, Scalar> term = velocity_gradient_pair_term<Scalar, Dim>(smoothed[a] - smoothed[b], g_ab);
      gradient += mass_[b] / state.density[b] * term;
      gradient_[b] += volume_a * term;
      if constexpr (density_rate == DensityRate::masses) {
        const Scalar trace = term.trace();
        divergence += mass_[b] * trace;
        density_rates[b] -= mass_[a] * trace;
      }
    }
    gradient_[a] += gradient;
    if constexpr (density_rate == DensityRate::masses) density_rates[a] -= divergence;
  }
  if constexpr (density_rate == DensityRate::volumes)
    for (int a = 0; a < particles(); ++a) density_rates[a] = -state.density[a] * gradient_[a].trace();
}

template <int Dim, class Scalar>
Tensor<Dim, Scalar> UpdatedSimulation<Dim, Scalar>::stress(const UpdatedState<Dim, Scalar>& state, int a) const {
  const Substance& substance = substances_[material_[a]];
  return total_stress<Scalar, Dim>(
      pressure(state.density[a], substance.reference_density, substance.sound_speed_squared),
      state.deviatoric_stress[a]);
}

template <int Dim, class Scalar>
Scalar UpdatedSimulation<Dim, Scalar>::von_mises_stress(const UpdatedState<Dim, Scalar>& state, int a) const {
  return solver::von_mises_stress(deviatoric_stress_in_space<Scalar, Dim>(state.deviatoric_stress[a]));
}

template <int Dim, class Scalar>
std::vector<int> UpdatedSimulation<Dim, Scalar>::isolated_particles() const {
  std::vector<bool> has_neighbour(mass_.size(), particles() == 1);
  for (int a = 0; a < particles(); ++a)
    for (int pair = first_[a]; pair < first_[a + 1]; ++pair) has_neighbour[a] = has_neighbour[neighbour_[pair]] = true;
  std::vector<int> isolated;
  for (int a = 0; a < particles(); ++a)
    if (!has_neighbour[a]) isolated.push_back(a);
  return isolated;
}

template <int Dim, class Scalar>
Scalar UpdatedSimulation<Dim, Scalar>::elastic_energy(const UpdatedState<Dim, Scalar>& state) const {
  Scalar energy(0);
  for (int a = 0; a < particles(); ++a) {
    const auto& [reference_density, sound_speed_squared, shear_modulus] = substances_[material_[a]];
    const Scalar P = pressure(state.density[a], reference_density, sound_speed_squared);
    Scalar density = P * P / (Scalar(2) * reference_density * sound_speed_squared);
    if (shear_modulus > Scalar(0))
      density += deviatoric_stress_in_space<Scalar, Dim>(state.deviatoric_stress[a]).squaredNorm() /
                 (Scalar(4) * shear_modulus);
    energy += mass_[a] / state.density[a] * density;
  }
  return energy;
}

template <int Dim, class Scalar>
Scalar UpdatedSimulation<Dim, Scalar>::kinetic_energy(const UpdatedState<Dim, Scalar>& state) const {
  Scalar twice_energy(0);
  for (int a = 0; a < particles(); ++a) twice_energy += mass_[a] * state.velocity[a].squaredNorm();
  return twice_energy / Scalar(2);
}

template <int Dim, class Scalar>
Vector<Dim, Scalar> UpdatedSimulation<Dim, Scalar>::momentum(const UpdatedState<Dim, Scalar>& state) const {
  Vector<Dim, Scalar> sum = Vector<Dim, Scalar>::Zero();
  for (int a = 0; a < particles(); ++a) sum += mass_[a] * state.velocity[a];
  return sum;
}

template <int Dim, class Scalar>
Tensor<Dim, Scalar> UpdatedSimulation<Dim, Scalar>::angular_momentum(const UpdatedState<Dim, Scalar>& state) const {
  Tensor<Dim, Scalar> sum = Tensor<Dim, Scalar>::Zero();
  for (int a = 0; a < particles(); ++a) sum += mass_[a] * (state.position[a] * state.velocity[a].transpose());
  return sum - sum.transpose();
}

template class UpdatedSimulation<1, double>;
template class UpdatedSimulation<1, float>;
template class UpdatedSimulation<1, Dual>;
template class UpdatedSimulation<2, double>;
template class UpdatedSimulation<2, float>;
template class UpdatedSimulation<2, Dual>;
template class UpdatedSimulation<3, double>;
template class UpdatedSimulation<3, float>;
template class UpdatedSimulation<3, Dual>;

}  // namespace sphstab::solver
