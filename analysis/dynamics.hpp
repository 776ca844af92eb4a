// SPDX-License-Identifier: MIT
#pragma once

#include <complex>

#include "model/tensor.hpp"

namespace sphstab::analysis {

/// The eigenvalues of M, by real then imaginary part; what rounding could have made of 0, or of a real number, is that.
template <int Dim>
Vector<Dim, std::complex<double>> squared_frequencies(const Tensor<Dim>& dynamical_matrix, double rounding);

/// The fastest growth of e^{iωt} and e^{−iωt}: |Re √(−ω²)|.
double growth_rate_of(std::complex<double> omega_squared);

/// M of d²x/dt² = −M x for one wave, 1 / time².
template <int Dim>
struct Dynamics {
  Tensor<Dim> M;
  double rounding;  ///< of an entry of M

  Vector<Dim, std::complex<double>> omega_squared() const { return squared_frequencies<Dim>(M, rounding); }
  bool symmetric() const { return (M - M.transpose()).cwiseAbs().maxCoeff() <= rounding; }
};

extern template Vector<1, std::complex<double>> squared_frequencies(const Tensor<1>&, double);
extern template Vector<2, std::complex<double>> squared_frequencies(const Tensor<2>&, double);
extern template Vector<3, std::complex<double>> squared_frequencies(const Tensor<3>&, double);

}  // namespace sphstab::analysis
