// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/device_items.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "contrejour/expert/trace.h"
#include "ghosts/light_frame.h"
#include "ghosts/ray_grid.h"
#include "optics/trace/by_wavelength.h"
#include "render/adaptive/kept_paths.h"
#include "render/device/device_frame.h"
#include "render/device/kept_device_dirt.h"
#include "render/device/kept_patterns.h"
#include "render/planning/adaptive_passes.h"
#include "render/stop_patterns/stop_transmittances.h"

namespace contrejour::inline internal::adaptive {
namespace {

// How far the images at the two ends of a band may lie apart at the default error; in proportion to its square, since
// the band is drawn as sharp as one wavelength, and the squared error of that grows with the distance.
constexpr double kSpread_px = 0.9, kLeastSpread_px = 0.1;

// How much the light of a band may differ from that of its wavelengths, at the default error, and in proportion to it.
constexpr double kUnevenness = 0.006;
// Images below this size have narrower bands: they are cheap, and may be the brightest pixels of a frame.
constexpr double kSpot_px = 6.0;

BandLimits limits_for(double error) {
  const double times = error / AdaptiveOptions{}.error;
  return {std::clamp(kSpread_px * times * times, kLeastSpread_px, kMaxSpread_px), kUnevenness * times, kSpot_px};
}

struct LayerItems {
  std::vector<DeviceItem> items;
  std::vector<DeviceGroup> groups;
};

// The data that all layers have in common.
struct FrameItems {
  std::vector<double> lambda_nm;  // of all lights, in order
  bool has_axial_symmetry = true;
  std::vector<LightFrame> frames;       // of the windows, by light
  std::vector<EntranceWindow> windows;  // by light
  std::shared_ptr<const DevicePaths> paths;  // by ghost, then by wavelength
  std::vector<DeviceStart> starts;  // by light
  std::vector<LayerItems> layers;
  std::vector<std::shared_ptr<const StopPattern>> patterns;
};

std::vector<double> wavelengths_of(const FramePlan& plan) {
  std::vector<double> all_nm;
  const auto add = [&](std::span<const PlannedPass> passes) {
    for (const PlannedPass& pass : passes) all_nm.push_back(pass.lambda_nm);
  };
  for (const auto& passes : plan.passes) add(passes);
  if (plan.passes.empty())
    for (const PlannedLight& light : plan.lights) add(light.passes);
  std::ranges::sort(all_nm);
  const auto repeated = std::ranges::unique(all_nm);
  all_nm.erase(repeated.begin(), repeated.end());
  return all_nm;
}

DeviceStart start_of(const LensSteps& steps, const Ghost& any, const PlannedLight& light, const LightFrame& frame,
                     const EntranceWindow& window) {
  const Vec2 corner_mm = frame.to_lens_frame(window.min_mm);
  const PacketPath path(steps, any, {{corner_mm.x, corner_mm.y, window.z_mm}, light.source});
  return {path.start(), LightFrame(light.source).to_lens_frame({1.0, 0.0})};
}

// Half-tones within a sharp outline are those of the picture as the iris, which devices have at all crossings.
bool is_picture(const std::shared_ptr<const StopPattern>& pattern) {
  return pattern && pattern->toned() != nullptr && pattern->toned()->edges() == nullptr;
}

// Adds the stop patterns of a ghost and a light; returns the first one's number, kNone without ringing. A wavelength
// whose fringes are not visible has those of the next one, slightly wider.
std::uint32_t add_patterns(const StopTransmittances& stops, const Ghost& ghost, const PlannedLight& light,
                           std::span<const PlannedPass> passes, FrameItems& to) {
  std::vector<std::shared_ptr<const StopPattern>> patterns;
  for (const PlannedPass& pass : passes) {
    patterns.push_back(stops.pattern_of(ghost, pass.lambda_nm, light.source));
    if (is_picture(patterns.back())) patterns.back() = nullptr;
  }
  const auto any = std::find_if(patterns.rbegin(), patterns.rend(), [](const auto& one) { return one != nullptr; });
  if (any == patterns.rend()) return DevicePatterns::kNone;
  auto next = *any;
  for (auto at = patterns.rbegin(); at != patterns.rend(); ++at) {
    if (*at == nullptr) *at = next;
    next = *at;
  }
  const auto first = static_cast<std::uint32_t>(to.patterns.size());
  to.patterns.insert(to.patterns.end(), patterns.begin(), patterns.end());
  return first;
}

// The items of a ghost and a light, at its wavelengths.
void add_group(const FramePlan& plan, const StopTransmittances& stops, GhostOfLight pair,
               std::span<const PlannedPass> passes, FrameItems& to) {
  const AppliedAdjustment& adjustment = plan.adjustments[pair.ghost];
  const EntranceWindow& window = to.windows[pair.light];
  const Vec2 corner_mm = to.frames[pair.light].to_lens_frame(window.min_mm);
  LayerItems& layer = to.layers[plan.layer_of(pair.ghost, pair.light)];
  const auto first = static_cast<std::uint32_t>(layer.items.size());
  const auto count = static_cast<std::uint32_t>(passes.size());
  layer.groups.push_back({first, count, first + count / 2});
  std::uint32_t pattern = add_patterns(stops, plan.ghosts[pair.ghost], plan.lights[pair.light], passes, to);
  for (const PlannedPass& pass : passes) {
    const auto tinted = [&](const Rgb& gain) {
      const Rgb out = adjustment.tinted(gain);
      return std::array{static_cast<float>(out[0]), static_cast<float>(out[1]), static_cast<float>(out[2])};
    };
    const auto at = std::ranges::lower_bound(to.lambda_nm, pass.lambda_nm) - to.lambda_nm.begin();
    layer.items.push_back(
        {.path = static_cast<std::uint32_t>(pair.ghost * to.lambda_nm.size()) + static_cast<std::uint32_t>(at),
         .start = static_cast<std::uint32_t>(pair.light),
         .window_mm = window.max_mm - window.min_mm,
         .irradiance = plan.lights[pair.light].source.shared_flux(),
         .gain = tinted(pass.gain),
         .gain_by_x = tinted(pass.slopes.by_x),
         .gain_by_y = tinted(pass.slopes.by_y),
         .middle_mm = pass.slopes.middle_mm - corner_mm,
         .shift_mm = adjustment.shift_mm,
         .pattern = pattern});
    if (pattern != DevicePatterns::kNone) ++pattern;
  }
}

FrameItems list_items(const PlannedFrame& planned, const FramePlan& plan, const StopTransmittances& stops) {
  FrameItems out;
  out.layers.resize(layer_count(plan));
  if (plan.ghosts.empty() || plan.lights.empty()) return out;
  out.lambda_nm = wavelengths_of(plan);
  if (out.lambda_nm.empty()) return out;
  out.has_axial_symmetry =
      std::ranges::all_of(plan.ghosts, [&](const Ghost& ghost) { return has_axial_symmetry(planned.lens, ghost); });
  for (const PlannedLight& light : plan.lights) {
    out.frames.emplace_back(light.source, out.has_axial_symmetry);
    out.windows.push_back(entrance_window(planned.lens, out.frames.back().source));
  }
  const auto kept =
      planned.cache.section<KeptPaths>({pupils::KeptPupils::key_of(planned.lens), plan.ghosts, out.lambda_nm});
  out.paths = kept->get(planned.lens, plan.tables, out.windows.front().z_mm);
  const StepsByWavelength steps(planned.lens, plan.tables);
  for (std::size_t k = 0; k < plan.lights.size(); ++k)
    out.starts.push_back(
        start_of(steps.at(out.lambda_nm.front()), plan.ghosts.front(), plan.lights[k], out.frames[k], out.windows[k]));
  for_each_pair_with_passes(plan, [&](std::size_t g, std::size_t k, std::span<const PlannedPass> passes) {
    if (!passes.empty()) add_group(plan, stops, {g, k}, passes, out);
  });
  return out;
}

}  // namespace

std::string device_lacks(const PlannedFrame& planned) {
  const RingingMode rings = planned.settings.ringing.mode;
  if (planned.lens.iris.field && rings == RingingMode::Fresnel)
    return "a picture as the iris with Fresnel's fringes is";
  const std::shared_ptr<const DirtField>& dirt = planned.plan.dirt;
  if (dirt && !dirt->has_picture() && rings != RingingMode::None) return "dirt with ringing is";
  return {};
}

Result<DrawnFlare> draw_on_device(KeptDevice& kept, const PlannedFrame& planned, const AdaptiveOptions& options,
                                  const Context& context) {
  const auto start = Clock::now();
  const Frame& frame = planned.settings.frame;
  const auto plan = with_adaptive_passes(planned.plan, planned.lens, frame, context, limits_for(options.error));
  if (!plan) return interrupted();
  StopTransmittances stops(planned.lens, planned.settings, plan->dirt, planned.cache);
  if (!stops.prepare(*plan, context)) return interrupted();
  const FrameItems all = list_items(planned, *plan, stops);
  std::vector<bool> has_light;
  for (const LayerItems& layer : all.layers) has_light.push_back(!layer.items.empty());
  RenderStatistics statistics;
  statistics.method = "adaptive";
  const IrisShape iris(planned.lens.iris);
  const auto patterns = planned.cache.section<KeptPatterns>({})->get(all.patterns, planned.lens.iris);
  const auto dirt = planned.cache.section<KeptDeviceDirt>({})->get(plan->dirt);
  const double front_gap_mm =
      dirt && !all.windows.empty() ? plan->dirt->site().front_z_mm - all.windows.front().z_mm : 0.0;
  return draw_layers(
      *kept.device, {*plan, frame, planned.cache, std::move(statistics), ms_since(start)}, has_light,
      [&](std::size_t layer, Image& image, const Context& drawing) {
        const auto& [items, groups] = all.layers[layer];
        const double error = options.error * std::sqrt(plan->error_fraction);
        return kept.device->draw(
            AdaptiveJob{frame, iris, all.paths, patterns, dirt, front_gap_mm, all.starts, items, groups, error,
                        plan->min_peak, kept.use, kept.starbursts, all.has_axial_symmetry},
            image, drawing);
      },
      context);
}

}  // namespace contrejour::inline internal::adaptive
