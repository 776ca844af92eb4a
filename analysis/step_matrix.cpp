// SPDX-License-Identifier: MIT
#include "analysis/step_matrix.hpp"

#include <cmath>

namespace sphstab::analysis {

template <int Dim, int Size, class Scalar>
StepMatrix<Dim, Size, Scalar> step_matrix(const LinearMotion<Dim, Size, Scalar>& motion, Integrator integrator,
                                          double time_step) {
  using Rows = StepMatrix<Dim, Size, Scalar>;
  const bool stores_rates = integrator == Integrator::predictor_corrector_pec;
  const int size = (2 * Dim + Size) + (stores_rates ? Dim + Size : 0);
  const double dt = time_step;
  // Every variable as a linear map of the state at the beginning of the step.
  const Rows start = Rows::Identity(size, size);
  Rows r = start.topRows(Dim), v = start.middleRows(Dim, Dim), q = start.middleRows(2 * Dim, Size);
  const auto force = [&](const Rows& of_r, const Rows& of_v, const Rows& of_q) -> Rows {
    return motion.of_position * of_r + motion.of_velocity * of_v + motion.of_state * of_q;
  };
  const auto drift = [&] {
    r += dt * motion.smoothing * v;
    q += dt * motion.state_rate * v;
  };
  Rows end(size, size);
  switch (integrator) {
    case Integrator::leapfrog:
      v += dt * force(r, v, q);
      drift();
      break;
    case Integrator::verlet:
      v += 0.5 * dt * force(r, v, q);
      drift();
      v += 0.5 * dt * force(r, v, q);
      break;
    case Integrator::predictor_corrector:
    case Integrator::predictor_corrector_pec: {
      const Rows F0 = stores_rates ? Rows(start.middleRows(2 * Dim + Size, Dim)) : force(r, v, q);
      const Rows D0 = stores_rates ? Rows(start.bottomRows(Size)) : Rows(motion.state_rate * v);
      const Rows v_p = v + dt * F0, q_p = q + dt * D0;
      r += dt * motion.smoothing * v + 0.5 * dt * dt * motion.position_unit * F0;
      const Rows F = force(r, v_p, q_p), D = motion.state_rate * v_p;
      v = v_p + 0.5 * dt * (F - F0);
      q = q_p + 0.5 * dt * (D - D0);
      if (stores_rates) end.bottomRows(Dim + Size) << F, D;
      break;
    }
  }
  end.topRows(2 * Dim + Size) << r, v, q;
  return end;
}

template <int Dim>
LinearMotion<Dim, UpdatedWave<Dim>::rates, std::complex<double>> full_motion(const UpdatedWave<Dim>& wave) {
  using Complex = std::complex<double>;
  constexpr Complex i(0.0, 1.0);
  return {wave.smoothing, wave.of_position.template cast<Complex>(), wave.of_velocity.template cast<Complex>(),
          i * wave.of_state.template cast<Complex>(), i * wave.state_rate.template cast<Complex>()};
}

template <int Dim>
LinearMotion<Dim, Dim, double> reduced_motion(const UpdatedWave<Dim>& wave) {
  const Tensor<Dim> stress_part = wave.stress_matrix();
  const double square = wave.geometric_matrix().norm() + stress_part.norm();
  const double unit = square > 0.0 ? std::sqrt(square) : 1.0;
  return {unit * wave.smoothing,          wave.of_position / unit, wave.of_velocity,
          unit * Tensor<Dim>::Identity(), -stress_part / unit,     unit};
}

template StepMatrix<1, 2, std::complex<double>> step_matrix(const LinearMotion<1, 2, std::complex<double>>&, Integrator,
                                                            double);
template StepMatrix<1, 1, double> step_matrix(const LinearMotion<1, 1, double>&, Integrator, double);
template LinearMotion<1, 2, std::complex<double>> full_motion(const UpdatedWave<1>&);
template LinearMotion<1, 1, double> reduced_motion(const UpdatedWave<1>&);
template StepMatrix<2, 4, std::complex<double>> step_matrix(const LinearMotion<2, 4, std::complex<double>>&, Integrator,
                                                            double);
template StepMatrix<2, 2, double> step_matrix(const LinearMotion<2, 2, double>&, Integrator, double);
template LinearMotion<2, 4, std::complex<double>> full_motion(const UpdatedWave<2>&);
template LinearMotion<2, 2, double> reduced_motion(const UpdatedWave<2>&);
template StepMatrix<3, 7, std::complex<double>> step_matrix(const LinearMotion<3, 7, std::complex<double>>&, Integrator,
                                                            double);
template StepMatrix<3, 3, double> step_matrix(const LinearMotion<3, 3, double>&, Integrator, double);
template LinearMotion<3, 7, std::complex<double>> full_motion(const UpdatedWave<3>&);
template LinearMotion<3, 3, double> reduced_motion(const UpdatedWave<3>&);

}  // namespace sphstab::analysis
