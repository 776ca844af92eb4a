// SPDX-License-Identifier: MIT
#include "study/beam_theory.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

#include "model/errors.hpp"
#include "study/plane_moduli.hpp"

namespace sphstab::study {

namespace {

using std::numbers::pi;
const boost::math::tools::eps_tolerance<double> to_rounding;

double midpoint(const std::pair<double, double>& bracket) { return 0.5 * (bracket.first + bracket.second); }

void require_mode(int mode) {
  if (mode < 1) throw InvalidInput(fmt::format("mode: {} is not at least 1", mode));
}

/// √(EI/ρA)/(2πL²): the frequency f of 2πf L² √(ρA/EI) = 1.
double frequency_unit(const Beam& beam) {
  require_positive("length", beam.length);
  require_positive("height", beam.height);
  const double stiffness = plane_moduli(beam.material, beam.plane).young_modulus / beam.material.density();
  return std::sqrt(stiffness / 12.0) * beam.height / (2.0 * pi * beam.length * beam.length);
}

/// Timoshenko's beam of unit length, EI and ρA. At the angular frequency b its state (w, φ, Q = (w' − φ)/s², M = φ')
/// obeys w' = φ + s²Q, φ' = M, Q' = −b²w, M' = −Q − b²r²φ.
struct UnitBeam {
  double r_squared;  ///< I/(AL²): inertia of rotation
  double s_squared;  ///< EI/(κGAL²): compliance in shear
  BeamEnds ends;
};

/// The largest wave number q of solutions e^{iqx}: q⁴ − b²(r²+s²) q² = b²(1 − b²r²s²).
double largest_wave_number(const UnitBeam& beam, double b) {
  const double half_sum = 0.5 * b * (beam.r_squared + beam.s_squared);
  const double half_difference = 0.5 * b * (beam.r_squared - beam.s_squared);
  return std::sqrt(b * (half_sum + std::sqrt(half_difference * half_difference + 1.0)));
}

/// Takes the state (w, φ/q, Q/q³, M/q²), of even size, along the length `angle`/q.
Eigen::Matrix4d transfer_matrix(const UnitBeam& beam, double b, double q, double angle) {
  const double slowness_squared = (b / q) * (b / q);
  Eigen::Matrix4d rate = Eigen::Matrix4d::Zero();
  rate(0, 1) = 1.0;
  rate(0, 2) = beam.s_squared * q * q;
  rate(1, 3) = 1.0;
  rate(2, 0) = -slowness_squared / (q * q);
  rate(3, 1) = -slowness_squared * beam.r_squared;
  rate(3, 2) = -1.0;
  return (angle * rate).exp();
}

int negative_eigenvalues(const Eigen::Matrix2d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(symmetric, Eigen::EigenvaluesOnly);
  return static_cast<int>((solver.eigenvalues().array() < 0.0).count());
}

/// The number of modes below the angular frequency b, rigid motions included, by Wittrick and Williams (1971): the
/// negative eigenvalues of the dynamic stiffness of segments joined at nodes, given that no segment has a mode below b
/// with clamped ends. None has where q·length < π/2, because even with a hinged and a guided end its lowest has π/2.
int modes_below(const UnitBeam& beam, double b) {
  const double q = largest_wave_number(beam, b);
  // An even number: where slender beams vibrate, q ≈ (n ± ½)π, what lies behind a node then resonates at no node.
  const int half = static_cast<int>(q / pi) + 1, segments = 2 * half;
  const Eigen::Matrix4d transfer = transfer_matrix(beam, b, q, q / segments);
  const Eigen::Matrix2d displacement_by_force = transfer.topRightCorner<2, 2>();
  const Eigen::Matrix2d stiffness_of_segment = displacement_by_force.inverse() * transfer.topLeftCorner<2, 2>();
  Eigen::Matrix2d stiffness = Eigen::Matrix2d::Zero();  // for (w, φ), of all that lies behind the node
  int count = 0;
  const auto eliminate_node = [&] {
    const Eigen::Matrix2d of_node = stiffness + stiffness_of_segment;
    count += negative_eigenvalues(of_node);
    stiffness = (transfer.bottomLeftCorner<2, 2>() + transfer.bottomRightCorner<2, 2>() * stiffness) *
                (displacement_by_force * of_node).inverse();
  };
  if (beam.ends == BeamEnds::clamped_free) {
    for (int node = 0; node < segments; ++node) eliminate_node();
    return count;
  }
  for (int node = 0; node < half; ++node) eliminate_node();
  // In the middle of a free beam two halves meet, mirrored: w and φ part, the stiffness is twice the diagonal.
  return 2 * count + static_cast<int>((stiffness.diagonal().array() < 0.0).count());
}

}  // namespace

double euler_bernoulli_root(BeamEnds ends, int mode) {
  require_mode(mode);
  const double sign = ends == BeamEnds::clamped_free ? 1.0 : -1.0;
  const int first = ends == BeamEnds::clamped_free ? mode - 1 : mode;  // one root between first·π and the next multiple
  std::uintmax_t iterations = 100;
  return midpoint(boost::math::tools::toms748_solve([&](double x) { return std::cos(x) + sign / std::cosh(x); },
                                                    first * pi, (first + 1) * pi, to_rounding, iterations));
}

double euler_bernoulli_frequency(const Beam& beam, int mode) {
  const double root = euler_bernoulli_root(beam.ends, mode);
  return root * root * frequency_unit(beam);
}

double cowper_shear_coefficient(const Material& material, Plane plane) {
  const double nu = plane_moduli(material, plane).poisson_ratio;
  return 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
}

double timoshenko_frequency(const Beam& beam, int mode, double shear_coefficient) {
  require_positive("shear_coefficient", shear_coefficient);
  const double unit = frequency_unit(beam), slenderness = beam.length / beam.height;
  const double r_squared = 1.0 / (12.0 * slenderness * slenderness);
  const double modulus_ratio = plane_moduli(beam.material, beam.plane).young_modulus / beam.material.shear_modulus();
  const UnitBeam unit_beam{r_squared, r_squared * modulus_ratio / shear_coefficient, beam.ends};
  const double modes = mode + (beam.ends == BeamEnds::free_free ? 2 : 0);  // two rigid motions come first
  const auto side = [&](double b) { return modes_below(unit_beam, b) < modes ? -1.0 : 1.0; };
  const double root = euler_bernoulli_root(beam.ends, mode);
  const double above = 2.0 * root * root;  // stiffer and lighter, Euler and Bernoulli's beam has the higher frequencies
  double below = above;
  while (side(below) > 0.0) below *= 0.5;
  return midpoint(boost::math::tools::bisect(side, below, above, to_rounding)) * unit;
}

double timoshenko_frequency(const Beam& beam, int mode) {
  return timoshenko_frequency(beam, mode, cowper_shear_coefficient(beam.material, beam.plane));
}

}  // namespace sphstab::study
