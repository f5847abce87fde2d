// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/wavelength_bands.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "render/adaptive/budget/band_error.h"
#include "render/ray_maps/lobatto_cells.h"

namespace contrejour::inline internal::adaptive {
namespace {

// Fraction of the displacement that a fit may make of all light. The error of bands is added to that of fits, is
// visible in full and shows in colours.
constexpr double kBandFraction = 0.6;
// A cell with a smaller area than this, over the squared sum of its diagonals on the sensor, is in a focus or a fold:
// its sides do not show how heights change across it.
constexpr double kFlat = 1e-3;

// How far each node is from getting through, as a height over that of what blocks it: 1 at the outline. The iris counts
// as its circumscribed circle.
std::vector<double> heights_of(const LobattoRays& rays) {
  std::vector<double> heights(rays.relative_height.begin(), rays.relative_height.end());
  for (const auto& crossing : rays.stop)
    for (std::size_t k = 0; k < heights.size(); ++k)
      heights[k] =
          std::max(heights[k], std::hypot(static_cast<double>(crossing[0][k]), static_cast<double>(crossing[1][k])));
  return heights;
}

// Returns how far a ghost's outline moves from one wavelength to another across itself. A ray on the outline moves on
// the sensor, and another ray takes its place where rims block more or less of the pupil: where heights hardly rise
// across the outline, as in a ghost that is about to vanish, that is by far the most.
double outline_shift_mm(const LobattoRays& a, const LobattoRays& b) {
  const LobattoCells cells(a);
  const std::vector<double> height_a = heights_of(a), height_b = heights_of(b);
  const auto at = [](const LobattoRays& rays, std::size_t k) { return Vec2{rays.sensor_x_mm[k], rays.sensor_y_mm[k]}; };
  double largest = 0.0;
  for (std::size_t first = 0; first < cells.end(); ++first) {
    if (!cells.has(first)) continue;
    const auto c = cells.corners(first);
    if (!std::ranges::all_of(c, [&](std::size_t k) { return a.counts(k) && b.counts(k); })) continue;
    const auto crosses = [&](const std::vector<double>& height) {
      const auto [low, high] = std::ranges::minmax(c, {}, [&](std::size_t k) { return height[k]; });
      return height[low] <= 1.0 && height[high] >= 1.0;
    };
    if (!crosses(height_a) && !crosses(height_b)) continue;
    const Vec2 first_diagonal = at(a, c[2]) - at(a, c[0]), second_diagonal = at(a, c[3]) - at(a, c[1]);
    const double area = cross(first_diagonal, second_diagonal), size = length(first_diagonal) + length(second_diagonal);
    if (!(std::abs(area) > kFlat * size * size)) continue;
    const double first_rise = height_a[c[2]] - height_a[c[0]], second_rise = height_a[c[3]] - height_a[c[1]];
    const Vec2 slope{(first_rise * second_diagonal.y - second_rise * first_diagonal.y) / area,
                     (second_rise * first_diagonal.x - first_rise * second_diagonal.x) / area};
    double along = 0.0, rise = 0.0;
    for (const std::size_t k : c) {
      along += 0.25 * dot(at(b, k) - at(a, k), slope);
      rise += 0.25 * (height_b[k] - height_a[k]);
    }
    const double steepness = length(slope);
    largest = std::max(largest, std::abs(along - rise) < size * steepness ? std::abs(along - rise) / steepness : size);
  }
  return largest;
}

// Returns how far a ghost moves from one wavelength to another, by the rays that get through or nearly do.
double shift_mm(const LobattoRays& a, const LobattoRays& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.count(); ++k) {
    if (!(a.relative_height[k] < kNearlyThrough && b.relative_height[k] < kNearlyThrough)) continue;
    const Vec2 shift{a.sensor_x_mm[k] - b.sensor_x_mm[k], a.sensor_y_mm[k] - b.sensor_y_mm[k]};
    largest = std::max(largest, length(shift));
  }
  return largest;
}

// The edges of all passes on a line along which the ghost moves, with their light over that of the brightest channel.
std::vector<SpectralEdge> edges_of(const FirstRays& rays, std::span<const PlannedPass> passes,
                                   const WavelengthSamples& samples, double pixel_pitch_mm) {
  const LobattoRays &first = rays.ray_sets.front(), &last = rays.ray_sets.back();
  const double half_shift_px = 0.5 * std::max(shift_mm(first, last), outline_shift_mm(first, last)) / pixel_pitch_mm;
  std::vector<SpectralEdge> edges;
  Rgb sum{};
  for (std::size_t k = 0; k < passes.size(); ++k) {
    SpectralEdge edge{half_shift_px * samples.position(k), light_of(rays, passes, k)};
    for (std::size_t c = 0; c < sum.size(); ++c) {
      edge.light[c] = std::abs(edge.light[c]);
      sum[c] += edge.light[c];
    }
    edges.push_back(edge);
  }
  const double brightest = *std::ranges::max_element(sum);
  for (SpectralEdge& edge : edges)
    for (double& light : edge.light) light = brightest > 0.0 ? light / brightest : 0.0;
  return edges;
}

// Bands of neighbouring passes, which are merged step by step.
class Joined {
 public:
  // between: a band may be drawn between the positions of its passes. farthest_px: the largest distance of any edge
  // from where its band is drawn.
  Joined(std::vector<SpectralEdge> edges, bool between, double farthest_px)
      : edges_(std::move(edges)), between_(between), farthest_px_(farthest_px) {
    for (std::size_t k = 0; k <= edges_.size(); ++k) ends_.push_back(k);
    wrong_.assign(edges_.size(), 0.0);
    for (std::size_t k = 0; k + 1 < edges_.size(); ++k) with_next_.push_back(error_of(k, k + 2));
  }

