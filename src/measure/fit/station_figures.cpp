// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/station_figures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

namespace contrejour::inline internal {
namespace {

constexpr double kStandsOut = 9.0;  // the square of a pixel's value over its standard deviation
constexpr double kUnclear = 9.0;    // the square of a standard deviation over the usual one

}  // namespace

Image model_of_station(const MeasuredFlare& flare, const FitStation& station) {
  const FlareLight light{station.frame.to_light * station.s, {1.0, 1.0, 1.0}};
  Result<Image> model = render_measured(flare, std::span(&light, 1), station.frame.pixels, {.threads = 1});
  return model ? std::move(*model) : Image(station.rate.width, station.rate.height);
}

ClearSums clear_sums(const FitStation& station, const Image& model) {
  ClearSums sums;
  for (std::size_t i = 0; i < model.pixels.size(); ++i) {
    const auto weight = static_cast<double>(station.weight.pixels[i]);
    const auto value = static_cast<double>(station.rate.pixels[i]);
    if (weight * value * value < kStandsOut) continue;
    sums.left += std::pow(value - static_cast<double>(model.pixels[i]), 2);
    sums.all += value * value;
  }
  return sums;
}

Image fitted_part(Image image, const FitStation& station) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (!(station.weight.pixels[i] > 0.0F)) image.pixels[i] = 0.0F;
  return image;
}

std::vector<bool> shows_flux(const FitStation& station, double model_error) {
  std::vector<double> variances(station.weight.pixels.size(), -1.0), used;
  for (std::size_t k = 0; k < variances.size(); ++k) {
    const auto weight = static_cast<double>(station.weight.pixels[k]);
    if (!(weight > 0.0)) continue;
    const double part = model_error * std::max(static_cast<double>(station.rate.pixels[k]), 0.0);
    variances[k] = std::max(1.0 / weight - part * part, 0.0);
    used.push_back(variances[k]);
  }
  std::vector<bool> shown(variances.size(), false);
  if (used.empty()) return shown;
  const auto middle = used.begin() + static_cast<std::ptrdiff_t>(used.size() / 2);
  std::nth_element(used.begin(), middle, used.end());
  for (std::size_t k = 0; k < shown.size(); ++k) shown[k] = variances[k] >= 0.0 && variances[k] <= kUnclear * *middle;
  return shown;
}

double flux_of(const Image& image, const std::vector<bool>& shown) {
  double sum = 0.0;
  for (std::size_t k = 0; k < shown.size(); ++k)
    if (shown[k]) sum += static_cast<double>(image.pixels[k]);
  return sum / 3.0;
}

}  // namespace contrejour::inline internal
