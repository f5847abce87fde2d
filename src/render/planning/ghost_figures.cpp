// SPDX-License-Identifier: Apache-2.0
#include "contrejour/ghost_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/tasks.h"
#include "contrejour/expert/check_lens.h"
#include "ghosts/light_frame.h"
#include "render/pupils/direct_meter.h"
#include "render/pupils/ghost_light.h"
#include "render/radiometry/check_frame.h"
#include "render/radiometry/direct_light.h"

namespace contrejour {
namespace {

struct Footprint_px {
  Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Vec2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  void add(Vec2 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
};

// The lens at the bands' wavelengths, and what all ghosts have in common.
class FigureMaker {
 public:
  FigureMaker(const LensState& lens, const FiguresRequest& request)
      : lens_(lens), request_(request), windows_(lens, request.light.source()), iris_(lens.iris), tables_(lens),
        steps_(lens, tables_) {
    for (const SpectralBand& band : request.bands) lambda_nm_.push_back(band.lambda_nm);
    std::sort(lambda_nm_.begin(), lambda_nm_.end());
    lambda_nm_.erase(std::unique(lambda_nm_.begin(), lambda_nm_.end()), lambda_nm_.end());
  }

  // Returns false when cancelled.
  [[nodiscard]] bool prepare(const Context& context) {
    if (lambda_nm_.empty()) return true;
    if (!parallel_for(lambda_nm_.size(), context, [&](std::size_t k) { (void)tables_.at(lambda_nm_[k]); }))
      return false;
    MeteredLight light{measured_source(lens_, request_.frame, request_.light.source()), request_.bands};
    KeptFluxes none(KeptFluxes::key_of(lens_));
    if (!measure_fluxes(lens_, tables_, none, {&light, 1}, context)) return false;
    const DirectMeter on_axis(lens_, {{0.0, 0.0, 1.0}, light.source.distance_mm});
    whole_ = direct_light(request_.bands, light.flux_mm2,
                          [&](std::size_t k) { return on_axis.flux_mm2(tables_.at(request_.bands[k].lambda_nm)); });
    return true;
  }

  [[nodiscard]] GhostFigures figures_of(const Ghost& ghost) const {
    GhostFigures figures;
    figures.ghost = ghost;
    add_first_order(figures);
    const LightSource light = request_.light.source();
    const EntranceWindow window = windows_.of(has_axial_symmetry(lens_, ghost));
    const pupils::PupilRequest pupil_request{steps_, ghost, light, window, lambda_nm_};
    const pupils::GhostPupil pupil = find_ghost_pupil(pupil_request);
    Rgb flux{};
    Vec2 centroid_mm;
    double weight_sum = 0.0, luminances = 0.0;
    Footprint_px bounds;
    std::optional<pupils::Footprint> brightest;  // in the band in which the ghost is brightest
    double highest = 0.0;
    for (const SpectralBand& band : request_.bands) {
      pupils::Footprint footprint = footprint_of(pupil_request, pupil, band.lambda_nm, iris_);
      const GhostMeasure& m = footprint.measure();
      const double brightness = luminance(band.weight, ColourSpace::Rec709);
      luminances += brightness;
      figures.reflectance += brightness * reflectance_of(ghost, band.lambda_nm);
      for (std::size_t c = 0; c < flux.size(); ++c) flux[c] += band.weight[c] * m.flux_mm2;
      if (m.flux_mm2 <= 0.0) continue;
      const double weight = brightness * m.flux_mm2;
      centroid_mm = centroid_mm + m.centroid_mm * weight;
      weight_sum += weight;
      bounds.add(request_.frame.pixel_from_sensor(m.min_mm));
      bounds.add(request_.frame.pixel_from_sensor(m.max_mm));
      if (weight <= highest) continue;
      highest = weight;
      brightest = std::move(footprint);
    }
    if (luminances > 0.0) figures.reflectance /= luminances;
    for (std::size_t c = 0; c < flux.size(); ++c) figures.rgb[c] = whole_[c] != 0.0 ? flux[c] / whole_[c] : 0.0;
    figures.relative_flux = luminance(figures.rgb, ColourSpace::Rec709);
    if (weight_sum > 0.0) {
      figures.centroid_mm = centroid_mm * (1.0 / weight_sum);
      figures.centroid_px = request_.frame.pixel_from_sensor(figures.centroid_mm);
      figures.size_px = bounds.high - bounds.low;
      figures.size_mm = figures.size_px * request_.frame.pixel_pitch_mm;
    }
    // A ghost has nearly the same shape in all bands, so each band adds to the peak in proportion to its flux.
    if (brightest) {
      const double scale = weight_sum / brightest->measure().flux_mm2;
      figures.peak_irradiance = scale * brightest->peak_per_mm2(request_.frame.pixel_pitch_mm);
    }
    return figures;
  }

 private:
  void add_first_order(GhostFigures& figures) const {
    figures.first_order = ghost_first_order(lens_, figures.ghost, lens_.design_wavelength_nm);
    const double diagonal_mm = std::hypot(lens_.sensor_width_mm, lens_.sensor_height_mm);
    figures.in_focus = figures.first_order.blur_mm <= GhostFigures::kSharpBlur * diagonal_mm;
    figures.pupil_ghost = std::abs(figures.first_order.relative_image_height) <= GhostFigures::kStillPosition;
  }

  [[nodiscard]] double reflectance_of(const Ghost& ghost, double lambda_nm) const {
    double product = 1.0;
    for (const int number : {ghost.i, ghost.j, ghost.k, ghost.l}) {
      if (number == 0) continue;
      const SurfaceState& surface = lens_.surfaces[static_cast<std::size_t>(number - 1)];
      product *= reflectance(surface.coating, refractive_index(surface.before, lambda_nm),
                             refractive_index(surface.after, lambda_nm), 1.0, lambda_nm);
    }
    return product;
  }

  const LensState& lens_;
  const FiguresRequest& request_;
  LightWindows windows_;
  IrisShape iris_;
  std::vector<double> lambda_nm_;  // rising
  TablesByWavelength tables_;
  StepsByWavelength steps_;
  Rgb whole_{};
};

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
  FigureMaker maker(lens, request);
  Context quiet = context;
  quiet.progress = {};
  if (!maker.prepare(quiet)) return interrupted();
  std::vector<GhostFigures> all(ghosts.size());
  const bool done = parallel_for(ghosts.size(), context, [&](std::size_t g) { all[g] = maker.figures_of(ghosts[g]); });
  if (!done) return interrupted();
  std::stable_sort(all.begin(), all.end(),
                   [](const GhostFigures& a, const GhostFigures& b) { return a.relative_flux > b.relative_flux; });
  return all;
}

}  // namespace contrejour
