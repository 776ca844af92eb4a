// SPDX-License-Identifier: MIT
#include "analysis/lattice_sums.hpp"

#include <cmath>
#include <complex>

#include "model/lattice_index.hpp"

namespace sphstab::analysis {
namespace {

/// `along` on the direction e, `across` on every direction normal to it.
template <int Dim>
Tensor<Dim> axial(const Vector<Dim>& e, double along, double across) {
  return across * Tensor<Dim>::Identity() + (along - across) * e * e.transpose();
}

/// φ of a pair and its derivative.
struct PairWeight {
  double value;
  double slope;
};

template <int Dim>
PairWeight pair_weight(const ArtificialStress& artificial_stress, const Kernel<Dim>& kernel, double spacing, double r) {
  const double n = artificial_stress.exponent;
  switch (artificial_stress.weight) {
    case ArtificialStressWeight::kernel_ratio: {
      const double W = kernel.value(r), W_spacing = kernel.value(spacing);
      if (!(W > 0.0 && W_spacing > 0.0)) return {0.0, 0.0};
      const double phi = std::pow(W / W_spacing, n);
      return {phi, n * phi * kernel.slope(r) / W};
    }
    case ArtificialStressWeight::distance_ratio: {
      const double phi = std::pow(r / spacing, n);
      return {phi, n * phi / r};
    }
  }
  return {};
}

}  // namespace

template <int Dim>
LatticeSummation<Dim>::LatticeSummation(const Lattice<Dim>& lattice, const Kernel<Dim>& kernel, NeighbourRule rule,
                                        const std::optional<ArtificialStress>& artificial_stress,
                                        const std::optional<Viscosity>& viscosity)
    : has_artificial_stress_(artificial_stress), has_viscosity_(viscosity) {
  const double twice_V = 2.0 * lattice.cell_volume();
  for (const auto& neighbour : lattice_neighbours(lattice, kernel.support(), rule)) {
    if (!in_upper_half<Dim>(neighbour.index)) continue;
    const double r = neighbour.distance;
    const Vector<Dim> d = neighbour.position, e = d / r;
    const double dW = twice_V * kernel.slope(r), d2W = twice_V * kernel.curvature(r);
    Pair pair{d,
              twice_V * kernel.value(r),
              dW * e,
              axial<Dim>(e, d2W, dW / r),
              Vector<Dim>::Zero(),
              Tensor<Dim>::Zero(),
              Tensor<Dim>::Zero()};
    if (artificial_stress) {
      const auto phi = pair_weight(*artificial_stress, kernel, lattice.spacing(), r);
      pair.weighted_slope = phi.value * pair.slope;
      pair.weighted_curvature = axial<Dim>(e, phi.value * d2W + phi.slope * dW, phi.value * dW / r);
    }
    if (viscosity) {
      const double soft = viscosity->eta * kernel.smoothing_length();
      pair.friction = dW * r / (r * r + soft * soft) * e * e.transpose();
    }
    pairs_.push_back(pair);
    largest_A_ += pair.slope.norm();
    largest_B_ += 2.0 * pair.curvature.norm();
    largest_f_ += 2.0 * pair.weighted_curvature.norm();
  }
}

template <int Dim>
template <class Scalar>
LatticeSums<Dim, Scalar> LatticeSummation<Dim>::operator()(const Vector<Dim, Scalar>& wave_vector) const {
  using std::cos, std::sin;
  LatticeSums<Dim, Scalar> sums{Vector<Dim, Scalar>::Zero(), Tensor<Dim, Scalar>::Zero(), Scalar(0.0),
                                Vector<Dim, Scalar>::Zero(), Tensor<Dim, Scalar>::Zero(), Tensor<Dim, Scalar>::Zero()};
  for (const Pair& pair : pairs_) {
    const Scalar half_angle = 0.5 * (wave_vector.transpose() * pair.d).value();
    const Scalar half_sine = sin(half_angle);
    const Scalar sine = 2.0 * half_sine * cos(half_angle), one_minus_cosine = 2.0 * half_sine * half_sine;
    sums.A += sine * pair.slope;
    sums.B += one_minus_cosine * pair.curvature;
    sums.beta_sum += one_minus_cosine * pair.W;
    if (has_artificial_stress_) {
      sums.A_phi += sine * pair.weighted_slope;
      sums.f += one_minus_cosine * pair.weighted_curvature;
    }
    if (has_viscosity_) sums.Gamma += one_minus_cosine * pair.friction;
  }
  return sums;
}

template <int Dim>
double LatticeSummation<Dim>::long_wave_weight() const {
  double weighted = 0.0, plain = 0.0;
  for (const Pair& pair : pairs_) {
    weighted += pair.d[0] * pair.weighted_slope[0];
    plain += pair.d[0] * pair.slope[0];
  }
  return weighted / plain;
}

template class LatticeSummation<1>;
template LatticeSums<1> LatticeSummation<1>::operator()(const Vector<1>&) const;
template LatticeSums<1, std::complex<double>> LatticeSummation<1>::operator()(
    const Vector<1, std::complex<double>>&) const;
template class LatticeSummation<2>;
template LatticeSums<2> LatticeSummation<2>::operator()(const Vector<2>&) const;
template LatticeSums<2, std::complex<double>> LatticeSummation<2>::operator()(
    const Vector<2, std::complex<double>>&) const;
template class LatticeSummation<3>;
template LatticeSums<3> LatticeSummation<3>::operator()(const Vector<3>&) const;
template LatticeSums<3, std::complex<double>> LatticeSummation<3>::operator()(
    const Vector<3, std::complex<double>>&) const;

}  // namespace sphstab::analysis
