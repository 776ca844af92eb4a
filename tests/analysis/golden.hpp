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
inline std::vector<nlohmann::json> cases(const std::string& command) {
  std::ifstream file(SPHSTAB_GOLDEN_FOLDER "/tl_linear_cases.jsonl");
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

/// The measure of the reference cases: |difference| / max(1, |value|).
inline double difference(double ours, double theirs) {
  return std::abs(ours - theirs) / std::max(1.0, std::abs(theirs));
}

}  // namespace sphstab::golden
