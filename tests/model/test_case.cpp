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

/// A complete case of `ul` in two dimensions, with more keys.
Case updated(std::initializer_list<std::pair<std::string_view, std::string_view>> more = {}) {
  return read({{"scheme", "ul"}, {"sound_speed", "1.5"}, {"shear_modulus", "0.3"}, {"density", "2"}}).under(read(more));
}

/// Products and sums of a few doubles.
constexpr double rounding = 1e-15;

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

TEST_CASE("a problem of ul is made of its keys and their defaults", "[fast]") {
  const auto problem = make_problem<2>(updated());
  CHECK(problem.scheme.formulation == Formulation::updated_lagrangian);
  CHECK(problem.integrator == Integrator::predictor_corrector);
  CHECK(problem.pressure == 0.0);
  CHECK(problem.deviatoric_stress.isZero(0.0));
  CHECK_FALSE(problem.scheme.artificial_stress);
  CHECK_FALSE(problem.scheme.xsph);
  CHECK_FALSE(problem.scheme.viscosity);
  CHECK(problem.material.bulk_modulus() == Approx(2.0 * 1.5 * 1.5).epsilon(rounding));  // ρ0 c0²
  CHECK(problem.material.shear_modulus() == 0.3);
}

TEST_CASE("every key of ul reaches its problem", "[fast]") {
  CHECK(make_problem<2>(updated({{"integrator", "leapfrog"}})).integrator == Integrator::leapfrog);
  CHECK(make_problem<2>(updated({{"integrator", "predictor-corrector-pec"}})).integrator ==
        Integrator::predictor_corrector_pec);
  CHECK(make_problem<2>(updated({{"pressure", "-0.05"}})).pressure == -0.05);
  CHECK(make_problem<2>(updated({{"xsph", "0.5"}})).scheme.xsph->epsilon == 0.5);
  CHECK(make_problem<2>(updated({{"xsph", "-0.5"}})).scheme.xsph->epsilon == -0.5);
  const auto viscous = make_problem<2>(updated({{"viscosity_alpha", "0.7"}, {"viscosity_eta", "0.2"}}));
  CHECK(viscous.scheme.viscosity->alpha == 0.7);
  CHECK(viscous.scheme.viscosity->eta == 0.2);
  CHECK(make_problem<2>(updated({{"viscosity_alpha", "0.7"}})).scheme.viscosity->eta == 0.1);

  const auto plain = make_problem<2>(updated({{"artificial_stress_epsilon", "0.3"}}));
  REQUIRE(plain.scheme.artificial_stress);
  CHECK(plain.scheme.artificial_stress->epsilon == 0.3);
  CHECK(plain.scheme.artificial_stress->exponent == 4.0);
  CHECK(plain.scheme.artificial_stress->weight == ArtificialStressWeight::kernel_ratio);
  CHECK(plain.scheme.artificial_stress->linearisation == ArtificialStressLinearisation::exact);
  CHECK(plain.scheme.artificial_stress->zero_side == ZeroStressSide::compression);
  const auto other = make_problem<2>(updated({{"artificial_stress_epsilon", "0.3"},
                                              {"artificial_stress_exponent", "6"},
                                              {"artificial_stress_weight", "distance-ratio"},
                                              {"artificial_stress_linearisation", "frozen"},
                                              {"artificial_stress_zero_side", "tension"}}));
  CHECK(other.scheme.artificial_stress->exponent == 6.0);
  CHECK(other.scheme.artificial_stress->weight == ArtificialStressWeight::distance_ratio);
  CHECK(other.scheme.artificial_stress->linearisation == ArtificialStressLinearisation::frozen);
  CHECK(other.scheme.artificial_stress->zero_side == ZeroStressSide::tension);

  // Young's modulus and Poisson's ratio, or bulk and shear modulus, do as well as c0.
  const auto young = read({{"scheme", "ul"}, {"young_modulus", "2.6"}, {"poisson_ratio", "0.3"}});
  CHECK(make_problem<2>(young).material.shear_modulus() == Approx(1.0).epsilon(rounding));
  const auto fluid = read({{"scheme", "ul"}, {"sound_speed", "2"}, {"shear_modulus", "0"}});
  CHECK(make_problem<2>(fluid).material.p_wave_modulus() == 4.0);
}

