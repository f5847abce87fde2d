// SPDX-License-Identifier: Apache-2.0
#include "diffraction/ring_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include "base/scalar.h"
#include "base/tasks.h"
#include "diffraction/band_sum.h"
#include "diffraction/near_field.h"
#include "diffraction/pixel_means.h"
#include "diffraction/ring_cells.h"

namespace contrejour::inline internal {
namespace {

constexpr double kFlatRho = 0.05;  // the pattern is flat to 1 per cent within
// Widths of bins at an octave's outer radius: pixels beyond kNear_px are interpolated between means over pixels;
// within, the cells themselves are summed, and a pixel's sides may cross them. Nearest to the centre spikes are too
// close together to get cells of their own.
constexpr double kBin_px = 0.7, kNearBin_px = 0.35, kInnerBin_px = 1.0 / 16.0;
constexpr double kInner_px = 16.0, kNearEnd_px = 1.45 * kNear_px;  // an octave's outer radius
constexpr double kBin_rho = 0.05;  // or this width, where the pattern itself is smoother than pixels
constexpr double kSharpBin_rho = 0.2;  // bins narrower than this resolve a spike's middle
constexpr std::size_t kMinBins = 96;
constexpr double kMaxBins = 32768;  // 0.7 pixels apart 7300 pixels from the centre; 50 MB an octave
constexpr double kFinest_px = 1.0 / 16.0, kCoarse_px = 2.0;  // windows that differ where a direction is sharp
constexpr double kSharp = 1.1;  // by this factor
constexpr double kFringesAside = 8.0;
constexpr std::size_t kPartsOfBin = 4;
constexpr double kStandsOut = 1.7;  // a part of a bin, over their mean
constexpr std::size_t kMaxParts = 48;
constexpr std::size_t kBlock = kDirectionsAtOnce;

double angle_of(double turns) { return (turns - 0.5) * kPi; }

// The data that all octaves share.
struct RingSource {
  const StarburstPattern& pattern;
  const BandShifts& shifts;
  double rho_per_px;
};

// An octave while its cells are filled: rows begin kRowMargin in front of its first.
struct OctaveCells {
  double first_px = 0.0;
  RingCells cells;
  std::vector<float> rgb0;  // [(row * cells + cell) * 4 + channel]
};

// One block of cells.
void fill(OctaveCells& octave, std::size_t first_cell, const RingSource& source) {
  // Row r of the result reads row r - shift of the pattern.
  const BandShifts& shifts = source.shifts;
  const int lead = shifts.last() + static_cast<int>(kRowMargin), rows = static_cast<int>(kRowsGiven);
  const int pattern_rows = rows + shifts.last() - shifts.first;
  const std::size_t cells = octave.cells.cells(), count = std::min(kBlock, cells - first_cell);
  std::vector<float> densities(static_cast<std::size_t>(pattern_rows) * kBlock);
  for (std::size_t a = 0; a < count; ++a) {
    const double from = octave.cells.edge[first_cell + a], to = octave.cells.edge[first_cell + a + 1];
    source.pattern.sample(angle_of(0.5 * (from + to)), (to - from) * kPi,
                          octave.first_px * row_ratio(-lead) * source.rho_per_px, pattern_rows, densities.data() + a,
                          kBlock);
  }
  const auto density = static_cast<float>(source.rho_per_px * source.rho_per_px);  // per rho^2 -> per square pixel
  DirectionSums sum;
  for (int row = 0; row < rows; ++row) {
    sum_bands(shifts.weight, densities.data() + static_cast<std::size_t>(row + shifts.last() - shifts.first) * kBlock,
              sum);
    float* const to = octave.rgb0.data() + (static_cast<std::size_t>(row) * cells + first_cell) * 4;
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t c = 0; c < 3; ++c) to[a * 4 + c] = density * sum[c][a];
  }
}

// True if the pattern in a direction is sharper than pixels: a narrow window is brighter than a wide one about it, or
// one side is darker than the other.
bool is_sharp(const StarburstPattern& pattern, double turns, double radius_px, double rho_per_px) {
  const auto mean = [&](double offset_px, double width_px) {
    float value = 0.0F;
    pattern.sample(angle_of(turns) + offset_px / radius_px, width_px / radius_px, radius_px * rho_per_px, 1, &value, 1);
    return static_cast<double>(value);
  };
  const double wide = mean(0.0, kCoarse_px), low = mean(-0.25 * kCoarse_px, 0.5 * kCoarse_px);
  return mean(0.0, kFinest_px) > kSharp * wide || std::max(low, 2.0 * wide - low) > kSharp * wide;
}

// The pattern in a window of directions, at a few rings at the end of the sampled spectrum.
class SpectrumEnd {
 public:
  SpectrumEnd(const StarburstPattern& pattern, double last_rho) : pattern_(pattern), last_rho_(last_rho) {}

