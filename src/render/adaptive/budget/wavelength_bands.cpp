// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/wavelength_bands.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "render/adaptive/budget/band_error.h"

namespace contrejour::inline internal::adaptive {
namespace {

// Fraction of the displacement that a fit may make of all light. The error of bands is added to that of fits, is
// visible in full and shows in colours.
constexpr double kBandFraction = 0.6;

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
  const double half_shift_px = 0.5 * shift_mm(rays.ray_sets.front(), rays.ray_sets.back()) / pixel_pitch_mm;
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
