// SPDX-License-Identifier: Apache-2.0
// Flares fitted to simulated captures of lenses whose prescriptions say what is right: a program of its own.
//   flare_fit [LENS] [STATIONS] [RAW WIDTH]
// Each ghost by itself, as the exact renderer draws it at one angle, is compared with the fitted ghost by itself: its
// middle over the light's place (speed), its RMS height (size), its flux, the RMS difference over its bright level.
// Only pixels above a part of that level count: caustic ghosts have faint skirts far outside what a picture shows.
// Ghosts that do not lie within the picture at this angle are not listed.
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
#include "contrejour/render.h"

using namespace contrejour;

namespace {

constexpr double kLambda_nm = 550.0;
constexpr double kPart = 0.45;     // of the range: the angle of the comparison
constexpr double kCounts = 0.3;    // of a ghost's bright level: what belongs to its body
constexpr double kSameGhost = 0.15;  // relative differences of speed and size of what counts as found
constexpr std::size_t kBrightest = 12;

// The figures of a ghost, taken from a picture of it alone.
struct GhostMoments {
  double speed = 0, size = 0, flux = 0, peak = 0;  // peak: the bright level
};

struct TrueGhost {
  Ghost ghost;
  Image picture;
  GhostMoments moments;
};

// The frame of the comparison, and the light's place in it.
struct Comparison {
  Frame frame;
  TangentFrame tangents;
  double s = 0;
};

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double grey_at(const Image& picture, std::size_t k) {
  return static_cast<double>(picture.pixels[3 * k] + picture.pixels[3 * k + 1] + picture.pixels[3 * k + 2]);
}

// A quarter of the light lies in brighter pixels.
double bright_level(const Image& picture) {
  std::vector<double> values;
  for (std::size_t k = 0; 3 * k < picture.pixels.size(); ++k) values.push_back(grey_at(picture, k));
  std::ranges::sort(values, std::greater());
  double all = 0.0, sum = 0.0;
  for (const double v : values) all += v;
  for (const double v : values) {
    sum += v;
    if (sum > 0.25 * all) return v;
  }
  return 0.0;
}

GhostMoments moments_of(const Image& picture, const Comparison& at) {
  GhostMoments m;
  m.peak = bright_level(picture);
  double count = 0.0;
  double x1 = 0.0, y2 = 0.0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const double value = static_cast<double>(picture.at(x, y, 0) + picture.at(x, y, 1) + picture.at(x, y, 2));
      m.flux += value;
      if (value < kCounts * m.peak) continue;
      ++count;
      x1 += x + 0.5 - at.tangents.centre_px.x;
      y2 += std::pow(y + 0.5 - at.tangents.centre_px.y, 2);
    }
  }
  if (count > 0.0) {
    m.speed = x1 / (count * at.s * at.tangents.focal_length_px);
    m.size = std::sqrt(y2 / count);
  }
  return m;
}

bool is_within(const Image& picture, double peak) {
  double edge = 0.0;
  const auto consider = [&](int x, int y) {
    edge = std::max(edge, static_cast<double>(picture.at(x, y, 0) + picture.at(x, y, 1) + picture.at(x, y, 2)));
  };
  for (int x = 0; x < picture.width; ++x) consider(x, 0), consider(x, picture.height - 1);
  for (int y = 0; y < picture.height; ++y) consider(0, y), consider(picture.width - 1, y);
  return edge < kCounts * peak;
}

Comparison comparison_of(const LensState& lens, int width, int height, double s_max) {
  Comparison at{frame_on_sensor(lens, width, height), {}, kPart * s_max};
  const double focal_length_px = first_order(lens, kLambda_nm).focal_length_mm / at.frame.pixel_pitch_mm;
  at.tangents = {width, height, focal_length_px, {0.5 * width, 0.5 * height}};
  return at;
}

// The ghosts that lie within the picture, the brightest first.
std::vector<TrueGhost> true_ghosts(const LensState& lens, const Comparison& at) {
  Light light;
  light.direction = direction_from_angles(std::atan(at.s), 0.0);
  light.radius_rad = SweepSettings{}.source_radius_rad;
  FrameSettings settings;
  settings.frame = at.frame;
  settings.starburst.on = false;
  settings.glare.fraction = 0.0;
  std::vector<TrueGhost> ghosts;
  for (const Ghost& ghost : enumerate_ghosts(lens, GhostScope::All)) {
    settings.selection = SelectList{{ghost}};
    Result<Flare> flare = render(AdaptiveOptions{}, lens, std::span(&light, 1), settings);
    if (!flare) continue;
    TrueGhost one{ghost, std::move(flare->image), {}};
    one.moments = moments_of(one.picture, at);
    if (one.moments.peak > 0.0 && is_within(one.picture, one.moments.peak)) ghosts.push_back(std::move(one));
  }
  std::ranges::sort(ghosts, [](const TrueGhost& a, const TrueGhost& b) { return a.moments.peak > b.moments.peak; });
  return ghosts;
}