  [[nodiscard]] double held(double turns, double window_turns) const {
    double sum = 0.0;
    for (const double r : {0.6, 0.8, 1.0}) {  // fringes are dark at some radii
      float value = 0.0F;
      pattern_.sample(angle_of(turns), window_turns * kPi, r * last_rho_, 1, &value, 1);
      sum += value * r * r;
    }
    return sum;
  }

  // The middle of the brightest part within a window about a direction.
  [[nodiscard]] double brightest(double turns, double window_turns) const {
    constexpr int kSteps = 12, kRounds = 3;
    for (int round = 0; round < kRounds; ++round, window_turns *= 0.4) {
      double sum = 0.0, moment = 0.0;
      for (int k = 0; k < kSteps; ++k) {
        const double offset = ((k + 0.5) / kSteps - 0.5) * window_turns;
        const double here = held(turns + offset, window_turns / kSteps);
        sum += here * here;
        moment += here * here * offset;
      }
      if (sum > 0.0) turns += moment / sum;
    }
    return turns - std::floor(turns);
  }

 private:
  const StarburstPattern& pattern_;
  double last_rho_;
};

// Finds sharp directions where they are unknown, as for a picture's edges: parts a few fringes wide that are brighter
// than the mean. If many lie together, none is sharp.
std::vector<double> sharp_parts(const StarburstPattern& pattern, const Context& context) {
  const SpectrumEnd end(pattern, pattern.spectrum_end());
  const auto bins = static_cast<std::size_t>(std::ceil(kPi * pattern.spectrum_end() / kFringesAside));
  const double part = 1.0 / static_cast<double>(kPartsOfBin * bins);
  std::vector<double> held(kPartsOfBin * bins);
  const auto middle = [&](std::size_t k) { return (static_cast<double>(k) + 0.5) * part; };
  parallel_for(held.size(), context, [&](std::size_t k) { held[k] = end.held(middle(k), part); });
  const auto mean = [&](std::size_t from, std::size_t count) {
    const auto first = held.begin() + static_cast<std::ptrdiff_t>(from);
    return std::accumulate(first, first + static_cast<std::ptrdiff_t>(count), 0.0) / static_cast<double>(count);
  };
  const double mean_of_all = mean(0, held.size());
  std::vector<double> found;
  for (std::size_t k = 0; k < held.size(); ++k) {
    const double neighbours = mean(k / kPartsOfBin * kPartsOfBin, kPartsOfBin);
    if (held[k] > kStandsOut * std::max(neighbours, mean_of_all)) found.push_back(middle(k));
  }
  if (found.size() > kMaxParts) return {};
  for (double& turns : found) turns = end.brightest(turns, 2.0 * part);
  std::sort(found.begin(), found.end());
  const auto is_same = [&](double a, double b) { return b - a < 0.5 * part; };  // found on both sides of a bin's border
  found.erase(std::unique(found.begin(), found.end(), is_same), found.end());
  return found;
}

OctaveCells laid_out(double first_px, std::span<const double> sharp, const RingSource& source) {
  const double outer_px = 2.0 * first_px;
  const double finest_px = outer_px <= kInner_px ? kInnerBin_px : outer_px <= kNearEnd_px ? kNearBin_px : kBin_px;
  const double wanted = kPi * outer_px * std::min(1.0 / finest_px, source.rho_per_px / kBin_rho);
  const auto bins = static_cast<std::size_t>(std::ceil(std::min(wanted, kMaxBins) / kBlock)) * kBlock;
  OctaveCells octave{first_px, {}, {}};
  const std::size_t enough = std::max(kMinBins, bins);
  const double bins_per_px = static_cast<double>(enough) / (kPi * outer_px);
  std::vector<double> cut;
  if (outer_px > kInner_px && source.rho_per_px > kSharpBin_rho * bins_per_px)
    for (const double turns : sharp)
      if (is_sharp(source.pattern, turns, first_px * std::numbers::sqrt2, source.rho_per_px)) cut.push_back(turns);
  octave.cells = cut_into_cells(enough, cut, bins_per_px);
  octave.rgb0.resize(kRowsGiven * octave.cells.cells() * 4);
  return octave;
}

CellOctave near_octave(const OctaveCells& from) {
  const std::size_t row_size = from.cells.cells() * 4;
  return {from.cells.edge,
          {from.rgb0.data() + kRowMargin * row_size, from.rgb0.data() + (kRowMargin + kRowsPerOctave + 1) * row_size}};
}

StarburstOctave far_octave(const OctaveCells& from, const Context& context) {
  StarburstOctave octave;
  octave.bins = from.cells.bins;
  const std::vector<float> means = means_over_bins(from.cells, from.rgb0, kRowsGiven);
  octave.rgb0.resize((kRowsPerOctave + 1) * (octave.bins + 1) * 4);
  parallel_for(static_cast<std::size_t>(kRowsPerOctave + 1), context, [&](std::size_t row) {
    average_over_pixels(means, octave.bins, from.first_px, row, octave.rgb0.data() + row * (octave.bins + 1) * 4);
  });
  const std::span<const float> rows(from.rgb0);
  add_sharp_zones(from.cells, rows.subspan(kRowMargin * from.cells.cells() * 4), kRowsPerOctave + 1, octave);
  return octave;
}

std::vector<double> sharp_turns(const StarburstPattern& pattern, const Context& context) {
  const std::vector<double> directions = pattern.sharp_directions();
  if (directions.empty()) return sharp_parts(pattern, context);
  std::vector<double> sharp;
  for (const double angle : directions) {
    const double turns = angle / kPi + 0.5;
    sharp.push_back(turns - std::floor(turns));
  }
  return sharp;
}

bool fill_all(OctaveCells& octave, const RingSource& source, const Context& context) {
  const std::size_t blocks = (octave.cells.cells() + kBlock - 1) / kBlock;
  return parallel_for(blocks, context, [&](std::size_t block) { fill(octave, block * kBlock, source); });
}

}  // namespace

