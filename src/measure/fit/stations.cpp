// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/stations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "base/tasks.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kFewestStations = 5;
constexpr double kMasked = 0.015;  // of the width, about the light
constexpr double kFloor = 0.02;    // of a bright pixel: residuals below this part of it count as noise
constexpr double kBright = 0.995;  // the quantile of a station's pixels that counts as bright
// Ghosts up to this radius have every pixel within kAboutPart * radius + kAbout_px fitted.
constexpr double kSmall_px = 8.0, kAboutPart = 1.3, kAbout_px = 2.0;
constexpr double kGuessError = 2.0;  // of the guess of a channel that is not measured

// Where the red pixel lies in a Bayer block, from its middle, in blocks; the blue one lies opposite.
Vec2 red_offset(BayerPattern pattern) {
  switch (pattern) {
    case BayerPattern::Rggb: return {-0.25, -0.25};
    case BayerPattern::Bggr: return {0.25, 0.25};
    case BayerPattern::Grbg: return {0.25, -0.25};
    case BayerPattern::Gbrg: return {-0.25, 0.25};
  }
  return {};
}

bool is_valid(const CapturedImage& image, int x, int y, int channel) {
  return image.valid.at(x, y, image.valid.channels > channel ? channel : 0) > 0.0F &&
         std::isfinite(image.rate.at(x, y, channel));
}

// A channel that was measured beside the middle of its pixels, interpolated there. The least values of saturated pixels
// give the least value of what is interpolated from them.
void move_channel(CapturedImage& image, int channel, Vec2 offset) {
  const CapturedImage from = image;
  const int step_x = offset.x < 0.0 ? 1 : -1, step_y = offset.y < 0.0 ? 1 : -1;
  const double u = std::abs(offset.x), v = std::abs(offset.y);
  const auto valid_at = [&](int x, int y) { return is_valid(from, x, y, channel); };
  for (int y = 0; y < from.rate.height; ++y) {
    for (int x = 0; x < from.rate.width; ++x) {
      const int x1 = std::clamp(x + step_x, 0, from.rate.width - 1);
      const int y1 = std::clamp(y + step_y, 0, from.rate.height - 1);
      const auto mixed = [&](const auto& at) {
        return (1.0 - v) * ((1.0 - u) * static_cast<double>(at(x, y)) + u * static_cast<double>(at(x1, y))) +
               v * ((1.0 - u) * static_cast<double>(at(x, y1)) + u * static_cast<double>(at(x1, y1)));
      };
      image.rate.at(x, y, channel) =
          static_cast<float>(mixed([&](int i, int j) { return from.rate.at(i, j, channel); }));
      const bool usable = valid_at(x, y) && valid_at(x1, y) && valid_at(x, y1) && valid_at(x1, y1);
      image.valid.at(x, y, channel) = usable ? 1.0F : 0.0F;
    }
  }
}

Image three_alike(const Image& one) {
  Image all(one.width, one.height);
  for (std::size_t k = 0; k < all.pixels.size(); ++k) all.pixels[k] = one.pixels[k / 3];
  return all;
}

void align_channels(CapturedImage& image, BayerPattern pattern) {
  if (image.valid.channels == 1) image.valid = three_alike(image.valid);
  const Vec2 red = red_offset(pattern);
  move_channel(image, 0, red);
  move_channel(image, 2, red * -1.0);
}

// Sums over a block of `block` x `block` pixels.
struct Block {
  double rate = 0, variance = 0;  // rate: with the least values of saturated pixels
  bool usable = true;  // all are valid
};

Block block_at(const CapturedImage& image, int left, int top, int block, int channel) {
  Block sum;
  for (int y = top; y < top + block; ++y) {
    for (int x = left; x < left + block; ++x) {
      const double rate = static_cast<double>(image.rate.at(x, y, channel));
      if (std::isfinite(rate)) sum.rate += rate;
      sum.variance += static_cast<double>(image.variance.at(x, y, channel));
      sum.usable = sum.usable && is_valid(image, x, y, channel);
    }
  }
  return sum;
}

FitStation reduced(const CapturedImage& image, int block, const Rgb& light) {
  FitStation station;
  const int width = image.rate.width / block, height = image.rate.height / block;
  station.rate = Image(width, height);
  station.weight = Image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const Block sum = block_at(image, x * block, y * block, block, c);
        const double scale = 1.0 / light[static_cast<std::size_t>(c)];
        station.rate.at(x, y, c) = static_cast<float>(scale * sum.rate);
        if (sum.usable) station.weight.at(x, y, c) = static_cast<float>(1.0 / (scale * scale * sum.variance));
      }
    }
  }
  return station;
}

constexpr double kMostJitter_px = 4.0;  // from where the angle puts the light: farther off is a reflection

// The light's image as the short exposure shows it; else where the head's angle puts it.
Vec2 light_position(const FlareSweep& sweep, std::size_t k, const SweepGeometry& geometry) {
  const Vec2 expected = geometry.position_of(sweep.angles_rad[k]);
  if (k >= sweep.direct.size() || !sweep.direct[k]) return expected;
  const Vec2 seen = sweep.direct[k]->position_px;
  return length(seen - expected) <= std::max(kMostJitter_px, 4.0 * geometry.rms_px) ? seen : expected;
}

