#include "render/adaptive/wavelength_bands.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contrejour::adaptive {
namespace {

// Of the displacement that a fit may make of all light: for bands it comes on top, and colours show.
constexpr double kBandShare = 0.8;

// How far a ghost moves from one wavelength to another, by the rays that are not far from getting through.
double shift_mm(const RaySheet& a, const RaySheet& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.count(); ++k) {
    if (!(a.r_rel[k] < kNearlyThrough && b.r_rel[k] < kNearlyThrough)) continue;
    const Vec2 shift{a.sensor_x_mm[k] - b.sensor_x_mm[k], a.sensor_y_mm[k] - b.sensor_y_mm[k]};
    largest = std::max(largest, length(shift));
  }
  return largest;
}

// Each pass's part of the light.
std::vector<double> light_shares(const FirstRays& rays, std::span<const PlannedPass> passes) {
  std::vector<double> shares;
  double sum = 0.0;
  for (std::size_t k = 0; k < passes.size(); ++k) {
    const auto light = light_of(rays, passes, k);
    shares.push_back(std::abs(light[0]) + std::abs(light[1]) + std::abs(light[2]));
    sum += shares.back();
  }
  for (double& share : shares) share = sum > 0.0 ? share / sum : 1.0 / static_cast<double>(passes.size());
  return shares;
}

std::vector<Band> even_bands(std::size_t passes, std::size_t count) {
  std::vector<Band> bands;
  for (std::size_t k = 0; k < count; ++k) bands.push_back({k * passes / count, (k + 1) * passes / count});
  return bands;
}

}  // namespace

// An edge that each wavelength shows d pixels off its place is wrong in strips that do not overlap: by squares, each
// wavelength's part of the light squared times d, or d^2 where pixels see only a part of it.
std::vector<Band> bands_for(const FirstRays& rays, std::span<const PlannedPass> passes,
                            const WavelengthSamples& samples, double pixel_pitch_mm) {
  if (passes.size() == 1) return {{0, 1}};
  const double shift_px = shift_mm(rays.sheets.front(), rays.sheets.back()) / pixel_pitch_mm;
  const std::vector<double> shares = light_shares(rays, passes);
  const double allowed = std::pow(kBandShare * rays.tolerance.position_px, 2.0);
  const auto wrong = [&](std::span<const Band> bands) {
    double sum = 0.0;
    for (const Band& band : bands) {
      for (std::size_t k = band.first; k < band.last; ++k) {
        const double off_px = 0.5 * shift_px * std::abs(samples.place(k) - samples.place(band.middle()));
        if (off_px > rays.tolerance.colour_px) return std::numeric_limits<double>::infinity();
        sum += shares[k] * shares[k] * std::min(off_px, off_px * off_px);
      }
    }
    return sum;
  };
  for (std::size_t count = 1; count < passes.size(); ++count) {
    std::vector<Band> bands = even_bands(passes.size(), count);
    if (wrong(bands) <= allowed) return bands;
  }
  return even_bands(passes.size(), passes.size());
}

}  // namespace contrejour::adaptive