std::shared_ptr<const StarburstRings> build_rings(const StarburstPattern& pattern, const BandShifts& shifts,
                                                  double rho_per_px, double radius_px, const Context& context) {
  const RingSource source{pattern, shifts, rho_per_px};
  // The number of octaves is such that the innermost is flat, and the last ends where the starburst does.
  const double flat_px = std::min({0.5, kFlatRho / rho_per_px, 0.5 * radius_px});
  const auto count = static_cast<int>(std::max(1.0, std::ceil(std::log2(radius_px / flat_px))));
  auto rings = std::make_shared<StarburstRings>();
  rings->radius_px = radius_px;
  rings->first_px = radius_px * std::exp2(-count);
  Context quiet = context;
  quiet.progress = {};
  const std::vector<double> sharp = sharp_turns(pattern, quiet);
  // Octaves are built one after the other: only the result of each takes memory.
  for (int o = 0; o < count; ++o) {
    OctaveCells octave = laid_out(radius_px * std::exp2(o - count), sharp, source);
    if (!fill_all(octave, source, quiet)) return nullptr;
    if (octave.first_px < kNear_px + 1.0) rings->near_cells.push_back(near_octave(octave));
    // By rounding, a point at kNear_px may be read from the next inner octave.
    const bool is_far = 2.0 * octave.first_px > 0.99 * kNear_px;
    rings->octaves.push_back(is_far ? far_octave(octave, quiet) : StarburstOctave());
    if (context.progress) context.progress((o + 1.0) / count);
  }
  if (context.cancelled()) return nullptr;
  rings->near = std::make_shared<const NearField>(rings->near_cells, rings->first_px, [](double) { return 1.0; });
  return rings;
}

}  // namespace contrejour::inline internal