TEST_CASE("deviatoric stress is listed as Sxx; Sxx, Syy, Sxy; Sxx, Syy, Szz, Sxy, Syz, Sxz", "[fast]") {
  const auto stress = [](std::string_view dimension, std::string_view text) {
    return updated({{"dimension", dimension}, {"deviatoric_stress", text}});
  };
  CHECK(make_problem<1>(stress("1", "7")).deviatoric_stress(0, 0) == 7.0);
  Tensor<2> plane;
  plane << 1.0, 3.0, 3.0, 2.0;
  CHECK(make_problem<2>(stress("2", "1,2,3")).deviatoric_stress == plane);
  Tensor<3> space;
  space << 1.0, 4.0, 6.0, 4.0, 2.0, 5.0, 6.0, 5.0, 3.0;
  CHECK(make_problem<3>(stress("3", "1,2,3,4,5,6")).deviatoric_stress == space);
  CHECK_THROWS_WITH(make_problem<3>(stress("3", "1,2,3")), "deviatoric_stress: has 3 components, but 6 are needed");
  CHECK_THROWS_WITH(make_problem<2>(stress("2", "1,2,3,4,5,6")),
                    "deviatoric_stress: has 6 components, but 3 are needed");
}

TEST_CASE("a deformation gradient moves the sites of the lattice and nothing else", "[fast]") {
  const auto input = updated({{"spacing", "0.5"}, {"deformation_gradient", "1.05,0.2,0.1,0.9"}, {"pressure", "-0.1"}});
  const auto problem = make_problem<2>(input);
  // F, row by row, times the primitive vectors (½, 0) and (0, ½).
  CHECK((problem.lattice.primitive_vectors().col(0) - Vector<2>(0.525, 0.05)).norm() < rounding);
  CHECK((problem.lattice.primitive_vectors().col(1) - Vector<2>(0.1, 0.45)).norm() < rounding);
  CHECK(problem.lattice.cell_volume() == Approx(0.25 * (1.05 * 0.9 - 0.2 * 0.1)).epsilon(rounding));
  CHECK(problem.lattice.spacing() == 0.5);
  CHECK(problem.kernel.smoothing_length() == 0.65);
  CHECK(problem.pressure == -0.1);  // which nothing but its key sets
  CHECK(problem.material.density() == 2.0);
  CHECK_THROWS_WITH(make_problem<2>(updated({{"deformation_gradient", "1,0,0,-1"}})),
                    "deformation_gradient: its determinant -1 is not above 0");
  CHECK_THROWS_WITH(make_problem<2>(updated({{"deformation_gradient", "1.1"}})),
                    "deformation_gradient: has 1 components, but 4 are needed");
}

TEST_CASE("a deformation gradient is the base state of large strain and leaves the lattice alone", "[fast]") {
  Case input = complete();
  for (const char* scheme : {"tl-corotated", "tl-pk1"}) {
    input.set("scheme", std::string(scheme));
    CHECK(make_problem<2>(input).deformation_gradient == Tensor<2>::Identity());
    input.set("deformation_gradient", std::vector{1.1, 0.2, -0.1, 0.9});
    const auto problem = make_problem<2>(input);
    CHECK(problem.deformation_gradient == Tensor<2>{{1.1, 0.2}, {-0.1, 0.9}});
    CHECK(problem.lattice.primitive_vectors() == make_lattice<2>(input).primitive_vectors());
    input.set("deformation_gradient", std::vector{0.0, 1.0, 1.0, 0.0});
    CHECK_THROWS_WITH(make_problem<2>(input), "deformation_gradient: its determinant -1 is not above 0");
    input.set("deformation_gradient", std::vector{1.0, 0.0, 0.0, 1.0});
  }
  input.set("elastic_law", std::string("neo-hookean"));
  CHECK(make_problem<2>(input).scheme.elastic_law == ElasticLaw::neo_hookean);
  input.set("scheme", std::string("tl-corotated"));
  CHECK_THROWS_WITH(make_problem<2>(input), "elastic_law: neo-hookean: is for the scheme tl-pk1, not tl-corotated");
  input.set("scheme", std::string("tl-linear"));
  CHECK_THROWS_WITH(make_problem<2>(input), "elastic_law: is for the schemes tl-corotated and tl-pk1, not tl-linear");
}

