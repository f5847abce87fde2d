// SPDX-License-Identifier: Apache-2.0
#include "render/planning/adaptive_passes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/tasks.h"
#include "contrejour/expert/trace.h"
#include "ghosts/light_frame.h"
#include "optics/trace/by_wavelength.h"
#include "render/pupils/kept_pupils.h"
#include "render/pupils/open_halves.h"
#include "render/radiometry/wavelength_samples.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kMinBands = 3;      // at least this many bands
// Wavelengths at which rays are traced: until two of them one after the other were predicted by those before, since
// coatings of several layers reflect unevenly.
constexpr std::size_t kFewestWavelengths = 6, kMostWavelengths = 21;
constexpr double kPredictedWithin = 0.005;  // of the largest mean transmittance
constexpr int kSide = 9;                // rays a side
// Slopes of fewer rays, or of rays that lie nearly on a line, would be arbitrary across it.
constexpr std::size_t kFewestRays = 6;
constexpr double kLeastSpread = 1e-3;  // of the determinant over that of independent x and y
constexpr float kNearlyThrough = 0.2F;  // the largest RayGrid::blocked of rays that count

// A ghost's transmittance in every pass and the displacement of its image over the spectrum, estimated from a few rays.
struct GhostSpectrum {
  WavelengthSamples samples;
  std::vector<double> carried;  // the light that is seen, one for each pass, relative to each other
  std::vector<Vec2> rays_mm;  // the rays that arrive at all traced wavelengths, relative to middle_mm
  std::vector<double> seen;  // how much each of these rays counts
  std::vector<std::vector<double>> by_ray;  // for each pass, the transmittance of these rays
  Vec2 middle_mm;  // of the pupil
  double shift_mm = 0.0;  // largest shift of a ray's image from first to last pass
  double image_mm = 0.0;  // size of the image at one of them: twice the standard deviation of its light
};

// How much light counts by where it arrives: 1 within the frame, and less with the distance from it, since the light of
// a ghost that is partly outside should be right where it is seen. It changes smoothly as the light moves.
class Seen {
 public:
  Seen(const Frame& frame, const LightFrame& light) : frame_(frame), light_(light) {}

  // A point of the sensor, in the light's frame.
  [[nodiscard]] double at(Vec2 sensor_mm) const {
    constexpr double kFalls = 0.25;  // of the frame's size: the distance at which light counts a quarter
    const Vec2 pixel = frame_.pixel_from_sensor(light_.to_lens_frame(sensor_mm));
    const double x = std::max({-pixel.x, pixel.x - frame_.width, 0.0});
    const double y = std::max({-pixel.y, pixel.y - frame_.height, 0.0});
    const double far = (x * x + y * y) / std::pow(kFalls * std::max(frame_.width, frame_.height), 2.0);
    return 1.0 / std::pow(1.0 + far, 2.0);
  }

 private:
  Frame frame_;
  LightFrame light_;
};

Vec2 sensor_of(const RayGrid& grid, std::size_t ray) { return {grid.sensor_x_mm[ray], grid.sensor_y_mm[ray]}; }

