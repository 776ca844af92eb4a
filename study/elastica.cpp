// SPDX-License-Identifier: MIT
#include "study/elastica.hpp"

#include <fmt/format.h>

#include <array>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/tools/roots.hpp>
#include <boost/numeric/odeint/integrate/integrate_n_steps.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <numbers>

#include "model/errors.hpp"

namespace sphstab::study {
namespace {

/// Beyond it the end angle is a right one to eight digits, and μ is 1 to rounding.
constexpr double largest_load = 200.0, near_right_angle = 1e-7;

constexpr int shooting_steps = 400;

/// μ and φ of an end angle.
struct Modulus {
  explicit Modulus(double end_angle)
      : mu(std::sqrt(0.5 * (1.0 + std::sin(end_angle)))), phi(std::atan(1.0 / std::sqrt(std::sin(end_angle)))) {}

  /// √α of the end angle.
  double root_of_load() const { return boost::math::ellint_1(mu) - boost::math::ellint_1(mu, phi); }
  /// E(μ) − E(φ, μ).
  double height() const { return boost::math::ellint_2(mu) - boost::math::ellint_2(mu, phi); }

  double mu;
  double phi;
};

}  // namespace

Elastica elastica(double load) {
  if (!(load > 0.0 && load <= largest_load))
    throw InvalidInput(fmt::format("load: {} is not above 0 and at most {}", load, largest_load));
  const double root = std::sqrt(load);
  const auto excess = [&](double end_angle) { return Modulus(end_angle).root_of_load() - root; };
  std::uintmax_t iterations = 200;
  const auto [low, high] = boost::math::tools::toms748_solve(excess, 1e-14, 0.5 * std::numbers::pi - near_right_angle,
                                                             boost::math::tools::eps_tolerance<double>(52), iterations);
  const double end_angle = 0.5 * (low + high);
  return {end_angle, 1.0 - 2.0 / root * Modulus(end_angle).height(), 1.0 - std::sqrt(2.0 * std::sin(end_angle) / load)};
}

Elastica shearable_elastica(const Strip& strip, double force_y) {
  const auto& [L, H, E] = strip;
  const double EA = E * H, EI = E * H * H * H / 12.0, shear_stiffness = 5.0 / 12.0 * E * H;
  using State = std::array<double, 4>;  // θ, M, x, y from the free end towards the clamp
  const auto rates = [&](const State& s, State& rate, double) {
    const double cosine = std::cos(s[0]), sine = std::sin(s[0]);
    const double stretch = 1.0 + force_y * sine / EA, slide = force_y * cosine / shear_stiffness;
    const double dx = stretch * cosine - slide * sine, dy = stretch * sine + slide * cosine;
    rate = {-s[1] / EI, dx * force_y, -dx, -dy};
  };
  const auto shoot = [&](double end_angle) {
    using namespace boost::numeric::odeint;
    State state{end_angle, 0.0, 0.0, 0.0};
    integrate_n_steps(runge_kutta_fehlberg78<State>(), rates, state, 0.0, L / shooting_steps, shooting_steps);
    return state;
  };
  std::uintmax_t iterations = 200;
  const auto [low, high] =
      boost::math::tools::toms748_solve([&](double end_angle) { return shoot(end_angle)[0]; }, -0.5 * std::numbers::pi,
                                        0.0, boost::math::tools::eps_tolerance<double>(48), iterations);
  const double end_angle = 0.5 * (low + high);
  const State clamp = shoot(end_angle);
  return {-end_angle, clamp[3] / L, 1.0 + clamp[2] / L};
}

double printed_end_angle(double load) {
  return 0.5 * load - 4.56543e-2 * std::pow(load, 3) + 8.02901e-3 * std::pow(load, 5) - 8.59983e-4 * std::pow(load, 7) +
         2.28499e-6 * std::pow(load, 9);
}

}  // namespace sphstab::study
