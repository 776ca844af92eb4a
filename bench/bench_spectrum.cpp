// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <random>

#include "analysis/body_operator.hpp"
#include "analysis/lanczos.hpp"
#include "analysis/spectrum.hpp"

// A table for docs/spectrum.md: the limit of square plates of 400 to 1 000 000 particles with 20 neighbours,
// on the lattice and jittered by 20 %; CPU time of one thread.

namespace {

using namespace sphstab;
using namespace sphstab::analysis;

double cpu_seconds() {
  std::timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

template <class Work>
double seconds_of(const Work& work) {
  const double start = cpu_seconds();
  work();
  return cpu_seconds() - start;
}

Body<2> plate(const Problem<2>& problem, int side, double jitter) {
  auto body = free_plate(problem, {side, side});
  if (jitter == 0.0) return body;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> move(-jitter, jitter);
  for (auto& x : body.position) x += Vector<2>(move(random), move(random));
  body.pairs = find_pairs(body.position, problem.kernel.support());
  return body;
}

/// Applications in the first of two passes.
constexpr int most = 1500;

/// What it costs to know the step to a relative error, as Lanczos' own residuals tell it.
struct Cost {
  LanczosResult result;
  double seconds;
};

Cost cost_of(BodyOperator<2>& op, const Eigen::VectorXd& start, double relative) {
  const SymmetricOperator apply = [&op](const Eigen::VectorXd& x, Eigen::VectorXd& y) { op.apply(x, y); };
  Cost cost;
  cost.seconds =
      seconds_of([&] { cost.result = largest_eigenvalue(apply, start, {.tolerance = 2.0 * relative, .most = most}); });
  return cost;
}

void print_row(const Problem<2>& problem, int side, double jitter) {
  const Body<2> body = plate(problem, side, jitter);
  BodyOperator<2> op(problem, body);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Eigen::VectorXd start(op.components()), image(op.components());
  for (auto& component : start) component = normal(random);
  const int repeats = std::max(3, 2000000 / body.size());
  const double apply = seconds_of([&] {
    for (int i = 0; i < repeats; ++i) op.apply(start, image);
  });

  const Cost six = cost_of(op, start, 1e-6), ten = cost_of(op, start, 1e-10);
  const double error = std::sqrt(ten.result.rayleigh_quotient / six.result.rayleigh_quotient) - 1.0;
  fmt::print("{:>9} {:>4.0f} % {:>6.0f} {:>7} {:>8.3f} {:>8.0e} {:>7}{} {:>8.3f}", body.size(), 100 * jitter,
             apply / repeats / body.size() * 1e9, six.result.applications, six.seconds, error, ten.result.applications,
             ten.result.dimension < most ? ' ' : '+', ten.seconds);
  for (const auto kind : {BoundKind::norm_bound, BoundKind::probabilistic, BoundKind::factorisation}) {
    if (kind == BoundKind::factorisation && body.size() > 100000) {
      fmt::print("{:>21}", "");
      continue;
    }
    BodyLimit limit{};
    const double time = seconds_of([&] {
      limit = body_limit(problem, body, {.bound = kind, .tolerance = kind == BoundKind::factorisation ? 1e-8 : 1e-4});
    });
    fmt::print("  {:>8.2f} {:>9.1e}", time, limit.bracket.high / limit.bracket.low - 1.0);
  }
  fmt::print("\n");
  std::fflush(stdout);
}

}  // namespace

int main() {
  const Problem<2> problem{.lattice = Lattice<2>(LatticeKind::square, 1.0),
                           .kernel = Kernel<2>(KernelFamily::cubic_spline, 1.3),
                           .material = Material::from_young_modulus(1.0, 1.3, 0.3)};
  fmt::print("{:>9} {:>6} {:>6} {:>7} {:>8} {:>8} {:>8} {:>8}  {:>18}  {:>18}  {:>18}\n", "particles", "jitter", "ns",
             "1e-6", "s", "error", "1e-10", "s", "norm: s, width", "probable: s, width", "factor: s, width");
  for (const int side : {20, 100, 316, 1000})
    for (const double jitter : {0.0, 0.2}) print_row(problem, side, jitter);
}
