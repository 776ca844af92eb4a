// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "model/problem.hpp"

namespace sphstab::golden {

/// The reference cases of one command, one JSON object a line, from an implementation that shares nothing with ours.
inline std::vector<nlohmann::json> cases(const std::string& command, const std::string& scheme = "tl_linear") {
  std::ifstream file(SPHSTAB_GOLDEN_FOLDER "/" + scheme + "_cases.jsonl");
  std::vector<nlohmann::json> found;
  for (std::string line; std::getline(file, line);)
    if (auto line_case = nlohmann::json::parse(line); line_case["command"] == command) found.push_back(line_case);
  return found;
}

template <class Enum>
Enum word(const nlohmann::json& reference, const char* key, Enum otherwise) {
  return reference.contains(key) ? from_name<Enum>(key, reference[key].get<std::string>()) : otherwise;
}

template <class EigenType>
EigenType numbers(const nlohmann::json& list) {
  EigenType result;
  for (int i = 0; i < result.size(); ++i) result[i] = list.at(static_cast<std::size_t>(i));
  return result;
}

/// The problem of a line; `sums` names no material and needs none.
inline Problem<2> problem(const nlohmann::json& reference) {
  Problem<2> problem{
      Lattice<2>(word(reference, "lattice", LatticeKind::square), reference["spacing"]),
      Kernel<2>(word(reference, "kernel", KernelFamily::cubic_spline), reference["smoothing_length"],
                reference.value("gaussian_cutoff", default_gaussian_cutoff)),
      word(reference, "neighbours", NeighbourRule::support),
      Material::from_young_modulus(reference.value("density", 1.0), reference.value("young_modulus", 1.0),
                                   reference.value("poisson_ratio", 0.25)),
      word(reference, "plane", Plane::strain),
      Scheme{},
      word(reference, "integrator", Integrator::leapfrog)};
  problem.scheme.kernel_normalisation = word(reference, "kernel_normalisation", KernelNormalisation::none);
  return problem;
}

/// The problem of a line of `ul`.
inline Problem<2> updated_problem(const nlohmann::json& reference) {
  Problem<2> problem{
      Lattice<2>(word(reference, "lattice", LatticeKind::square), reference["spacing"]),
      Kernel<2>(word(reference, "kernel", KernelFamily::cubic_spline), reference["smoothing_length"],
                reference.value("gaussian_cutoff", default_gaussian_cutoff)),
      NeighbourRule::support,
      Material::from_sound_speed(reference["density"], reference["sound_speed"], reference["shear_modulus"]),
      Plane::strain,
      Scheme{},
      word(reference, "integrator", Integrator::predictor_corrector)};
  Scheme& scheme = problem.scheme;
  scheme.formulation = Formulation::updated_lagrangian;
  problem.pressure = reference["pressure"];
  if (reference.contains("deviatoric_stress"))
    problem.deviatoric_stress = symmetric_tensor<2, double>(numbers<Vector<3>>(reference["deviatoric_stress"]));
  if (const double xsph = reference.value("xsph", 0.0); xsph != 0.0) scheme.xsph = Xsph{xsph};
  if (const double epsilon = reference.value("artificial_stress_epsilon", 0.0); epsilon != 0.0)
    scheme.artificial_stress = ArtificialStress{
        epsilon, reference.value("artificial_stress_exponent", 4.0), ArtificialStressWeight::kernel_ratio,
        word(reference, "artificial_stress_linearisation", ArtificialStressLinearisation::exact)};
  if (const double alpha = reference.value("viscosity_alpha", 0.0); alpha != 0.0)
    scheme.viscosity = Viscosity{alpha, reference["viscosity_eta"]};
  return problem;
}

/// The measure of the reference cases: |difference| / max(1, |value|).
inline double difference(double ours, double theirs) {
  return std::abs(ours - theirs) / std::max(1.0, std::abs(theirs));
}

}  // namespace sphstab::golden
