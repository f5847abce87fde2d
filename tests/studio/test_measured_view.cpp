// SPDX-License-Identifier: Apache-2.0
// A measured flare as its panel shows it.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <doctest/doctest.h>

#include "contrejour/expert/station_file.h"
#include "studio/core/measured_view.h"
#include "support/approx.h"
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
  CHECK(speed[0].points.back().x == test::approx(largest_angle_deg(mirrored_disc())));
  for (const Vec2 p : speed[0].points) CHECK(p.y == test::approx(-0.5));
  CHECK(curves_of(mirrored_disc(), GhostCurve::HalfWidth)[0].points[3].y == test::approx(0.02));
}

MeasuredAnswer answer_to(MeasuredJob& job, const MeasuredOrder& order) {
  job.post(order);
  MeasuredAnswer answer;
  while (!job.is_idle())
    if (auto next = job.take()) answer = std::move(*next);
  return answer;
}

TEST_CASE("the kymograph has the ghost where its speed puts it at each angle") {
  const test::ScratchFolder folder;
  const auto file = folder / "disc.flare.toml";
  std::ofstream(file) << write_flare(mirrored_disc());
  MeasuredJob job(measured_work(), {});
  const MeasuredAnswer first = answer_to(job, {file.string(), 0});
  REQUIRE_MESSAGE(first.flare, first.error);
  CHECK(first.half_width == test::approx(0.3));
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
  CHECK(brightest_column(kKymographHeight / 2) == test::approx(kKymographWidth / 2.0).epsilon(0.01));
  CHECK(brightest_column(0) == test::approx(kKymographWidth / 2.0 + 0.1 * px).epsilon(0.01));
  CHECK(brightest_column(kKymographHeight - 1) == test::approx(kKymographWidth / 2.0 - 0.1 * px).epsilon(0.01));
  const MeasuredAnswer second = answer_to(job, {file.string(), 10});
  CHECK(second.kymograph == first.kymograph);  // the same one
  CHECK(second.picture != first.picture);
  CHECK(answer_to(job, {(folder / "no.flare.toml").string(), 0}).error.find("no.flare.toml") != std::string::npos);
}

constexpr int kSweepWidth = 240, kSweepHeight = 160;
constexpr double kSweepRoll_rad = 0.05, kLightRate = 5000;

// The place of the light of an angle, in pixels with y down.
Vec2 light_at(double s, double focal_px) {
  return {0.5 * kSweepWidth + focal_px * s * std::cos(kSweepRoll_rad),
          0.5 * kSweepHeight - focal_px * s * std::sin(kSweepRoll_rad)};
}

// Scattered light about the light's image, relative to the light: near it a hundred times as bright as the disc.
float halo_at(double r_px) { return static_cast<float>(7e-4 / (1 + r_px * r_px / 200)); }

void add_halo(Image& rate, Vec2 light_px) {
  for (int y = 0; y < rate.height; ++y)
    for (int x = 0; x < rate.width; ++x)
      for (int c = 0; c < 3; ++c)
        rate.at(x, y, c) +=
            static_cast<float>(kLightRate) * halo_at(std::hypot(x + 0.5 - light_px.x, y + 0.5 - light_px.y));
}

// The disc's photographs by a camera that is rolled; that of the last station has a spot that the flare has not.
void write_sweep(const std::filesystem::path& folder, bool has_halo = false) {
  const double focal_px = 0.5 * kSweepWidth / 0.3;
  const TangentFrame frame{kSweepWidth, kSweepHeight, focal_px, {0.5 * kSweepWidth, 0.5 * kSweepHeight}};
  for (int k = 0; k < 7; ++k) {
    const double angle_deg = 3.0 * (k - 3), s = std::tan(angle_deg * 0.017453292519943295);
    const FlareLight light{{s * std::cos(kSweepRoll_rad), s * std::sin(kSweepRoll_rad)},
                           {kLightRate, kLightRate, kLightRate}};
    auto rate = render_measured(mirrored_disc(), {&light, 1}, frame);
    REQUIRE(rate);
    if (k == 6)
      for (int y = 20; y < 30; ++y)
        for (int x = 20; x < 30; ++x) rate->at(x, y, 1) = 1.0F;
    if (has_halo) add_halo(*rate, light_at(s, focal_px));
    MergedStation station{k + 1, angle_deg, {std::move(*rate), {}, {}, {}, {}}, {}};
    station.image.variance = station.image.valid = Image(kSweepWidth, kSweepHeight);
    station.direct = DirectFlux{light_at(s, focal_px), {kLightRate, kLightRate, kLightRate}};
    REQUIRE(write_station(folder / ("station-000" + std::to_string(k + 1) + ".exr"), station));
  }
}

