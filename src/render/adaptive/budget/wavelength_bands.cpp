// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/wavelength_bands.h"

#include <algorithm>
#include <array>
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

// The fraction of the light that each pass carries.
std::vector<double> light_fractions(const FirstRays& rays, std::span<const PlannedPass> passes) {
  std::vector<double> fractions;
  double sum = 0.0;
  for (std::size_t k = 0; k < passes.size(); ++k) {
    const auto light = light_of(rays, passes, k);
    fractions.push_back(std::abs(light[0]) + std::abs(light[1]) + std::abs(light[2]));
    sum += fractions.back();
  }
  for (double& fraction : fractions) fraction = sum > 0.0 ? fraction / sum : 1.0 / static_cast<double>(passes.size());
  return fractions;
}

// The light of each channel, over that of the brightest one.
std::array<std::vector<double>, 3> channel_fractions(const FirstRays& rays, std::span<const PlannedPass> passes) {
  std::array<std::vector<double>, 3> fractions;
  Rgb sum{};
  for (std::size_t k = 0; k < passes.size(); ++k) {
    const auto light = light_of(rays, passes, k);
    for (std::size_t c = 0; c < 3; ++c) {
      fractions[c].push_back(std::abs(light[c]));
      sum[c] += std::abs(light[c]);
    }
  }
  const double brightest = *std::ranges::max_element(sum);
  for (auto& of_channel : fractions)
    for (double& fraction : of_channel) fraction = brightest > 0.0 ? fraction / brightest : 0.0;
  return fractions;
}

// Bands of neighbouring passes, which are merged step by step.
class Joined {
 public:
  // between: a band may be drawn between the positions of its passes. farthest_px: the largest distance of any edge
  // from where its band is drawn. channels: the light of each edge by channel. The error is the mean of the channels':
  // in the sum over all wavelengths, the displacements of a ghost's red and blue rims would cancel.
  Joined(std::vector<SpectralEdge> edges, std::array<std::vector<double>, 3> channels, bool between, double farthest_px)
      : edges_(std::move(edges)), channels_(std::move(channels)), between_(between), farthest_px_(farthest_px) {
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
      for (const SpectralEdge& edge : of(band.first, band.last)) light += edge.light;
      for (const SpectralEdge& edge : of(band.first, band.last))
        if (between_ && light > 0.0) band.mix.push_back(edge.light / light);
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
    double sum = 0.0;
    std::vector<SpectralEdge> of_channel(edges.begin(), edges.end());
    for (const std::vector<double>& light : channels_) {
      for (std::size_t k = 0; k < of_channel.size(); ++k) of_channel[k].light = light[first + k];
      sum += band_error(of_channel, drawn_px);
    }
    return sum / static_cast<double>(channels_.size());
  }
  [[nodiscard]] double more(std::size_t k) const { return with_next_[k] - wrong_[k] - wrong_[k + 1]; }
  [[nodiscard]] std::size_t cheapest() const {
    std::size_t at = 0;
    for (std::size_t k = 1; k < with_next_.size(); ++k)
      if (more(k) < more(at)) at = k;
    return at;
  }

  std::vector<SpectralEdge> edges_;  // of all passes
  std::array<std::vector<double>, 3> channels_;
  bool between_;
  double farthest_px_;
  std::vector<std::size_t> ends_;  // first pass of each band, and the end
  std::vector<double> wrong_, with_next_;  // errors: of each band, and of each merged with the next one
};

}  // namespace

std::vector<Band> bands_for(const FirstRays& rays, std::span<const PlannedPass> passes,
                            const WavelengthSamples& samples, double pixel_pitch_mm, std::size_t pieces) {
  if (passes.size() == 1) return {{0, 1, {}}};
  const double half_shift_px = 0.5 * shift_mm(rays.ray_sets.front(), rays.ray_sets.back()) / pixel_pitch_mm;
  const std::vector<double> fractions = light_fractions(rays, passes);
  std::vector<SpectralEdge> edges;
  for (std::size_t k = 0; k < passes.size(); ++k) edges.push_back({half_shift_px * samples.position(k), fractions[k]});
  Joined joined(std::move(edges), channel_fractions(rays, passes), rays.samples > 0, rays.tolerance.colour_px);
  // Items share out the squared error as if theirs were independent. All pieces of a light have the same bands, though,
  // whose errors add up: in squares to n times those of independent ones.
  const double apart = std::pow(kBandFraction * rays.tolerance.position_px, 2.0);
  joined.join_within(apart / static_cast<double>(pieces));
  return joined.bands();
}

}  // namespace contrejour::inline internal::adaptive
