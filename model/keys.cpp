// SPDX-License-Identifier: MIT
#include "model/keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "model/names.hpp"
#include "model/problem.hpp"

namespace sphstab {
namespace {

constexpr Limits any_number{};
constexpr Limits positive{.low = 0.0, .low_allowed = false};
constexpr Limits not_negative{.low = 0.0};
constexpr Limits at_least_one{.low = 1.0};

constexpr std::array<std::string_view, 2> seed_words{"noise", "mode"};
constexpr std::array<std::string_view, 1> time_step_words{"auto"};
constexpr std::array<std::string_view, 4> upper_bound_words{"auto", "factorisation", "norm-bound", "probabilistic"};

using enum KeyKind;
using enum KeyGroup;

const Key table[] = {
    {"dimension", integer, discretisation, "2", "number of space dimensions", {.low = 1.0, .high = 3.0}},
    {"lattice", word, discretisation, "",
     "arrangement of the particles; default chain in 1D, square in 2D, cubic in 3D", any_number,
     all_names<LatticeKind>},
    {"primitive_vectors", numbers, discretisation, "",
     "primitive vectors of the lattice custom in spacings, one after the other"},
    {"spacing", number, discretisation, "1", "particle spacing, a length", positive},
    {"kernel", word, discretisation, "cubic-spline", "smoothing kernel", any_number, all_names<KernelFamily>},
    {"smoothing_length", number, discretisation, "", "smoothing length h, a length; default 1.3 spacings", positive},
    {"h_over_spacing", number, discretisation, "", "h in spacings, instead of smoothing_length", positive},
    {"gaussian_cutoff", number, discretisation, "3", "support of the Gaussian in h, not renormalised", positive},
    {"neighbours", word, discretisation, "support", "all sites within the support, or the nearest shell only",
     any_number, all_names<NeighbourRule>},

    {"density", number, material, "1", "reference density", positive},
    {"young_modulus", number, material, "", "Young's modulus, with poisson_ratio", positive},
    {"poisson_ratio", number, material, "", "Poisson's ratio, above -1 and below 0.5"},
    {"bulk_modulus", number, material, "", "bulk modulus, with shear_modulus", positive},
    {"shear_modulus", number, material, "", "shear modulus, stress over engineering shear strain", not_negative},
    {"sound_speed", number, material, "", "ul: bulk sound speed c0, with shear_modulus", positive},
    {"plane", word, material, "strain", "tl-linear: plane strain or plane stress (2D); others are plane strain",
     any_number, all_names<Plane>},

    {"scheme", word, scheme, "",
     "discretisation: tl-linear (Zhang et al., total Lagrangian, linear), tl-corotated (Tran-Duc et al., total "
     "Lagrangian, force R S), tl-pk1 (the same with force F S), ul (Gray et al., updated Lagrangian)",
     any_number, all_names<Formulation>},
    {"integrator", word, scheme, "", "time integrator; default leapfrog, predictor-corrector for ul", any_number,
     all_names<Integrator>},
    {"elastic_law", word, scheme, "saint-venant-kirchhoff",
     "tl-corotated, tl-pk1: stress of large strains; neo-hookean (compressible) for tl-pk1", any_number,
     all_names<ElasticLaw>},
    {"density_in_momentum", word, scheme, "frozen", "tl-linear: density in the momentum equation", any_number,
     all_names<MomentumDensity>},
    {"displacement_gradient", numbers, scheme, "",
     "tl-linear: displacement gradient of the base state, row by row; default zeros"},
    {"deformation_gradient", numbers, scheme, "",
     "tl-corotated, tl-pk1, ul: that of the base state, row by row; with ul the lattice is deformed by it at fixed h "
     "and "
     "W(spacing), a particle filling a deformed cell; default the identity"},
    {"pressure", number, scheme, "0", "ul: pressure of the base state, positive in compression"},
    {"deviatoric_stress", numbers, scheme, "",
     "ul: deviatoric stress of the base state: Sxx; Sxx,Syy,Sxy; Sxx,Syy,Szz,Sxy,Syz,Sxz; default zeros"},
    {"kernel_normalisation", word, scheme, "none", "tl-linear: division of the particle sums by the kernel sum",
     any_number, all_names<KernelNormalisation>},
    {"damping_rate", number, scheme, "0", "tl-linear, tl-corotated, tl-pk1: mass-proportional damping, 1/time",
     not_negative},
    {"density_rate", word, scheme, "masses",
     "ul: sum of masses (Eq. 3.8) or of volumes (Eq. 3.9, for bodies of different densities)", any_number,
     all_names<DensityRate>},
    {"artificial_stress_epsilon", number, scheme, "0", "ul: factor epsilon of the artificial stress, 0 is off",
     not_negative},
    {"artificial_stress_weight", word, scheme, "kernel-ratio",
     "ul: weight of the artificial stress of a pair, (W(r)/W(spacing))^n or (r/spacing)^n", any_number,
     all_names<ArtificialStressWeight>},
    {"artificial_stress_linearisation", word, scheme, "exact",
     "ul: the artificial stress follows the perturbed stress, or is constant as in the published analysis", any_number,
     all_names<ArtificialStressLinearisation>},
    {"artificial_stress_zero_side", word, scheme, "compression",
     "ul: the side from which a principal stress of exactly zero is linearised", any_number, all_names<ZeroStressSide>},
    {"xsph", number, scheme, "0", "ul: XSPH factor, particles move with an average velocity"},
    {"viscosity_alpha", number, scheme, "0", "ul: linear artificial viscosity", not_negative},
    {"viscosity_pairs", word, scheme, "all",
     "ul: pairs that the viscosity acts on; approaching alone has no linear theory", any_number,
     all_names<ViscousPairs>},
    {"viscosity_eta", number, scheme, "0.1", "ul: eta in the viscosity's denominator r^2 + (eta h)^2", not_negative},

    {"wave_vector", numbers, mode, "", "wave vector k, radians per length"},
    {"mode", integers, mode, "", "m,l of k = (m pi/(M spacing), l pi/(L spacing)), with box", any_number},
    {"box", integers, mode, "", "M,L of mode, in particles", at_least_one},

    {"path", text, path, "",
     "labelled points such as G-X-M-G, or G-X|M-R with a break; default the standard path of the lattice"},
    {"path_points", integer, path, "200", "points along the path", {.low = 2.0}},
    {"grid", integers, path, "", "points of a grid over the Brillouin zone along each reciprocal vector", at_least_one},

    {"time_step", number, time, "", "length of a step, a time; run: auto follows the limit of the moving body",
     positive, time_step_words},
    {"tolerated_growth_per_step", number, growth, "", "growth per step, max abs(lambda) - 1, that is acceptable",
     positive},
    {"steps", number, growth, "", "instead of it: number of steps in which a factor e is acceptable", at_least_one},

    {"plate", integers, KeyGroup::body, "", "particles of a free rectangular plate", {.low = 2.0}},
    {"scene", text, KeyGroup::body, "", "TOML file of a scene: its bodies, how they are held and loaded, and keys"},
    {"patch", integers, KeyGroup::body, "",
     "periodic cells along each primitive vector; bisect: default 16 each, 8 in 3D", at_least_one},
    {"gravity", numbers, KeyGroup::body, "", "gravitational acceleration; default zeros"},

    {"lowest_modes", integer, spectrum, "", "number of lowest modes and frequencies to compute", at_least_one},
    {"upper_bound", word, spectrum, "auto",
     "proof that no frequency is larger: a factorisation, a norm bound, or a bound for a random start; auto takes the "
     "tightest that the size of the body allows",
     any_number, upper_bound_words},
    {"state", text, spectrum, "",
     "tl-corotated, tl-pk1: states.h5 of a run of the same body, about a state of which the spectrum is"},
    {"snapshot", integer, spectrum, "", "which of its states, from 0; default the last", not_negative},

    {"duration", number, run, "", "time that is simulated", positive},
    {"step_fraction", number, run, "0.9",
     "time step over the critical one of the scene, instead of time_step; by default less where an integrator grows at "
     "every step",
     positive},
    {"initial_noise", number, run, "0",
     "random velocities at the start, of every component uniform within this many p-wave speeds", not_negative},
    {"snapshots", integer, run, "10", "states that are stored after the first, at equal intervals", at_least_one},

    {"seed", word, search, "noise", "start from noise, or from the critical mode of the theory", any_number,
     seed_words},
    {"noise_seed", integer, noise, "1", "seed of the random numbers", not_negative},
    {"tolerance",
     number,
     search,
     "1e-6",
     "relative width of the bracket",
     {.low = 0.0, .high = 0.1, .low_allowed = false}},
    {"horizon", integer, search, "", "steps of a run; default from the tolerance", {.low = 30.0}},
    {"command", text, search, "",
     "foreign solver: a shell command in which {time_step} and {steps} are replaced and that prints one amplitude a "
     "step"},

    {"distance", number, distance, "", "distance of two particles, a length", not_negative},
    {"artificial_stress_exponent", number, artificial_stress, "4", "ul: exponent n of the artificial stress's weight",
     not_negative},
};

bool is_word_of(const Key& key, std::string_view given) {
  return std::find(key.words.begin(), key.words.end(), given) != key.words.end();
}

double parse_number(const Key& key, std::string_view word) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size())
    throw InvalidInput(fmt::format("{}: '{}' is not a number{}{}", key.name, word, key.words.empty() ? "" : " or ",
                                   fmt::join(key.words, ", ")));
  return value;
}

