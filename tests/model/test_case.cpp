// SPDX-License-Identifier: MIT
#include "model/case.hpp"

#include <catch2/catch.hpp>
#include <numbers>

using namespace sphstab;

namespace {

Case read(std::initializer_list<std::pair<std::string_view, std::string_view>> entries) {
  Case input;
  for (const auto& [key, text] : entries) input.set(key, parse_value(find_key(key), text));
  return input;
}

Case complete() { return read({{"scheme", "tl-linear"}, {"young_modulus", "1.3"}, {"poisson_ratio", "0.3"}}); }

Case complete_with(std::string_view key, std::string_view text) {
  Case input = complete();
  input.set(key, parse_value(find_key(key), text));
  return input;
}

}  // namespace

TEST_CASE("defaults of the key table parse and pass their own checks", "[fast]") {
  for (const Key& key : key_table()) {
    INFO(key.name);
    CHECK_FALSE(key.help.empty());
    if (!key.default_value.empty()) CHECK_NOTHROW(check_value(key, parse_value(key, key.default_value)));
  }
}

TEST_CASE("a problem is made of the keys and their defaults", "[fast]") {
  Case input = complete();
  input.set("spacing", 0.5);
  const auto problem = make_problem<2>(input);
  CHECK(problem.kernel.smoothing_length() == 0.65);
  CHECK(problem.lattice.kind() == LatticeKind::square);
  CHECK(problem.plane == Plane::strain);
  CHECK(problem.integrator == Integrator::leapfrog);
  CHECK(problem.neighbour_rule == NeighbourRule::support);
  CHECK_FALSE(problem.scheme.damping);
  CHECK(problem.displacement_gradient.isZero());
}

TEST_CASE("every key that describes a problem reaches it", "[fast]") {
  CHECK(make_problem<2>(complete_with("lattice", "hexagonal")).lattice.kind() == LatticeKind::hexagonal);
  CHECK(make_problem<2>(complete_with("kernel", "sinc-5")).kernel.family() == KernelFamily::sinc_5);
  CHECK(make_problem<2>(complete_with("smoothing_length", "1.7")).kernel.smoothing_length() == 1.7);
  CHECK(make_problem<2>(complete_with("h_over_spacing", "2.5")).kernel.smoothing_length() == 2.5);
  CHECK(make_problem<2>(complete_with("neighbours", "nearest")).neighbour_rule == NeighbourRule::nearest);
  CHECK(make_problem<2>(complete_with("density", "7")).material.density() == 7.0);
  CHECK(make_problem<2>(complete_with("plane", "stress")).plane == Plane::stress);
  CHECK(make_problem<2>(complete_with("integrator", "verlet")).integrator == Integrator::verlet);
  CHECK(make_problem<2>(complete_with("density_in_momentum", "equation-of-state")).scheme.momentum_density ==
        MomentumDensity::equation_of_state);
  CHECK(make_problem<2>(complete_with("kernel_normalisation", "sum")).scheme.kernel_normalisation ==
        KernelNormalisation::sum);
  CHECK(make_problem<2>(complete_with("damping_rate", "0.2")).scheme.damping->rate == 0.2);
  const auto gradient = make_problem<2>(complete_with("displacement_gradient", "1,2,3,4")).displacement_gradient;
  CHECK(gradient(0, 1) == 2.0);  // row by row
  CHECK(gradient(1, 0) == 3.0);
  Case gaussian = complete_with("kernel", "gaussian");
  gaussian.set("gaussian_cutoff", 7.0);
  CHECK(make_problem<2>(gaussian).kernel.support() == Approx(9.1));
  const auto moduli = read({{"scheme", "tl-linear"}, {"bulk_modulus", "2"}, {"shear_modulus", "0.7"}});
  CHECK(make_problem<2>(moduli).material.shear_modulus() == Approx(0.7));
}

TEST_CASE("a wave vector comes from its components or from a mode of the paper's box", "[fast]") {
  CHECK(make_wave_vector<2>(read({{"wave_vector", "0.1,-0.2"}})) == Vector<2>(0.1, -0.2));
  const auto k = make_wave_vector<2>(read({{"mode", "3,1"}, {"box", "20,10"}, {"spacing", "0.5"}}));
  CHECK(k[0] == Approx(std::numbers::pi * 3 / 10));
  CHECK(k[1] == Approx(std::numbers::pi / 5));
  CHECK_THROWS_WITH(make_wave_vector<2>(read({})), Catch::StartsWith("wave_vector: missing"));
  CHECK_THROWS_WITH(make_wave_vector<2>(read({{"mode", "3,1"}})), Catch::StartsWith("box: missing"));
  CHECK_THROWS_WITH(make_wave_vector<2>(read({{"wave_vector", "1,2"}, {"mode", "3,1"}})),
                    "wave_vector: cannot be given with mode");
  CHECK_THROWS_WITH(make_wave_vector<2>(read({{"wave_vector", "1,2,3"}})),
                    "wave_vector: has 3 components, but 2 are needed");
}