double middle_of(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

// The light of each station. Its drift is that of the green flux, its colour the usual one of all stations: red and
// blue pixels are few in a small image, and miss a part of it that depends on where it lies among them.
std::vector<Rgb> lights_of(const FlareSweep& sweep) {
  std::array<std::vector<double>, 3> over_green;
  for (const auto& direct : sweep.direct) {
    for (std::size_t c = 0; direct && c < 3; ++c) over_green[c].push_back(direct->rate[c] / direct->rate[1]);
  }
  std::vector<Rgb> lights(sweep.angles_rad.size(), sweep.light);
  for (std::size_t k = 0; k < sweep.direct.size(); ++k) {
    for (std::size_t c = 0; sweep.direct[k] && c < 3; ++c)
      lights[k][c] = sweep.direct[k]->rate[1] * middle_of(over_green[c]);
  }
  return lights;
}

void place(FitStation& station, Vec2 light_px, const SweepGeometry& geometry, int block) {
  const double scale = 1.0 / block, focal_length_px = std::abs(geometry.focal_length_px);
  station.frame.pixels = {station.rate.width, station.rate.height, scale * focal_length_px, geometry.centre_px * scale};
  const Vec2 offset = light_px - geometry.centre_px;
  const double distance = length(offset);
  station.s = distance / focal_length_px;
  if (distance > 0.0) station.frame.to_light = {offset.x / distance, -offset.y / distance};
}

double bright_value(const FitStation& station) {
  std::vector<float> values;
  for (std::size_t k = 0; k < station.rate.pixels.size(); ++k) {
    if (station.weight.pixels[k] > 0.0F) values.push_back(station.rate.pixels[k]);
  }
  if (values.empty()) return 0.0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(kBright * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

// The brightest value of a channel at a pixel and its neighbours, not below 0.
double brightest_near(const Image& rate, int x, int y, int channel) {
  double most = 0.0;
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, rate.height - 1); ++j) {
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, rate.width - 1); ++i)
      most = std::max(most, static_cast<double>(rate.at(i, j, channel)));
  }
  return most;
}

// The error is a part of the brightest value nearby: a part of a pixel's own value would favour those that are low by
// chance, as a Bayer mosaic makes every second pixel of a small spot.
void add_model_error(FitStation& station, double model_error, double floor) {
  for (int y = 0; y < station.rate.height; ++y) {
    for (int x = 0; x < station.rate.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        float& weight = station.weight.at(x, y, c);
        if (weight == 0.0F) continue;
        const double off = model_error * brightest_near(station.rate, x, y, c);
        weight = static_cast<float>(1.0 / (1.0 / static_cast<double>(weight) + off * off + floor * floor));
      }
    }
  }
}

}  // namespace

Result<SweepStations> reduced_stations(const FlareSweep& sweep, const SweepGeometry& geometry,
                                       const FlareFitOptions& options, const Context& context) {
  const std::size_t count = sweep.angles_rad.size();
  if (count < kFewestStations || !sweep.picture) {
    return invalid_argument(fmt::format("{} stations; a fit needs at least {}", count, kFewestStations));
  }
  const bool dark = std::ranges::any_of(
      sweep.direct, [](const auto& d) { return d && !std::ranges::all_of(d->rate, [](double v) { return v > 0.0; }); });
  if (dark || (!sweep.direct.empty() && sweep.direct.size() != count))
    return invalid_argument("the light's images must be as many as stations, each with a flux above 0");
  if (!(std::abs(geometry.focal_length_px) > 0.0)) return invalid_argument("the geometry has no focal length");
  SweepStations all;
  const std::vector<Rgb> lights = lights_of(sweep);
  std::optional<Error> error;
  int width = 0, height = 0;
  double saturated = 0.0;
  const bool done = ordered_pipeline(
      count, context,
      [&](std::size_t k) -> Result<std::pair<FitStation, Vec2>> {
        Result<CapturedImage> image = sweep.picture(k);
        if (!image) return tl::unexpected(image.error());
        if (image->pattern) align_channels(*image, *image->pattern);
        const int block = std::max(1, (image->rate.width + options.max_width - 1) / options.max_width);
        FitStation station = reduced(*image, block, lights[k]);
        const Vec2 light_px = light_position(sweep, k, geometry);
        place(station, light_px, geometry, block);
        return std::pair{std::move(station), light_px * (1.0 / block)};
      },
      [&](std::size_t k, Result<std::pair<FitStation, Vec2>>& one) {
        if (error) return;
        if (!one) {
          error = one.error();
          return;
        }
        if (k == 0) {
          width = one->first.rate.width;
          height = one->first.rate.height;
        }
        if (one->first.rate.width != width || one->first.rate.height != height) {
          error = invalid_argument("the pictures of a sweep must have the same size").value();
          return;
        }
        for (const float weight : one->first.weight.pixels) saturated += weight == 0.0F ? 1.0 : 0.0;
        all.lights_px.push_back(one->second);
        all.stations.push_back(std::move(one->first));
      });
  if (error) return tl::unexpected(*error);
  if (!done) return interrupted();
  all.saturated = saturated / (3.0 * static_cast<double>(count) * width * height);
  all.masked_px = std::max(2.0, kMasked * width);
  return all;
}

