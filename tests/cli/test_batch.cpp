// SPDX-License-Identifier: MIT
#include <Eigen/Core>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "cli/program.hpp"
#include "io/files.hpp"
#include "io/scratch_folder.hpp"

using namespace sphstab;
using namespace sphstab::cli_test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

const std::string material = R"("scheme":"tl-linear","young_modulus":1,"poisson_ratio":0.3)";

/// The answers to lines on standard input, one a line.
std::vector<Json> batch(const std::string& lines) {
  const std::string out = result_of({"batch"}, lines).out;
  std::vector<Json> answers;
  for (std::size_t begin = 0, end; (end = out.find('\n', begin)) != std::string::npos; begin = end + 1)
    answers.push_back(Json::parse(out.substr(begin, end - begin)));
  return answers;
}

Json result_of_line(const std::string& line) {
  const auto answers = batch(line + "\n");
  REQUIRE(answers.size() == 1);
  INFO(answers[0]);
  REQUIRE(answers[0]["ok"] == true);
  return answers[0]["result"];
}

std::string error_of_line(const std::string& line) {
  const auto answers = batch(line + "\n");
  REQUIRE(answers.size() == 1);
  REQUIRE(answers[0]["ok"] == false);
  CHECK_FALSE(answers[0].contains("result"));
  return answers[0]["error"];
}

/// det(x − E) by the method of Faddeev and Le Verrier, highest power first.
std::vector<std::complex<double>> characteristic_polynomial(const Json& rows) {
  const auto size = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXcd E(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j < size; ++j) E(i, j) = std::complex<double>(rows[i][j][0], rows[i][j][1]);
  std::vector<std::complex<double>> coefficients{1.0};
  Eigen::MatrixXcd power = Eigen::MatrixXcd::Zero(size, size);
  for (Eigen::Index n = 1; n <= size; ++n) {
    power = (E * power).eval() + coefficients.back() * Eigen::MatrixXcd::Identity(size, size);
    coefficients.push_back(-(E * power).trace() / static_cast<double>(n));
  }
  return coefficients;
}

/// The measure of the reference cases: |difference| / max(1, |value|), of polynomials up to their conjugates.
double difference(std::complex<double> ours, std::complex<double> theirs) {
  return std::abs(ours - theirs) / std::max(1.0, std::abs(theirs));
}

std::complex<double> complex(const Json& pair) { return {pair[0].get<double>(), pair[1].get<double>()}; }

double difference_of_polynomials(const std::vector<std::complex<double>>& ours, const Json& theirs) {
  if (ours.size() != theirs.size()) return std::numeric_limits<double>::infinity();
  double same = 0.0, conjugate = 0.0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    same = std::max(same, difference(ours[i], complex(theirs[i])));
    conjugate = std::max(conjugate, difference(std::conj(ours[i]), complex(theirs[i])));
  }
  return std::min(same, conjugate);
}

void check_expected(const std::string& key, const Json& expected, const Json& result, double tolerance) {
  INFO(key << ": expected " << expected);
  if (key == "characteristic_polynomial") {
    CHECK(difference_of_polynomials(characteristic_polynomial(result["amplification_matrix"]), expected) <= tolerance);
  } else if (key == "omega_squared") {
    const Json& found = result["points"][0]["omega_squared"];
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
      CHECK(difference(complex(found[i]), complex(expected[i])) <= tolerance);
  } else {
    REQUIRE(result.contains(key));
    REQUIRE(result[key].is_number());
    const double found = result[key], wanted = expected;
    if (key == "critical_time_step")
      CHECK(std::abs(found / wanted - 1.0) <= tolerance);
    else
      CHECK(difference(found, wanted) <= tolerance);
  }
}

}  // namespace

TEST_CASE("every reference line of ul is answered within its tolerance", "[fast]") {
  const std::string lines = io::read_file(SPHSTAB_GOLDEN_FOLDER "/ul_cases.jsonl");
  const auto answers = batch(lines);
  const auto references = lines_of(lines);
  REQUIRE(references.size() == 102);
  REQUIRE(answers.size() == references.size());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const Json reference = Json::parse(references[i]);
    INFO(answers[i].dump());
    REQUIRE(answers[i]["id"] == reference["id"]);
    REQUIRE(answers[i]["ok"] == true);
    for (const auto& [key, expected] : reference["expect"].items())
      check_expected(key, expected, answers[i]["result"], reference["tolerance"]);
  }
}