TEST_CASE("a bad value names its key, itself and what is allowed", "[fast]") {
  CHECK_THROWS_WITH(read({{"spacing", "-1"}}), "spacing: -1 is not above 0");
  CHECK_THROWS_WITH(read({{"spacing", "nan"}}), "spacing: nan is not a finite number");
  CHECK_THROWS_WITH(read({{"spacing", "1e999"}}), "spacing: '1e999' is not a number");
  CHECK_THROWS_WITH(read({{"spacing", "1.0m"}}), "spacing: '1.0m' is not a number");
  CHECK_THROWS_WITH(read({{"patch", "8.5,8"}}), "patch: 8.5 is not a whole number");
  CHECK_THROWS_WITH(read({{"patch", "8,"}}), "patch: '' is not a number");
  CHECK_THROWS_WITH(read({{"patch", "8,99999999999"}}), Catch::EndsWith("is too large"));
  CHECK_THROWS_WITH(
      read({{"kernel", "gausian"}}),
      Catch::StartsWith("kernel: 'gausian' is not known; did you mean 'gaussian'? Allowed: cubic-spline"));
  CHECK_THROWS_WITH(read({{"smothing_length", "1"}}), Catch::Contains("did you mean 'smoothing_length'?"));
  CHECK_THROWS_WITH(Case().set("spacing", std::string("1")), "spacing: is not a number");
  CHECK_THROWS_WITH(Case().set("wave_vector", 1.0), "wave_vector: is not a list of numbers");
}

TEST_CASE("contradictory, missing and impossible keys are refused together", "[fast]") {
  CHECK_THROWS_WITH(make_problem<2>(read({{"young_modulus", "1"}, {"poisson_ratio", "0"}})),
                    Catch::StartsWith("scheme: missing"));
  CHECK_THROWS_WITH(make_problem<2>(read({{"scheme", "tl-linear"}})), Catch::StartsWith("young_modulus: missing"));
  CHECK_THROWS_WITH(make_problem<2>(complete_with("shear_modulus", "1")),
                    "young_modulus: cannot be given with shear_modulus");
  CHECK_THROWS_WITH(make_problem<2>(complete_with("poisson_ratio", "0.5")),
                    "poisson_ratio: 0.5 is not below 0.5 (plane strain)");
  CHECK_THROWS_WITH(make_problem<2>(complete_with("h_over_spacing", "0.4")), Catch::Contains("no neighbour"));
  CHECK_THROWS_WITH(make_problem<2>(complete_with("displacement_gradient", "1,2,3")),
                    "displacement_gradient: has 3 components, but 4 are needed");
  Case both = complete_with("h_over_spacing", "2");
  both.set("smoothing_length", 2.0);
  CHECK_THROWS_WITH(make_problem<2>(both), "smoothing_length: cannot be given with h_over_spacing");
}

TEST_CASE("primitive vectors of a custom lattice are listed one after the other, in spacings", "[fast]") {
  Case input = complete_with("lattice", "custom");
  CHECK_THROWS_WITH(make_lattice<2>(input), Catch::StartsWith("primitive_vectors: missing"));
  input.set("primitive_vectors", std::vector{1.0, 0.25, -0.5, 2.0});
  input.set("spacing", 0.5);
  const auto lattice = make_lattice<2>(input);
  CHECK(lattice.kind() == LatticeKind::custom);
  CHECK(lattice.primitive_vectors().col(0) == Vector<2>(0.5, 0.125));
  CHECK(lattice.primitive_vectors().col(1) == Vector<2>(-0.25, 1.0));
  CHECK(lattice.spacing() == 0.5);
  CHECK_THROWS_WITH(make_lattice<3>(input), "primitive_vectors: has 4 components, but 9 are needed");
  input.set("primitive_vectors", std::vector{1.0, 2.0, 0.5, 1.0});
  CHECK_THROWS_WITH(make_lattice<2>(input), "primitive_vectors: 1,2,0.5,1 are linearly dependent");
  CHECK_THROWS_WITH(make_lattice<2>(complete_with("primitive_vectors", "1,0,0,1")),
                    "primitive_vectors: only for the lattice custom, not square");
}

TEST_CASE("keys of paths and grids have their limits", "[fast]") {
  CHECK(read({{"path", "G-X|M-R"}}).word("path") == "G-X|M-R");
  CHECK(Case().number("path_points") == 200.0);
  CHECK_THROWS_WITH(read({{"path_points", "1"}}), "path_points: 1 is not at least 2");
  CHECK_THROWS_WITH(read({{"grid", "4,0"}}), "grid: 0 is not at least 1");
}
