// SPDX-License-Identifier: Apache-2.0
// Exported source code, compiled and run where a compiler is installed, against the library.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "contrejour/expert/polynomial.h"
#include "polynomial/zone_rays.h"

using namespace contrejour;

namespace {

constexpr std::array<std::array<double, 4>, 3> kRays{
    {{0.02, 1.0, 0.5, 550.0}, {0.11, -2.0, 1.5, 450.0}, {0.2, 0.3, -2.0, 640.0}}};  // field, x, y, wavelength

// The fit of a lens's ghosts, so coarse that it takes no time: the code is tested, not the accuracy.
const LensPolynomials& fit() {
  static const LensPolynomials made = [] {
    const auto lens = configure_lens(*find_lens("cooke-triplet"));
    REQUIRE(lens.has_value());
    const auto fitted = fit_polynomials(*lens, {.position_px = 1e5,
                                                .edge = 1e3,
                                                .transmittance = 1e3,
                                                .target_px = 1.0,
                                                .max_order = 7,
                                                .max_halvings = 1,
                                                .scope = GhostScope::OneSideOfStop});
    REQUIRE(fitted.has_value());
    return *fitted;
  }();
  return made;
}

std::vector<Ghost> fitted_ghosts() {
  std::vector<Ghost> ghosts;
  for (const GhostPolynomials& ghost : fit().ghosts)
    if (ghosts.size() < 2 && ghost.zones.front().state == PolynomialZone::State::Fitted) ghosts.push_back(ghost.ghost);
  REQUIRE(!ghosts.empty());
  return ghosts;
}

bool runs(const std::string& command) { return std::system((command + " > /dev/null 2>&1").c_str()) == 0; }

class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / fmt::format("contrejour-export-{}", std::rand())) {
    std::filesystem::create_directories(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] std::string file(const char* name) const { return (path_ / name).string(); }
  void write(const char* name, const std::string& text) const { std::ofstream(path_ / name) << text; }

 private:
  std::filesystem::path path_;
};

// Compares the numbers that a program printed with the library's.
void check_printed(const std::string& file) {
  std::ifstream printed(file);
  int compared = 0;
  for (const Ghost& ghost : fitted_ghosts()) {
    const auto& of = *std::ranges::find(fit().ghosts, ghost, &GhostPolynomials::ghost);
    for (const auto& [field, x, y, lambda_nm] : kRays) {
      const PolynomialZone* const zone = find_zone(of, field);
      const bool fitted = zone != nullptr && zone->state == PolynomialZone::State::Fitted;
      int is_fitted = 0;
      REQUIRE(static_cast<bool>(printed >> is_fitted));
      CHECK((is_fitted != 0) == fitted);
      if (!fitted) continue;
      std::array<double, 10> values{};
      for (double& value : values) REQUIRE(static_cast<bool>(printed >> value));
      const PolynomialRay ray = evaluate(fit(), *zone, field, {x, y}, lambda_nm);
      CHECK(values[0] == doctest::Approx(ray.sensor_mm.x).epsilon(1e-9));
      CHECK(values[1] == doctest::Approx(ray.sensor_mm.y).epsilon(1e-9));
      CHECK(values[2] == doctest::Approx(ray.stop[0].x).epsilon(1e-9));
      CHECK(values[3] == doctest::Approx(ray.stop[0].y).epsilon(1e-9));
      CHECK(std::sqrt(values[8]) == doctest::Approx(ray.relative_height).epsilon(1e-9));
      CHECK(values[9] == doctest::Approx(ray.transmittance).epsilon(1e-9));
      std::array<double, 3> bounds{};
      for (double& value : bounds) REQUIRE(static_cast<bool>(printed >> value));
      const PolynomialBounds expected = polynomial::bounds_between(*zone, field);
      CHECK(bounds[0] == doctest::Approx(expected.low_x_mm));
      CHECK(bounds[1] == doctest::Approx(expected.high_x_mm));
      CHECK(bounds[2] == doctest::Approx(expected.half_y_mm));
      ++compared;
    }
  }
  CHECK(compared > 0);
}

}  // namespace

