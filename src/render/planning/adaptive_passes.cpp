// SPDX-License-Identifier: Apache-2.0
#include "render/planning/adaptive_passes.h"

#include <algorithm>
#include <cmath>

#include "base/tasks.h"
#include "contrejour/expert/trace.h"
#include "ghosts/light_frame.h"
#include "optics/trace/by_wavelength.h"
#include "render/pupils/kept_pupils.h"
#include "render/radiometry/wavelength_samples.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kMinBands = 3;      // at least this many bands
constexpr std::size_t kRayWavelengths = 7;     // wavelengths at which rays are traced
constexpr int kSide = 9;                // rays a side
// Slopes of fewer rays, or of rays that lie nearly on a line, would be arbitrary across it.
constexpr std::size_t kFewestRays = 6;
constexpr double kLeastSpread = 1e-3;  // of the determinant over that of independent x and y
constexpr float kNearlyThrough = 0.2F;  // the largest RayGrid::blocked of rays that count

// A ghost's transmittance in every pass and the displacement of its image over the spectrum, estimated from a few rays.
struct GhostSpectrum {
  WavelengthSamples samples;
  std::vector<double> carried;  // the mean transmittance, one for each pass
  std::vector<Vec2> rays_mm;  // the rays that arrive at all traced wavelengths, relative to middle_mm
  std::vector<std::vector<double>> by_ray;  // for each pass, the transmittance of these rays
  Vec2 middle_mm;  // of the pupil
  double shift_mm = 0.0;  // largest shift of a ray's image from first to last pass
};

double mean_transmission(const RayGrid& grid) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < grid.blocked.size(); ++k)
    if (grid.blocked[k] <= kNearlyThrough) sum += grid.transmission[k], ++count;
  return count > 0 ? sum / count : 0.0;
}

// The numbers of the rays that arrive in all grids.
std::vector<std::size_t> common_rays(std::span<const RayGrid> grids) {
  std::vector<std::size_t> common;
  for (std::size_t k = 0; k < grids.front().blocked.size(); ++k)
    if (std::ranges::all_of(grids, [&](const RayGrid& grid) { return grid.blocked[k] <= kNearlyThrough; }))
      common.push_back(k);
  return common;
}

double shift_mm(const RayGrid& a, const RayGrid& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.blocked.size(); ++k) {
    if (!(a.blocked[k] <= kNearlyThrough && b.blocked[k] <= kNearlyThrough)) continue;
    const Vec2 shift{a.sensor_x_mm[k] - b.sensor_x_mm[k], a.sensor_y_mm[k] - b.sensor_y_mm[k]};
    largest = std::max(largest, length(shift));
  }
  return largest;
}

// Traces the rays of one ghost of one light, in the light's meridional frame where there is one.
class GhostProbe {
 public:
  // All arguments must outlive this object.
  GhostProbe(const FramePlan& plan, const StepsByWavelength& steps, const Ghost& ghost, const PlannedLight& light,
             const Context& context)
      : plan_(plan), steps_(steps), ghost_(ghost), light_(light), context_(context),
        frame_(light.source, has_axial_symmetry(steps.lens(), ghost)) {
    for (const PlannedPass& pass : light.passes) lambda_nm_.push_back(pass.lambda_nm);
  }

  // nullopt where nothing gets through.
  [[nodiscard]] std::optional<GhostSpectrum> spectrum() const {
    const EntranceWindow window = LightWindows(steps_.lens(), light_.source).of(frame_.symmetric);
    const std::optional<Rectangle> pupil = this->pupil(window);
    if (!pupil) return std::nullopt;
    GhostSpectrum out{WavelengthSamples(lambda_nm_, kRayWavelengths), std::vector<double>(lambda_nm_.size(), 0.0)};
    std::vector<RayGrid> grids(out.samples.size());
    const LightRays rays{{0.0, 0.0, window.z_mm}, frame_.source};
    for (std::size_t k = 0; k < grids.size(); ++k) {
      PacketPath path(steps_.at(lambda_nm_[out.samples[k]]), ghost_, rays);
      grids[k].trace(path, iris_, *pupil, kSide, PacketPrecision::Double);
    }
    add_rays(grids, *pupil, out);
    if (grids.size() > 1) out.shift_mm = shift_mm(grids[0], grids[1]);
    return out;
  }