struct Capture {
  SweepSettings settings;
  std::vector<CapturedImage> pictures;
  std::vector<DirectImage> lights;
  std::vector<std::optional<DirectFlux>> direct;
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
    capture.direct.emplace_back();
    if (const auto flux = direct_flux(station->direct)) {
      capture.direct.back() = *flux;
      capture.lights.push_back({s.angles_deg[k] * 0.017453292519943295, flux->position_px});
    }
  }
  return capture;
}

struct FittedGhost {
  Image picture;
  GhostMoments moments;
};

std::vector<FittedGhost> fitted_ghosts(const MeasuredFlare& flare, const Comparison& at) {
  std::vector<FittedGhost> all;
  for (const MeasuredGhost& ghost : flare.ghosts) {
    MeasuredFlare alone = flare;
    alone.ghosts = {ghost};
    const FlareLight light{{at.s, 0.0}, {1.0, 1.0, 1.0}};
    Result<Image> picture = render_measured(alone, std::span(&light, 1), at.tangents);
    if (!picture) continue;
    all.push_back({std::move(*picture), {}});
    all.back().moments = moments_of(all.back().picture, at);
  }
  return all;
}

const FittedGhost* match_of(const TrueGhost& truth, const std::vector<FittedGhost>& fitted) {
  const FittedGhost* best = nullptr;
  double best_off = kSameGhost;
  for (const FittedGhost& ghost : fitted) {
    if (!(ghost.moments.flux > 0.0)) continue;
    const double off =
        std::hypot((ghost.moments.speed - truth.moments.speed) / std::max(std::abs(truth.moments.speed), 0.5),
                   std::log(ghost.moments.size / truth.moments.size));
    if (!(off < best_off)) continue;  // also where it is not a number: a ghost smaller than a pixel has no size
    best_off = off;
    best = &ghost;
  }
  return best;
}

double rms_difference(const Image& a, const Image& b, double peak) {
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < a.pixels.size(); k += 3) {
    const double in_a = static_cast<double>(a.pixels[k] + a.pixels[k + 1] + a.pixels[k + 2]);
    const double in_b = static_cast<double>(b.pixels[k] + b.pixels[k + 1] + b.pixels[k + 2]);
    if (in_a < kCounts * peak) continue;
    sum += (in_a - in_b) * (in_a - in_b);
    ++count;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

void print_ghosts(const std::vector<TrueGhost>& ghosts, const std::vector<FittedGhost>& fitted) {
  std::size_t found = 0;
  const std::size_t count = std::min(ghosts.size(), kBrightest);
  for (std::size_t k = 0; k < count; ++k) {
    const GhostMoments& truth = ghosts[k].moments;
    std::printf("  %2d-%-2d peak %8.2e speed %8.4f size %6.2f px", ghosts[k].ghost.i, ghosts[k].ghost.j, truth.peak,
                truth.speed, truth.size);
    if (const FittedGhost* match = match_of(ghosts[k], fitted)) {
      const GhostMoments& fit = match->moments;
      std::printf("   speed %+6.2f %%  size %+6.2f %%  flux %+6.1f %%  NRMSE %4.1f %%",
                  100.0 * (fit.speed / truth.speed - 1.0), 100.0 * (fit.size / truth.size - 1.0),
                  100.0 * (fit.flux / truth.flux - 1.0),
                  100.0 * rms_difference(ghosts[k].picture, match->picture, truth.peak) / truth.peak);
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
  const Result<SweepGeometry> geometry =
      fit_geometry(capture->lights, expected_centre(capture->settings.width / 2, capture->settings.height / 2));
  if (!geometry) return 1;
  const double light = capture->settings.light_rate / 4.0;  // over pixels of half the raw size
  FlareSweep sweep;
  for (const double angle : capture->settings.angles_deg) sweep.angles_rad.push_back(angle * 0.017453292519943295);
  sweep.light = {light, light, light};
  sweep.direct = capture->direct;
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
      "%s, %d stations, %d px: %.0f s, %zu ghosts, %.0f image evaluations, NRMSE %.3f, held out %.3f, centre off by "
      "%.2f, %.2f px"
      " (from the light alone %.2f)\n",
      name.c_str(), stations, capture->pictures[0].rate.width, seconds_now() - start, fit->flare.ghosts.size(),
      fit->image_evaluations, fit->nrmse, fit->held_out_nrmse, fit->centre_px.x - centre.x, fit->centre_px.y - centre.y,
      geometry->centre_px.x - centre.x);
  const Image& first = capture->pictures[0].rate;
  const Comparison at = comparison_of(lens, first.width, first.height, fit->flare.s_max);
  print_ghosts(true_ghosts(lens, at), fitted_ghosts(fit->flare, at));
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
