// SPDX-License-Identifier: Apache-2.0
// Flares fitted to simulated captures of lenses whose prescriptions say what is right: a program of its own.
//   flare_fit [LENS, or all] [STATIONS] [RAW WIDTH] [FOLDER FOR WHAT IS RENDERED] [FOLDER FOR PICTURES, or -] [WIDTH]
//     [lens]
// Pictures have half the raw width, and the fit reduces them to at most the last width. With `lens`, it starts from the
// ghosts of the lens.
// Each ghost by itself, as the exact renderer draws it at one angle, is compared with the fitted ghost by itself: its
// middle over the light's place (speed), its RMS height (size), its flux, and the RMS difference over its bright level.
// `in picture` is the RMS difference of all ghosts together over the ghost's body, over its bright level, but for a
// constant: the light scattered everywhere is in the captured pictures, and the flare's veil has it. Only pixels above
// a part of that level are its body: caustic ghosts have faint skirts far outside what a picture shows. In the picture,
// only pixels of the body that show the ghost count: those of which it has more than half of all light, since under a
// brighter ghost the error is that ghost's. The angle is none of the sweep's, and the truth has no noise. A ghost is
// listed if a picture can show it: its body lies within the frame and beside the light's masked image, stands out of
// the noise, and is not buried under brighter ghosts; of those that coincide the brightest stands for all.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

#include "contrejour/expert/first_order.h"
#include "contrejour/expert/learn_lens.h"
#include "contrejour/image_io.h"
#include "flare_fit_cache.h"

using namespace contrejour;

namespace {

constexpr double kLambda_nm = 550.0;
constexpr double kPart = 0.45;  // of the range: the angle of the comparison
constexpr double kCounts = 0.3;  // of a ghost's bright level: what belongs to its body
constexpr int kStarts = 16;  // ghosts of a known lens, from which a fit may start
constexpr double kSameGhost = 0.15;  // relative differences of speed and size of what counts as found
constexpr double kResolution_px = 0.5;  // the RMS size of a point in a picture: sizes are compared with it
constexpr double kCoincide = 0.03;  // the same of two true ghosts that no picture could tell apart
constexpr double kBuried = 0.1;  // of what the other ghosts have in its body: a dimmer ghost cannot be made out
constexpr double kShows = 0.5;  // of all light: pixels where a ghost has less show another one
constexpr double kNoise = 3.0;  // standard deviations of a dark pixel
constexpr double kMasked = 0.015;  // of the width, about the light
constexpr std::size_t kBrightest = 12, kSought = 10;
constexpr double kMostError = 0.1, kMostSpeed_percent = 0.5, kMostSize_percent = 1.0;

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
  double noise = 0;  // the standard deviation of a dark pixel in units of the light
};

constexpr double kRadians = 0.017453292519943295;

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

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

Comparison comparison_of(const LensState& lens, const SimulatedCapture& capture, double light) {
  const Image& first = capture.pictures.front().rate;
  Comparison at{frame_on_sensor(lens, first.width, first.height), {}, 0.0, 0.0};
  at.s = kPart * std::tan(capture.settings.angles_deg.back() * kRadians);
  const double focal_length_px = first_order(lens, kLambda_nm).focal_length_mm / at.frame.pixel_pitch_mm;
  at.tangents = {first.width, first.height, focal_length_px, {0.5 * first.width, 0.5 * first.height}};
  std::vector<float> variances(capture.pictures.front().variance.pixels.begin(),
                               capture.pictures.front().variance.pixels.end());
  const auto low = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 10);
  std::ranges::nth_element(variances, low);
  at.noise = std::sqrt(3.0 * static_cast<double>(*low)) / light;  // of the sum of three channels
  return at;
}

// How much two ghosts differ in speed and in the size that a picture shows, relative.
double difference_of(const GhostMoments& a, const GhostMoments& b) {
  const auto shown = [](double size) { return std::hypot(size, kResolution_px); };
  return std::hypot((a.speed - b.speed) / std::max(std::abs(b.speed), 0.5), std::log(shown(a.size) / shown(b.size)));
}

bool coincide(const GhostMoments& a, const GhostMoments& b) { return difference_of(a, b) < kCoincide; }

