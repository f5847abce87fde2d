#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/memory.h"
#include "base/tasks.h"
#include "contrejour/check_lens.h"
#include "contrejour/render.h"
#include "contrejour/ringing.h"
#include "render/area/area_render.h"
#include "render/driver/registry.h"
#include "render/starburst/starburst_pass.h"

namespace contrejour {
namespace {

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

Result<Flare> render(std::string_view method, const LensState& lens, std::span<const Light> lights,
                     const RenderSettings& settings, const Context& context) {
  if (auto good = check_lens(lens); !good) return tl::unexpected(good.error());
  const Method* const known = find_method(method);
  if (known == nullptr)
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("there is no method '{}'; choose one of {}", method, fmt::join(render_methods(), ", ")));
  if (settings.ringing.mode != RingingMode::None && !settings.ringing.patterns)
    return render(method, lens, lights, with_patterns(settings), context);
  const bool adds_lights = settings.starburst.on || settings.glare.share != 0.0;
  auto flare = (adds_lights ? render_with_lights : render_ghosts)(*known, lens, lights, settings, context);
  if (context.cancelled()) return interrupted();  // some of its loops may have stopped early
  if (flare) flare->statistics.peak_memory_bytes = peak_memory_bytes();
  return flare;
}

}  // namespace contrejour
