// SPDX-License-Identifier: MIT
#include "model/case.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <numbers>

#include "model/compressible.hpp"

namespace sphstab {
namespace {

constexpr double default_h_over_spacing = 1.3;

template <class Enum>
Enum enumerator(const Case& input, std::string_view key) {
  return from_name<Enum>(key, input.required_word(key));
}

InvalidInput missing(const Key& key) { return InvalidInput(fmt::format("{}: missing ({})", key.name, key.help)); }

void refuse_both(const Case& input, std::string_view one, std::string_view other) {
  if (input.has(one) && input.has(other)) throw InvalidInput(fmt::format("{}: cannot be given with {}", one, other));
}

void require_length(std::string_view key, std::size_t given, std::size_t needed) {
  if (given != needed) throw InvalidInput(fmt::format("{}: has {} components, but {} are needed", key, given, needed));
}

/// Formulations that some keys are for.
struct SchemeFamily {
  std::string_view name;
  bool (*includes)(Formulation);
};
using enum Formulation;
constexpr SchemeFamily linear{"the scheme tl-linear", [](Formulation f) { return f == total_lagrangian_linear; }};
constexpr SchemeFamily finite_strain{"the schemes tl-corotated and tl-pk1", is_finite_strain};
constexpr SchemeFamily total_lagrangian{"total-Lagrangian schemes", is_total_lagrangian};
constexpr SchemeFamily updated{"the scheme ul", [](Formulation f) { return f == updated_lagrangian; }};

/// The keys that mean something for some formulations only.
struct SchemeKey {
  std::string_view name;
  SchemeFamily of;
};
constexpr std::array scheme_keys{SchemeKey{"density_in_momentum", linear},
                                 SchemeKey{"displacement_gradient", linear},
                                 SchemeKey{"kernel_normalisation", linear},
                                 SchemeKey{"plane", linear},
                                 SchemeKey{"elastic_law", finite_strain},
                                 SchemeKey{"damping_rate", total_lagrangian},
                                 SchemeKey{"sound_speed", updated},
                                 SchemeKey{"pressure", updated},
                                 SchemeKey{"deviatoric_stress", updated},
                                 SchemeKey{"artificial_stress_epsilon", updated},
                                 SchemeKey{"xsph", updated},
                                 SchemeKey{"viscosity_alpha", updated},
                                 SchemeKey{"density_rate", updated}};

/// Whether the key switches nothing on: zeros, or the default.
bool is_neutral(const Case& input, const Key& key) {
  if (key.kind == KeyKind::numbers) {
    const auto values = *input.numbers(key.name);
    return std::all_of(values.begin(), values.end(), [](double value) { return value == 0.0; });
  }
  if (key.kind == KeyKind::number) return *input.number(key.name) == 0.0;
  return *input.word(key.name) == key.default_value;
}

InvalidInput of_another_scheme(std::string_view key, std::string_view of, Formulation given) {
  return InvalidInput(fmt::format("{}: is for {}, not {}", key, of, name_of(given)));
}

void refuse_keys_of_other_schemes(const Case& input, Formulation formulation) {
  for (const auto& [name, of] : scheme_keys)
    if (!of.includes(formulation) && input.has(name) && !is_neutral(input, find_key(name)))
      throw of_another_scheme(name, of.name, formulation);
}

std::optional<ArtificialStress> make_artificial_stress(const Case& input) {
  const double epsilon = input.required_number("artificial_stress_epsilon");
  if (epsilon == 0.0) return std::nullopt;
  return ArtificialStress{
      .epsilon = epsilon,
      .exponent = input.required_number("artificial_stress_exponent"),
      .weight = enumerator<ArtificialStressWeight>(input, "artificial_stress_weight"),
      .linearisation = enumerator<ArtificialStressLinearisation>(input, "artificial_stress_linearisation"),
      .zero_side = enumerator<ZeroStressSide>(input, "artificial_stress_zero_side")};
}

Scheme make_scheme(const Case& input) {
  Scheme scheme{.formulation = enumerator<Formulation>(input, "scheme"),
                .elastic_law = enumerator<ElasticLaw>(input, "elastic_law"),
                .momentum_density = enumerator<MomentumDensity>(input, "density_in_momentum"),
                .kernel_normalisation = enumerator<KernelNormalisation>(input, "kernel_normalisation"),
                .damping = std::nullopt,
                .artificial_stress = make_artificial_stress(input),
                .xsph = std::nullopt,
                .viscosity = std::nullopt,
                .density_rate = enumerator<DensityRate>(input, "density_rate")};
  refuse_keys_of_other_schemes(input, scheme.formulation);
  if (scheme.elastic_law == ElasticLaw::neo_hookean && scheme.formulation == total_lagrangian_corotated)
    throw of_another_scheme("elastic_law: neo-hookean", "the scheme tl-pk1", scheme.formulation);
  if (const double rate = input.required_number("damping_rate"); rate > 0.0) scheme.damping = Damping{rate};
  if (const double epsilon = input.required_number("xsph"); epsilon != 0.0) scheme.xsph = Xsph{epsilon};
  if (const double alpha = input.required_number("viscosity_alpha"); alpha > 0.0)
    scheme.viscosity =
        Viscosity{alpha, input.required_number("viscosity_eta"), enumerator<ViscousPairs>(input, "viscosity_pairs")};
  return scheme;
}

Integrator make_integrator(const Case& input, Formulation formulation) {
  const bool is_updated = !is_total_lagrangian(formulation);
  if (!input.has("integrator")) return is_updated ? Integrator::predictor_corrector : Integrator::leapfrog;
  const auto integrator = enumerator<Integrator>(input, "integrator");
  if (!is_updated && integrator != Integrator::leapfrog && integrator != Integrator::verlet)
    throw for_updated_lagrangian_only(integrator);
  return integrator;
}

template <int Dim>
Tensor<Dim> make_tensor(const Case& input, std::string_view key, const Tensor<Dim>& otherwise = Tensor<Dim>::Zero()) {
  const auto rows = input.numbers(key);
  if (!rows) return otherwise;
  require_length(key, rows->size(), Dim * Dim);
  return Eigen::Map<const Tensor<Dim>>(rows->data()).transpose();
}

/// Whatever it is that it deforms.
template <int Dim>
Tensor<Dim> make_deformation_gradient(const Case& input, Formulation formulation) {
  const Tensor<Dim> unity = Tensor<Dim>::Identity(), F = make_tensor<Dim>(input, "deformation_gradient", unity);
  if (formulation == total_lagrangian_linear && F != unity)
    throw of_another_scheme("deformation_gradient", "the schemes tl-corotated, tl-pk1 and ul", formulation);
  return F;
}

/// The lattice on which the kernels are evaluated: that of the base state in `ul`, the reference state otherwise.
template <int Dim>
Lattice<Dim> make_deformed_lattice(const Case& input, Formulation formulation) {
  if (is_total_lagrangian(formulation)) return make_lattice<Dim>(input);
  return make_lattice<Dim>(input).deformed(make_deformation_gradient<Dim>(input, formulation));
}

/// S of the base state of `ul`.
template <int Dim>
Tensor<Dim> make_deviatoric_stress(const Case& input) {
  const auto components = input.numbers("deviatoric_stress");
  if (!components) return Tensor<Dim>::Zero();
  require_length("deviatoric_stress", components->size(), symmetric_size<Dim>);
  return symmetric_tensor<Dim, double>(Eigen::Map<const Vector<symmetric_size<Dim>>>(components->data()));
}

/// Throws InvalidInput unless the base state of `ul` has a density.
void require_density(const Material& material, double pressure) {
  const double density = material.density() * (1.0 + pressure / material.bulk_modulus());
  if (!(density > 0.0))
    throw InvalidInput(
        fmt::format("pressure: {} leaves no density: density + pressure / sound_speed^2 is {}", pressure, density));
}

}  // namespace

void Case::set(std::string_view key, KeyValue value) {
  check_value(find_key(key), value);
  values_.insert_or_assign(std::string(key), std::move(value));
}

Case Case::under(const Case& upper) const {
  Case merged = upper;
  merged.values_.insert(values_.begin(), values_.end());
  return merged;
}

template <class Type>
std::optional<Type> Case::value(std::string_view key) const {
  if (const auto found = values_.find(key); found != values_.end()) {
    if (const auto* held = std::get_if<Type>(&found->second)) return *held;
    if constexpr (std::is_same_v<Type, std::string>) return std::nullopt;  // a number where a word could be
    throw InvalidInput(fmt::format("{}: '{}' is for run; here a number is needed", key,
                                   std::get<std::string>(found->second)));
  }
  const Key& entry = find_key(key);
  if (entry.default_value.empty()) return std::nullopt;
  return std::get<Type>(parse_value(entry, entry.default_value));
}

template std::optional<double> Case::value(std::string_view) const;
template std::optional<std::string> Case::value(std::string_view) const;
template std::optional<std::vector<double>> Case::value(std::string_view) const;

double Case::required_number(std::string_view key) const {
  if (const auto found = number(key)) return *found;
  throw missing(find_key(key));
}

std::string Case::required_word(std::string_view key) const {
  if (const auto found = word(key)) return *found;
  throw missing(find_key(key));
}

template <int Dim>
Kernel<Dim> make_kernel(const Case& input) {
  refuse_both(input, "smoothing_length", "h_over_spacing");
  const double h_over_spacing = input.number("h_over_spacing").value_or(default_h_over_spacing);
  const double smoothing_length =
      input.number("smoothing_length").value_or(h_over_spacing * input.required_number("spacing"));
  return Kernel<Dim>(enumerator<KernelFamily>(input, "kernel"), smoothing_length,
                     input.required_number("gaussian_cutoff"));
}

template <int Dim>
Lattice<Dim> make_lattice(const Case& input) {
  constexpr std::array default_kind{LatticeKind::chain, LatticeKind::square, LatticeKind::cubic};
  const auto kind = input.has("lattice") ? enumerator<LatticeKind>(input, "lattice") : default_kind[Dim - 1];
  const double spacing = input.required_number("spacing");
  if (kind != LatticeKind::custom) {
    if (input.has("primitive_vectors"))
      throw InvalidInput(fmt::format("primitive_vectors: only for the lattice custom, not {}", name_of(kind)));
    return Lattice<Dim>(kind, spacing);
  }
  if (!input.has("primitive_vectors")) throw missing(find_key("primitive_vectors"));
  return Lattice<Dim>(make_tensor<Dim>(input, "primitive_vectors").transpose(), spacing);
}

NeighbourRule neighbour_rule(const Case& input) { return enumerator<NeighbourRule>(input, "neighbours"); }

Material make_material(const Case& input) {
  for (const auto one : {"young_modulus", "poisson_ratio"})
    for (const auto other : {"bulk_modulus", "shear_modulus", "sound_speed"}) refuse_both(input, one, other);
  refuse_both(input, "bulk_modulus", "sound_speed");
  const double density = input.required_number("density");
  if (const auto sound_speed = input.number("sound_speed"))
    return Material::from_sound_speed(density, *sound_speed, input.required_number("shear_modulus"));
  if (input.has("bulk_modulus") || input.has("shear_modulus")) {
    if (!input.has("bulk_modulus"))
      throw InvalidInput("bulk_modulus: missing (with shear_modulus; or sound_speed for ul)");
    const double bulk_modulus = input.required_number("bulk_modulus");
    return Material::from_bulk_modulus(density, bulk_modulus, input.required_number("shear_modulus"));
  }
  const double young_modulus = input.required_number("young_modulus");
  return Material::from_young_modulus(density, young_modulus, input.required_number("poisson_ratio"));
}

template <int Dim>
Problem<Dim> make_problem(const Case& input) {
  const Scheme scheme = make_scheme(input);
  Problem<Dim> problem{.lattice = make_deformed_lattice<Dim>(input, scheme.formulation),
                       .kernel = make_kernel<Dim>(input),
                       .neighbour_rule = neighbour_rule(input),
                       .material = make_material(input),
                       .plane = enumerator<Plane>(input, "plane"),
                       .scheme = scheme,
                       .integrator = make_integrator(input, scheme.formulation),
                       .displacement_gradient = make_tensor<Dim>(input, "displacement_gradient"),
                       .deformation_gradient = Tensor<Dim>::Identity(),
                       .pressure = input.required_number("pressure"),
                       .deviatoric_stress = make_deviatoric_stress<Dim>(input)};
  if (const Tensor<Dim> F = make_deformation_gradient<Dim>(input, scheme.formulation);
      is_finite_strain(scheme.formulation)) {
    if (const double J = F.determinant(); !(J > 0.0))
      throw InvalidInput(fmt::format("deformation_gradient: its determinant {} is not above 0", J));
    problem.deformation_gradient = F;
  }
  if (Dim != 2 && problem.plane != Plane::strain)
    throw InvalidInput(fmt::format("plane: {} is for 2 dimensions, not {}", name_of(problem.plane), Dim));
  if (scheme.formulation == updated_lagrangian) {
    require_compressible(problem.material);
    require_density(problem.material, problem.pressure);
  } else {
    problem.material.lame(problem.plane);  // refuses ν = 0.5 in plane strain
  }
  lattice_neighbours(problem.lattice, problem.kernel.support(), problem.neighbour_rule);  // refuses no neighbour
  return problem;
}

template <int Dim>
Vector<Dim> make_gravity(const Case& input) {
  const auto components = input.numbers("gravity");
  if (!components) return Vector<Dim>::Zero();
  require_length("gravity", components->size(), Dim);
  return Eigen::Map<const Vector<Dim>>(components->data());
}

template <int Dim>
Vector<Dim> make_wave_vector(const Case& input) {
  refuse_both(input, "wave_vector", "mode");
  if (const auto components = input.numbers("wave_vector")) {
    require_length("wave_vector", components->size(), Dim);
    return Eigen::Map<const Vector<Dim>>(components->data());
  }
  const auto mode = make_counts<Dim>(input, "mode");
  if (!mode) throw InvalidInput("wave_vector: missing (or mode with box)");
  const auto box = make_counts<Dim>(input, "box");
  if (!box) throw missing(find_key("box"));
  return std::numbers::pi / input.required_number("spacing") *
         mode->template cast<double>().cwiseQuotient(box->template cast<double>());
}

template <int Dim>
std::optional<LatticeIndex<Dim>> make_counts(const Case& input, std::string_view key) {
  const auto counts = input.numbers(key);
  if (!counts) return std::nullopt;
  require_length(key, counts->size(), Dim);
  return Eigen::Map<const Vector<Dim>>(counts->data()).template cast<int>();
}

template Kernel<1> make_kernel(const Case&);
template Kernel<2> make_kernel(const Case&);
template Kernel<3> make_kernel(const Case&);
template Lattice<1> make_lattice(const Case&);
template Problem<1> make_problem(const Case&);
template Vector<1> make_gravity(const Case&);
template Vector<1> make_wave_vector(const Case&);
template std::optional<LatticeIndex<1>> make_counts(const Case&, std::string_view);
template Lattice<2> make_lattice(const Case&);
template Problem<2> make_problem(const Case&);
template Vector<2> make_gravity(const Case&);
template Vector<2> make_wave_vector(const Case&);
template std::optional<LatticeIndex<2>> make_counts(const Case&, std::string_view);
template Lattice<3> make_lattice(const Case&);
template Problem<3> make_problem(const Case&);
template Vector<3> make_gravity(const Case&);
template Vector<3> make_wave_vector(const Case&);
template std::optional<LatticeIndex<3>> make_counts(const Case&, std::string_view);

}  // namespace sphstab
