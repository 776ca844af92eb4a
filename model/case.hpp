// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>

#include "model/keys.hpp"
#include "model/problem.hpp"

namespace sphstab {

/// The keys of a case and their values, each checked on its own when it is set.
class Case {
 public:
  /// Sets or replaces a value. Throws InvalidInput for an unknown key, a value of the wrong kind or out of its limits.
  void set(std::string_view key, KeyValue value);

  bool has(std::string_view key) const { return values_.find(key) != values_.end(); }

  /// This case with every key that `upper` sets over its own.
  Case under(const Case& upper) const;

  /// The value, or the default of the key table, or nothing.
  std::optional<double> number(std::string_view key) const { return value<double>(key); }
  std::optional<std::string> word(std::string_view key) const { return value<std::string>(key); }
  std::optional<std::vector<double>> numbers(std::string_view key) const { return value<std::vector<double>>(key); }

  /// The same, where a value must be there. Throw InvalidInput naming the key if it is not.
  double required_number(std::string_view key) const;
  std::string required_word(std::string_view key) const;

  int dimension() const { return static_cast<int>(*number("dimension")); }

 private:
  template <class Type>
  std::optional<Type> value(std::string_view key) const;

  std::map<std::string, KeyValue, std::less<>> values_;
};

/// Kernel of the case; h from smoothing_length, or h_over_spacing, or 1.3 spacings. Throws InvalidInput if both are
/// given.
template <int Dim>
Kernel<Dim> make_kernel(const Case& input);

/// Lattice of the case. primitive_vectors lists a_1, a_2 … one after the other, in spacings. Throws InvalidInput if
/// they are missing for the lattice custom, given for another, too few or many, or dependent.
template <int Dim>
Lattice<Dim> make_lattice(const Case& input);

NeighbourRule neighbour_rule(const Case& input);

/// Density, and Young's modulus with Poisson's ratio, or the shear modulus with the bulk modulus or the bulk sound
/// speed. Throws InvalidInput if one is missing, two pairs are given, or a value is not allowed.
Material make_material(const Case& input);

/// The whole problem. Throws InvalidInput naming the key for whatever is missing, contradictory or impossible together.
template <int Dim>
Problem<Dim> make_problem(const Case& input);

/// The acceleration of the key gravity, zeros if it is absent. Throws InvalidInput for a wrong length.
template <int Dim>
Vector<Dim> make_gravity(const Case& input);

/// k from wave_vector, or from mode and box: k = (mπ/(M Δp), lπ/(L Δp)), Zhang Eq. 13. Throws InvalidInput if neither
/// or both are there or a length is wrong.
template <int Dim>
Vector<Dim> make_wave_vector(const Case& input);

/// Counts along each direction (patch, plate, box). Nothing if the key is absent; throws InvalidInput for a wrong
/// length.
template <int Dim>
std::optional<LatticeIndex<Dim>> make_counts(const Case& input, std::string_view key);

}  // namespace sphstab