 private:
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
      }
    }
    out.by_ray.assign(lambda_nm_.size(), std::vector<double>(out.rays_mm.size(), 0.0));
    for (std::size_t pass = 0; pass < lambda_nm_.size(); ++pass) {
      const std::vector<double> factors = out.samples.factors(grids.size(), pass);
      for (std::size_t k = 0; k < grids.size(); ++k) {
        out.carried[pass] += factors[k] * mean_transmission(grids[k]);
        for (std::size_t at = 0; at < out.rays_mm.size(); ++at)
          out.by_ray[pass][at] += factors[k] * static_cast<double>(grids[k].transmission[common[at % common.size()]]);
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
    sum += own[ray];
    mean = mean + spectrum.rays_mm[ray] * own[ray];
  }
  if (!(sum > 0.0)) return;
  mean = mean * (1.0 / sum);
  for (std::size_t ray = 0; ray < own.size(); ++ray) {
    const Vec2 p = (spectrum.rays_mm[ray] - mean) * own[ray];
    xx += p.x * p.x, xy += p.x * p.y, yy += p.y * p.y;
  }
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > kLeastSpread * xx * yy)) return;
  out.slopes.middle_mm = spectrum.middle_mm + mean;
  for (std::size_t c = 0; c < 3; ++c) {
    double x = 0.0, y = 0.0;
    for (std::size_t ray = 0; ray < own.size(); ++ray) {
      double light = -out.gain[c] * own[ray];
      for (std::size_t k = first; k < last; ++k) light += passes[k].gain[c] * spectrum.by_ray[k][ray];
      const Vec2 p = (spectrum.rays_mm[ray] - mean) * own[ray];
      x += p.x * light, y += p.y * light;
    }
    out.slopes.by_x[c] = (yy * x - xy * y) / determinant;
    out.slopes.by_y[c] = (xx * y - xy * x) / determinant;
  }
}

// One pass, at the middle one, for the passes from `first` to the one before `last`.
PlannedPass joined(std::span<const PlannedPass> passes, const GhostSpectrum& spectrum, std::size_t first,
                   std::size_t last) {
  const std::vector<double>& carried = spectrum.carried;
  std::size_t at = (first + last) / 2;
  for (std::size_t k = first; k < last; ++k)
    if (!(carried[at] > 0.0) && carried[k] > 0.0) at = k;
  PlannedPass out = passes[at];
  double squares = 0.0;
  out.gain = {};
  for (std::size_t k = first; k < last; ++k) {
    const double times = carried[at] > 0.0 ? carried[k] / carried[at] : 1.0;
    for (std::size_t c = 0; c < 3; ++c) out.gain[c] += times * passes[k].gain[c];
    squares += std::pow(passes[k].lambda_nm - out.lambda_nm, 2.0) + passes[k].spread_nm * passes[k].spread_nm;
  }
  out.spread_nm = std::sqrt(squares / static_cast<double>(last - first));
  if (last - first > 1) set_slopes(passes, spectrum, at, first, last, out);
  return out;
}

// Appends the bands that the passes from `first` to the one before `last` are joined to.
void add_bands(std::span<const PlannedPass> passes, const GhostSpectrum& spectrum, double max_spread_mm,
               std::size_t first, std::size_t last, std::vector<PlannedPass>& out) {
  const auto& samples = spectrum.samples;
  const double wide_mm = 0.5 * spectrum.shift_mm * std::abs(samples.position(last - 1) - samples.position(first));
  if (last - first == 1 || wide_mm <= max_spread_mm) return out.push_back(joined(passes, spectrum, first, last));
  const std::size_t middle = (first + last) / 2;
  add_bands(passes, spectrum, max_spread_mm, first, middle, out);
  add_bands(passes, spectrum, max_spread_mm, middle, last, out);
}

std::vector<PlannedPass> passes_for(std::span<const PlannedPass> passes, const GhostSpectrum& spectrum,
                                    double max_spread_mm) {
  std::vector<PlannedPass> out;
  const std::size_t thirds = std::min(kMinBands, passes.size());
  for (std::size_t k = 0; k < thirds; ++k)
    add_bands(passes, spectrum, max_spread_mm, k * passes.size() / thirds, (k + 1) * passes.size() / thirds, out);
  return out;
}

}  // namespace

std::optional<FramePlan> with_adaptive_passes(const FramePlan& plan, const LensState& lens, const Frame& frame,
                                              const Context& context, double max_spread_px) {
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
    const auto spectrum = GhostProbe(plan, steps, plan.ghosts[pairs[k].ghost], light, quiet).spectrum();
    if (spectrum) out.passes[k] = passes_for(light.passes, *spectrum, max_spread_px * frame.pixel_pitch_mm);
  });
  return done ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace contrejour::inline internal