FitStation half_size_station(const FitStation& station) {
  FitStation half;
  half.s = station.s;
  half.frame = station.frame;
  const int width = station.rate.width / 2, height = station.rate.height / 2;
  half.frame.pixels = {width, height, 0.5 * station.frame.pixels.focal_length_px, station.frame.pixels.centre_px * 0.5};
  half.rate = Image(width, height);
  half.weight = Image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        float sum = 0.0F, weight = 0.0F;
        int used = 0;
        for (int k = 0; k < 4; ++k) {
          const float w = station.weight.at(2 * x + k % 2, 2 * y + k / 2, c);
          sum += station.rate.at(2 * x + k % 2, 2 * y + k / 2, c);
          weight += w;
          used += w > 0.0F ? 1 : 0;
        }
        half.rate.at(x, y, c) = sum;  // the light of a pixel of four times the area
        if (used == 4) half.weight.at(x, y, c) = weight / 64.0F;
      }
    }
  }
  return half;
}

std::vector<FitStation> stations_without(const SweepStations& sweep, const HaloProfile& halo, double model_error,
                                         const std::vector<double>& deviations) {
  std::vector<FitStation> stations = sweep.stations;
  if (stations.empty()) return stations;
  std::vector<double> bright;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    subtract_halo(stations[k], halo, sweep.lights_px[k], sweep.masked_px, deviations.empty() ? 1.0 : deviations[k]);
    bright.push_back(bright_value(stations[k]));
  }
  std::ranges::nth_element(bright, bright.begin() + static_cast<std::ptrdiff_t>(bright.size() / 2));
  const double floor = kFloor * std::max(bright[bright.size() / 2], 0.0);
  for (FitStation& station : stations) add_model_error(station, model_error, floor);
  return stations;
}

namespace {

// The pixels about ghosts that are small at this station.
std::vector<bool> about_small_ghosts(const FitStation& station, const MeasuredFlare& flare) {
  const TangentFrame& frame = station.frame.pixels;
  std::vector<bool> marked(station.rate.pixels.size() / 3, false);
  const Vec2 along{station.frame.to_light.x, -station.frame.to_light.y};
  for (const MeasuredGhost& ghost : flare.ghosts) {
    const auto at = ghost_at(ghost, station.s, flare.s_max);
    if (!at) continue;
    const GhostOutline& outline = at->outline;
    const double radius = std::max({outline.left, outline.right, outline.half_height}) * frame.focal_length_px;
    if (radius > kSmall_px) continue;
    const Vec2 middle = frame.centre_px + along * (outline.centre * frame.focal_length_px);
    const double reach = kAboutPart * radius + kAbout_px;
    for (int y = std::max(0, static_cast<int>(middle.y - reach)); y < frame.height && y < middle.y + reach; ++y) {
      for (int x = std::max(0, static_cast<int>(middle.x - reach)); x < frame.width && x < middle.x + reach; ++x)
        marked[static_cast<std::size_t>(y * frame.width + x)] = true;
    }
  }
  return marked;
}

}  // namespace

void guess_channels(FitStation& station) {
  for (std::size_t first = 0; first < station.rate.pixels.size(); first += 3) {
    double sum = 0.0, variance = 0.0, measured = 0.0;
    for (std::size_t k = first; k < first + 3; ++k) {
      const auto weight = static_cast<double>(station.weight.pixels[k]);
      if (weight == 0.0) continue;
      sum += static_cast<double>(station.rate.pixels[k]);
      variance += 1.0 / weight;
      ++measured;
    }
    if (measured == 0.0 || measured == 3.0) continue;
    for (std::size_t k = first; k < first + 3; ++k) {
      if (station.weight.pixels[k] != 0.0F) continue;
      const double guess = std::max(sum / measured, static_cast<double>(station.rate.pixels[k]));
      const double off = kGuessError * guess;
      station.rate.pixels[k] = static_cast<float>(guess);
      station.weight.pixels[k] = static_cast<float>(1.0 / (off * off + variance / measured));
    }
  }
}

std::vector<FitStation> sampled_stations(std::vector<FitStation> stations, int every, const MeasuredFlare& flare) {
  for (FitStation& station : stations) {
    station.frame.sampled_every = every;
    station.frame.sampled_shift = std::max(2, static_cast<int>(std::lround(std::sqrt(every))));
    if (!flare.ghosts.empty())
      station.frame.also_sampled = std::make_shared<const std::vector<bool>>(about_small_ghosts(station, flare));
    for (int y = 0; y < station.rate.height; ++y) {
      for (int x = 0; x < station.rate.width; ++x) {
        for (int c = 0; c < 3; ++c) {
          if (!station.frame.is_sampled(x, y)) station.weight.at(x, y, c) = 0.0F;
        }
      }
    }
    guess_channels(station);
  }
  return stations;
}

}  // namespace contrejour::inline internal