TEST_CASE("bad lines of a batch never stop the others, and every id comes back with its answer", "[fast]") {
  const auto answers = batch(
      "{\"id\":1,\"command\":\"kernel\",\"distance\":0.5}\r\n"
      "\n"
      "{broken\n"
      " \t\r\n"
      "{\"id\":\"second\",\"command\":\"kernel\",\"distance\":-1}\n"
      "[1]\n"
      "{\"command\":\"kernel\",\"distance\":0.5}\n"
      "{\"id\":[3,{\"a\":null}],\"command\":\"kernel\",\"distance\":0.5}");
  REQUIRE(answers.size() == 6);
  const std::vector<std::pair<Json, bool>> expected{{1, true},         {nullptr, false},
                                                    {"second", false}, {nullptr, false},
                                                    {nullptr, true},   {Json::parse(R"([3,{"a":null}])"), true}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    INFO(answers[i]);
    CHECK(answers[i]["id"] == expected[i].first);
    CHECK(answers[i]["ok"] == expected[i].second);
    CHECK(answers[i].contains("result") == expected[i].second);
    CHECK(answers[i].contains("error") != expected[i].second);
  }
}

TEST_CASE("a batch line with something wrong says what in the words of the flags", "[fast]") {
  CHECK(error_of_line(R"({"command":"kernel","distance":0.5,"distance":1})") == "distance: given twice");
  CHECK_THAT(error_of_line("{\"command\":"), StartsWith("invalid JSON: parse error at line 1"));
  CHECK_THAT(error_of_line(R"({"command":"kernel","distance":NaN})"), StartsWith("invalid JSON: "));
  CHECK_THAT(error_of_line(R"({"command":"kernel","distance":1e999})"), StartsWith("invalid JSON: "));
  CHECK(error_of_line("3") == "number is no JSON object");
  CHECK(error_of_line("{}") == "command: missing");
  CHECK(error_of_line(R"({"command":7})") == "command: missing");
  CHECK_THAT(error_of_line(R"({"command":"kernal"})"),
             StartsWith("command: 'kernal' is not known; did you mean 'kernel'?"));
  CHECK_THAT(error_of_line(R"({"command":"dt","smothing_length":1})"),
             StartsWith("key: 'smothing_length' is not known; did you mean 'smoothing_length'?"));
  CHECK_THAT(error_of_line(R"({"command":"dt","kernel":"gausian"})"), StartsWith("kernel: 'gausian' is not known"));
  CHECK(error_of_line(R"({"command":"dt","spacing":"1"})") == "spacing: is not a number");
  CHECK(error_of_line(R"({"command":"dt","spacing":-1})") == "spacing: -1 is not above 0");
  CHECK(error_of_line(R"({"command":"dt","spacing":null})") == "spacing: null is no number, word or list of numbers");
  CHECK(error_of_line(R"({"command":"dt","wave_vector":[1,"2"]})") == "wave_vector: \"2\" is not a number");
  CHECK(error_of_line(R"({"command":"sums","wave_vector":[]})") == "wave_vector: has 0 components, but 2 are needed");
  CHECK_THAT(error_of_line(R"({"command":"kernel"})"), StartsWith("distance: missing ("));
  CHECK_THAT(error_of_line(R"({"command":"bisect","patch":[65536,65536],)" + material + "}"),
             StartsWith("patch: 65536,65536"));
}

TEST_CASE("a batch line gives the result of the command", "[fast]") {
  Arguments matrix = on_case("matrix", {"--wave-vector", "-1.5,0.3", "--time-step", "0.7", "--format", "json"});
  CHECK(result_of_line(R"({"command":"matrix","wave_vector":[-1.5,0.3],"time_step":0.7,)" + material + "}") ==
        result_of(matrix).json());
  CHECK(result_of_line(R"({"command":"dt",)" + material + "}") ==
        result_of(on_case("dt", {"--format", "json"})).json());
  CHECK(result_of_line(R"({"command":"bisect","patch":[3,3],"tolerance":1e-3,)" + material + "}")["agrees"] == true);
}

