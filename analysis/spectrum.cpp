// SPDX-License-Identifier: MIT
#include "analysis/spectrum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/body_operator.hpp"
#include "analysis/factorisation_bound.hpp"
#include "analysis/lanczos.hpp"
#include "analysis/mode_step.hpp"

namespace sphstab::analysis {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// ω² below this part of what rounding adds to the operator comes of sums that cancel, squared: no force is felt.
constexpr double cancelled = 1e-10;

/// What is factorised without being asked for: about two minutes.
constexpr int most_factorised_particles = 100000;
constexpr double most_multiplications = 1e12;
/// What is factorised at all.
constexpr double most_memory = 4e9;

/// Lanczos is asked again, for a hundredth of the tolerance each time, where it missed the largest eigenvalue.
constexpr double finer = 1e-2, finest_tolerance = 1e-14;

struct UpperBound {
  BoundKind kind;
  double value;
  double margin = 0.0;  ///< of a factorisation, relative, above the approximation
};

template <int Dim>
class LimitSearch {
 public:
  LimitSearch(const Problem<Dim>& problem, const Body<Dim>& body, const BodyLimitOptions& options)
      : operator_(problem, body), options_(options), steps_(problem) {}

  BodyLimit limit() {
    if (unknowns() == 0) throw InvalidInput("clamp: holds every particle, so that nothing moves");
    const double rounding = operator_.rounding();
    prepare_factorisation();
    LanczosResult top = find_top(options_.tolerance);
    if (!(top.rayleigh_quotient > cancelled * rounding))
      throw InvalidInput("smoothing_length: no particle of this body feels a force");
    UpperBound upper = find_bound(top);
    // A factorisation that fails has seen an eigenvalue that Lanczos took for one with those below it.
    for (double tolerance = options_.tolerance; upper.margin > options_.tolerance && tolerance > finest_tolerance;) {
      tolerance *= finer;
      const long applications = top.applications;
      top = find_top(tolerance);
      top.applications += applications;
      upper = find_bound(top);
    }
    const double largest = top.rayleigh_quotient;
    const double lower = largest - rounding - operator_.components() * epsilon * largest;
    const double step = step_of(largest);
    return {.critical_time_step = step,
            .bracket = {std::min(step, step_of(upper.value)),
                        lower > 0.0 ? step_of(lower) : std::numeric_limits<double>::infinity()},
            .bracket_kind = upper.kind,
            .failure_probability = upper.kind == BoundKind::probabilistic ? options_.failure_probability : 0.0,
            .omega_max = std::sqrt(largest),
            .residual = top.residual / largest,
            .applications = top.applications,
            .displacement = operator_.displacement(top.vector)};
  }

 private:
  double step_of(double omega_squared) const { return *steps_(omega_squared).limit(); }

  /// Assembles the matrix and orders its unknowns if it is to be factorised.
  void prepare_factorisation() {
    const bool asked = options_.bound == BoundKind::factorisation;
    if (!asked && (options_.bound || operator_.body().size() > most_factorised_particles)) return;
    factorisation_.emplace(operator_);
    if (asked && factorisation_->memory() > most_memory)
      throw InvalidInput(fmt::format("upper_bound: a factorisation of this body would take {:.0f} GB, at most {:.0f}",
                                     1e-9 * factorisation_->memory(), 1e-9 * most_memory));
    if (!asked && (factorisation_->memory() > most_memory || factorisation_->multiplications() > most_multiplications))
      factorisation_.reset();
  }

  LanczosResult find_top(double tolerance) {
    LanczosOptions lanczos{.tolerance = tolerance, .progress = options_.progress};
    if (!factorisation_ && options_.bound != BoundKind::norm_bound)
      lanczos.fewest =
          dimension_for_ratio(1.0 + options_.probabilistic_width, options_.failure_probability, unknowns());
    return largest_eigenvalue([this](const Eigen::VectorXd& x, Eigen::VectorXd& y) { operator_.apply(x, y); },
                              operator_.random_components(options_.seed), lanczos);
  }

  UpperBound find_bound(const LanczosResult& top) {
    if (factorisation_) {
      const auto [value, margin] = factorisation_->above(top.rayleigh_quotient, options_.tolerance);
      return {BoundKind::factorisation, value, margin};
    }
    const UpperBound proven{BoundKind::norm_bound, operator_.norm_bound()};
    if (options_.bound == BoundKind::norm_bound) return proven;
    const UpperBound probable{
        BoundKind::probabilistic,
        top.rayleigh_quotient * probable_ratio(options_.failure_probability, top.dimension, unknowns())};
    return !options_.bound && proven.value <= probable.value ? proven : probable;
  }

  int unknowns() const { return static_cast<int>(operator_.unknowns().size()); }

  BodyOperator<Dim> operator_;
  const BodyLimitOptions& options_;
  ModeSteps steps_;
  std::optional<FactorisationBound> factorisation_;
};

}  // namespace

template <int Dim>
BodyLimit body_limit(const Problem<Dim>& problem, const Body<Dim>& body, const BodyLimitOptions& options) {
  return LimitSearch<Dim>(problem, body, options).limit();
}

template BodyLimit body_limit(const Problem<1>&, const Body<1>&, const BodyLimitOptions&);
template BodyLimit body_limit(const Problem<2>&, const Body<2>&, const BodyLimitOptions&);
template BodyLimit body_limit(const Problem<3>&, const Body<3>&, const BodyLimitOptions&);

}  // namespace sphstab::analysis