  // Merges, again and again, the two neighbouring bands that add the least error, until the sum would exceed `allowed`.
  void join_within(double allowed) {
    double sum = 0.0;
    while (!with_next_.empty()) {
      const std::size_t k = cheapest();
      sum += more(k);
      if (!(sum <= allowed)) return;
      wrong_[k] = with_next_[k];
      const auto next = static_cast<std::ptrdiff_t>(k) + 1;
      wrong_.erase(wrong_.begin() + next);
      ends_.erase(ends_.begin() + next);
      with_next_.erase(with_next_.begin() + next - 1);
      if (k > 0) with_next_[k - 1] = error_of(ends_[k - 1], ends_[k + 1]);
      if (k < with_next_.size()) with_next_[k] = error_of(ends_[k], ends_[k + 2]);
    }
  }

  [[nodiscard]] std::vector<Band> bands() const {
    std::vector<Band> out;
    for (std::size_t k = 0; k + 1 < ends_.size(); ++k) {
      Band band{ends_[k], ends_[k + 1], {}};
      double light = 0.0;
      for (const SpectralEdge& edge : of(band.first, band.last)) light += all_light(edge);
      for (const SpectralEdge& edge : of(band.first, band.last))
        if (between_ && light > 0.0) band.mix.push_back(all_light(edge) / light);
      out.push_back(std::move(band));
    }
    return out;
  }

 private:
  [[nodiscard]] std::span<const SpectralEdge> of(std::size_t first, std::size_t last) const {
    return std::span(edges_).subspan(first, last - first);
  }
  [[nodiscard]] double error_of(std::size_t first, std::size_t last) const {
    const auto edges = of(first, last);
    const double drawn_px = between_ ? middle_of_light(edges) : edges_[Band{first, last, {}}.middle()].position_px;
    for (const SpectralEdge& edge : edges)
      if (std::abs(edge.position_px - drawn_px) > farthest_px_) return std::numeric_limits<double>::infinity();
    return band_error(edges, drawn_px);
  }
  [[nodiscard]] double more(std::size_t k) const { return with_next_[k] - wrong_[k] - wrong_[k + 1]; }
  [[nodiscard]] std::size_t cheapest() const {
    std::size_t at = 0;
    for (std::size_t k = 1; k < with_next_.size(); ++k)
      if (more(k) < more(at)) at = k;
    return at;
  }

  std::vector<SpectralEdge> edges_;  // of all passes
  bool between_;
  double farthest_px_;
  std::vector<std::size_t> ends_;  // first pass of each band, and the end
  std::vector<double> wrong_, with_next_;  // errors: of each band, and of each merged with the next one
};

}  // namespace

std::vector<Band> bands_for(const FirstRays& rays, std::span<const PlannedPass> passes,
                            const WavelengthSamples& samples, double pixel_pitch_mm, std::size_t pieces) {
  if (passes.size() == 1) return {{0, 1, {}}};
  Joined joined(edges_of(rays, passes, samples, pixel_pitch_mm), rays.samples > 0, rays.tolerance.colour_px);
  // Items share out the squared error as if theirs were independent. All pieces of a light have the same bands, though,
  // whose errors add up: in squares to n times those of independent ones.
  const double apart = std::pow(kBandFraction * rays.tolerance.position_px, 2.0);
  joined.join_within(apart / static_cast<double>(pieces));
  return joined.bands();
}

}  // namespace contrejour::inline internal::adaptive