TEST_CASE("a time step is a number, or where a run asks for it auto", "[fast]") {
  Case input;
  input.set("time_step", parse_value(find_key("time_step"), "auto"));
  CHECK(input.word("time_step") == "auto");
  CHECK_THROWS_WITH(input.number("time_step"), "time_step: 'auto' is for run; here a number is needed");
  CHECK_THROWS_WITH(input.set("time_step", std::string("soon")), "time_step: is not a number");
  input.set("time_step", parse_value(find_key("time_step"), "0.25"));
  CHECK(input.number("time_step") == 0.25);
  CHECK_FALSE(input.word("time_step"));
}

TEST_CASE("keys of another scheme are refused unless they switch nothing on", "[fast]") {
  for (const auto& [key, text] : {std::pair{"density_in_momentum", "equation-of-state"},
                                  {"displacement_gradient", "0.1,0,0,0"},
                                  {"kernel_normalisation", "sum"},
                                  {"plane", "stress"}})
    CHECK_THROWS_WITH(make_problem<2>(updated({{key, text}})),
                      std::string(key) + ": is for the scheme tl-linear, not ul");
  CHECK_THROWS_WITH(make_problem<2>(updated({{"damping_rate", "0.1"}})),
                    "damping_rate: is for total-Lagrangian schemes, not ul");
  CHECK_THROWS_WITH(make_problem<2>(complete_with("deformation_gradient", "1.1,0,0,1")),
                    "deformation_gradient: is for the schemes tl-corotated, tl-pk1 and ul, not tl-linear");
  for (const auto& [key, text] : {std::pair{"pressure", "0.1"},
                                  {"deviatoric_stress", "0,0,0.1"},
                                  {"artificial_stress_epsilon", "0.3"},
                                  {"xsph", "0.5"},
                                  {"viscosity_alpha", "1"}})
    CHECK_THROWS_WITH(make_problem<2>(complete_with(key, text)),
                      std::string(key) + ": is for the scheme ul, not tl-linear");
  for (const auto& [key, text] :
       {std::pair{"displacement_gradient", "0,0,0,0"}, {"damping_rate", "0"}, {"plane", "strain"}})
    CHECK_NOTHROW(make_problem<2>(updated({{key, text}})));
  for (const auto& [key, text] : {std::pair{"deformation_gradient", "1,0,0,1"}, {"pressure", "0"}, {"xsph", "0"}})
    CHECK_NOTHROW(make_problem<2>(complete_with(key, text)));
  for (const auto* integrator : {"predictor-corrector", "predictor-corrector-pec"})
    CHECK_THROWS_WITH(make_problem<2>(complete_with("integrator", integrator)),
                      "integrator: " + std::string(integrator) + " is for the scheme ul only");
}

TEST_CASE("materials and states of ul that cannot be are refused by name", "[fast]") {
  for (const auto* key : {"young_modulus", "poisson_ratio"})
    CHECK_THROWS_WITH(make_problem<2>(updated({{key, "0.3"}})),
                      std::string(key) + ": cannot be given with shear_modulus");
  CHECK_THROWS_WITH(make_problem<2>(updated({{"bulk_modulus", "1"}})),
                    "bulk_modulus: cannot be given with sound_speed");
  CHECK_THROWS_WITH(make_problem<2>(read({{"scheme", "ul"}, {"sound_speed", "1"}})),
                    Catch::StartsWith("shear_modulus: missing"));
  CHECK_THROWS_WITH(make_problem<2>(read({{"scheme", "ul"}, {"bulk_modulus", "1"}, {"shear_modulus", "0"}})),
                    "shear_modulus: 0 is not a positive finite number");
  CHECK_THROWS_WITH(make_problem<2>(read({{"scheme", "tl-linear"}, {"sound_speed", "1"}, {"shear_modulus", "1"}})),
                    "sound_speed: is for the scheme ul, not tl-linear");
  // ρ0 c0² = 4.5: nothing is left of the density at P = −4.5.
  CHECK_THROWS_WITH(make_problem<2>(updated({{"pressure", "-4.5"}})),
                    Catch::StartsWith("pressure: -4.5 leaves no density"));
  CHECK_NOTHROW(make_problem<2>(updated({{"pressure", "-4.4"}})));
  CHECK_THROWS_WITH(read({{"artificial_stress_epsilon", "-0.1"}}), "artificial_stress_epsilon: -0.1 is not at least 0");
  CHECK_THROWS_WITH(read({{"viscosity_alpha", "-1"}}), "viscosity_alpha: -1 is not at least 0");
  CHECK_THROWS_WITH(read({{"sound_speed", "0"}}), "sound_speed: 0 is not above 0");
}
