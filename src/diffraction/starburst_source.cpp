// SPDX-License-Identifier: Apache-2.0
#include "diffraction/starburst_source.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/tasks.h"
#include "base/units.h"
#include "diffraction/ring_builder.h"
#include "diffraction/starburst_pattern.h"

namespace contrejour::inline internal {
namespace {

constexpr double kLargestRadius_px = 1e6;
constexpr int kMaxSamples = 4096;  // its spectrum takes 1 GB

// Lengths of any optics, mm or nm: beyond these, their ratios leave the range of double.
bool is_positive(double value) { return value >= 1e-9 && value <= 1e9; }

std::optional<std::string> problem_with(std::span<const SpectralBand> bands, const StarburstSettings& settings) {
  const std::pair<double, const char*> lengths[] = {{settings.distance_mm, "distance of the exit pupil, in mm,"},
                                                    {settings.pupil_radius_mm, "radius of the exit pupil, in mm,"},
                                                    {settings.pixel_pitch_mm, "pixel pitch, in mm,"},
                                                    {settings.radius_px, "radius of a starburst, in pixels,"}};
  for (const auto& [value, name] : lengths)
    if (!is_positive(value)) return fmt::format("the {} must be positive, not {}", name, value);
  if (settings.radius_px > kLargestRadius_px)
    return fmt::format("a starburst of {} pixels is too large; {} are the limit", settings.radius_px,
                       kLargestRadius_px);
  if (settings.samples_across < 16 || settings.samples_across > kMaxSamples)
    return fmt::format("{} samples across the pupil are out of range; choose 16 to {}", settings.samples_across,
                       kMaxSamples);
  if (bands.empty()) return "a starburst needs the light's wavelengths; there are none";
  for (const SpectralBand& band : bands)
    if (!is_positive(band.lambda_nm) || !std::isfinite(band.weight[0] + band.weight[1] + band.weight[2]))
      return fmt::format("a band at {} nm, or its weight, is no number that light can have", band.lambda_nm);
  return std::nullopt;
}

std::optional<std::string> problem_with(const PupilMask& mask, const PupilOutline* outline) {
  if (!mask.real()) return "a starburst takes a mask without phase";
  const auto side = static_cast<std::size_t>(std::max(mask.grid.side, 0));
  if (mask.grid.side < 2 || mask.grid.side > kMaxSamples || mask.amplitude.size() != side * side)
    return fmt::format("a mask of {} samples a side with {} samples is no square of 2 to {}", mask.grid.side,
                       mask.amplitude.size(), kMaxSamples);
  if (!is_positive(mask.grid.pitch_mm))
    return fmt::format("a mask's samples cannot be {} mm apart", mask.grid.pitch_mm);
  if (!std::isfinite(mask.open_area_mm2())) return "a mask's amplitudes must be finite";
  if (outline && !outline->opening.closed() && !is_positive(outline->area_mm2()))
    return "the outline of the pupil has no area";
  if (outline && outline->dirt && !is_positive(outline->dirt->power_mm2))
    return "dirt that lets nothing through leaves no starburst";
  return std::nullopt;
}

}  // namespace

Result<StarburstSource> StarburstSource::make(const PupilMask& mask, const PupilOutline* outline,
                                              std::span<const SpectralBand> bands, const StarburstSettings& settings,
                                              const Context& context) {
  if (context.cancelled()) return interrupted();
  if (const auto problem = problem_with(bands, settings)) return invalid_argument(*problem);
  if (const auto problem = problem_with(mask, outline)) return invalid_argument(*problem);
  StarburstSource source;
  if (!(mask.open_area_mm2() > 0.0) || (outline && outline->opening.closed())) return source;
  Context steps = context;
  steps.progress = {};
  source.shifts_ = shifts_of(bands);
  source.pattern_ = std::make_shared<const StarburstPattern>(mask, outline, settings.pupil_radius_mm, steps);
  if (context.cancelled()) return interrupted();
  // rho = x / (lambda N), N = distance / (2 pupil radius): hullin2011 eq. 2.
  source.rho_per_mm_ = 2.0 * settings.pupil_radius_mm / (mm_from_nm(source.shifts_.lambda_nm) * settings.distance_mm);
  return source;
}

Result<Starburst> StarburstSource::at(double pixel_pitch_mm, double radius_px, const Context& context) const {
  if (!pattern_) return Starburst();
  auto rings = build_rings(*pattern_, shifts_, pixel_pitch_mm * rho_per_mm_, radius_px, context);
  if (!rings) return interrupted();
  return Starburst(std::move(rings));
}

}  // namespace contrejour::inline internal

namespace contrejour {

Result<Starburst> make_starburst(const PupilMask& mask, const PupilOutline* outline,
                                 std::span<const SpectralBand> bands, const StarburstSettings& settings,
                                 const Context& context) {
  const auto source = StarburstSource::make(mask, outline, bands, settings, context);
  if (!source) return tl::unexpected(source.error());
  return source->at(settings.pixel_pitch_mm, settings.radius_px, context);
}

Result<Starburst> make_starburst(const IrisOpening& opening, std::span<const SpectralBand> bands,
                                 const StarburstSettings& settings, const Context& context) {
  if (const auto problem = problem_with(bands, settings)) return invalid_argument(*problem);
  if (opening.closed()) return Starburst();
  Context steps = context;
  steps.progress = {};
  const double radius_mm = settings.pupil_radius_mm;
  const PupilMask mask = make_mask(grid_over(radius_mm, settings.samples_across), opening, radius_mm, steps);
  const PupilOutline outline{opening, {radius_mm, 0.0}, {0.0, radius_mm}};
  return make_starburst(mask, &outline, bands, settings, context);
}

}  // namespace contrejour
