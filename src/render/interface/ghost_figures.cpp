#include "contrejour/ghost_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "base/tasks.h"
#include "contrejour/check_lens.h"
#include "contrejour/first_order.h"
#include "render/interface/check_frame.h"
#include "render/interface/direct_light.h"

namespace contrejour {
namespace {

// A parallel bundle at height y leaves at the sensor with height a y and slope c y: it meets the axis -a / c on.
std::optional<double> paraxial_focus_mm(const LensState& lens, Ghost ghost) {
  const Abcd m = abcd_ghost(lens, ghost, lens.design_wavelength_nm);
  const double focus = -m.a / m.c;
  return std::isfinite(focus) ? std::optional<double>(focus) : std::nullopt;
}

struct Footprint {
  Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Vec2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  void add(Vec2 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
};

GhostFigures figures_of(const LensState& lens, Ghost ghost, const FiguresRequest& request,
                        std::span<const GhostMeter> meters, const Rgb& whole) {
  GhostFigures figures;
  figures.ghost = ghost;
  figures.paraxial_focus_mm = paraxial_focus_mm(lens, ghost);
  Rgb flux{};
  Vec2 centroid_mm;
  double weight_sum = 0.0;
  Footprint footprint;
  for (std::size_t k = 0; k < request.bands.size(); ++k) {
    const SpectralBand& band = request.bands[k];
    const GhostMeasure m = meters[k].measure(ghost, request.light.source());
    for (std::size_t c = 0; c < flux.size(); ++c) flux[c] += band.weight[c] * m.flux_mm2;
    if (m.flux_mm2 <= 0.0) continue;
    const double brightness = luminance(band.weight, ColourSpace::Rec709);
    figures.peak_irradiance += brightness * m.peak_per_mm2;
    centroid_mm = centroid_mm + m.centroid_mm * (brightness * m.flux_mm2);
    weight_sum += brightness * m.flux_mm2;
    footprint.add(request.frame.pixel_from_sensor(m.min_mm));
    footprint.add(request.frame.pixel_from_sensor(m.max_mm));
  }
  for (std::size_t c = 0; c < flux.size(); ++c) figures.rgb[c] = whole[c] != 0.0 ? flux[c] / whole[c] : 0.0;
  figures.relative_flux = luminance(figures.rgb, ColourSpace::Rec709);
  if (weight_sum > 0.0) {
    figures.centroid_px = request.frame.pixel_from_sensor(centroid_mm * (1.0 / weight_sum));
    figures.size_px = footprint.high - footprint.low;
  }
  return figures;
}

Result<void> check_request(const LensState& lens, const FiguresRequest& request) {
  if (auto good = check_lens(lens); !good) return good;
  if (auto good = check_frame(request.frame); !good) return good;
  for (const SpectralBand& band : request.bands) {
    if (!is_wavelength(band.lambda_nm) || !std::isfinite(band.weight[0] + band.weight[1] + band.weight[2]))
      return failure(ErrorCode::InvalidArgument, fmt::format("no band of a light is at {} nm", band.lambda_nm));
  }
  return {};
}

}  // namespace

Result<std::vector<GhostFigures>> ghost_figures(const LensState& lens, const FiguresRequest& request,
                                                const Context& context) {
  if (const auto good = check_request(lens, request); !good) return tl::unexpected(good.error());
  if (const auto good = check_source(lens, request.light.source()); !good) return tl::unexpected(good.error());
  const std::vector<Ghost> ghosts = enumerate_ghosts(lens, request.scope, request.reflections);
  std::vector<GhostMeter> meters;
  for (const SpectralBand& band : request.bands) meters.emplace_back(lens, band.lambda_nm);
  const LightSource measured = measured_source(lens, request.frame, request.light.source());
  std::vector<double> direct_mm2;
  for (const GhostMeter& meter : meters) direct_mm2.push_back(meter.direct_flux(measured));
  const LightSource on_axis({0.0, 0.0, 1.0}, measured.distance_mm);
  const Rgb whole =
      direct_light(request.bands, direct_mm2, [&](std::size_t k) { return meters[k].direct_flux(on_axis); });
  std::vector<GhostFigures> all(ghosts.size());
  const bool done = parallel_for(ghosts.size(), context,
                                 [&](std::size_t g) { all[g] = figures_of(lens, ghosts[g], request, meters, whole); });
  if (!done) return interrupted();
  std::stable_sort(all.begin(), all.end(),
                   [](const GhostFigures& a, const GhostFigures& b) { return a.relative_flux > b.relative_flux; });
  return all;
}

}  // namespace contrejour