int brightest(const std::vector<std::uint32_t>& codes) {
  unsigned most = 0;
  for (const std::uint32_t code : codes) most = std::max(most, code >> 8U & 255U);
  return static_cast<int>(most);
}

TEST_CASE("photographs of a rolled camera lie on their fit, and what it has not is in the residual") {
  const test::ScratchFolder folder;
  std::ofstream(folder / "disc.flare.toml") << write_flare(mirrored_disc());
  write_sweep(folder / ".");
  MeasuredJob job(measured_work(), {});
  const std::string file = (folder / "disc.flare.toml").string(), sweep = (folder / ".").string();
  const MeasuredAnswer first = answer_to(job, {file, 5.5, sweep});
  REQUIRE_MESSAGE(first.photograph, first.error);
  CHECK(first.angle_deg == test::approx(6.0).epsilon(0.01));
  CHECK(first.photograph->station == 5);
  CHECK(first.photograph->count == 7);
  CHECK(first.photograph->read == 7);
  CHECK(brightest(first.photograph->captured) > 100);
  CHECK(std::abs(brightest(first.photograph->captured) - brightest(first.photograph->fitted)) <= 2);
  // Both are sampled by pixels: edges differ by a part of one, elsewhere there is nothing left.
  const auto& residual = first.photograph->residual;
  CHECK(std::ranges::count_if(residual, [](std::uint32_t code) { return (code >> 8U & 255U) > 60; }) <
        static_cast<int>(residual.size() / 100));
  // In the kymograph of the photographs the disc stands where it does in that of the fit.
  const auto middle_of_row = [](const std::vector<std::uint32_t>& codes, int row) {
    double sum = 0, at = 0;
    for (int x = 0; x < kKymographWidth; ++x) {
      const double level = codes[static_cast<std::size_t>(row * kKymographWidth + x)] >> 8U & 255U;
      sum += level;
      at += level * x;
    }
    return at / sum;
  };
  for (const int row : {kKymographHeight / 2, 20})
    CHECK(std::abs(middle_of_row(*first.photograph->kymograph, row) - middle_of_row(*first.kymograph, row)) < 12);

  const MeasuredAnswer last = answer_to(job, {file, 9, sweep});
  REQUIRE(last.photograph);
  CHECK(last.photograph->station == 6);
  CHECK(std::ranges::count_if(last.photograph->residual, [](std::uint32_t code) { return (code >> 8U & 255U) > 60; }) >
        80);
  const MeasuredAnswer none = answer_to(job, {file, 9, (folder / "elsewhere").string()});
  CHECK_FALSE(none.photograph);
  CHECK(none.error.find("measure merge") != std::string::npos);
  CHECK(none.flare);
}

TEST_CASE("the halo about the light is left out of the residual, what the fit lacks is not") {
  const test::ScratchFolder folder;
  std::ofstream(folder / "disc.flare.toml") << write_flare(mirrored_disc());
  write_sweep(folder / ".", true);
  MeasuredJob job(measured_work(), {});
  const std::string file = (folder / "disc.flare.toml").string(), sweep = (folder / ".").string();
  const auto bright = [](const std::vector<std::uint32_t>& codes, int x_end, int y_end) {
    int count = 0;
    for (int y = 0; y < y_end; ++y)
      for (int x = 0; x < x_end; ++x)
        count += (codes[static_cast<std::size_t>(y * kMeasuredWidth + x)] >> 8U & 255U) > 128 ? 1 : 0;
    return count;
  };
  const MeasuredAnswer middle = answer_to(job, {file, 3, sweep});
  REQUIRE_MESSAGE(middle.photograph, middle.error);
  // The rest lies next to the light, where half a per cent of the halo is as bright as a part of the disc.
  CHECK(bright(middle.photograph->captured, kMeasuredWidth, kMeasuredHeight) > 20000);
  CHECK(bright(middle.photograph->residual, kMeasuredWidth, kMeasuredHeight) < 3000);
  const MeasuredAnswer last = answer_to(job, {file, 9, sweep});
  REQUIRE(last.photograph);
  CHECK(bright(middle.photograph->captured, 45, 45) > 1000);
  CHECK(bright(middle.photograph->residual, 45, 45) < 40);  // pixels that the photograph's edge cuts
  CHECK(bright(last.photograph->residual, 45, 45) > 80);    // and the spot
}

}  // namespace
}  // namespace contrejour::studio