// Whether the other ghosts leave it to be made out.
bool is_buried(const TrueGhost& ghost, const Image& all) {
  double own = 0.0, others = 0.0;
  for (std::size_t k = 0; 3 * k < all.pixels.size(); ++k) {
    const double value = grey_at(ghost.picture, k);
    if (value < kCounts * ghost.moments.peak) continue;
    own += value;
    others += grey_at(all, k) - value;
  }
  return own < kBuried * others;
}

struct TrueGhosts {
  Image all;  // of all, listed or not
  std::vector<TrueGhost> listed;  // the brightest first
};

TrueGhosts true_ghosts(std::vector<DrawnGhost> drawn, const Comparison& at) {
  TrueGhosts ghosts;
  ghosts.all = Image(at.frame.width, at.frame.height);
  std::vector<TrueGhost> candidates;
  for (DrawnGhost& one : drawn) {
    for (std::size_t k = 0; k < one.picture.pixels.size(); ++k) ghosts.all.pixels[k] += one.picture.pixels[k];
    candidates.push_back({one.ghost, std::move(one.picture), {}});
    candidates.back().moments = moments_of(candidates.back().picture, at);
  }
  std::ranges::sort(candidates, std::greater(), [](const TrueGhost& g) { return g.moments.peak; });
  const double light_px = at.s * at.tangents.focal_length_px;
  for (TrueGhost& one : candidates) {
    const GhostMoments& m = one.moments;
    const bool masked = std::abs(m.speed - 1.0) * light_px < std::max(2.0, kMasked * at.frame.width);
    if (m.peak < kNoise * at.noise || masked || !is_within(one.picture, m.peak) || is_buried(one, ghosts.all)) continue;
    const auto same = [&](const TrueGhost& other) { return coincide(other.moments, m); };
    if (std::ranges::none_of(ghosts.listed, same)) ghosts.listed.push_back(std::move(one));
  }
  return ghosts;
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
    const double off = difference_of(ghost.moments, truth.moments);
    if (!(off < best_off)) continue;
    best_off = off;
    best = &ghost;
  }
  return best;
}

// The middle difference of two pictures.
double offset_of(const Image& a, const Image& b) {
  std::vector<double> differences;
  for (std::size_t k = 0; 3 * k < a.pixels.size(); ++k) differences.push_back(grey_at(a, k) - grey_at(b, k));
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::ranges::nth_element(differences, middle);
  return *middle;
}

// The RMS difference of two pictures, less a constant, over the body of a ghost, over its bright level. Only pixels
// that show the ghost count, if it has more than half of `all` anywhere.
double nrmse_of(const Image& a, const Image& b, const TrueGhost& ghost, double offset = 0.0,
                const Image* all = nullptr) {
  struct Sum {
    double squares = 0, count = 0;
  };
  Sum body, shown;
  for (std::size_t k = 0; 3 * k < a.pixels.size(); ++k) {
    const double own = grey_at(ghost.picture, k);
    if (own < kCounts * ghost.moments.peak) continue;
    const double square = std::pow(grey_at(a, k) - grey_at(b, k) - offset, 2);
    body = {body.squares + square, body.count + 1.0};
    if (all && own > kShows * grey_at(*all, k)) shown = {shown.squares + square, shown.count + 1.0};
  }
  const Sum& sum = shown.count > 0.0 ? shown : body;
  return sum.count > 0.0 ? std::sqrt(sum.squares / sum.count) / ghost.moments.peak : 0.0;
}

double percent_off(double fitted, double truth) { return 100.0 * (fitted / truth - 1.0); }

// How many of a lens's brightest ghosts hold each target.
struct GhostScore {
  std::size_t brightest = 0, sought = 0;  // up to 12, up to 10
  std::size_t found = 0, error = 0, speed = 0, size = 0;
};

