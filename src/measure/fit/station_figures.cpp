// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/station_figures.h"

#include <span>
#include <utility>

namespace contrejour::inline internal {
namespace {

constexpr double kStandsOut = 9.0;  // the square of a pixel's value over its standard deviation

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

double flux_of(const Image& image, const FitStation& station) {
  double sum = 0.0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (station.weight.pixels[i] > 0.0F) sum += static_cast<double>(image.pixels[i]);
  return sum / 3.0;
}

}  // namespace contrejour::inline internal
