#include "render/interface/frame_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "base/tasks.h"

namespace contrejour {
namespace {

constexpr int kMaxWavelengths = 1024;
constexpr double kMaxPixels = 268435456.0;  // 2^28
constexpr double kGreen_nm = 550.0;         // ghosts are ranked there

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

PlannedLight plan_light(const LensState& lens, const Light& light, const RenderSettings& settings) {
  PlannedLight planned;
  planned.direction = normalized(light.direction);
  const auto bands = bands_of(light, settings);
  Vec3 measured = measured_direction(lens, settings.frame, planned.direction);
  if (direct_flux(lens, measured, lens.design_wavelength_nm) <= 0.0) measured = {0.0, 0.0, 1.0};
  Rgb whole{};
  for (const SpectralBand& band : bands) {
    const double flux = direct_flux(lens, measured, band.lambda_nm);
    for (std::size_t c = 0; c < whole.size(); ++c) whole[c] += band.weight[c] * flux;
  }
  for (const SpectralBand& band : bands) {
    PlannedPass pass{band.lambda_nm, {}};
    for (std::size_t c = 0; c < whole.size(); ++c) {
      pass.gain[c] = whole[c] != 0.0 ? light.value[c] * band.weight[c] / whole[c] : 0.0;
    }
    planned.passes.push_back(std::move(pass));
  }
  return planned;
}

// Flux of each ghost summed over the lights, weighted by their luminance, in green.
Result<std::vector<double>> ghost_fluxes(const LensState& lens, std::span<const Ghost> ghosts,
                                         std::span<const Light> lights, const RenderSettings& settings,
                                         const Context& context) {
  std::vector<double> flux(ghosts.size(), 0.0);
  Context quiet = context;
  quiet.progress = {};
  const bool done = parallel_for(ghosts.size(), quiet, [&](std::size_t g) {
    for (const Light& light : lights) {
      const double weight = std::abs(luminance(light.value, settings.colour_space));
      flux[g] += weight * measure_ghost(lens, ghosts[g], normalized(light.direction), kGreen_nm).flux_mm2;
    }
  });
  if (!done) return failure(ErrorCode::Cancelled, "interrupted");
  return flux;
}

// Indices of the ghosts to keep, given their fluxes; by falling flux, ties in ghost order.
std::vector<std::size_t> by_falling_flux(const std::vector<double>& flux) {
  std::vector<std::size_t> order(flux.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return flux[a] > flux[b]; });
  return order;
}

std::size_t count_to_keep(const SelectByFlux& select, const std::vector<double>& flux,
                          const std::vector<std::size_t>& order) {
  const double allowed = std::accumulate(flux.begin(), flux.end(), 0.0) * select.drop_percent / 100.0;
  double dropped = 0.0;
  std::size_t keep = order.size();
  while (keep > 0 && dropped + flux[order[keep - 1]] <= allowed) dropped += flux[order[--keep]];
  return keep;
}

Result<void> check_list(const std::vector<Ghost>& list, std::span<const Ghost> all) {
  for (const Ghost& g : list) {
    if (std::find(all.begin(), all.end(), g) == all.end()) {
      return tl::unexpected<Error>(invalid(fmt::format(
          "there is no ghost {}-{} in this lens; `contrejour ghosts` lists those there are", g.i, g.j)));
    }
  }
  return {};
}

struct Selected {
  std::vector<Ghost> ghosts;
  double skipped_flux = 0;
};

Selected keep_ghosts(const std::vector<Ghost>& all, const std::vector<double>& flux,
                     const std::set<std::size_t>& kept) {
  Selected out;
  double total = 0.0;
  double skipped = 0.0;
  for (std::size_t g = 0; g < all.size(); ++g) {
    total += flux[g];
    if (kept.count(g) > 0) {
      out.ghosts.push_back(all[g]);
    } else {
      skipped += flux[g];
    }
  }
  out.skipped_flux = total > 0.0 ? skipped / total : 0.0;
  return out;
}

Result<Selected> select_ghosts(const LensState& lens, std::span<const Light> lights, const RenderSettings& settings,
                               const Context& context) {
  if (std::holds_alternative<SelectAll>(settings.selection)) return Selected{enumerate_ghosts(lens, settings.scope), 0};
  const auto* list = std::get_if<SelectList>(&settings.selection);
  const auto all = enumerate_ghosts(lens, list != nullptr ? GhostScope::All : settings.scope);
  if (list != nullptr) {
    if (const auto ok = check_list(list->ghosts, all); !ok) return tl::unexpected<Error>(ok.error());
  }
  const auto flux = ghost_fluxes(lens, all, lights, settings, context);
  if (!flux) return tl::unexpected<Error>(flux.error());

  std::set<std::size_t> kept;
  const auto keep_first = [&](std::size_t count) {
    const auto order = by_falling_flux(*flux);
    kept.insert(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(std::min(count, order.size())));
  };
  if (const auto* brightest = std::get_if<SelectBrightest>(&settings.selection)) {
    keep_first(static_cast<std::size_t>(std::max(0, brightest->count)));
  } else if (const auto* share = std::get_if<SelectByFlux>(&settings.selection)) {
    keep_first(count_to_keep(*share, *flux, by_falling_flux(*flux)));
  } else {
    const auto* surface = std::get_if<SelectSurface>(&settings.selection);
    for (std::size_t g = 0; g < all.size(); ++g) {
      const bool chosen = surface != nullptr
                              ? all[g].i == surface->surface || all[g].j == surface->surface
                              : std::find(list->ghosts.begin(), list->ghosts.end(), all[g]) != list->ghosts.end();
      if (chosen) kept.insert(g);
    }
  }
  return keep_ghosts(all, *flux, kept);
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