TEST_CASE("exported C compiles and gives the library's values") {
  if (!runs("cc --version")) {
    MESSAGE("skipped: there is no C compiler `cc`");
    return;
  }
  const auto code = export_polynomials(fit(), fitted_ghosts(), PolynomialLanguage::C);
  REQUIRE(code.has_value());
  std::string main = "#include <stdio.h>\nint main(void) {\n  double o[13];\n";
  for (std::size_t g = 0; g < fitted_ghosts().size(); ++g)
    for (const auto& [field, x, y, lambda_nm] : kRays)
      main += fmt::format(
          "  if (!flare_ray({}, {}, {}, {}, {}, o)) puts(\"0\");\n  else {{ printf(\"1\"); for (int i = 0; "
          "i < 10; ++i) printf(\" %.17g\", o[i]); flare_bounds({}, {}, o + 10); printf(\" %.17g %.17g %.17g\\n\", "
          "o[10], o[11], o[12]); }}\n",
          g, field, x, y, lambda_nm, g, field);
  const Folder folder;
  folder.write("ghosts.c", *code + main + "  return 0;\n}\n");
  REQUIRE(runs(fmt::format("cc -std=c99 -Wall -Werror -O0 {} -o {}", folder.file("ghosts.c"), folder.file("ghosts"))));
  REQUIRE(std::system(fmt::format("{} > {}", folder.file("ghosts"), folder.file("out")).c_str()) == 0);
  check_printed(folder.file("out"));
}

TEST_CASE("exported Python gives the library's values") {
  if (!runs("python3 --version")) {
    MESSAGE("skipped: there is no python3");
    return;
  }
  const auto code = export_polynomials(fit(), fitted_ghosts(), PolynomialLanguage::Python);
  REQUIRE(code.has_value());
  std::string calls;
  for (std::size_t g = 0; g < fitted_ghosts().size(); ++g)
    for (const auto& [field, x, y, lambda_nm] : kRays)
      calls += fmt::format(
          "r = flare_ray({}, {}, {}, {}, {})\nb = flare_bounds({}, {}) or [0, 0, 0]\n"
          "print(0 if r is None else '1 ' + ' '.join(map(repr, r + b)))\n",
          g, field, x, y, lambda_nm, g, field);
  const Folder folder;
  folder.write("ghosts.py", *code + "\n\n" + calls);
  REQUIRE(std::system(fmt::format("python3 {} > {}", folder.file("ghosts.py"), folder.file("out")).c_str()) == 0);
  check_printed(folder.file("out"));
}

TEST_CASE("exported GLSL and HLSL compile") {
  if (!runs("glslangValidator --version")) {
    MESSAGE("skipped: there is no glslangValidator");
    return;
  }
  const auto code = export_polynomials(fit(), fitted_ghosts(), PolynomialLanguage::Glsl);
  REQUIRE(code.has_value());
  const Folder folder;
  folder.write("ghosts.frag", "#version 330\n" + *code +
                                  "out vec4 colour;\nvoid main() {\n  float r[10];\n  bool ok = flare_ray(0, 0.1, 1.0, "
                                  "0.5, 550.0, r);\n  colour = ok ? vec4(r[0], r[1], r[8], r[9]) : vec4(0.0);\n}\n");
  CHECK(runs("glslangValidator " + folder.file("ghosts.frag")));
  folder.write("buffer.frag",
               "#version 430\nlayout(std430, binding = 0) buffer In { float numbers[]; };\n"
               "#define flare_COEFFICIENT(i) numbers[i]\n" +
                   *code +
                   "out vec4 colour;\nvoid main() {\n  float r[10];\n  colour = flare_ray(0, 0.1, 1.0, 0.5, "
                   "550.0, r) ? vec4(r[0]) : vec4(0.0);\n}\n");
  CHECK(runs("glslangValidator " + folder.file("buffer.frag")));
  const auto hlsl = export_polynomials(fit(), fitted_ghosts(), PolynomialLanguage::Hlsl);
  REQUIRE(hlsl.has_value());
  folder.write("ghosts.hlsl",
               *hlsl +
                   "float4 main() : SV_Target {\n  float r[10];\n  bool ok = flare_ray(0, 0.1, 1.0, 0.5, "
                   "550.0, r);\n  return ok ? float4(r[0], r[1], r[8], r[9]) : 0.0;\n}\n");
  CHECK(runs("glslangValidator -D -V -S frag -e main -o /dev/null " + folder.file("ghosts.hlsl")));
}

TEST_CASE("a ghost that the fit does not have and a wrong prefix are refused") {
  CHECK(!export_polynomials(fit(), {{1, 99}}, PolynomialLanguage::C).has_value());
  CHECK(!export_polynomials(fit(), {}, PolynomialLanguage::C, "2x").has_value());
  CHECK(!export_polynomials(fit(), {}, PolynomialLanguage::C, "").has_value());
}
