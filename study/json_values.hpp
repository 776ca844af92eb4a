// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <optional>
#include <type_traits>
#include <vector>

#include "analysis/critical_step.hpp"
#include "model/tensor.hpp"
#include "study/request.hpp"

// How the values of the library look in JSON, for the answers of all commands.

namespace sphstab::study {

template <class... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};
template <class... Handlers>
Overloaded(Handlers...) -> Overloaded<Handlers...>;

/// Calls `answer` with the dimension as a compile-time constant: the one place where a run-time dimension becomes one.
template <class Answer>
auto in_dimension(const Case& input, const Answer& answer) {
  switch (input.dimension()) {
    case 1:
      return answer(std::integral_constant<int, 1>());
    case 2:
      return answer(std::integral_constant<int, 2>());
    default:
      return answer(std::integral_constant<int, 3>());
  }
}

template <int Rows>
Json components(const Vector<Rows>& vector) {
  return std::vector<double>(vector.data(), vector.data() + Rows);
}

template <int Dim>
Json rows(const Tensor<Dim>& tensor) {
  Json list = Json::array();
  for (int i = 0; i < Dim; ++i) list.push_back(components<Dim>(tensor.row(i)));
  return list;
}

template <int Dim>
Json mode_json(const analysis::CriticalMode<Dim>& mode) {
  return {{"wave_vector", components<Dim>(mode.wave_vector)}, {"branch", name_of(mode.branch)}, {"omega", mode.omega}};
}

inline Json complex_pair(std::complex<double> value) { return {value.real(), value.imag()}; }

inline Json matrix_rows(const Eigen::MatrixXcd& matrix) {
  Json rows = Json::array();
  for (int i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (int j = 0; j < matrix.cols(); ++j) row.push_back(complex_pair(matrix(i, j)));
    rows.push_back(std::move(row));
  }
  return rows;
}

inline Json number_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

}  // namespace sphstab::study
