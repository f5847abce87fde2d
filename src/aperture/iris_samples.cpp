// SPDX-License-Identifier: Apache-2.0
#include "aperture/iris_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "contrejour/expert/vec.h"

namespace contrejour::inline internal {
namespace {

constexpr int kMinSamples = 128;
constexpr int kMaxSamples = 1024;
constexpr float kNoLine = 1e9F;

// The weights of a few pixels in a sample, along one axis of the picture.
struct PixelWeight {
  int pixel = 0;
  float weight = 0;
};

// Averages over a sample's width, in pixels; no weights if the sample lies outside the picture.
std::vector<PixelWeight> average(double begin, double end, int pixels) {
  std::vector<PixelWeight> weights;
  const int last = std::min(static_cast<int>(std::ceil(end)), pixels);
  for (int p = std::max(static_cast<int>(std::floor(begin)), 0); p < last; ++p) {
    const double covered = std::min(end, p + 1.0) - std::max(begin, static_cast<double>(p));
    if (covered > 0.0) weights.push_back({p, static_cast<float>(covered / (end - begin))});
  }
  return weights;
}

// Interpolates between two pixels' middles; the outermost pixels extend to the picture's edge.
std::vector<PixelWeight> interpolation(double middle, int pixels) {
  if (middle < 0.0 || middle > pixels) return {};
  const double u = std::clamp(middle - 0.5, 0.0, pixels - 1.0);
  const int p = std::min(static_cast<int>(u), std::max(pixels - 2, 0));
  const auto t = static_cast<float>(u - p);
  if (pixels == 1) return {{0, 1.0F}};
  return {{p, 1.0F - t}, {p + 1, t}};
}

std::vector<std::vector<PixelWeight>> weights_of_samples(int samples, int longer, int pixels) {
  const double width = static_cast<double>(longer) / samples;
  std::vector<std::vector<PixelWeight>> all;
  for (int k = 0; k < samples; ++k) {
    const double begin = k * width - 0.5 * (longer - pixels);
    all.push_back(samples > longer ? interpolation(begin + 0.5 * width, pixels)
                                   : average(begin, begin + width, pixels));
  }
  return all;
}

struct Segment {
  Vec2 a, b;
};

double distance_to(const Segment& s, Vec2 p) {
  const Vec2 along = s.b - s.a;
  const double squared = dot(along, along);
  const double t = squared > 0.0 ? std::clamp(dot(p - s.a, along) / squared, 0.0, 1.0) : 0.0;
  return length(p - s.a - along * t);
}

// Marching squares: the pieces of the line in the cell to the right of and above sample (i, j).
void add_segments(const StopSamples& s, float level, int i, int j, std::vector<Segment>& out) {
  constexpr std::array<Vec2, 4> kCorner{Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}};
  const std::array<float, 4> v{s.value[s.at(i, j)] - level, s.value[s.at(i + 1, j)] - level,
                               s.value[s.at(i + 1, j + 1)] - level, s.value[s.at(i, j + 1)] - level};
  std::array<Vec2, 4> crossing;
  std::size_t count = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t n = (k + 1) % 4;
    if ((v[k] >= 0.0F) == (v[n] >= 0.0F)) continue;
    const double t = static_cast<double>(v[k]) / (static_cast<double>(v[k]) - v[n]);
    crossing[count++] =
        Vec2{static_cast<double>(i), static_cast<double>(j)} + kCorner[k] + (kCorner[n] - kCorner[k]) * t;
  }
  if (count == 2) out.push_back({crossing[0], crossing[1]});
  if (count < 4) return;
  // Two opposite corners are open; joined if the middle is. Crossing k lies between corners k and k + 1.
  const bool joined = (v[0] + v[1] + v[2] + v[3] >= 0.0F) == (v[0] >= 0.0F);
  const std::size_t first = joined ? 0 : 3;
  out.push_back({crossing[first], crossing[(first + 1) % 4]});
  out.push_back({crossing[(first + 2) % 4], crossing[(first + 3) % 4]});
}