std::vector<double> parse_list(const Key& key, std::string_view text) {
  std::vector<double> values;
  for (const auto part : split(text, ',')) values.push_back(parse_number(key, part));
  return values;
}

void check_number(const Key& key, double value) {
  if (!std::isfinite(value)) throw InvalidInput(fmt::format("{}: {} is not a finite number", key.name, value));
  if ((key.kind == integer || key.kind == integers) && value != std::floor(value))
    throw InvalidInput(fmt::format("{}: {} is not a whole number", key.name, value));
  if (value < key.limits.low || (!key.limits.low_allowed && value == key.limits.low))
    throw InvalidInput(fmt::format("{}: {} is not {} {}", key.name, value,
                                   key.limits.low_allowed ? "at least" : "above", key.limits.low));
  if (value > key.limits.high)
    throw InvalidInput(fmt::format("{}: {} is not at most {}", key.name, value, key.limits.high));
  // Counts are stored as int further on.
  if ((key.kind == integer || key.kind == integers) && std::abs(value) > std::numeric_limits<int>::max())
    throw InvalidInput(fmt::format("{}: {} is too large", key.name, value));
}

}  // namespace

std::span<const Key> key_table() { return table; }

const Key& find_key(std::string_view name) {
  const auto found = std::find_if(std::begin(table), std::end(table), [&](const Key& key) { return key.name == name; });
  if (found != std::end(table)) return *found;
  std::vector<std::string_view> names;
  for (const Key& key : table) names.push_back(key.name);
  throw unknown_word("key", name, names);
}

