#include "render/interface/frame_plan.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "base/tasks.h"
#include "render/interface/ghost_selection.h"

namespace contrejour {
namespace {

constexpr int kMaxWavelengths = 1024;
constexpr double kMaxPixels = 268435456.0;  // 2^28

Error invalid(std::string message) { return {ErrorCode::InvalidArgument, std::move(message), {}}; }

bool is_finite(const Light& light) {
  const Vec3 d = light.direction;
  return std::isfinite(d.x + d.y + d.z) && std::isfinite(light.value[0] + light.value[1] + light.value[2]);
}

std::optional<Error> problem_with(std::span<const Light> lights, const RenderSettings& settings) {
  const Frame& f = settings.frame;
  if (f.width <= 0 || f.height <= 0 || f.full_width <= 0 || f.full_height <= 0) {
    return invalid(fmt::format("a frame of {} x {} pixels has no pixels; give a size of at least 1x1", f.width, f.height));
  }
  if (static_cast<double>(f.width) * f.height > kMaxPixels) {
    return invalid(fmt::format("a frame of {} x {} pixels is too large; 2^28 pixels are the limit", f.width, f.height));
  }
  if (!(f.pixel_pitch_mm > 0.0) || !std::isfinite(f.pixel_pitch_mm)) return invalid("the pixel pitch must be positive");
  if (settings.lambda_nm.empty() && (settings.wavelengths < 1 || settings.wavelengths > kMaxWavelengths)) {
    return invalid(fmt::format("{} wavelengths is out of range; choose 1 to {}", settings.wavelengths, kMaxWavelengths));
  }
  for (std::size_t k = 0; k < lights.size(); ++k) {
    if (!is_finite(lights[k])) return invalid(fmt::format("light {} has a value that is not a finite number", k + 1));
    if (!(lights[k].direction.z > 0.0)) return invalid(fmt::format("light {} is beside or behind the camera", k + 1));
  }
  return std::nullopt;
}

std::vector<SpectralBand> bands_of(const Light& light, const RenderSettings& settings) {
  if (settings.lambda_nm.empty()) return spectral_bands(settings.wavelengths, light.spectrum, settings.colour_space);
  std::vector<SpectralBand> bands;
  const double share = 1.0 / static_cast<double>(settings.lambda_nm.size());
  for (const double lambda_nm : settings.lambda_nm) bands.push_back({lambda_nm, {share, share, share}});
  return bands;
}

// The direction whose direct image the light's value is measured by: its own inside the frame; outside, the
// nearest point of the frame's edge on the way to its centre (ARCHITECTURE, Radiometry).
Vec3 measured_direction(const LensState& lens, const Frame& frame, Vec3 direction) {
  const Vec2 uv = frame.uv_from_sensor(landing_of(lens, direction, lens.design_wavelength_nm));
  const double outside = std::max(std::abs(uv.x - 0.5), std::abs(uv.y - 0.5)) / 0.5;
  if (!(outside > 1.0)) return direction;
  const Vec2 edge = Vec2{0.5, 0.5} + (uv - Vec2{0.5, 0.5}) * (1.0 / outside);
  return direction_to_land_at(lens, frame.sensor_from_uv(edge), lens.design_wavelength_nm);
}

// sum over bands of w[c] * Phi, for the direction the light is measured in.
Rgb direct_light(const LensState& lens, const Frame& frame, Vec3 direction, std::span<const SpectralBand> bands) {
  const auto towards = [&](Vec3 measured) {
    Rgb whole{};
    for (const SpectralBand& band : bands) {
      const double flux = direct_flux(lens, measured, band.lambda_nm);
      for (std::size_t c = 0; c < whole.size(); ++c) whole[c] += band.weight[c] * flux;
    }
    return whole;
  };
  const Rgb whole = towards(measured_direction(lens, frame, direction));
  const bool dark = whole == Rgb{};
  return dark ? towards({0.0, 0.0, 1.0}) : whole;
}

PlannedLight plan_light(const LensState& lens, const Light& light, const RenderSettings& settings) {
  PlannedLight planned;
  planned.direction = normalized(light.direction);
  const auto bands = bands_of(light, settings);
  const Rgb whole = direct_light(lens, settings.frame, planned.direction, bands);
  for (const SpectralBand& band : bands) {
    PlannedPass pass{band.lambda_nm, {}};
    for (std::size_t c = 0; c < whole.size(); ++c) {
      pass.gain[c] = whole[c] != 0.0 ? light.value[c] * band.weight[c] / whole[c] : 0.0;
    }
    planned.passes.push_back(std::move(pass));
  }
  return planned;
}

}  // namespace

Result<FramePlan> plan_frame(const LensState& lens, std::span<const Light> lights, const RenderSettings& settings,
                             const Context& context) {
  if (const auto problem = problem_with(lights, settings)) return tl::unexpected<Error>(*problem);
  const auto selected = select_ghosts(lens, lights, settings, context);
  if (!selected) return tl::unexpected<Error>(selected.error());

  FramePlan plan;
  plan.ghosts = selected->ghosts;
  plan.skipped_flux = selected->skipped_flux;
  plan.lights.resize(lights.size());
  Context quiet = context;
  quiet.progress = {};
  const bool done =
      parallel_for(lights.size(), quiet, [&](std::size_t k) { plan.lights[k] = plan_light(lens, lights[k], settings); });
  if (!done) return failure(ErrorCode::Cancelled, "interrupted");
  return plan;
}

}  // namespace contrejour
