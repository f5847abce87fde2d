// SPDX-License-Identifier: Apache-2.0
// Exported source code, compiled and run where a compiler is installed, against the library.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "contrejour/expert/polynomial.h"
#include "polynomial/asymmetric_basis.h"
#include "polynomial/zone_rays.h"
#include "support/approx.h"
#include "support/coarse_polynomials.h"
#include "support/scratch_folder.h"

using namespace contrejour;

namespace {

struct Call {
  std::size_t ghost = 0;  // of the exported ones
  Vec2 tangents, at_mm;
  double lambda_nm = 550.0;
};

// A fit, and calls of the functions that it is exported as.
struct Exported {
  LensPolynomials fit;
  std::vector<Ghost> ghosts;
  std::vector<Call> calls;
  bool is_centred = true;

  [[nodiscard]] const GhostPolynomials& ghost_of(const Call& call) const {
    return test::polynomials_of(fit, ghosts[call.ghost]);
  }
  [[nodiscard]] std::size_t bounds_count() const { return is_centred ? 3 : 4; }
  [[nodiscard]] std::string name_of(const char* function) const {
    return fmt::format("flare_{}{}", function, is_centred ? "" : "_at");
  }
  [[nodiscard]] std::string direction_of(const Call& call) const {
    return is_centred ? fmt::format("{}, {}", call.ghost, call.tangents.x)
                      : fmt::format("{}, {}, {}", call.ghost, call.tangents.x, call.tangents.y);
  }
  [[nodiscard]] std::string arguments_of(const Call& call) const {
    return fmt::format("{}, {}, {}, {}", direction_of(call), call.at_mm.x, call.at_mm.y, call.lambda_nm);
  }
  [[nodiscard]] std::string code(PolynomialLanguage language) const {
    const auto text = export_polynomials(fit, ghosts, language);
    REQUIRE(text.has_value());
    return *text;
  }
};

const Exported& centred() {
  static const Exported made = [] {
    LensPolynomials fit = test::coarse_triplet_polynomials(7);
    std::vector<Ghost> ghosts = test::fitted_ghosts(fit, 2);
    std::vector<Call> calls;
    for (std::size_t g = 0; g < ghosts.size(); ++g) {
      calls.push_back({g, {0.02, 0.0}, {1.0, 0.5}, 550.0});
      calls.push_back({g, {0.11, 0.0}, {-2.0, 1.5}, 450.0});
      calls.push_back({g, {0.2, 0.0}, {0.3, -2.0}, 640.0});
    }
    return Exported{std::move(fit), std::move(ghosts), std::move(calls)};
  }();
  return made;
}

std::mt19937& random_numbers() {
  static std::mt19937 numbers(7);
  return numbers;
}
float random_number() { return std::uniform_real_distribution(-1.0F, 1.0F)(random_numbers()); }

ChebyshevSum random_sum(int degree, const polynomial::Parities& parities, int wavelength_terms) {
  ChebyshevSum sum;
  sum.degree = degree;
  sum.wavelength_terms = wavelength_terms;
  const int count = wavelength_terms * polynomial::asymmetric_term_count(degree, parities);
  for (int k = 0; k < count; ++k) sum.coefficients.push_back(random_number());
  return sum;
}

// A zone of a ghost without axial symmetry, of random polynomials, whose bounds have a part without light.
AsymmetricZone random_zone(Vec2 low, Vec2 high, bool even_x, bool even_y, int degree) {
  AsymmetricZone zone;
  zone.state = PolynomialZone::State::Fitted;
  zone.low = low, zone.high = high;
  zone.even_x = even_x, zone.even_y = even_y;
  zone.radius_mm = {4.0, 5.0};
  for (std::size_t k = 0; k < zone.centre_x_mm.size(); ++k)
    zone.centre_x_mm[k] = random_number(), zone.centre_y_mm[k] = random_number();
  const auto vector = [&](int of) {
    return AsymmetricVector{random_sum(of, polynomial::parities_of_x(zone), 2),
                            random_sum(of, polynomial::parities_of_y(zone), 1)};
  };
  zone.sensor_mm = vector(degree);
  zone.stop.push_back(vector(3));
  const polynomial::Parities scalars = polynomial::parities_of_scalar(zone);
  for (int step = 0; step < 2; ++step) zone.rims.push_back({step, random_sum(2, scalars, 1)});
  zone.transmittance = random_sum(4, scalars, 13);
  zone.bounds_side = 4;
  for (int k = 0; k < 16; ++k) {
    const float x = random_number(), y = random_number();
    zone.bounds.push_back(k % 4 == 3 ? AsymmetricBounds{} : AsymmetricBounds{x - 2.0F, y - 1.0F, x + 1.0F, y + 3.0F});
  }
  return zone;
}

// One ghost with a mirror plane and zones in its middle and on one side, and one without.
const Exported& decentred() {
  static const Exported made = [] {
    LensPolynomials fit;
    fit.lens = "random";
    fit.ghosts.push_back({{1, 2}, {{}}, {}, true, false});
    fit.ghosts.front().asymmetric = {random_zone({-0.1, -0.2}, {0.1, 0.3}, true, false, 13),
                                     random_zone({0.1, -0.2}, {0.4, 0.3}, false, false, 5)};
    fit.ghosts.push_back({{3, 4}, {{}}, {}, true, true});
    fit.ghosts.back().asymmetric = {random_zone({-0.3, -0.2}, {0.3, 0.2}, true, true, 9)};
    std::vector<Call> calls;
    for (const std::size_t ghost : {std::size_t{0}, std::size_t{1}})
      for (const Vec2 tangents : {Vec2{0.05, -0.1}, Vec2{-0.07, 0.12}, Vec2{0.23, 0.15}, Vec2{-0.28, -0.11},
                                  Vec2{-0.1 + 1e-9, 0.199}, Vec2{0.5, 0.0}})
        calls.push_back({ghost, tangents, {1.5, -0.7}, 430.0 + 50.0 * static_cast<double>(calls.size() % 5)});
    return Exported{std::move(fit), {{1, 2}, {3, 4}}, std::move(calls), false};
  }();
  return made;
}

struct Expected {
  PolynomialRay ray;
  std::vector<double> bounds;
};

std::optional<Expected> expected_of(const Exported& exported, const Call& call) {
  const GhostPolynomials& ghost = exported.ghost_of(call);
  if (exported.is_centred) {
    const double field = call.tangents.x;
    const PolynomialZone* const zone = find_zone(ghost, field);
    if (zone == nullptr || zone->state != PolynomialZone::State::Fitted) return std::nullopt;
    const PolynomialBounds b = polynomial::bounds_between(*zone, field);
    return Expected{evaluate(exported.fit, *zone, field, call.at_mm, call.lambda_nm),
                    {b.low_x_mm, b.high_x_mm, b.half_y_mm}};
  }
  const auto ray = evaluate(exported.fit, ghost, call.tangents, call.at_mm, call.lambda_nm);
  if (!ray) return std::nullopt;
  const FoundAsymmetricZone found = find_zone(ghost, call.tangents);
  const auto mirrored = [&](Vec2 v) { return Vec2{found.mirrored_x ? -v.x : v.x, found.mirrored_y ? -v.y : v.y}; };
  const AsymmetricBounds b = polynomial::bounds_between(*found.zone, mirrored(call.tangents));
  const Vec2 low = mirrored({b.low_x_mm, b.low_y_mm}), high = mirrored({b.high_x_mm, b.high_y_mm});
  return Expected{*ray,
                  {std::min(low.x, high.x), std::min(low.y, high.y), std::max(low.x, high.x), std::max(low.y, high.y)}};
}

bool runs(const std::string& command) { return std::system((command + " > /dev/null 2>&1").c_str()) == 0; }

void check_values(const std::vector<double>& values, const Expected& expected) {
  const PolynomialRay& ray = expected.ray;
  CHECK(values[0] == test::approx(ray.sensor_mm.x).epsilon(1e-9));
  CHECK(values[1] == test::approx(ray.sensor_mm.y).epsilon(1e-9));
  CHECK(values[2] == test::approx(ray.stop[0].x).epsilon(1e-9));
  CHECK(values[3] == test::approx(ray.stop[0].y).epsilon(1e-9));
  CHECK(std::sqrt(values[8]) == test::approx(ray.relative_height).epsilon(1e-9));
  CHECK(values[9] == test::approx(ray.transmittance).epsilon(1e-9));
  for (std::size_t k = 0; k < expected.bounds.size(); ++k) CHECK(values[10 + k] == test::approx(expected.bounds[k]));
}

// Compares the numbers that a program printed with the library's.
void check_printed(const Exported& exported, const std::string& file) {
  std::ifstream printed(file);
  int compared = 0;
  for (const Call& call : exported.calls) {
    CAPTURE(exported.arguments_of(call));
    const auto expected = expected_of(exported, call);
    int is_fitted = 0;
    REQUIRE(static_cast<bool>(printed >> is_fitted));
    CHECK((is_fitted != 0) == expected.has_value());
    if (!expected || is_fitted == 0) continue;
    std::vector<double> values(10 + exported.bounds_count());
    for (double& value : values) REQUIRE(static_cast<bool>(printed >> value));
    check_values(values, *expected);
    ++compared;
  }
  CHECK(compared > 1);
}

void check_c(const Exported& exported) {
  std::string main = "#include <stdio.h>\nint main(void) {\n  double o[14];\n";
  for (const Call& call : exported.calls)
    main += fmt::format(
        "  if (!{}({}, o)) puts(\"0\");\n  else {{\n    printf(\"1\");\n    {}({}, o + 10);\n    for (int i = 0; i < "
        "{}; "
        "++i) printf(\" %.17g\", o[i]);\n    puts(\"\");\n  }}\n",
        exported.name_of("ray"), exported.arguments_of(call), exported.name_of("bounds"), exported.direction_of(call),
        10 + exported.bounds_count());
  const test::ScratchFolder folder;
  const std::string source = (folder / "ghosts.c").string(), program = (folder / "ghosts").string(),
                    out = (folder / "out").string();
  std::ofstream(source) << exported.code(PolynomialLanguage::C) << main << "  return 0;\n}\n";
  REQUIRE(runs(fmt::format("cc -std=c99 -Wall -Wextra -Werror -O0 {} -o {} -lm", source, program)));
  REQUIRE(std::system(fmt::format("{} > {}", program, out).c_str()) == 0);
  check_printed(exported, out);
}

void check_python(const Exported& exported) {
  std::string calls;
  for (const Call& call : exported.calls)
    calls += fmt::format(
        "r = {}({})\nb = {}({}) or [0] * {}\nprint(0 if r is None else '1 ' + ' '.join(map(repr, r + b)))\n",
        exported.name_of("ray"), exported.arguments_of(call), exported.name_of("bounds"), exported.direction_of(call),
        exported.bounds_count());
  const test::ScratchFolder folder;
  const std::string source = (folder / "ghosts.py").string(), out = (folder / "out").string();
  std::ofstream(source) << exported.code(PolynomialLanguage::Python) << "\n\n" << calls;
  REQUIRE(std::system(fmt::format("python3 {} > {}", source, out).c_str()) == 0);
  check_printed(exported, out);
}

// The statements of a shader's main function that use both exported functions.
std::string shader_body(const Exported& exported, const char* four) {
  const Call& call = exported.calls.front();
  return fmt::format(
      "  float r[10], b[{}];\n  bool ok = {}({}, r) && {}({}, b);\n  {}4 colour_of = ok ? {}4(r[0], r[1], "
      "b[0], r[9]) : {}4(0.0, 0.0, 0.0, 0.0);\n",
      exported.bounds_count(), exported.name_of("ray"), exported.arguments_of(call), exported.name_of("bounds"),
      exported.direction_of(call), four, four, four);
}

void check_shaders(const Exported& exported) {
  const test::ScratchFolder folder;
  const auto compiles = [&](const char* name, const std::string& options, const std::string& text) {
    const std::string file = (folder / name).string();
    std::ofstream(file) << text;
    return runs("glslangValidator " + options + " " + file);
  };
  const std::string code = exported.code(PolynomialLanguage::Glsl);
  const std::string main =
      "out vec4 colour;\nvoid main() {\n" + shader_body(exported, "vec") + "  colour = colour_of;\n}\n";
  CHECK(compiles("ghosts.frag", "", "#version 330\n" + code + main));
  CHECK(compiles("buffer.frag", "",
                 "#version 430\nlayout(std430, binding = 0) buffer In { float numbers[]; };\n"
                 "#define flare_COEFFICIENT(i) numbers[i]\n" +
                     code + main));
  CHECK(compiles("ghosts.hlsl", "-D -V -S frag -e main -o /dev/null",
                 exported.code(PolynomialLanguage::Hlsl) + "float4 main() : SV_Target {\n" +
                     shader_body(exported, "float") + "  return colour_of;\n}\n"));
}

// False, with a message, where a program is not installed.
bool is_installed(const std::string& program) {
  const bool found = runs(program + " --version");
  if (!found) MESSAGE("skipped: there is no ", program);
  return found;
}

}  // namespace

TEST_CASE("exported C compiles and gives the library's values") {
  if (is_installed("cc")) check_c(centred());
}

TEST_CASE("exported C of ghosts without axial symmetry compiles and gives the library's values") {
  if (is_installed("cc")) check_c(decentred());
}

TEST_CASE("exported Python gives the library's values") {
  if (is_installed("python3")) check_python(centred());
}

TEST_CASE("exported Python of ghosts without axial symmetry gives the library's values") {
  if (is_installed("python3")) check_python(decentred());
}

TEST_CASE("exported GLSL and HLSL compile") {
  if (is_installed("glslangValidator")) check_shaders(centred());
}

TEST_CASE("exported GLSL and HLSL of ghosts without axial symmetry compile") {
  if (is_installed("glslangValidator")) check_shaders(decentred());
}

TEST_CASE("a ghost that the fit does not have and a wrong prefix are refused") {
  const LensPolynomials& fit = centred().fit;
  CHECK(!export_polynomials(fit, {{1, 99}}, PolynomialLanguage::C).has_value());
  CHECK(!export_polynomials(fit, {}, PolynomialLanguage::C, "2x").has_value());
  CHECK(!export_polynomials(fit, {}, PolynomialLanguage::C, "").has_value());
}
