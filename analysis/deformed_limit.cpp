// SPDX-License-Identifier: MIT
#include "analysis/deformed_limit.hpp"

#include <algorithm>

#include "analysis/arnoldi.hpp"
#include "analysis/critical_step.hpp"

namespace sphstab::analysis {
namespace {

template <int Dim>
class Search {
 public:
  Search(DeformedBodyOperator<Dim>& body_operator, const DeformedLimitOptions& options)
      : operator_(body_operator), options_(options) {}

  DeformedMode extreme(Extreme which, const Eigen::VectorXd& start) {
    const ArnoldiResult found =
        arnoldi([this](const Eigen::VectorXd& x, Eigen::VectorXd& y) { operator_.apply(x, y); }, start,
                {.extreme = which,
                 .dimension = options_.dimension,
                 .tolerance = options_.tolerance,
                 .most = options_.most,
                 .progress = progress()});
    applications_ += found.applications;
    const bool is_real = std::abs(found.value.imag()) <= std::max(found.residual, options_.tolerance * found.largest);
    return {is_real ? found.value.real() : found.value, found.residual / found.largest,
            found.vector.real().normalized()};
  }

  long applications() const { return applications_; }

 private:
  /// Of this end: the share of all applications that may be needed.
  std::function<void(long)> progress() const {
    if (!options_.progress) return nullptr;
    const double ends = options_.leftmost ? 2.0 : 1.0;
    return [this, ends](long done) {
      options_.progress(static_cast<double>(applications_ + done) / (ends * static_cast<double>(options_.most)));
    };
  }

  DeformedBodyOperator<Dim>& operator_;
  const DeformedLimitOptions& options_;
  long applications_ = 0;
};

}  // namespace

template <int Dim>
std::optional<double> step_of_mode(const Problem<Dim>& problem, std::complex<double> omega_squared) {
  if (omega_squared.imag() != 0.0 || !(omega_squared.real() > 0.0)) return std::nullopt;
  return ModeSteps(problem)(omega_squared.real()).limit();
}

template <int Dim>
DeformedLimit deformed_limit(DeformedBodyOperator<Dim>& body_operator, const DeformedLimitOptions& options) {
  if (body_operator.unknowns().empty()) throw InvalidInput("clamp: holds every particle, so that nothing moves");
  Search<Dim> search(body_operator, options);
  const Eigen::VectorXd random = body_operator.random_components(options.seed).normalized();
  DeformedLimit limit{};
  limit.largest = search.extreme(
      Extreme::rightmost,
      options.start.size() == 0 ? random : Eigen::VectorXd(options.start.normalized() + options.noise * random));
  limit.critical_time_step = step_of_mode(body_operator.problem(), limit.largest.omega_squared);
  if (options.leftmost) limit.leftmost = search.extreme(Extreme::leftmost, random);
  limit.applications = search.applications();
  return limit;
}

template std::optional<double> step_of_mode(const Problem<1>&, std::complex<double>);
template std::optional<double> step_of_mode(const Problem<2>&, std::complex<double>);
template std::optional<double> step_of_mode(const Problem<3>&, std::complex<double>);
template DeformedLimit deformed_limit(DeformedBodyOperator<1>&, const DeformedLimitOptions&);
template DeformedLimit deformed_limit(DeformedBodyOperator<2>&, const DeformedLimitOptions&);
template DeformedLimit deformed_limit(DeformedBodyOperator<3>&, const DeformedLimitOptions&);

}  // namespace sphstab::analysis
