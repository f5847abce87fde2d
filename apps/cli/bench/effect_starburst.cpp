// SPDX-License-Identifier: Apache-2.0
// The cost of starbursts: of computing and drawing that of a new iris or new dirt, and of drawing a kept one again.
#include <algorithm>

#include <fmt/format.h>

#include "cli/bench/effects.h"
#include "contrejour/expert/lens_starburst.h"

namespace contrejour::cli {
namespace {

constexpr int kBands = 120;  // the same as renderers use
constexpr double kDust = 20.0, kScratches = 5.0;  // per cm^2: a dusty, worn filter
constexpr double kMaxNew_ms = 150.0, kMaxKept_ms = 5.0;  // on two cores

struct StarburstTimer {
  const EffectScene& scene;
  Frame frame = scene.render.frame;
  Vec3 direction = scene.lights.front().direction;
  Vec2 centre_px =
      frame.pixel_from_sensor(chief_ray_image_point(scene.lens, direction, scene.lens.design_wavelength_nm));
  std::vector<SpectralBand> bands = spectral_bands(kBands, scene.lights.front().spectrum, ColourSpace::Rec709);
  Image image{frame.width, frame.height};

  [[nodiscard]] Result<Starburst> make(const LensState& lens) const {
    const Vec2 farthest{std::max(centre_px.x, frame.width - centre_px.x),
                        std::max(centre_px.y, frame.height - centre_px.y)};
    return lens_starburst(lens, direction, bands, {frame.pixel_pitch_mm, 1.0 + length(farthest)}, scene.context);
  }
  Result<void> draw_new(const LensState& lens) {
    const auto starburst = make(lens);
    if (!starburst) return tl::unexpected(starburst.error());
    add_starburst(image, *starburst, centre_px, {1.0, 1.0, 1.0}, scene.context);
    return {};
  }
  Result<double> draw_kept_ms() {
    const auto starburst = make(scene.lens);
    if (!starburst) return tl::unexpected(starburst.error());
    const auto sheet = lay_out(*starburst, frame.width, frame.height, scene.context);
    if (!sheet) return tl::unexpected(sheet.error());
    return fastest_ms(scene.runs, [&]() -> Result<void> {
      add_starburst(image, *sheet, centre_px, {1.0, 1.0, 1.0}, scene.context);
      return {};
    });
  }
};

}  // namespace

Result<std::vector<Target>> measure_starbursts(const EffectScene& scene) {
  StarburstTimer timer{scene};
  EffectScene dirty = scene;
  dirty.settings.dirt.dust_per_cm2 = kDust;
  dirty.settings.dirt.scratches_per_cm2 = kScratches;
  const auto dirty_lens = configure_lens(dirty.prescription, dirty.settings);
  if (!dirty_lens) return tl::unexpected(dirty_lens.error());
  const auto clean_ms = fastest_ms(scene.runs, [&] { return timer.draw_new(scene.lens); });
  if (!clean_ms) return tl::unexpected(clean_ms.error());
  const auto dirty_ms = fastest_ms(scene.runs, [&] { return timer.draw_new(*dirty_lens); });
  if (!dirty_ms) return tl::unexpected(dirty_ms.error());
  const auto kept_ms = timer.draw_kept_ms();
  if (!kept_ms) return tl::unexpected(kept_ms.error());

  const auto row = [&](const char* name, double ms, double must, std::string note) {
    return Target{.name = name,
                  .system = scene.lens.name,
                  .value = ms,
                  .must = must,
                  .aim = must,
                  .unit = "ms",
                  .note = std::move(note)};
  };
  const std::string size = fmt::format("{}x{}", scene.render.frame.width, scene.render.frame.height);
  return std::vector<Target>{row("starburst of a new iris", *clean_ms, kMaxNew_ms, size),
                             row("starburst of new dirt", *dirty_ms, kMaxNew_ms,
                                 fmt::format("{:g} specks, {:g} scratches per cm^2; {:.2f} times a new iris", kDust,
                                             kScratches, *dirty_ms / *clean_ms)),
                             row("kept starburst, a frame", *kept_ms, kMaxKept_ms, size)};
}

}  // namespace contrejour::cli
