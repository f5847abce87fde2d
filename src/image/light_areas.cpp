// SPDX-License-Identifier: Apache-2.0
// Runs of bright pixels, row by row, joined by union-find: He et al. 2008, "A run-based two-scan labeling algorithm".
#include "image/light_areas.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal {
namespace {

// The mean squared distance of a pixel's points from its centre: a pixel is a square of side 1.
constexpr double kPixelSecondMoment = 1.0 / 6;

struct Run {
  int begin = 0, end = 0;  // pixels [begin, end)
  std::size_t area = 0;
};

struct PlacedRun {
  int y = 0, begin = 0, end = 0;
};

class UnionFind {
 public:
  std::size_t add() {
    parent_.push_back(parent_.size());
    return parent_.size() - 1;
  }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  // The smaller number remains the root, so that areas keep the order of their first pixels.
  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

// Sums over one run, with coordinates from its left end so that a shifted picture gives the same digits.
DetectedLight light_of_run(const Image& rgb, int y, int begin, int end, const AreaSettings& settings) {
  DetectedLight light;
  light.min_x = begin;
  light.max_x = end - 1;
  light.min_y = light.max_y = y;
  light.pixel_count = end - begin;
  double sum = 0, sum_x = 0, sum_xx = 0;
  for (int x = begin; x < end; ++x) {
    const float* const pixel = rgb.pixels.data() + rgb.index(x, y);
    const double level = level_of(pixel);
    const double weight = weight_of(level, settings);
    double brightness = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = weight * usable_sample(pixel[c]);
      light.flux[c] += value;
      brightness += value;
    }
    const double dx = x - begin;
    sum += brightness;
    sum_x += brightness * dx;
    sum_xx += brightness * dx * dx;
    light.peak = std::max(light.peak, level);
  }
  const double mean = sum_x / sum;
  light.centroid_px = {begin + mean + 0.5, y + 0.5};
  light.rms_radius_px = std::sqrt(std::max(0.0, sum_xx / sum - mean * mean) + kPixelSecondMoment);
  return light;
}

std::vector<Run> runs_of_row(const Image& rgb, int y, const AreaSettings& settings) {
  std::vector<Run> runs;
  for (int x = 0; x < rgb.width; ++x) {
    if (!is_bright(rgb.pixels.data() + rgb.index(x, y), settings)) continue;
    if (runs.empty() || runs.back().end != x) runs.push_back({x, x, 0});
    runs.back().end = x + 1;
  }
  return runs;
}

}  // namespace

bool is_bright(const float* pixel, const AreaSettings& settings) {
  const double level = level_of(pixel);
  // At the threshold a soft weight is 0 and a hard one 1, but a level of 0 is never a light.
  return settings.softness > 0 && settings.threshold > 0 ? level > settings.threshold
                                                         : level > 0 && level >= settings.threshold;
}

double matte_weight(double level, const AreaSettings& settings) {
  const double above = level - settings.threshold, ramp = settings.softness * settings.threshold;
  return above >= ramp ? 1 : above / ramp;
}

double weight_of(double level, const AreaSettings& settings) {
  return matte_weight(level, settings) * std::min(1.0, settings.max_value / level);
}

float usable_sample(float value) { return value > 0 && std::isfinite(value) ? value : 0; }

float level_of(const float* rgb) {
  return std::max({usable_sample(rgb[0]), usable_sample(rgb[1]), usable_sample(rgb[2])});
}

double total_flux(const DetectedLight& light) { return light.flux[0] + light.flux[1] + light.flux[2]; }

DetectedLight merged(const DetectedLight& a, const DetectedLight& b) {
  DetectedLight sum;
  for (std::size_t c = 0; c < 3; ++c) sum.flux[c] = a.flux[c] + b.flux[c];
  const double fraction = total_flux(b) / (total_flux(a) + total_flux(b));
  const Vec2 offset = b.centroid_px - a.centroid_px;
  sum.centroid_px = a.centroid_px + fraction * offset;
  // Steiner's theorem for the second moments.
  const double within =
      (1 - fraction) * a.rms_radius_px * a.rms_radius_px + fraction * b.rms_radius_px * b.rms_radius_px;
  sum.rms_radius_px = std::sqrt(within + fraction * (1 - fraction) * dot(offset, offset));
  sum.min_x = std::min(a.min_x, b.min_x);
  sum.min_y = std::min(a.min_y, b.min_y);
  sum.max_x = std::max(a.max_x, b.max_x);
  sum.max_y = std::max(a.max_y, b.max_y);
  sum.pixel_count = a.pixel_count + b.pixel_count;
  sum.peak = std::max(a.peak, b.peak);
  sum.merged_areas = a.merged_areas + b.merged_areas;
  sum.areas = a.areas;
  sum.areas.insert(sum.areas.end(), b.areas.begin(), b.areas.end());
  return sum;
}

std::vector<DetectedLight> bright_areas(const Image& rgb, const AreaSettings& settings,
                                        std::vector<std::int32_t>& area_of_pixel) {
  UnionFind labels;
  std::vector<DetectedLight> run_lights;  // by label
  std::vector<Run> above;
  std::vector<PlacedRun> all_runs;
  for (int y = 0; y < rgb.height; ++y) {
    std::vector<Run> runs = runs_of_row(rgb, y, settings);
    std::size_t first = 0;  // first of the runs above that may still touch
    for (Run& run : runs) {
      run.area = labels.add();
      run_lights.push_back(light_of_run(rgb, y, run.begin, run.end, settings));
      all_runs.push_back({y, run.begin, run.end});
      while (first < above.size() && above[first].end < run.begin) ++first;
      for (std::size_t i = first; i < above.size() && above[i].begin <= run.end; ++i)
        labels.join(above[i].area, run.area);
    }
    above = std::move(runs);
  }

  std::vector<DetectedLight> areas;
  std::vector<std::size_t> index(run_lights.size());
  for (std::size_t i = 0; i < run_lights.size(); ++i) {
    const std::size_t root = labels.root(i);
    index[i] = root == i ? areas.size() : index[root];
    if (root == i) {
      areas.push_back(run_lights[i]);
    } else {
      DetectedLight& area = areas[index[root]];
      area = merged(area, run_lights[i]);
      area.merged_areas = 1;
    }
  }
  for (std::size_t k = 0; k < areas.size(); ++k) areas[k].areas = {static_cast<int>(k)};
  area_of_pixel.assign(static_cast<std::size_t>(rgb.width) * static_cast<std::size_t>(rgb.height), -1);
  for (std::size_t i = 0; i < all_runs.size(); ++i) {
    const auto row = area_of_pixel.begin() + static_cast<std::ptrdiff_t>(all_runs[i].y) * rgb.width;
    std::fill(row + all_runs[i].begin, row + all_runs[i].end, static_cast<std::int32_t>(index[i]));
  }
  return areas;
}

}  // namespace contrejour::inline internal
