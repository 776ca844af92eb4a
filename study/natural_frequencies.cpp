// SPDX-License-Identifier: MIT
#include "study/natural_frequencies.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace sphstab::study {

RecognisedMode recognise(const Body<2>& body, const std::vector<analysis::BodyMode>& modes,
                         const std::vector<ShapeFunction>& shapes) {
  const int size = body.size();
  Eigen::VectorXd root_volume(2 * size);
  Eigen::MatrixXd basis(2 * size, shapes.size());
  for (int a = 0; a < size; ++a) {
    root_volume.segment<2>(2 * a).setConstant(std::sqrt(body.volume[a]));
    for (std::size_t i = 0; i < shapes.size(); ++i)
      basis.col(i).segment<2>(2 * a) = std::sqrt(body.volume[a]) * shapes[i](body.position[a]);
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(basis);
  const Eigen::MatrixXd span = qr.householderQ() * Eigen::MatrixXd::Identity(2 * size, qr.rank());
  RecognisedMode best{-1, 0.0, 0.0, {}};
  for (int i = 0; i < static_cast<int>(modes.size()); ++i) {
    if (modes[i].kind == analysis::BodyModeKind::rigid) continue;
    const Eigen::VectorXd s = root_volume.cwiseProduct(modes[i].displacement);
    const double likeness = (span.transpose() * s).squaredNorm() / s.squaredNorm();
    if (likeness > best.likeness) best = {i, 0.5 * modes[i].omega / std::numbers::pi, likeness, modes[i].kind};
  }
  return best;
}

std::vector<ShapeFunction> bending_shapes(const Beam& beam, int mode) {
  const double root = euler_bernoulli_root(beam.ends, mode), beta = root / beam.length, middle = 0.5 * beam.height;
  const double sign = beam.ends == BeamEnds::free_free ? 1.0 : -1.0;
  const double sigma = (std::cosh(root) - sign * std::cos(root)) / (std::sinh(root) - sign * std::sin(root));
  const auto deflection = [=](const Vector<2>& position) {
    const double x = beta * std::max(position[0], 0.0);
    return Vector<2>(0.0, std::cosh(x) + sign * std::cos(x) - sigma * (std::sinh(x) + sign * std::sin(x)));
  };
  const auto rotation = [=](const Vector<2>& position) {
    const double x = beta * std::max(position[0], 0.0);
    const double slope = std::sinh(x) - sign * std::sin(x) - sigma * (std::cosh(x) + sign * std::cos(x));
    return Vector<2>((middle - position[1]) * beta * slope, 0.0);
  };
  return {deflection, rotation};
}

Scene<2> beam_of_particles(const Beam& beam, int across, KernelFamily kernel, double h_over_spacing,
                           KernelNormalisation normalisation) {
  const double spacing = beam.height / across;
  Problem<2> problem{.lattice = Lattice<2>(LatticeKind::square, spacing),
                     .kernel = Kernel<2>(kernel, h_over_spacing * spacing),
                     .material = beam.material,
                     .plane = beam.plane};
  problem.scheme.kernel_normalisation = normalisation;
  const bool is_clamped = beam.ends == BeamEnds::clamped_free;
  const double start = is_clamped ? -spacing * std::ceil(problem.kernel.support() / spacing) : 0.0;
  const Placement<2> placement{.shape = Box<2>{{start, 0.0}, {beam.length, beam.height}}};
  SceneDescription<2> description{
      .name = "beam", .problem = problem, .materials = {beam.material}, .parts = {{"beam", placement}}};
  if (is_clamped) description.clamps = {{Box<2>{{start, 0.0}, {0.0, beam.height}}, Directions<2>::Constant(true)}};
  return make_scene(description);
}

double long_wave_factor(const Problem<2>& problem) {
  const auto cell = periodic_patch<2>(problem, {1, 1});
  double slope = 0.0, sum = cell.volume[0] * problem.kernel.value(0.0);
  for (const auto& r : cell.pairs.separation) {
    slope -= 0.5 * cell.volume[0] * problem.kernel.slope(r.norm()) * r.norm();
    sum += cell.volume[0] * problem.kernel.value(r.norm());
  }
  return problem.scheme.kernel_normalisation == KernelNormalisation::sum ? slope / sum : slope;
}

}  // namespace sphstab::study