GhostScore print_ghosts(const TrueGhosts& ghosts, const MeasuredFlare& flare, const Comparison& at) {
  const std::vector<FittedGhost> fitted = fitted_ghosts(flare, at);
  const FlareLight light{{at.s, 0.0}, {1.0, 1.0, 1.0}};
  const auto drawn = render_measured(flare, std::span(&light, 1), at.tangents);
  if (!drawn) {
    std::printf("%s\n", drawn.error().to_string().c_str());
    return {};
  }
  const Image& all = *drawn;
  const double offset = offset_of(ghosts.all, all);
  GhostScore score;
  score.brightest = std::min(ghosts.listed.size(), kBrightest);
  score.sought = std::min(score.brightest, kSought);
  for (std::size_t k = 0; k < score.brightest; ++k) {
    const TrueGhost& ghost = ghosts.listed[k];
    const GhostMoments& truth = ghost.moments;
    const double in_picture = nrmse_of(ghosts.all, all, ghost, offset, &ghosts.all);
    if (in_picture < kMostError) ++score.error;
    std::printf("  %2d-%-2d peak %8.2e speed %8.4f size %6.2f px  in picture %5.1f %%", ghost.ghost.i, ghost.ghost.j,
                truth.peak, truth.speed, truth.size, 100.0 * in_picture);
    if (const FittedGhost* match = match_of(ghost, fitted)) {
      const GhostMoments& fit = match->moments;
      const double speed = percent_off(fit.speed, truth.speed);
      const double size = percent_off(std::hypot(fit.size, kResolution_px), std::hypot(truth.size, kResolution_px));
      std::printf("   speed %+6.2f %%  size %+6.2f %%  flux %+6.1f %%  alone %4.1f %%", speed, size,
                  percent_off(fit.flux, truth.flux), 100.0 * nrmse_of(ghost.picture, match->picture, ghost));
      if (k < kSought) ++score.found;
      if (std::abs(speed) < kMostSpeed_percent) ++score.speed;
      if (std::abs(size) < kMostSize_percent) ++score.size;
    }
    std::printf("\n");
  }
  return score;
}

// Captured, fitted and what is left (red: too dark, blue: too bright), one above the other.
void write_pictures(const FittedFlare& fit, const std::string& folder, const std::string& name) {
  for (const FittedStation& station : fit.stations) {
    const Image& captured = station.captured_picture;
    if (captured.pixels.empty()) continue;
    std::vector<float> sorted(captured.pixels.begin(), captured.pixels.end());
    std::ranges::sort(sorted);
    const float bright = sorted[sorted.size() * 995 / 1000];
    Image sheet(captured.width, 3 * captured.height);
    const std::size_t size = captured.pixels.size();
    for (std::size_t k = 0; k < size; ++k) {
      const float a = captured.pixels[k] / bright, b = station.fitted_picture.pixels[k] / bright;
      sheet.pixels[k] = std::max(a, 0.0F);
      sheet.pixels[size + k] = std::max(b, 0.0F);
      if (k % 3 == 1) continue;
      const float left =
          captured.pixels[k / 3 * 3 + 1] / bright - station.fitted_picture.pixels[k / 3 * 3 + 1] / bright;
      sheet.pixels[2 * size + k] = std::max(k % 3 == 0 ? left : -left, 0.0F);
    }
    const std::string file = folder + "/" + name + "-" + std::to_string(station.station) + ".png";
    if (!write_preview_png(file, sheet)) std::printf("  %s could not be written\n", file.c_str());
  }
}

FlareSweep sweep_of(const SimulatedCapture& capture, double light) {
  FlareSweep sweep;
  for (const double angle : capture.settings.angles_deg) sweep.angles_rad.push_back(angle * kRadians);
  sweep.light = {light, light, light};
  sweep.direct = capture.direct;
  sweep.picture = [&capture](std::size_t k) -> Result<CapturedImage> { return capture.pictures[k]; };
  return sweep;
}

// The RMS relative error of the flux by angle.
double flux_error(const FittedFlare& fit) {
  double sum = 0.0;
  for (const FittedStation& station : fit.stations) sum += std::pow(station.fitted / station.captured - 1.0, 2);
  return std::sqrt(sum / static_cast<double>(fit.stations.size()));
}

// The flux of each station, captured and fitted, as the name of a table to be written.
void write_fluxes(const FittedFlare& fit, const std::string& file) {
  std::ofstream out(file);
  out << "station,s,held_out,captured,fitted,nrmse\n";
  for (const FittedStation& k : fit.stations) {
    out << k.station << ',' << k.s << ',' << k.held_out << ',' << k.captured << ',' << k.fitted << ',' << k.nrmse
        << '\n';
  }
}

