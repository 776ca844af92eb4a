// SPDX-License-Identifier: MIT
#include "study/natural_frequencies.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace sphstab;
using study::Beam;
using study::BeamEnds;

namespace {

/// Sums of some hundred doubles.
constexpr double rounding = 1e-12;

/// Edges and clamps are felt by a share of the particles that falls as 1/n: first order. Between 8 and 16 across the
/// higher orders still matter: of normalised edges, whose leading error is small, most.
constexpr double least_order = 0.6, largest_order = 1.4;

Beam slender_beam(BeamEnds ends) {
  return {.length = 10.0,
          .height = 1.0,
          .material = Material::from_young_modulus(1.7, 2.3, 0.3),
          .plane = Plane::stress,
          .ends = ends};
}

/// Frequencies of three bending modes over those of Timoshenko and the factor of long waves.
std::array<double, 3> relative_frequencies(BeamEnds ends, KernelNormalisation normalisation, int across) {
  constexpr int enough_modes = 24;
  const Beam beam = slender_beam(ends);
  const auto scene = study::beam_of_particles(beam, across, KernelFamily::cubic_spline, 1.0, normalisation);
  const auto modes = analysis::lowest_modes(scene.problem, scene.body, enough_modes);
  std::array<double, 3> relative{};
  for (int mode = 1; mode <= 3; ++mode) {
    const auto found = study::recognise(scene.body, modes, study::bending_shapes(beam, mode));
    CHECK(found.likeness > 0.9);
    relative[mode - 1] =
        found.frequency / study::timoshenko_frequency(beam, mode) / study::long_wave_factor(scene.problem);
  }
  return relative;
}

}  // namespace

TEST_CASE("beams of particles bend at Timoshenko's frequencies, up to a first-order error of their edges", "[ladder]") {
  for (const BeamEnds ends : {BeamEnds::free_free, BeamEnds::clamped_free})
    for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum}) {
      INFO((ends == BeamEnds::free_free ? "free" : "clamped") << ", " << name_of(normalisation));
      std::array<std::array<double, 3>, 2> errors{};
      for (const int across : {4, 8, 16}) {
        const auto relative = relative_frequencies(ends, normalisation, across);
        // At worst the outermost rows, which feel half of the strain, carry nothing: f ∝ √(h³/h'), two rows less in h.
        for (const double value : relative) {
          CHECK(value > std::pow(1.0 - 2.0 / across, 1.5));
          CHECK(value < 1.0);
        }
        errors[0] = errors[1];
        errors[1] = relative;
      }
      for (int i = 0; i < 3; ++i) {
        const double order = std::log2((1.0 - errors[0][i]) / (1.0 - errors[1][i]));
        CHECK(order > least_order);
        CHECK(order < largest_order);
      }
    }
}

TEST_CASE("the factor of long waves is the sum over the two nearest shells of the square lattice", "[fast]") {
  // Cubic spline, h = Δp: w'(1) = −3/4, w'(√2) = −(3/4)(2 − √2)², w(1) = 1/4, w(√2) = (2 − √2)³/4, and nothing beyond.
  const double alpha = 10.0 / (7.0 * std::numbers::pi), gap = 2.0 - std::numbers::sqrt2;
  const double slope = 0.5 * alpha * 4.0 * (0.75 + std::numbers::sqrt2 * 0.75 * gap * gap);
  const double sum = alpha * (1.0 + 1.0 + gap * gap * gap);
  for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum}) {
    const auto scene =
        study::beam_of_particles(slender_beam(BeamEnds::free_free), 4, KernelFamily::cubic_spline, 1.0, normalisation);
    CHECK(study::long_wave_factor(scene.problem) ==
          Approx(normalisation == KernelNormalisation::sum ? slope / sum : slope).epsilon(rounding));
  }
}

TEST_CASE("a mode is recognised by its shape among rigid motions and displacements that alternate", "[fast]") {
  const Beam beam = slender_beam(BeamEnds::free_free);
  const auto scene = study::beam_of_particles(beam, 4, KernelFamily::cubic_spline, 1.0, KernelNormalisation::none);
  const auto& body = scene.body;
  const auto shapes = study::bending_shapes(beam, 2);
  Eigen::VectorXd bending(2 * body.size()), alternating(2 * body.size());
  for (int a = 0; a < body.size(); ++a) {
    bending.segment<2>(2 * a) = shapes[0](body.position[a]);
    alternating.segment<2>(2 * a).setConstant((body.site[a].sum() % 2 == 0) ? 1.0 : -1.0);
  }
  bending.normalize();
  alternating.normalize();
  const auto mode = [](double omega, analysis::BodyModeKind kind, const Eigen::VectorXd& displacement) {
    return analysis::BodyMode{omega, kind, 0.0, displacement};
  };
  const std::vector<analysis::BodyMode> modes{
      mode(0.0, analysis::BodyModeKind::rigid, bending), mode(1.0, analysis::BodyModeKind::zero_energy, alternating),
      mode(2.0, analysis::BodyModeKind::vibration, 0.8 * bending + 0.6 * alternating),
      mode(3.0, analysis::BodyModeKind::zero_energy, 0.6 * bending - 0.8 * alternating)};
  const auto found = study::recognise(body, modes, shapes);
  CHECK(found.index == 2);
  CHECK(found.frequency == Approx(2.0 / (2.0 * std::numbers::pi)).epsilon(rounding));
  // The smooth shape and the alternating one are orthogonal up to 1 / particles.
  CHECK(found.likeness == Approx(0.64).margin(1.0 / body.size()));
}

TEST_CASE("a clamped beam is held outside of its length, as far as the kernel reaches", "[fast]") {
  const Beam beam = slender_beam(BeamEnds::clamped_free);
  const auto scene = study::beam_of_particles(beam, 4, KernelFamily::cubic_spline, 1.0, KernelNormalisation::none);
  int free_particles = 0;
  double nearest = 1e30, farthest = 0.0;
  for (int a = 0; a < scene.body.size(); ++a) {
    const bool held = scene.body.clamped[a].all();
    CHECK(held == (scene.body.position[a][0] < 0.0));
    if (!held) nearest = std::min(nearest, scene.body.position[a][0]);
    if (held) farthest = std::min(farthest, scene.body.position[a][0]);
    free_particles += !held;
  }
  CHECK(free_particles == 160);
  CHECK(scene.body.size() == 168);  // two columns of four
  CHECK(nearest == Approx(0.125));
  CHECK(farthest == Approx(-0.375));
}
