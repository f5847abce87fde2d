// SPDX-License-Identifier: Apache-2.0
// The examples of docs/polynomial-export.md, with exported code.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "contrejour/expert/direct_polynomials.h"
#include "support/approx.h"
#include "support/coarse_polynomials.h"
#include "support/scratch_folder.h"

using namespace contrejour;

namespace {

const std::string kExamples = CONTREJOUR_EXAMPLES;

bool ends_well(const std::string& command) { return std::system((command + " > /dev/null 2>&1").c_str()) == 0; }

}  // namespace

TEST_CASE("the example of a path tracer's camera draws a picture, and finds lamps where the library does") {
  if (!ends_well("cc --version")) {
    MESSAGE("skipped: there is no C compiler `cc`");
    return;
  }
  const auto lens = configure_lens(*find_lens("cooke-triplet"), {.object_distance_mm = 1500.0});
  REQUIRE(lens.has_value());
  const auto fit = fit_direct_polynomials(*lens);
  REQUIRE(fit.has_value());
  const DirectPolynomials one = at_wavelength(*fit, 550.0);
  const test::ScratchFolder folder;
  std::ofstream(folder / "lens.c") << *export_direct_polynomials(one, PolynomialLanguage::C);
  const std::string program = (folder / "camera").string(), picture = (folder / "picture.pgm").string();
  REQUIRE(std::system(fmt::format("cc -std=c99 -Wall -Wextra -Werror -O1 -I{} {}/c/camera.c -o {} -lm",
                                  (folder / "").string(), kExamples, program)
                          .c_str()) == 0);
  REQUIRE(std::system(fmt::format("{} {} 30 20 8 1.0 > {}", program, picture, (folder / "out").string()).c_str()) == 0);
  CHECK(std::filesystem::file_size(picture) == std::string("P5\n30 20\n255\n").size() + 600);
  std::ifstream out(folder / "out");
  std::string text;
  std::getline(out, text);
  double middle = 0.0;
  std::array<double, 3> found{};
  REQUIRE(std::sscanf(text.c_str(), "middle %lf; lamp at %lf, %lf mm, radius of its blur %lf mm", &middle, &found[0],
                      &found[1], &found[2]) == 4);
  CHECK(middle > 0.0);
  const ScenePoint lamp{{300.0, 300.0, -3000.0}};
  const Vec2 at = *direct_sensor_point(one, lamp, {}, 550.0), edge = *direct_sensor_point(one, lamp, {1.0, 0.0}, 550.0);
  CHECK(found[0] == test::approx(at.x).epsilon(1e-4));
  CHECK(found[1] == test::approx(at.y).epsilon(1e-4));
  CHECK(found[2] == test::approx(length(edge - at)).epsilon(1e-2));
}

TEST_CASE("the example of a game's shaders compiles") {
  if (!ends_well("glslangValidator --version")) {
    MESSAGE("skipped: there is no glslangValidator");
    return;
  }
  const LensPolynomials fit = test::coarse_triplet_polynomials(5, {{1, 2}, {3, 6}});
  const test::ScratchFolder folder;
  std::ofstream(folder / "ghosts.hlsl") << *export_polynomials(fit, {{1, 2}, {3, 6}}, PolynomialLanguage::Hlsl);
  for (const auto& [stage, entry] : {std::pair{"vert", "vertex_main"}, std::pair{"frag", "pixel_main"}})
    CHECK(ends_well(fmt::format("glslangValidator -D -V -S {} -e {} -I{} -o /dev/null {}/game/ghosts_draw.hlsl", stage,
                                entry, (folder / "").string(), kExamples)));
}
