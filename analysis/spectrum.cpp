// SPDX-License-Identifier: MIT
#include "analysis/spectrum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "analysis/body_operator.hpp"
#include "analysis/lanczos.hpp"
#include "analysis/mode_step.hpp"
#include "analysis/sparse_cholesky.hpp"

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

/// σ lies the tolerance above the Ritz value, and after each failure so many times more.
constexpr double wider = 16.0;

struct UpperBound {
  BoundKind kind;
  double value;
};

template <int Dim>
class LimitSearch {
 public:
  LimitSearch(const Problem<Dim>& problem, const Body<Dim>& body, const BodyLimitOptions& options)
      : operator_(problem, body), options_(options), steps_(problem) {}

  BodyLimit limit() {
    const double rounding = operator_.rounding();
    prepare_factorisation();
    const LanczosResult top = find_top();
    const double largest = top.rayleigh_quotient;
    if (!(largest > cancelled * rounding))
      throw InvalidInput("smoothing_length: no particle of this body feels a force");
    const UpperBound upper = find_bound(top);
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
    matrix_ = operator_.matrix();
    cholesky_.emplace(matrix_, operator_.places());
    if (asked && cholesky_->memory() > most_memory)
      throw InvalidInput(fmt::format("upper_bound: a factorisation of this body would take {:.0f} GB, at most {:.0f}",
                                     1e-9 * cholesky_->memory(), 1e-9 * most_memory));
    if (!asked && (cholesky_->memory() > most_memory || cholesky_->multiplications() > most_multiplications))
      cholesky_.reset();
  }

  LanczosResult find_top() {
    std::mt19937_64 random(options_.seed);
    std::normal_distribution<double> normal;  // of every free component: no direction is preferred
    Eigen::VectorXd start = Eigen::VectorXd::Zero(operator_.components());
    for (const int i : operator_.unknowns()) start[i] = normal(random);
    LanczosOptions lanczos{.tolerance = options_.tolerance, .progress = options_.progress};
    if (!cholesky_ && options_.bound != BoundKind::norm_bound)
      lanczos.fewest =
          dimension_for_ratio(1.0 + options_.probabilistic_width, options_.failure_probability, unknowns());
    return largest_eigenvalue([this](const Eigen::VectorXd& x, Eigen::VectorXd& y) { operator_.apply(x, y); }, start,
                              lanczos);
  }

  UpperBound find_bound(const LanczosResult& top) {
    if (cholesky_) return {BoundKind::factorisation, factorisation_bound(top.rayleigh_quotient)};
    const UpperBound proven{BoundKind::norm_bound, operator_.norm_bound()};
    if (options_.bound == BoundKind::norm_bound) return proven;
    const UpperBound probable{
        BoundKind::probabilistic,
        top.rayleigh_quotient * probable_ratio(options_.failure_probability, top.dimension, unknowns())};
    return !options_.bound && proven.value <= probable.value ? proven : probable;
  }

  /// The least σ tried such that σ − M^−½ S M^−½ has a factor, and what rounding may hide.
  double factorisation_bound(double largest) {
    const Eigen::VectorXd diagonal = matrix_.diagonal();
    matrix_ *= -1.0;
    for (double margin = options_.tolerance;; margin *= wider) {
      const double sigma = largest * (1.0 + margin);
      for (int i = 0; i < matrix_.cols(); ++i) matrix_.coeffRef(i, i) = sigma - diagonal[i];
      if (cholesky_->factorise(matrix_, SparseCholesky::Keep::nothing))
        return sigma + cholesky_->backward_error() + operator_.rounding() + 4.0 * epsilon * sigma;
    }
  }

  int unknowns() const { return static_cast<int>(operator_.unknowns().size()); }

  BodyOperator<Dim> operator_;
  const BodyLimitOptions& options_;
  ModeSteps steps_;
  Eigen::SparseMatrix<double> matrix_;
  std::optional<SparseCholesky> cholesky_;
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
