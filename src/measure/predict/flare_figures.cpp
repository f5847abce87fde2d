// SPDX-License-Identifier: Apache-2.0
// walch2018 3.5, and the transmission of stray light: docs/physics/flare-prediction.md.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "contrejour/expert/flare_prediction.h"

namespace contrejour {
namespace {

constexpr double kPeakQuantile = 0.999;
constexpr double kLowQuantile = 0.01, kHighQuantile = 0.99;

Result<void> check_image(const Image& image) {
  if (image.width > 0 && image.height > 0 && image.channels == 3) return {};
  return invalid_argument(fmt::format("figures are those of pictures of three channels, not of {} x {} x {}",
                                      image.width, image.height, image.channels));
}

Result<void> check_settings(const FigureSettings& settings) {
  if (settings.white > 0.0 && std::isfinite(settings.white) && settings.covered_level >= 0.0) return {};
  return invalid_argument("white must be above 0, and the level of covered pixels not below 0");
}

double luminance_at(const Image& image, std::size_t pixel, ColourSpace space) {
  const float* const p = image.pixels.data() + 3 * pixel;
  return luminance({p[0], p[1], p[2]}, space);
}

// Luminances of an image's finite pixels, not below 0: colours beyond the gamut may have negative channels.
std::vector<double> luminances_of(const Image& image, ColourSpace space) {
  std::vector<double> values;
  values.reserve(image.pixels.size() / 3);
  for (std::size_t k = 0; k < image.pixels.size() / 3; ++k) {
    const double y = luminance_at(image, k, space);
    if (std::isfinite(y)) values.push_back(std::max(y, 0.0));
  }
  return values;
}

double mean_of(const std::vector<double>& values) {
  return values.empty() ? 0.0 : std::reduce(values.begin(), values.end()) / static_cast<double>(values.size());
}

double log_average_of(const std::vector<double>& values, double offset) {
  if (values.empty()) return 0.0;
  double sum = 0.0;
  for (const double value : values) sum += std::log(offset + value);
  return std::exp(sum / static_cast<double>(values.size())) - offset;
}

// Sorts the values in part.
double quantile_of(std::vector<double>& values, double fraction) {
  if (values.empty()) return 0.0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double contrast_of(std::vector<double>& values) {
  const double low = quantile_of(values, kLowQuantile), high = quantile_of(values, kHighQuantile);
  return high + low > 0.0 ? (high - low) / (high + low) : 0.0;
}

double inverse(double transmission) {
  return transmission > 0.0 ? 1.0 / transmission : std::numeric_limits<double>::infinity();
}

}  // namespace

Result<FlareFigures> figures_of(const Image& flare, const FigureSettings& settings) {
  if (auto ok = check_image(flare); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_settings(settings); !ok) return tl::unexpected(ok.error());
  std::vector<double> values = luminances_of(flare, settings.space);
  FlareFigures figures;
  if (values.empty()) return figures;
  const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
  figures.minimum = *smallest;
  figures.maximum = *largest;
  figures.mean = mean_of(values);
  figures.sum = figures.mean * static_cast<double>(values.size());
  figures.log_average = log_average_of(values, kLogOffset * settings.white);
  const double level = settings.covered_level * settings.white;
  const auto covered = std::ranges::count_if(values, [level](double value) { return value > level; });
  figures.covered = static_cast<double>(covered) / static_cast<double>(values.size());
  figures.median = quantile_of(values, 0.5);
  figures.percentile_99 = quantile_of(values, kHighQuantile);
  return figures;
}

Result<SceneFigures> figures_on(const Image& scene, const Image& flare, const FigureSettings& settings) {
  for (const Image* image : {&scene, &flare}) {
    if (auto ok = check_image(*image); !ok) return tl::unexpected(ok.error());
  }
  if (auto ok = check_settings(settings); !ok) return tl::unexpected(ok.error());
  if (scene.width != flare.width || scene.height != flare.height) {
    return invalid_argument(fmt::format("the scene of {} x {} pixels and the flare of {} x {} differ in size",
                                        scene.width, scene.height, flare.width, flare.height));
  }
  std::vector<double> without, with, alone;
  for (std::size_t k = 0; k < scene.pixels.size() / 3; ++k) {
    const double below = luminance_at(scene, k, settings.space), added = luminance_at(flare, k, settings.space);
    if (!std::isfinite(below) || !std::isfinite(added)) continue;
    without.push_back(std::max(below, 0.0));
    alone.push_back(std::max(added, 0.0));
    with.push_back(without.back() + alone.back());
  }
  const double offset = kLogOffset * settings.white;
  const double scene_log = log_average_of(without, offset) + offset;
  SceneFigures figures;
  figures.log_average_ratio = scene_log / (log_average_of(alone, offset) + offset);
  figures.brightening = (log_average_of(with, offset) + offset) / scene_log;
  figures.contrast_without = contrast_of(without);
  figures.contrast_with = contrast_of(with);
  if (figures.contrast_without > 0.0) figures.contrast_kept = figures.contrast_with / figures.contrast_without;
  return figures;
}

Result<double> direct_level(double value, double radius_rad, const Frame& frame, double focal_length_mm) {
  const double radius_px = std::tan(radius_rad) * focal_length_mm / frame.pixel_pitch_mm;
  if (radius_px > 0.0 && std::isfinite(radius_px)) return value / (std::numbers::pi * radius_px * radius_px);
  return invalid_argument("the direct image of a light needs a radius, a focal length and pixels above 0");
}

Result<GlareFigures> glare_of(const Image& flare, double level_of_direct_image, ColourSpace space) {
  if (auto ok = check_image(flare); !ok) return tl::unexpected(ok.error());
  if (!(level_of_direct_image > 0.0)) return invalid_argument("the level of the direct image must be above 0");
  std::vector<double> values = luminances_of(flare, space);
  GlareFigures glare;
  glare.mean_transmission = mean_of(values) / level_of_direct_image;
  glare.peak_transmission = quantile_of(values, kPeakQuantile) / level_of_direct_image;
  glare.mean_attenuation = inverse(glare.mean_transmission);
  glare.least_attenuation = inverse(glare.peak_transmission);
  return glare;
}

Result<Rating> rating_of(double value, std::span<const double> others) {
  if (others.empty()) return invalid_argument("there is nothing to rate a value against");
  const auto [smallest, largest] = std::minmax_element(others.begin(), others.end());
  Rating rating;
  if (*largest > *smallest) rating.in_range = (value - *smallest) / (*largest - *smallest);
  double below = 0.0;
  for (const double other : others) below += other < value ? 1.0 : other == value ? 0.5 : 0.0;
  rating.rank = below / static_cast<double>(others.size());
  return rating;
}

double value_of(const LightFigures& figures, Estimator estimator) {
  switch (estimator) {
    case Estimator::Maximum: return figures.flare.maximum;
    case Estimator::Sum: return figures.flare.sum;
    case Estimator::Mean: return figures.flare.mean;
    case Estimator::LogAverage: return figures.flare.log_average;
    case Estimator::Covered: return figures.flare.covered;
    case Estimator::MeanTransmission: return figures.glare.mean_transmission;
    case Estimator::PeakTransmission: return figures.glare.peak_transmission;
  }
  return 0.0;
}

}  // namespace contrejour