// The nearest segment of every sample.
class NearestSegments {
 public:
  NearestSegments(int side, const std::vector<Segment>& segments)
      : grid_{side, {}}, segments_(segments), nearest_(grid_.at(0, side), -1), distance_(grid_.at(0, side), kNoLine) {
    for (std::size_t k = 0; k < segments.size(); ++k) offer_around(static_cast<std::int32_t>(k));
    for (int pass = 0; pass < 2; ++pass) {
      for (int j = 0; j < side; ++j) sweep_row(j, -1);
      for (int j = side - 1; j >= 0; --j) sweep_row(j, 1);
    }
  }

  [[nodiscard]] const std::vector<float>& distance() const { return distance_; }

 private:
  void offer(int i, int j, std::int32_t segment) {
    if (segment < 0 || i < 0 || j < 0 || i >= grid_.side || j >= grid_.side) return;
    const std::size_t at = grid_.at(i, j);
    if (nearest_[at] == segment) return;
    const auto d = static_cast<float>(
        distance_to(segments_[static_cast<std::size_t>(segment)], {static_cast<double>(i), static_cast<double>(j)}));
    if (d >= distance_[at]) return;
    distance_[at] = d;
    nearest_[at] = segment;
  }

  void offer_around(std::int32_t segment) {
    const Vec2 a = segments_[static_cast<std::size_t>(segment)].a;
    const int i0 = static_cast<int>(a.x);
    const int j0 = static_cast<int>(a.y);
    for (int j = j0 - 1; j <= j0 + 2; ++j)
      for (int i = i0 - 1; i <= i0 + 2; ++i) offer(i, j, segment);
  }

  void take_from(int i, int j, int from_i, int from_j) {
    if (from_i < 0 || from_j < 0 || from_i >= grid_.side || from_j >= grid_.side) return;
    offer(i, j, nearest_[grid_.at(from_i, from_j)]);
  }

  // Propagates from the neighbouring row on the side `dj`, then along the row in both directions.
  void sweep_row(int j, int dj) {
    for (int i = 0; i < grid_.side; ++i) {
      for (int di = -1; di <= 1; ++di) take_from(i, j, i + di, j + dj);
      take_from(i, j, i - 1, j);
    }
    for (int i = grid_.side - 1; i >= 0; --i) take_from(i, j, i + 1, j);
  }

  StopSamples grid_;
  const std::vector<Segment>& segments_;
  std::vector<std::int32_t> nearest_;
  std::vector<float> distance_;
};

}  // namespace

StopSamples samples_over_stop(std::span<const float> level, int width, int height) {
  const int longer = std::max(width, height);
  // An even number of samples a pixel, so that edges of small pictures lie between samples.
  const int repeats = longer >= kMinSamples ? 1 : 2 * ((kMinSamples + 2 * longer - 1) / (2 * longer));
  const int samples = std::min(longer * repeats, kMaxSamples);
  const auto columns = weights_of_samples(samples, longer, width);
  const auto rows = weights_of_samples(samples, longer, height);
  StopSamples out{samples + 2, {}};
  out.value.resize(out.at(0, out.side));
  for (int r = 0; r < samples; ++r) {
    for (int c = 0; c < samples; ++c) {
      float sum = 0.0F;
      for (const PixelWeight& row : rows[static_cast<std::size_t>(r)]) {
        const auto line = level.subspan(static_cast<std::size_t>(row.pixel) * static_cast<std::size_t>(width));
        for (const PixelWeight& column : columns[static_cast<std::size_t>(c)])
          sum += row.weight * column.weight * line[static_cast<std::size_t>(column.pixel)];
      }
      out.value[out.at(c + 1, samples - r)] = sum;
    }
  }
  return out;
}

StopSamples distances_from_level(const StopSamples& samples, float level) {
  std::vector<Segment> segments;
  for (int j = 0; j + 1 < samples.side; ++j)
    for (int i = 0; i + 1 < samples.side; ++i) add_segments(samples, level, i, j, segments);
  StopSamples out{samples.side, NearestSegments(samples.side, segments).distance()};
  for (std::size_t k = 0; k < out.value.size(); ++k)
    if (samples.value[k] >= level) out.value[k] = -out.value[k];
  return out;
}

}  // namespace contrejour::inline internal
