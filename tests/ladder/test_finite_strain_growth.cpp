// SPDX-License-Identifier: MIT
// Rung 5 of finite strain: growth of the running solver against theory.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "analysis/critical_step.hpp"
#include "analysis/ellipticity.hpp"
#include "ladder/finite_strain_cases.hpp"
#include "study/growth_cases.hpp"
#include "study/growth_run.hpp"
#include "study/patch_wave.hpp"
#include "study/step_comparison.hpp"

using namespace sphstab;
using study::PeriodicPatch;

namespace {

/// Rung 5, per step: the bound of the ladder. Runs see strains of up to 2e-5, and a wave of three cells drives itself
/// in the first order of them.
constexpr double seeded_tolerance = 1e-5;
/// Per step, of a run that goes from strains of 1e-10 to 2e-5 and back again and again. Where three waves of one growth
/// add up to none their product bends it by the strain itself, in the mean over the e-foldings by a twelfth of 2e-5 of
/// it, and it is 0.1; the rounding of positions beside strains of 1e-10 is a tenth of that.
constexpr double noise_floor = 2e-7;

/// ln of the largest spectral radius over the waves that a patch admits.
template <int Dim>
double theory_growth(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells, double time_step) {
  return std::log(study::largest_radius(problem, cells, time_step).spectral_radius);
}

template <int Dim>
double seeded_growth(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells, double time_step) {
  const auto mode = study::critical_mode_displacement<Dim>(problem, PeriodicPatch<Dim>{cells});
  const auto fit = study::GrowthRun<Dim>(problem, periodic_patch<Dim>(problem, cells), mode)(time_step, 400);
  CHECK(fit.trend == solver::Trend::growing);
  return fit.growth_per_step;
}

/// A base state beyond the loss of ellipticity of its law, and where along that line of states it is lost.
struct LostEllipticity {
  ladder::FiniteStrainScheme scheme;
  double poisson_ratio;
  double stretch;  ///< along x
  double threshold;
};

/// ν = 0.3 of theory.md §5; of F S printed there to three digits. The neo-Hookean law bears any compression, but in a
/// plane that is stretched by l along x it loses the wave along y, (λ + 2G − λ ln l)/ρ0: l = exp(1 + 2G/λ).
const LostEllipticity lost[] = {
    {ladder::finite_strain_schemes[0], 0.3, 0.42, 0.46909570},
    {ladder::finite_strain_schemes[1], 0.3, 0.65, 0.706},
    {ladder::finite_strain_schemes[2], 0.45, 4.0, std::exp(1.0 + 2.0 / 9.0)},
};

Problem<2> stretched(const LostEllipticity& subject, LatticeKind lattice, double stretch) {
  auto problem = ladder::finite_strain_problem<2>(subject.scheme, lattice, KernelFamily::wendland_c2, 1.3);
  problem.material = Material::from_young_modulus(1.7, 2.9, subject.poisson_ratio);
  problem.deformation_gradient(0, 0) = stretch;
  return problem;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG(
    "rung 5: above the limit a seeded wave of finite strain grows by ln of the spectral radius a step", "[ladder]",
    ((int Dim), Dim), 1, 2, 3) {
  const auto cells = ladder::running_patch<Dim>();
  for (const auto& variant : ladder::every_finite_strain<Dim>())
    for (const auto& [name, problem] : ladder::every_step(variant)) {
      INFO(name);
      const auto limit = std::get<analysis::ConditionallyStable<Dim>>(analysis::patch_limit(problem, cells));
      const double time_step = 1.01 * limit.critical_time_step;
      CHECK(std::abs(seeded_growth<Dim>(problem, cells, time_step) - theory_growth<Dim>(problem, cells, time_step)) <
            seeded_tolerance);
    }
}

TEST_CASE("rung 5: beyond the loss of ellipticity finite strain grows as theory says, from its wave and from noise",
          "[ladder]") {
  const LatticeIndex<2> cells(6, 6);
  for (const auto& subject : lost)
    for (const LatticeKind lattice : lattices_of(2)) {
      const auto problem = stretched(subject, lattice, subject.stretch);
      INFO(ladder::describe(problem.scheme) << ", " << name_of(lattice));
      const auto limit = std::get<analysis::NeverStable<2>>(analysis::patch_limit(problem, cells));
      const double time_step = 0.1 / limit.growth_rate;
      const double expected = theory_growth<2>(problem, cells, time_step);
      CHECK(expected > 0.09);
      CHECK(std::abs(seeded_growth<2>(problem, cells, time_step) - expected) < seeded_tolerance);
      CHECK(study::compare_step<2>(problem, PeriodicPatch<2>{cells}, {}).agrees(0.0));
      std::vector<double> growths;
      for (unsigned noise_seed = 1; noise_seed <= study::noise_runs; ++noise_seed) {
        study::GrowthRun<2> run(problem, periodic_patch(problem, cells), noise_seed);
        const auto fit = run(time_step, 4000);
        CHECK(fit.trend == solver::Trend::growing);
        growths.push_back(fit.growth_per_step);
      }
      const Eigen::Map<const Eigen::VectorXd> g(growths.data(), study::noise_runs);
      const double mean = g.mean();
      const double error = std::sqrt((g.array() - mean).square().sum() / (study::noise_runs - 1.0) / study::noise_runs);
      CHECK(std::abs(mean - expected) <= std::max(study::noise_standard_errors * error, noise_floor));
      CHECK(std::abs(mean - expected) <= study::growth_tolerance * expected);
    }
}

TEST_CASE("rung 5: on this side of the loss of ellipticity no run of finite strain grows", "[ladder]") {
  const LatticeIndex<2> cells(6, 6);
  for (const auto& subject : lost) {
    const double side = subject.threshold < 1.0 ? 1.01 : 0.99;
    const auto problem = stretched(subject, LatticeKind::square, side * subject.threshold);
    INFO(ladder::describe(problem.scheme));
    CHECK(analysis::weakest_direction(problem).squared_speed > 0.0);
    CHECK(analysis::weakest_direction(stretched(subject, LatticeKind::square, subject.threshold / side)).squared_speed <
          0.0);
    const auto limit = std::get<analysis::ConditionallyStable<2>>(analysis::patch_limit(problem, cells));
    for (unsigned noise_seed = 1; noise_seed <= 4; ++noise_seed)
      CHECK(
          study::GrowthRun<2>(problem, periodic_patch(problem, cells), noise_seed)(0.5 * limit.critical_time_step, 2000)
              .trend == solver::Trend::bounded);
  }
}

TEST_CASE("rung 5: a chain under F S that is compressed below 1/sqrt(3) grows at every wave by its own closed form",
          "[ladder]") {
  // ω² = (λ + 2G) (3l² − 1)/2 |D~|²/ρ0; leapfrog: e^g + e^−g − 2 = −ω²Δt².
  const LatticeIndex<1> cells(24);
  auto problem = ladder::finite_strain_problem<1>(ladder::finite_strain_schemes[1], LatticeKind::chain,
                                                  KernelFamily::quintic_spline, 1.1);
  const auto rest = std::get<analysis::ConditionallyStable<1>>(analysis::patch_limit(problem, cells));
  constexpr double stretch = 0.5, softening = (1.0 - 3.0 * stretch * stretch) / 2.0;
  problem.deformation_gradient(0, 0) = stretch;
  const double time_step = 0.5 * rest.critical_time_step;
  const double growth = seeded_growth<1>(problem, cells, time_step);
  CHECK(2.0 * std::sinh(0.5 * growth) == Approx(std::sqrt(softening) * rest.mode.omega * time_step).epsilon(1e-6));
}
