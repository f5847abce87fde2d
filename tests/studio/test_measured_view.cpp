// SPDX-License-Identifier: Apache-2.0
// A measured flare as its panel shows it.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <doctest/doctest.h>

#include "studio/core/measured_view.h"
#include "support/scratch_folder.h"

namespace contrejour::studio {
namespace {

// A disc that mirrors the light: its centre is at -0.5 s.
MeasuredFlare mirrored_disc() {
  MeasuredFlare flare;
  flare.name = "disc";
  flare.s_max = 0.2;
  flare.half_field = Vec2{0.3, 0.2};
  MeasuredGhost ghost;
  ghost.name = "1";
  ghost.centre = {Parity::Odd, {-0.5}};
  ghost.half_width = ghost.half_height = {Parity::Even, {0.02}};
  ghost.width_in = ghost.width_out = {Parity::Even, {0.002}};
  for (auto* levels : {&ghost.border, &ghost.inside})
    for (AngleCurve& level : *levels) level = {Parity::Even, {1.0}};
  ghost.last = 0.2;
  flare.ghosts.push_back(ghost);
  return flare;
}

TEST_CASE("the curves of a ghost are its parameters over the angle") {
  const auto speed = curves_of(mirrored_disc(), GhostCurve::Speed);
  REQUIRE(speed.size() == 1);
  CHECK(speed[0].points.front().x == 0);
  CHECK(speed[0].points.back().x == doctest::Approx(largest_angle_deg(mirrored_disc())));
  for (const Vec2 p : speed[0].points) CHECK(p.y == doctest::Approx(-0.5));
  CHECK(curves_of(mirrored_disc(), GhostCurve::HalfWidth)[0].points[3].y == doctest::Approx(0.02));
}

TEST_CASE("the kymograph has the ghost where its speed puts it at each angle") {
  const test::ScratchFolder folder;
  const auto file = folder / "disc.flare.toml";
  std::ofstream(file) << write_flare(mirrored_disc());
  MeasuredJob job(measured_work(), {});
  const auto answer_to = [&](const MeasuredOrder& order) {
    job.post(order);
    MeasuredAnswer answer;
    while (!job.is_idle())
      if (auto next = job.take()) answer = std::move(*next);
    return answer;
  };
  const MeasuredAnswer first = answer_to({file.string(), 0});
  REQUIRE_MESSAGE(first.flare, first.error);
  CHECK(first.half_width == doctest::Approx(0.3));
  const auto brightest_column = [&](int row) {
    double sum = 0, at = 0;
    for (int x = 0; x < kKymographWidth; ++x) {
      const double level = (*first.kymograph)[static_cast<std::size_t>(row * kKymographWidth + x)] & 255U;
      sum += level;
      at += level * (x + 0.5);
    }
    return at / sum;
  };
  const double px = kKymographWidth / 0.6;  // per tangent
  CHECK(brightest_column(kKymographHeight / 2) == doctest::Approx(kKymographWidth / 2.0).epsilon(0.01));
  CHECK(brightest_column(0) == doctest::Approx(kKymographWidth / 2.0 + 0.1 * px).epsilon(0.01));
  CHECK(brightest_column(kKymographHeight - 1) == doctest::Approx(kKymographWidth / 2.0 - 0.1 * px).epsilon(0.01));
  const MeasuredAnswer second = answer_to({file.string(), 10});
  CHECK(second.kymograph == first.kymograph);  // the same one
  CHECK(second.picture != first.picture);
  CHECK(answer_to({(folder / "no.flare.toml").string(), 0}).error.find("no.flare.toml") != std::string::npos);
}

}  // namespace
}  // namespace contrejour::studio