struct Run {
  int stations = 61, raw_width = 1280;
  int width = FlareFitOptions{}.max_width;
  std::string kept, pictures;  // folders; empty: none
  bool from_lens = false;  // the fit starts from the ghosts of the lens
};

int run(const std::string& name, const Run& settings) {
  const Result<Prescription> prescription = find_lens(name);
  if (!prescription) return 1;
  const LensState lens = *configure_lens(*prescription, {});
  const std::string kept = settings.kept.empty()
                               ? ""
                               : settings.kept + "/" + name + "-" + std::to_string(settings.stations) + "-" +
                                     std::to_string(settings.raw_width);
  const Result<SimulatedCapture> capture = simulated_capture(lens, settings.stations, settings.raw_width, kept);
  if (!capture) {
    std::printf("%s: %s\n", name.c_str(), capture.error().to_string().c_str());
    return 1;
  }
  const SweepSettings& taken = capture->settings;
  const Result<SweepGeometry> geometry =
      fit_geometry(capture->lights, expected_centre(taken.width / 2, taken.height / 2));
  if (!geometry) return 1;
  const double light = taken.light_rate / 4.0;  // over pixels of half the raw size
  const double start = seconds_now(), processor_start = processor_seconds();
  FlareFitOptions options;
  options.max_width = settings.width;
  options.pictures = settings.pictures.empty() ? 0 : 8;
  if (settings.from_lens) {
    const auto starts = discs_of_lens(lens, taken.angles_deg.back() * kRadians, kStarts);
    if (!starts) return 1;
    options.starts = *starts;
  }
  const Result<FittedFlare> fit = fit_flare(sweep_of(*capture, light), *geometry, options);
  if (!fit) {
    std::printf("%s: %s\n", name.c_str(), fit.error().to_string().c_str());
    return 1;
  }
  const Vec2 centre = Vec2{0.25 * taken.width, 0.25 * taken.height} + taken.centre_offset_px * 0.5;
  const double processor = processor_seconds() - processor_start, wall = seconds_now() - start;
  std::printf("%s, %d stations, %d px: %zu ghosts, %.0f image evaluations, NRMSE %.3f\n", name.c_str(),
              settings.stations, capture->pictures[0].rate.width, fit->flare.ghosts.size(), fit->image_evaluations,
              fit->nrmse);
  if (!settings.pictures.empty()) {
    write_pictures(*fit, settings.pictures, name);
    write_fluxes(*fit, settings.pictures + "/" + name + "-flux.csv");
    MeasuredFlare named = fit->flare;
    named.name = name;
    std::ofstream(settings.pictures + "/" + name + ".flare.toml") << write_flare(named);
  }
  const Comparison at = comparison_of(lens, *capture, light);
  const GhostScore score = print_ghosts(true_ghosts(drawn_ghosts(lens, at.frame, at.s, kept), at), fit->flare, at);
  std::printf("| %-12s | %5.1f %% | %5.2f %% | %zu of %zu | %zu of %zu | %zu, %zu | %.2f, %.2f | %.0f | %.0f |\n",
              name.c_str(), 100.0 * fit->held_out_nrmse, 100.0 * flux_error(*fit), score.found, score.sought,
              score.error, score.brightest, score.speed, score.size, fit->centre_px.x - centre.x,
              fit->centre_px.y - centre.y, processor, wall);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Run settings;
  if (argc > 2) settings.stations = std::stoi(argv[2]);
  if (argc > 3) settings.raw_width = std::stoi(argv[3]);
  if (argc > 4) settings.kept = argv[4];
  if (argc > 5 && std::string(argv[5]) != "-") settings.pictures = argv[5];
  if (argc > 6) settings.width = std::stoi(argv[6]);
  if (argc > 7) settings.from_lens = std::string(argv[7]) == "lens";
  if (argc > 1 && std::string(argv[1]) != "all") return run(argv[1], settings);
  std::printf("| Lens | Held out | Flux | Found | Error below 10 %% | Speed, size | Centre, px | CPU s | s |\n");
  int failed = 0;
  for (const char* lens : {"heliar", "tessar", "planar-50", "distagon-25", "nikon-80-200"})
    failed += run(lens, settings);
  return failed;
}