double mean_transmission(const RayGrid& grid, const Seen& seen) {
  double sum = 0.0, weights = 0.0;
  for (std::size_t k = 0; k < grid.blocked.size(); ++k) {
    if (grid.blocked[k] > kNearlyThrough) continue;
    const double weight = seen.at(sensor_of(grid, k));
    sum += weight * grid.transmission[k];
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : 0.0;
}

// The light of some cells of a grid that is seen. Between rays, points of the sensor and transmittances are
// interpolated: the image of a ghost may be so large that few rays arrive in the frame. Its size changes with the
// wavelength.
double seen_light(const RayGrid& grid, std::span<const std::size_t> cells, const Seen& seen) {
  constexpr int kParts = 3;  // of a cell, a side
  double sum = 0.0;
  for (const std::size_t cell : cells) {
    const std::array<std::size_t, 4> corners{cell, cell + 1, cell + kSide, cell + kSide + 1};
    for (int part = 0; part < kParts * kParts; ++part) {
      const double u = (part % kParts + 0.5) / kParts, v = (part / kParts + 0.5) / kParts;
      const std::array weights{(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v};
      Vec2 at;
      double transmission = 0.0;
      for (std::size_t k = 0; k < 4; ++k) {
        at = at + sensor_of(grid, corners[k]) * weights[k];
        transmission += weights[k] * grid.transmission[corners[k]];
      }
      sum += transmission * seen.at(at);
    }
  }
  return sum;
}

// The light through the open part of a pupil that is seen, which also changes with the size of the pupil. Rays far
// beyond its rim do not count, since coatings reflect much more at their angles.
double open_light(const RayGrid& grid, const Seen& seen) {
  double sum = 0.0;
  const auto add = [&](const OpenTriangle& half) {
    double light = 0.0, rays = 0.0;
    for (const std::size_t k : half.vertex) {
      if (grid.blocked[k] > kNearlyThrough) continue;
      light += grid.transmission[k] * seen.at(sensor_of(grid, k));
      rays += 1.0;
    }
    if (rays > 0.0) sum += half.open * light / rays;
  };
  for (int iy = 0; iy < grid.cells(); ++iy)
    for (int ix = 0; ix < grid.cells(); ++ix) for_each_open_half(grid, grid.corners(ix, iy), add);
  return sum;
}

// The first rays of the cells of which all rays arrive in all grids.
std::vector<std::size_t> common_cells(std::span<const std::size_t> common_rays) {
  std::vector<std::size_t> cells;
  const auto arrives = [&](std::size_t ray) { return std::ranges::binary_search(common_rays, ray); };
  for (const std::size_t ray : common_rays)
    if (ray % kSide + 1 < kSide && arrives(ray + 1) && arrives(ray + kSide) && arrives(ray + kSide + 1))
      cells.push_back(ray);
  return cells;
}

// The numbers of the rays that arrive in all grids.
std::vector<std::size_t> common_rays(std::span<const RayGrid> grids) {
  std::vector<std::size_t> common;
  for (std::size_t k = 0; k < grids.front().blocked.size(); ++k)
    if (std::ranges::all_of(grids, [&](const RayGrid& grid) { return grid.blocked[k] <= kNearlyThrough; }))
      common.push_back(k);
  return common;
}

// The largest distance between a ray's images in two grids, of the rays that arrive in both. Where none does, since the
// pupil moves as well, it is of those that arrive in one and do not fail in the other.
double shift_mm(const RayGrid& a, const RayGrid& b) {
  double in_both = 0.0, in_one = 0.0;
  for (std::size_t k = 0; k < a.blocked.size(); ++k) {
    const auto [least, most] = std::minmax(a.blocked[k], b.blocked[k]);
    if (!(least <= kNearlyThrough && std::isfinite(most))) continue;
    const double shift = length(sensor_of(a, k) - sensor_of(b, k));
    double& largest = most <= kNearlyThrough ? in_both : in_one;
    largest = std::max(largest, shift);
  }
  return in_both > 0.0 ? in_both : in_one;
}

// Twice the standard deviation of the light of a grid's rays on the sensor; infinite where none arrives.
double image_mm(const RayGrid& grid) {
  double sum = 0.0;
  Vec2 mean;
  const auto for_each_ray = [&](const auto& visit) {
    for (std::size_t k = 0; k < grid.blocked.size(); ++k)
      if (grid.blocked[k] <= 0.0F) visit(sensor_of(grid, k), static_cast<double>(grid.transmission[k]));
  };
  for_each_ray([&](Vec2 at, double light) { sum += light, mean = mean + at * light; });
  if (!(sum > 0.0)) return std::numeric_limits<double>::infinity();
  mean = mean * (1.0 / sum);
  double squares = 0.0;
  for_each_ray([&](Vec2 at, double light) { squares += light * dot(at - mean, at - mean); });
  return 2.0 * std::sqrt(squares / sum);
}

// Traces the rays of one ghost of one light, in the light's meridional frame where there is one.
class GhostProbe {
 public:
  // All arguments must outlive this object.
  GhostProbe(const FramePlan& plan, const StepsByWavelength& steps, GhostOfLight pair, const Frame& frame,
             const Context& context)
      : plan_(plan), steps_(steps), ghost_(plan.ghosts[pair.ghost]), light_(plan.lights[pair.light]), context_(context),
        frame_(light_.source, has_axial_symmetry(steps.lens(), ghost_)),
        seen_(plan.adjustments[pair.ghost].placed(frame), frame_) {
    for (const PlannedPass& pass : light_.passes) lambda_nm_.push_back(pass.lambda_nm);
  }

  // nullopt where nothing gets through.
  [[nodiscard]] std::optional<GhostSpectrum> spectrum() const {
    const EntranceWindow window = LightWindows(steps_.lens(), light_.source).of(frame_.symmetric);
    const std::optional<Rectangle> pupil = this->pupil(window);
    if (!pupil) return std::nullopt;
    GhostSpectrum out{WavelengthSamples(lambda_nm_, kMostWavelengths), std::vector<double>(lambda_nm_.size(), 0.0)};
    const std::vector<RayGrid> grids = trace(window.z_mm, *pupil, out.samples);
    add_rays(grids, *pupil, out);
    if (grids.size() > 1) out.shift_mm = shift_mm(grids[0], grids[1]);
    out.image_mm = std::numeric_limits<double>::infinity();
    for (const RayGrid& grid : grids) out.image_mm = std::min(out.image_mm, image_mm(grid));
    return out;
  }

 private:
  [[nodiscard]] std::vector<RayGrid> trace(double z_mm, const Rectangle& pupil,
                                           const WavelengthSamples& samples) const {
    const LightRays rays{{0.0, 0.0, z_mm}, frame_.source};
    std::vector<RayGrid> grids;
    std::vector<double> means;
    double largest = 0.0;
    for (int predicted = 0; grids.size() < samples.size() && predicted < 2;) {
      const std::size_t traced = grids.size(), pass = samples[traced];
      PacketPath path(steps_.at(lambda_nm_[pass]), ghost_, rays);
      grids.emplace_back().trace(path, iris_, pupil, kSide, PacketPrecision::Double);
      means.push_back(mean_transmission(grids.back(), seen_));
      largest = std::max(largest, means.back());
      if (traced < kFewestWavelengths) continue;
      const std::vector<double> factors = samples.factors(traced, pass);
      const double expected = std::inner_product(factors.begin(), factors.end(), means.begin(), 0.0);
      predicted = std::abs(expected - means.back()) <= kPredictedWithin * largest ? predicted + 1 : 0;
    }
    return grids;
  }

  // The largest box of the pupil.
  [[nodiscard]] std::optional<Rectangle> pupil(const EntranceWindow& window) const {
    const auto boxes =
        plan_.kept_pupils->find_ghost_pupil({steps_, ghost_, light_.source, window, lambda_nm_, 1.0, &context_}).boxes;
    const auto area = [](const Rectangle& box) { return (box.high.x - box.low.x) * (box.high.y - box.low.y); };
    const auto largest = std::ranges::max_element(boxes, {}, area);
    return largest == boxes.end() ? std::nullopt : std::optional(*largest);
  }

  void add_rays(std::span<const RayGrid> grids, const Rectangle& pupil, GhostSpectrum& out) const {
    const std::vector<std::size_t> common = common_rays(grids);
    const Vec2 step = grids.front().step_mm();
    const bool has_mirror_image = frame_.symmetric && (pupil.low.y > 0.0 || pupil.high.y < 0.0);
    const Vec2 middle =
        has_mirror_image ? Vec2{0.5 * (pupil.low.x + pupil.high.x), 0.0} : (pupil.low + pupil.high) * 0.5;
    out.middle_mm = frame_.to_lens_frame(middle);
    for (const double mirror : {1.0, -1.0}) {
      if (mirror < 0.0 && !has_mirror_image) continue;
      for (const std::size_t ray : common) {
        const Vec2 steps{static_cast<double>(ray % kSide), static_cast<double>(ray / kSide)};
        const Vec2 at = pupil.low + Vec2{steps.x * step.x, steps.y * step.y};
        out.rays_mm.push_back(frame_.to_lens_frame(Vec2{at.x, mirror * at.y} - middle));
        const Vec2 sensor_mm = sensor_of(grids.front(), ray);
        out.seen.push_back(seen_.at({sensor_mm.x, mirror * sensor_mm.y}));
      }
    }
    out.by_ray.assign(lambda_nm_.size(), std::vector<double>(out.rays_mm.size(), 0.0));
    const std::vector<std::size_t> cells = common_cells(common);
    // Light through the rays in common, and the whole pupil's relative to it.
    std::vector<double> light, whole;
    for (const RayGrid& grid : grids) {
      light.push_back(cells.empty() ? mean_transmission(grid, seen_) : seen_light(grid, cells, seen_));
      whole.push_back(light.back() > 0.0 ? open_light(grid, seen_) / light.back() : 0.0);
    }
    for (std::size_t pass = 0; pass < lambda_nm_.size(); ++pass) {
      const std::vector<double> factors = out.samples.factors(grids.size(), pass);
      const std::vector<double> weights = out.samples.linear_weights(grids.size(), pass);
      const double part = std::inner_product(weights.begin(), weights.end(), whole.begin(), 0.0);
      for (std::size_t k = 0; k < grids.size(); ++k) {
        out.carried[pass] += part * factors[k] * light[k];
        for (std::size_t at = 0; at < out.rays_mm.size(); ++at)
          out.by_ray[pass][at] +=
              part * factors[k] * static_cast<double>(grids[k].transmission[common[at % common.size()]]);
      }
      out.carried[pass] = std::max(out.carried[pass], 0.0);
    }
  }

  const FramePlan& plan_;
  const StepsByWavelength& steps_;
  const Ghost& ghost_;
  const PlannedLight& light_;
  const Context& context_;
  LightFrame frame_;
  Seen seen_;
  std::vector<double> lambda_nm_;
  IrisShape iris_{Iris{}};
};

// Sets the slopes with which a pass at the wavelength of `at` has about the light of all passes at each ray (least
// squares). They are taken about the mean place of its light, so that its light in all stays that of its gains.
void set_slopes(std::span<const PlannedPass> passes, const GhostSpectrum& spectrum, std::size_t at, std::size_t first,
                std::size_t last, PlannedPass& out) {
  const std::vector<double>& own = spectrum.by_ray[at];
  if (own.size() < kFewestRays) return;
  double xx = 0.0, xy = 0.0, yy = 0.0, sum = 0.0;
  Vec2 mean;
  for (std::size_t ray = 0; ray < own.size(); ++ray) {
    const double light = own[ray] * spectrum.seen[ray];
    sum += light;
    mean = mean + spectrum.rays_mm[ray] * light;
  }
  if (!(sum > 0.0)) return;
  mean = mean * (1.0 / sum);
  for (std::size_t ray = 0; ray < own.size(); ++ray) {
    const Vec2 p = (spectrum.rays_mm[ray] - mean) * own[ray];
    const double seen = spectrum.seen[ray];
    xx += seen * p.x * p.x, xy += seen * p.x * p.y, yy += seen * p.y * p.y;
  }
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > kLeastSpread * xx * yy)) return;
  out.slopes.middle_mm = spectrum.middle_mm + mean;
  for (std::size_t c = 0; c < 3; ++c) {
    double x = 0.0, y = 0.0;
    for (std::size_t ray = 0; ray < own.size(); ++ray) {
      double light = -out.gain[c] * own[ray];
      for (std::size_t k = first; k < last; ++k) light += passes[k].gain[c] * spectrum.by_ray[k][ray];
      const Vec2 p = (spectrum.rays_mm[ray] - mean) * (own[ray] * spectrum.seen[ray]);
      x += p.x * light, y += p.y * light;
    }
    out.slopes.by_x[c] = (yy * x - xy * y) / determinant;
    out.slopes.by_y[c] = (xx * y - xy * x) / determinant;
  }
}

