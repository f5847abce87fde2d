// SPDX-License-Identifier: Apache-2.0
#include "render/session/render_frame.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/tasks.h"
#include "contrejour/expert/check_lens.h"
#include "render/area_lights/area_render.h"
#include "render/device/check_target.h"
#include "render/device/kept_device.h"
#include "render/planning/frame_memory.h"
#include "render/planning/statistics.h"
#include "render/session/registry.h"
#include "render/starburst/starburst_pass.h"

namespace contrejour::inline internal {
namespace {

constexpr double kGhostsFraction = 0.9;  // of the progress; the rest is for the lights' own images

// A context that maps its progress to the part of the whole from one fraction to another.
Context part_of(const Context& whole, double from, double to) {
  Context part = whole;
  if (whole.progress) part.progress = [&whole, from, to](double done) { whole.progress(from + (to - from) * done); };
  return part;
}

bool has_points_only(std::span<const Light> lights) {
  return std::ranges::all_of(lights, [](const Light& light) { return light.is_point(); });
}

Result<GhostImages> render_ghosts(const DrawPlan& draw, const FrameRequest& frame, const Context& context) {
  return (has_points_only(frame.lights) ? render_planned : render_areas)(draw, frame, context);
}

bool adds_lights(const FrameSettings& settings) { return settings.starburst.on || settings.glare.fraction != 0.0; }

std::span<const Light> imaged_lights(const FrameRequest& frame) {
  const auto& own = frame.settings.starburst.lights;
  return own ? std::span<const Light>(*own) : frame.lights;
}

// The frame with the lights that have images of their own.
FrameRequest with_imaged_lights(const FrameRequest& frame) {
  return {frame.lens, imaged_lights(frame), frame.settings, frame.cache, frame.layers};
}

// Whether a device may add starbursts to the ghosts: it draws the whole picture at once, and nothing is taken off them.
bool may_place_starbursts(const FrameRequest& frame) {
  const auto kept = frame.cache.find<KeptDevice>();
  const StarburstOptions& starburst = frame.settings.starburst;
  return kept && kept->device && starburst.on && !starburst.left_out && has_points_only(frame.lights);
}

// Gives the device the starbursts of points. Returns the time that their patterns took.
Result<double> place_on_device(const FrameRequest& frame, const Context& context) {
  const auto start = Clock::now();
  auto placed = place_starbursts(with_imaged_lights(frame), context);
  if (!placed) return tl::unexpected(placed.error());
  frame.cache.section<KeptDevice>({})->starbursts = *std::move(placed);
  return ms_since(start);
}

// Whether nothing is left for the CPU to add to a picture that the device draws, if it can place these starbursts.
bool is_whole_on_device(const FrameRequest& frame, std::span<const PlacedStarburst> placed) {
  const FrameSettings& settings = frame.settings;
  if (!has_points_only(frame.lights) || settings.glare.fraction != 0.0) return false;
  return !settings.starburst.on || (!placed.empty() && has_points_only(imaged_lights(frame)));
}

Result<Flare> render_whole(const DrawPlan& draw, const FrameRequest& frame, const Context& context) {
  const bool adds = adds_lights(frame.settings), places = may_place_starbursts(frame);
  Result<double> placing_ms = 0.0;
  if (places) placing_ms = place_on_device(frame, context);
  if (!placing_ms) return tl::unexpected(placing_ms.error());
  KeptDevice& kept = *frame.cache.section<KeptDevice>({});
  if (kept.use == PictureUse::Kept && !is_whole_on_device(frame, kept.starbursts)) kept.use = PictureUse::Read;
  auto ghosts = render_ghosts(draw, frame, adds ? part_of(context, 0.0, kGhostsFraction) : context);
  kept.starbursts.clear();
  if (!ghosts) return tl::unexpected(ghosts.error());
  Flare flare{std::move(ghosts->image), std::move(ghosts->statistics)};
  if (places) count_last(flare.statistics, "starburst patterns", *placing_ms);
  if (!adds) return flare;
  const auto added =
      add_light_images(flare.image, flare.statistics, {with_imaged_lights(frame), kept.has_added_starbursts},
                       part_of(context, kGhostsFraction, 1.0));
  if (!added) return tl::unexpected(added.error());
  return flare;
}

// The layer of each light with an image of its own: that of the light in the nearest direction, since bright areas of a
// photograph may be divided into more lights for their images than for their ghosts.
std::vector<std::size_t> layers_of_images(const LayerMap& map, const FrameRequest& frame) {
  const std::span<const Light> imaged = imaged_lights(frame);
  std::vector<std::size_t> layers(imaged.size());
  for (std::size_t k = 0; k < imaged.size(); ++k) {
    const auto away = [&](const Light& light) { return length(light.direction - imaged[k].direction); };
    const auto nearest = std::ranges::min_element(frame.lights, {}, away);
    const bool is_same = !frame.settings.starburst.lights;
    layers[k] = map.of_light(is_same ? k : static_cast<std::size_t>(std::distance(frame.lights.begin(), nearest)));
  }
  return layers;
}

void add(FlareLayer& layer, Image image) {
  if (image.pixels.empty()) return;
  const FlareLayer ghosts = std::exchange(layer, {layer.name, std::move(image), 0, 0});
  for (int y = 0; y < ghosts.image.height; ++y)
    for (std::size_t k = 0; k < ghosts.image.row(y).size(); ++k)
      layer.image.row(ghosts.top + y)[3 * static_cast<std::size_t>(ghosts.left) + k] += ghosts.image.row(y)[k];
}

Result<void> add_lights_to(LayeredFlare& flare, const LayerMap& map, const FrameRequest& frame,
                           const Context& context) {
  const std::vector<std::size_t> by_light =
      map.is_by_light() ? layers_of_images(map, frame) : std::vector<std::size_t>();
  auto images = draw_light_images(flare.statistics, with_imaged_lights(frame), by_light, context);
  if (!images) return tl::unexpected(images.error());
  if (map.is_by_light()) {
    for (std::size_t k = 0; k < images->starburst.size(); ++k) add(flare.layers[k], std::move(images->starburst[k]));
    return {};
  }
  if (frame.settings.starburst.on) flare.layers.push_back({"starburst", std::move(images->starburst.front()), 0, 0});
  if (frame.settings.glare.fraction > 0.0) flare.layers.push_back({"glare", std::move(images->glare.front()), 0, 0});
  return {};
}

Image sum_of(std::span<const FlareLayer> layers, const FrameRequest& request, const Context& context) {
  const Frame& frame = request.settings.frame;
  Image sum = unwritten_image(request.cache, frame.width, frame.height);
  parallel_for(static_cast<std::size_t>(frame.height), context, [&](std::size_t row) {
    const auto to = sum.row(static_cast<int>(row));
    std::ranges::fill(to, 0.0F);
    for (const FlareLayer& layer : layers) {
      const int y = static_cast<int>(row) - layer.top;
      if (y < 0 || y >= layer.image.height) continue;
      const auto from = layer.image.row(y);
      for (std::size_t k = 0; k < from.size(); ++k) to[3 * static_cast<std::size_t>(layer.left) + k] += from[k];
    }
  });
  return sum;
}

Result<LayeredFlare> draw_layers(const DrawPlan& draw, const FrameRequest& frame, const Context& context) {
  const bool adds = adds_lights(frame.settings);
  auto ghosts = render_ghosts(draw, frame, adds ? part_of(context, 0.0, kGhostsFraction) : context);
  if (!ghosts) return tl::unexpected(ghosts.error());
  LayeredFlare flare;
  flare.statistics = std::move(ghosts->statistics);
  const LayerMap& map = *ghosts->layer_map;
  for (std::size_t k = 0; k < map.count(); ++k) {
    DrawnImage& drawn = ghosts->layers[k];
    flare.layers.push_back({map.names()[k], std::move(drawn.image), drawn.left, drawn.top});
  }
  if (adds)
    if (const auto ok = add_lights_to(flare, map, frame, part_of(context, kGhostsFraction, 1.0)); !ok)
      return tl::unexpected(ok.error());
  Context quiet = context;
  quiet.progress = {};
  flare.image = sum_of(flare.layers, frame, quiet);
  return flare;
}

Result<DrawPlan> checked(const MethodOptions& method, const FrameRequest& frame) {
  if (auto good = check_lens(frame.lens); !good) return tl::unexpected(good.error());
  const auto known = known_method(method.name());
  if (!known) return tl::unexpected(known.error());
  if (adds_lights(frame.settings))
    if (const auto good = check_light_images(frame.lights, frame.settings); !good) return tl::unexpected(good.error());
  return DrawPlan([&method, draw = (*known)->draw](const PlannedFrame& planned, const Context& drawing) {
    return draw(planned, method, drawing);
  });
}

// Forgets why the last frame was drawn by the CPU, and what the device added to it.
void begin_on_device(RenderCache& cache) {
  KeptDevice& kept = *cache.section<KeptDevice>({});
  kept.reason.clear();
  kept.has_added_starbursts = false;
  kept.has_kept_picture = false;
}

// Says why the CPU drew a frame although there is a device.
void note_device(RenderStatistics& statistics, const RenderCache& cache) {
  const auto kept = cache.find<KeptDevice>();
  if (!kept || !kept->device || statistics.device != "cpu") return;
  statistics.device += kept->reason.empty() ? fmt::format(" ({} is drawn by the CPU)", statistics.method)
                                            : fmt::format(" ({})", kept->reason);
}

}  // namespace

Result<Flare> render_frame(const MethodOptions& method, const FrameRequest& frame, const Context& context) {
  const auto draw = checked(method, frame);
  if (!draw) return tl::unexpected(draw.error());
  begin_on_device(frame.cache);
  auto flare = render_whole(*draw, frame, context);
  if (context.cancelled()) return interrupted();  // some of its loops may have stopped early
  if (flare) {
    flare->statistics.peak_memory_bytes = peak_memory_bytes();
    note_device(flare->statistics, frame.cache);
  }
  return flare;
}

Result<RenderStatistics> render_frame_to(const MethodOptions& method, const FrameRequest& frame,
                                         const VulkanTarget& target, const Context& context) {
  const Frame& size = frame.settings.frame;
  if (const auto good = check_target(target, size.width, size.height); !good) return tl::unexpected(good.error());
  KeptDevice& kept = *frame.cache.section<KeptDevice>({});
  kept.use = PictureUse::Kept;
  auto flare = render_frame(method, frame, context);
  kept.use = PictureUse::Read;
  if (!flare) return tl::unexpected(flare.error());
  const auto written = kept.device->write(target, kept.has_kept_picture ? nullptr : &flare->image);
  if (!written) return tl::unexpected(written.error());
  for (const auto& [stage, ms] : written->stages_ms) flare->statistics.time_ms.emplace_back("device: " + stage, ms);
  count_last(flare->statistics, "hand over", written->ms);
  return std::move(flare->statistics);
}

Result<LayeredFlare> render_frame_layers(const MethodOptions& method, const FrameRequest& frame,
                                         const Context& context) {
  const auto draw = checked(method, frame);
  if (!draw) return tl::unexpected(draw.error());
  begin_on_device(frame.cache);
  auto flare = draw_layers(*draw, frame, context);
  if (context.cancelled()) return interrupted();
  if (flare) {
    flare->statistics.peak_memory_bytes = peak_memory_bytes();
    note_device(flare->statistics, frame.cache);
  }
  return flare;
}

}  // namespace contrejour::inline internal
