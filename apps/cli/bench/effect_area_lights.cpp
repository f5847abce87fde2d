// Lights with a size beside points: the sun where a point is, in the same run.
#include <algorithm>
#include <array>
#include <cstddef>
#include <ctime>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "cli/bench/effects.h"
#include "contrejour/trace.h"

namespace contrejour::cli {
namespace {

constexpr double kMust = 2.0, kAim = 1.5;

// Beside the scene's own lens.
struct AreaSystem {
  const char* lens;
  double focal_length_mm;  // 0: no zoom
  double f_number;
};
constexpr AreaSystem kSystems[] = {{"heliar", 0.0, 16.0}, {"itoh-zoom", 123.0, 32.0}, {"nikon-80-200", 140.0, 16.0}};

constexpr Vec2 kPlace_uv{0.70, 0.33};  // bodonyi2023's light

double processor_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Processor time, of all threads together, which other programs do not take from. In turns, so that what changes while
// they run changes both.
struct Fastest {
  double point_ms = 0.0, sun_ms = 0.0;
};

Result<Fastest> measure(const EffectScene& scene, const LensState& lens, const RenderSettings& settings,
                        const Light& point) {
  Light sun = point;
  sun.radius_rad = kSunRadius_rad;
  const std::array<Light, 2> lights{point, sun};
  std::array<double, 2> ms{};
  ms.fill(std::numeric_limits<double>::infinity());
  for (int k = 0; k < 2 * scene.runs; ++k) {
    const auto which = static_cast<std::size_t>(k % 2);
    const double start = processor_ms();
    const auto flare = render("adaptive", lens, {&lights[which], 1}, settings, scene.context);
    if (!flare) return tl::unexpected(flare.error());
    ms[which] = std::min(ms[which], processor_ms() - start);
  }
  return Fastest{ms[0], ms[1]};
}

Result<Target> row(const EffectScene& scene, const LensState& lens, const RenderSettings& settings,
                   const Light& point) {
  const auto fastest = measure(scene, lens, settings, point);
  if (!fastest) return tl::unexpected(fastest.error());
  return Target{.name = "the sun / a point",
                .system = lens.name,
                .value = fastest->sun_ms / fastest->point_ms,
                .must = kMust,
                .aim = kAim,
                .note = fmt::format("f/{:g}, {:.1f} ms, {:.1f} ms of processor time", lens.f_number, fastest->sun_ms,
                                    fastest->point_ms)};
}

}  // namespace

Result<std::vector<Target>> measure_area_lights(const EffectScene& scene) {
  std::vector<Target> rows;
  auto own = row(scene, scene.lens, scene.render, scene.lights.front());
  if (!own) return tl::unexpected(own.error());
  rows.push_back(std::move(*own));
  for (const AreaSystem& system : kSystems) {
    const auto prescription = find_lens(system.lens);
    if (!prescription) return tl::unexpected(prescription.error());
    LensSettings settings;
    settings.f_number = system.f_number;
    if (system.focal_length_mm > 0.0) settings.focal_length_mm = system.focal_length_mm;
    const auto lens = lens_at(*prescription, settings);
    if (!lens) return tl::unexpected(lens.error());
    RenderSettings render = scene.render;
    render.frame = frame_on_sensor(*lens, scene.render.frame.width, scene.render.frame.height);
    Light point = scene.lights.front();
    point.direction = direction_to_land_at(*lens, render.frame.sensor_from_uv(kPlace_uv), lens->design_wavelength_nm);
    auto one = row(scene, *lens, render, point);
    if (!one) return tl::unexpected(one.error());
    rows.push_back(std::move(*one));
  }
  return rows;
}

}  // namespace contrejour::cli