// The difference of a band's light at the rays from that of its passes: the RMS over the channels' largest.
double unevenness(std::span<const PlannedPass> passes, const GhostSpectrum& spectrum, std::size_t first,
                  std::size_t last, std::size_t at, const PlannedPass& band) {
  const Vec2 middle = band.slopes.middle_mm - spectrum.middle_mm;
  double off = 0.0, whole = 0.0;
  for (std::size_t ray = 0; ray < spectrum.rays_mm.size(); ++ray) {
    const Vec2 by = spectrum.rays_mm[ray] - middle;
    double largest = 0.0, differs = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      double light = 0.0;
      for (std::size_t k = first; k < last; ++k) light += passes[k].gain[c] * spectrum.by_ray[k][ray];
      const double gain = band.gain[c] + band.slopes.by_x[c] * by.x + band.slopes.by_y[c] * by.y;
      largest = std::max(largest, std::abs(light));
      differs = std::max(differs, std::abs(gain * spectrum.by_ray[at][ray] - light));
    }
    off += spectrum.seen[ray] * differs * differs;
    whole += spectrum.seen[ray] * largest * largest;
  }
  return whole > 0.0 ? std::sqrt(off / whole) : 0.0;
}

struct Band {
  PlannedPass pass;
  double unevenness = 0.0;
};

