#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/memory.h"
#include "base/tasks.h"
#include "contrejour/check_lens.h"
#include "contrejour/render.h"
#include "contrejour/ringing.h"
#include "render/adaptive/adaptive.h"
#include "render/area/area_render.h"
#include "render/bundle/bundle.h"
#include "render/reference/reference.h"
#include "render/starburst/starburst_pass.h"
#include "render/tiled/tiled.h"

namespace contrejour {
namespace {

struct Method {
  std::string_view name;
  PlannedRenderer draw;
};

// The default first.
constexpr std::array kMethods{Method{"adaptive", render_adaptive}, Method{"bundle", render_bundle},
                              Method{"tiled", render_tiled}, Method{"reference", render_reference}};

constexpr double kGhostsShare = 0.9;  // of the progress, where the lights' own images follow

// The part of a whole's progress from one share to another.
Context part_of(const Context& whole, double from, double to) {
  Context part = whole;
  if (whole.progress) part.progress = [&whole, from, to](double done) { whole.progress(from + (to - from) * done); };
  return part;
}

Result<Flare> render_ghosts(const Method& method, const LensState& lens, std::span<const Light> lights,
                            const RenderSettings& settings, const Context& context) {
  const bool points = std::all_of(lights.begin(), lights.end(), [](const Light& light) { return light.is_point(); });
  return (points ? render_planned : render_areas)(method.draw, lens, lights, settings, context);
}

Result<Flare> render_with_lights(const Method& method, const LensState& lens, std::span<const Light> lights,
                                 const RenderSettings& settings, const Context& context) {
  if (const auto good = check_light_images(lights, settings); !good) return tl::unexpected(good.error());
  auto flare = render_ghosts(method, lens, lights, settings, part_of(context, 0.0, kGhostsShare));
  if (!flare) return flare;
  const auto added = add_light_images(*flare, lens, settings.starburst.lights ? *settings.starburst.lights : lights,
                                      settings, part_of(context, kGhostsShare, 1.0));
  if (!added) return tl::unexpected(added.error());
  return flare;
}

// Pictures of one frame share its ringing patterns, as lights with a size have many.
RenderSettings with_patterns(RenderSettings settings) {
  settings.ringing.patterns = std::make_shared<RingingPatterns>();
  return settings;
}

}  // namespace

std::vector<std::string_view> render_methods() {
  std::vector<std::string_view> names;
  for (const Method& method : kMethods) names.push_back(method.name);
  return names;
}

Result<Flare> render(std::string_view method, const LensState& lens, std::span<const Light> lights,
                     const RenderSettings& settings, const Context& context) {
  if (auto good = check_lens(lens); !good) return tl::unexpected(good.error());
  for (const Method& known : kMethods) {
    if (known.name != method) continue;
    if (settings.ringing.mode != RingingMode::None && !settings.ringing.patterns)
      return render(method, lens, lights, with_patterns(settings), context);
    const bool adds_lights = settings.starburst.on || settings.glare.share != 0.0;
    auto flare = (adds_lights ? render_with_lights : render_ghosts)(known, lens, lights, settings, context);
    if (context.cancelled()) return interrupted();  // some of its loops may have stopped early
    if (flare) flare->statistics.peak_memory_bytes = peak_memory_bytes();
    return flare;
  }
  return failure(ErrorCode::InvalidArgument,
                 fmt::format("there is no method '{}'; choose one of {}", method, fmt::join(render_methods(), ", ")));
}

}  // namespace contrejour