KeyValue parse_value(const Key& key, std::string_view text_given) {
  switch (key.kind) {
    case number:
    case integer:
      if (is_word_of(key, text_given)) return std::string(text_given);
      return parse_number(key, text_given);
    case numbers:
    case integers:
      return parse_list(key, text_given);
    case word:
    case text:
      return std::string(text_given);
  }
  return {};
}

void check_value(const Key& key, const KeyValue& value) {
  switch (key.kind) {
    case number:
    case integer:
      if (const auto* given = std::get_if<std::string>(&value); given && is_word_of(key, *given)) return;
      if (!std::holds_alternative<double>(value)) throw InvalidInput(fmt::format("{}: is not a number", key.name));
      return check_number(key, std::get<double>(value));
    case numbers:
    case integers:
      if (!std::holds_alternative<std::vector<double>>(value))
        throw InvalidInput(fmt::format("{}: is not a list of numbers", key.name));
      for (const double component : std::get<std::vector<double>>(value)) check_number(key, component);
      return;
    case word:
    case text:
      if (!std::holds_alternative<std::string>(value)) throw InvalidInput(fmt::format("{}: is not a word", key.name));
      if (const auto& given = std::get<std::string>(value); !key.words.empty() && !is_word_of(key, given))
        throw unknown_word(key.name, given, key.words);
      return;
  }
}

}  // namespace sphstab