// The pass at which to draw the passes from `first` to the one before `last`: the middle one, or the one nearest to it
// that carries at least half of the most light of one, so that the light of none is multiplied by a large number.
std::size_t drawn_pass(std::span<const double> carried, std::size_t first, std::size_t last) {
  const std::size_t middle = (first + last) / 2;
  const double enough = 0.5 * std::ranges::max(carried.subspan(first, last - first));
  if (carried[middle] >= enough) return middle;
  std::size_t at = last;
  for (std::size_t k = first; k < last; ++k) {
    const auto far = [&](std::size_t pass) { return pass > middle ? pass - middle : middle - pass; };
    if (carried[k] >= enough && (at == last || far(k) < far(at))) at = k;
  }
  return at;
}

// One pass for the passes from `first` to the one before `last`.
Band joined(std::span<const PlannedPass> passes, const GhostSpectrum& spectrum, std::size_t first, std::size_t last) {
  const std::vector<double>& carried = spectrum.carried;
  const std::size_t at = drawn_pass(carried, first, last);
  PlannedPass out = passes[at];
  double squares = 0.0;
  out.gain = {};
  for (std::size_t k = first; k < last; ++k) {
    const double times = carried[at] > 0.0 ? carried[k] / carried[at] : 1.0;
    for (std::size_t c = 0; c < 3; ++c) out.gain[c] += times * passes[k].gain[c];
    squares += std::pow(passes[k].lambda_nm - out.lambda_nm, 2.0) + passes[k].spread_nm * passes[k].spread_nm;
  }
  out.spread_nm = std::sqrt(squares / static_cast<double>(last - first));
  if (last - first == 1) return {out};
  set_slopes(passes, spectrum, at, first, last, out);
  return {out, unevenness(passes, spectrum, first, last, at, out)};
}