TEST_CASE("every key of a batch line changes its answer", "[fast]") {
  const std::string base = R"({"command":"dt","kernel":"gaussian",)" + material;
  const Json plain = result_of_line(base + "}");
  for (const std::string key :
       {R"("spacing":2)", R"("smoothing_length":1.2)", R"("h_over_spacing":1.2)", R"("gaussian_cutoff":2)",
        R"("neighbours":"nearest")", R"("lattice":"hexagonal")", R"("density":2)", R"("plane":"stress")",
        R"("kernel_normalisation":"sum")", R"("damping_rate":0.1)", R"("wave_vector":[1,0])", R"("box":[3,3])",
        R"("mode":[1,1],"box":[3,3])", R"("time_step":1)", R"("tolerated_growth_per_step":0.1)", R"("steps":10)",
        R"("density_in_momentum":"equation-of-state","displacement_gradient":[0.1,0,0,0])"}) {
    INFO(key);
    CHECK(result_of_line(base + "," + key + "}") != plain);
  }
  CHECK(result_of_line(base + R"(,"damping_rate":0.5,"integrator":"verlet"})") !=
        result_of_line(base + R"(,"damping_rate":0.5})"));
}

TEST_CASE("kernels are normalised in one, two and three dimensions", "[fast]") {
  // Cubic spline: W(0) = 2/3, 10/7π and 1/π times 1/h^d; at q = 1 the shape 1 − 3q²/2 + 3q³/4 is 1/4, its derivatives
  // −3/4 and 3/2. A dozen roundings.
  constexpr double rounding = 1e-14, h = 0.8;
  const double constants[] = {2.0 / 3.0, 10.0 / (7.0 * std::numbers::pi), 1.0 / std::numbers::pi};
  for (int dimension = 1; dimension <= 3; ++dimension) {
    const std::string line =
        R"({"command":"kernel","smoothing_length":0.8,"distance":)" + std::to_string(h) + R"(,"dimension":)";
    const Json kernel = result_of_line(line + std::to_string(dimension) + "}");
    const double W0 = constants[dimension - 1] / std::pow(h, dimension);
    CHECK(kernel["normalisation"].get<double>() == Approx(W0).epsilon(rounding));
    CHECK(kernel["W"].get<double>() == Approx(0.25 * W0).epsilon(rounding));
    CHECK(kernel["dW"].get<double>() == Approx(-0.75 * W0 / h).epsilon(rounding));
    CHECK(kernel["d2W"].get<double>() == Approx(1.5 * W0 / (h * h)).epsilon(rounding));
  }
}

TEST_CASE("sums answers with Gray's sums: A and beta vanish at k = 0, f depends on the exponent", "[fast]") {
  const Json sums = result_of_line(R"({"command":"sums","wave_vector":[0,0],"smoothing_length":1})");
  CHECK(sums["A"] == Json({0.0, 0.0}));
  CHECK(sums["beta_sum"] == 0.0);
  CHECK(sums["neighbours"] == 8);
  const Json other = result_of_line(R"({"command":"sums","wave_vector":[1,0],"smoothing_length":1})");
  CHECK(other["f"] !=
        result_of_line(
            R"({"command":"sums","wave_vector":[1,0],"smoothing_length":1,"artificial_stress_exponent":2})")["f"]);
}

TEST_CASE("a batch comes from a file too, which must be there", "[fast]") {
  const ScratchFolder folder;
  const std::string line = R"({"id":1,"command":"kernel","distance":0.5})";
  io::write_file(folder / "cases.jsonl", line + "\n" + line + "\n");
  CHECK(result_of({"batch", folder / "cases.jsonl"}).out == result_of({"batch"}, line + "\n" + line).out);
  CHECK(result_of({"batch"}, "").out == "");
  CHECK(complaint_about({"batch", folder / "none"}) == "batch: '" + (folder / "none").string() + "' cannot be read");
  CHECK(complaint_about({"batch", folder.path()}) == "batch: '" + folder.path().string() + "' cannot be read");
}

TEST_CASE("the expectation of a reference line is passed over, its tolerance is a key", "[fast]") {
  CHECK(result_of_line(R"({"command":"kernel","distance":0.5,"expect":{"W":1},"tolerance":1e-12})").contains("W"));
}
