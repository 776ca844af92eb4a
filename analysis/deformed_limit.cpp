// SPDX-License-Identifier: MIT
#include "analysis/deformed_limit.hpp"

#include <algorithm>
#include <random>

#include "analysis/arnoldi.hpp"
#include "analysis/critical_step.hpp"

namespace sphstab::analysis {
namespace {

template <int Dim>
class Search {
 public:
  Search(DeformedBodyOperator<Dim>& body_operator, const DeformedLimitOptions& options)
      : operator_(body_operator), options_(options) {}

  ExtremeSquare extreme(Extreme which, const Eigen::VectorXd& start) {
    const ArnoldiResult found = arnoldi(
        [this](const Eigen::VectorXd& x, Eigen::VectorXd& y) { operator_.apply(x, y); }, start,
        {.extreme = which, .dimension = options_.dimension, .tolerance = options_.tolerance, .most = options_.most});
    applications_ += found.applications;
    const bool is_real = std::abs(found.value.imag()) <= std::max(found.residual, options_.tolerance * found.largest);
    return {is_real ? found.value.real() : found.value, found.residual / found.largest,
            found.vector.real().normalized()};
  }

  /// A direction of equal probability.
  Eigen::VectorXd random_start() const {
    std::mt19937_64 random(options_.seed);
    std::normal_distribution<double> normal;
    Eigen::VectorXd start = Eigen::VectorXd::Zero(operator_.components());
    for (const int i : operator_.unknowns()) start[i] = normal(random);
    return start.normalized();
  }

  long applications() const { return applications_; }

 private:
  DeformedBodyOperator<Dim>& operator_;
  const DeformedLimitOptions& options_;
  long applications_ = 0;
};

}  // namespace

template <int Dim>
DeformedLimit deformed_limit(DeformedBodyOperator<Dim>& body_operator, const DeformedLimitOptions& options) {
  if (body_operator.unknowns().empty()) throw InvalidInput("clamp: holds every particle, so that nothing moves");
  Search<Dim> search(body_operator, options);
  const Eigen::VectorXd random = search.random_start();
  DeformedLimit limit{};
  limit.largest = search.extreme(
      Extreme::rightmost,
      options.start.size() == 0 ? random : Eigen::VectorXd(options.start.normalized() + options.noise * random));
  const std::complex<double> omega_squared = limit.largest.omega_squared;
  if (omega_squared.imag() == 0.0 && omega_squared.real() > 0.0)
    limit.critical_time_step = ModeSteps(body_operator.problem())(omega_squared.real()).limit();
  if (options.leftmost) limit.leftmost = search.extreme(Extreme::leftmost, random);
  limit.applications = search.applications();
  return limit;
}

template DeformedLimit deformed_limit(DeformedBodyOperator<1>&, const DeformedLimitOptions&);
template DeformedLimit deformed_limit(DeformedBodyOperator<2>&, const DeformedLimitOptions&);
template DeformedLimit deformed_limit(DeformedBodyOperator<3>&, const DeformedLimitOptions&);

}  // namespace sphstab::analysis