// Appends the bands that the passes from `first` to the one before `last` are joined to.
void add_bands(std::span<const PlannedPass> passes, const GhostSpectrum& spectrum, const BandLimits& limits,
               double pixel_mm, std::size_t first, std::size_t last, std::vector<PlannedPass>& out) {
  const auto& samples = spectrum.samples;
  const double narrowed = limits.spot_px > 0.0 ? std::min(spectrum.image_mm / (limits.spot_px * pixel_mm), 1.0) : 1.0;
  const double wide_mm = 0.5 * spectrum.shift_mm * std::abs(samples.position(last - 1) - samples.position(first));
  if (last - first == 1 || wide_mm <= narrowed * limits.spread_px * pixel_mm) {
    const Band band = joined(passes, spectrum, first, last);
    if (band.unevenness <= limits.unevenness) return out.push_back(band.pass);
  }
  const std::size_t middle = (first + last) / 2;
  add_bands(passes, spectrum, limits, pixel_mm, first, middle, out);
  add_bands(passes, spectrum, limits, pixel_mm, middle, last, out);
}

std::vector<PlannedPass> passes_for(std::span<const PlannedPass> passes, const GhostSpectrum& spectrum,
                                    const BandLimits& limits, double pixel_mm) {
  std::vector<PlannedPass> out;
  const std::size_t thirds = std::min(kMinBands, passes.size());
  for (std::size_t k = 0; k < thirds; ++k)
    add_bands(passes, spectrum, limits, pixel_mm, k * passes.size() / thirds, (k + 1) * passes.size() / thirds, out);
  return out;
}

}  // namespace

std::optional<FramePlan> with_adaptive_passes(const FramePlan& plan, const LensState& lens, const Frame& frame,
                                              const Context& context, const BandLimits& limits) {
  FramePlan out = plan;
  if (!plan.adapts_passes) return out;
  std::vector<GhostOfLight> pairs;
  for_each_pair(plan, [&](std::size_t g, std::size_t k) { pairs.push_back({g, k}); });
  out.passes.resize(pairs.size());
  Context quiet = context;
  quiet.progress = {};
  const StepsByWavelength steps(lens, plan.tables);
  const bool done = parallel_for(pairs.size(), quiet, [&](std::size_t k) {
    const PlannedLight& light = plan.lights[pairs[k].light];
    if (light.passes.empty()) return;
    const auto spectrum = GhostProbe(plan, steps, pairs[k], frame, quiet).spectrum();
    if (spectrum) out.passes[k] = passes_for(light.passes, *spectrum, limits, frame.pixel_pitch_mm);
  });
  return done ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace contrejour::inline internal
