// SPDX-License-Identifier: Apache-2.0
// Flares fitted to simulated captures of lenses whose prescriptions say what is right: a program of its own.
//   flare_fit [LENS] [STATIONS] [RAW WIDTH]
// Speeds and sizes of ghosts come from exact rays: a ghost's speed is that of the middle of its footprint, close to the
// axis. Ghosts higher than the picture, whose outline no picture shows, are not listed.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "contrejour/expert/first_order.h"
#include "contrejour/expert/fit_flare.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/expert/sweep.h"
#include "contrejour/frame.h"
#include "contrejour/light.h"

using namespace contrejour;

namespace {

constexpr double kLambda_nm = 550.0;
constexpr double kNearAxis = 0.1;  // of the range, where speeds are taken
constexpr std::size_t kBrightest = 12;

struct TrueGhost {
  Ghost ghost;
  double speed = 0, radius = 0, level = 0;  // mean over its footprint near the axis
};

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Those whose outline fits into the picture, the brightest first.
std::vector<TrueGhost> true_ghosts(const LensState& lens, double s_max) {
  const GhostMeter meter(lens, kLambda_nm);
  const double focal_length_mm = first_order(lens, kLambda_nm).focal_length_mm;
  std::vector<TrueGhost> ghosts;
  for (const Ghost& ghost : enumerate_ghosts(lens, GhostScope::All)) {
    const double s = kNearAxis * s_max;
    const GhostMeasure axis = meter.measure(ghost, LightSource(Vec3{0.0, 0.0, 1.0}));
    const GhostMeasure off = meter.measure(ghost, LightSource(direction_from_angles(std::atan(s), 0.0)));
    if (!(axis.flux_mm2 > 0.0 && off.flux_mm2 > 0.0)) continue;
    TrueGhost one{ghost, 0.0, 0.0, 0.0};
    one.radius = 0.5 * (axis.max_mm.y - axis.min_mm.y) / focal_length_mm;
    one.speed = -0.5 * (off.min_mm.x + off.max_mm.x) / (focal_length_mm * s);
    one.level = axis.flux_mm2 / (one.radius * one.radius);
    if (one.radius < 0.5 * lens.sensor_height_mm / focal_length_mm) ghosts.push_back(one);
  }
  std::ranges::sort(ghosts, std::greater(), &TrueGhost::level);
  return ghosts;
}

struct Capture {
  SweepSettings settings;
  std::vector<CapturedImage> pictures;
  std::vector<DirectImage> lights;
};

Result<Capture> captured(const LensState& lens, int stations, int raw_width) {
  Capture capture;
  SweepSettings& s = capture.settings;
  s.width = raw_width;
  s.height = 2 * static_cast<int>(0.5 * raw_width * lens.sensor_height_mm / lens.sensor_width_mm);
  s.angles_deg = even_angles_deg(0.95 * largest_angle_deg(lens), stations);
  const Result<double> light = automatic_light_rate(lens, s);
  if (!light) return tl::unexpected(light.error());
  s.light_rate = *light;
  for (std::size_t k = 0; k < s.angles_deg.size(); ++k) {
    const Result<SweepStation> station = simulate_station(lens, s, k);
    if (!station) return tl::unexpected(station.error());
    Result<CapturedImage> picture = merge_exposures(station->exposures, station->background);
    if (!picture) return tl::unexpected(picture.error());
    capture.pictures.push_back(std::move(*picture));
    if (const auto at = direct_image_position(station->direct))
      capture.lights.push_back({s.angles_deg[k] * 0.017453292519943295, *at});
  }
  return capture;
}

const MeasuredGhost* match_of(const TrueGhost& ghost, const MeasuredFlare& flare) {
  const MeasuredGhost* best = nullptr;
  double best_off = 0.15;
  for (const MeasuredGhost& fitted : flare.ghosts) {
    const double speed = fitted.centre.derivative(0.0) + fitted.skew.derivative(0.0);
    const double off = std::hypot((speed - ghost.speed) / std::max(std::abs(ghost.speed), 0.5),
                                  std::log(std::max(fitted.half_height(0.0), 1e-9) / ghost.radius));
    if (off >= best_off) continue;
    best_off = off;
    best = &fitted;
  }
  return best;
}

void print_ghosts(const std::vector<TrueGhost>& ghosts, const MeasuredFlare& flare) {
  std::size_t found = 0, count = std::min(ghosts.size(), kBrightest);
  for (std::size_t k = 0; k < count; ++k) {
    const TrueGhost& truth = ghosts[k];
    const MeasuredGhost* fitted = match_of(truth, flare);
    std::printf("  %2d-%-2d level %9.3g speed %8.4f radius %.5f", truth.ghost.i, truth.ghost.j, truth.level,
                truth.speed, truth.radius);
    if (fitted != nullptr) {
      const double speed = fitted->centre.derivative(0.0) + fitted->skew.derivative(0.0);
      std::printf("   speed %+6.2f %%  size %+6.2f %%", 100.0 * (speed / truth.speed - 1.0),
                  100.0 * (fitted->half_height(0.0) / truth.radius - 1.0));
      if (k < 10) ++found;
    }
    std::printf("\n");
  }
  std::printf("  found %zu of the %zu brightest\n", found, std::min<std::size_t>(count, 10));
}

int run(const std::string& name, int stations, int raw_width) {
  const Result<Prescription> prescription = find_lens(name);
  if (!prescription) return 1;
  const LensState lens = *configure_lens(*prescription, {});
  const Result<Capture> capture = captured(lens, stations, raw_width);
  if (!capture) {
    std::printf("%s: %s\n", name.c_str(), capture.error().to_string().c_str());
    return 1;
  }
  const Result<SweepGeometry> geometry = fit_geometry(capture->lights);
  if (!geometry) return 1;
  const double light = capture->settings.light_rate / 4.0;  // over pixels of half the raw size
  FlareSweep sweep;
  for (const double angle : capture->settings.angles_deg) sweep.angles_rad.push_back(angle * 0.017453292519943295);
  sweep.light = {light, light, light};
  sweep.pattern = capture->settings.sensor.pattern;
  sweep.picture = [&](std::size_t k) -> Result<CapturedImage> { return capture->pictures[k]; };
  const double start = seconds_now();
  const Result<FittedFlare> fit = fit_flare(sweep, *geometry);
  if (!fit) {
    std::printf("%s: %s\n", name.c_str(), fit.error().to_string().c_str());
    return 1;
  }
  const Vec2 centre{0.25 * capture->settings.width + 0.5 * capture->settings.centre_offset_px.x,
                    0.25 * capture->settings.height + 0.5 * capture->settings.centre_offset_px.y};
  std::printf(
      "%s, %d stations, %d px: %.0f s, %zu ghosts, %.0f image evaluations, NRMSE %.3f, centre off by %.2f, %.2f px"
      " (from the light alone %.2f)\n",
      name.c_str(), stations, capture->pictures[0].rate.width, seconds_now() - start, fit->flare.ghosts.size(),
      fit->image_evaluations, fit->nrmse, fit->centre_px.x - centre.x, fit->centre_px.y - centre.y,
      geometry->centre_px.x - centre.x);
  print_ghosts(true_ghosts(lens, fit->flare.s_max), fit->flare);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const int stations = argc > 2 ? std::stoi(argv[2]) : 61, raw_width = argc > 3 ? std::stoi(argv[3]) : 1200;
  if (argc > 1) return run(argv[1], stations, raw_width);
  int failed = 0;
  for (const char* lens : {"heliar", "tessar", "planar-50", "distagon-25", "nikon-80-200"})
    failed += run(lens, stations, raw_width);
  return failed;
}
