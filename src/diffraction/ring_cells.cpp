// SPDX-License-Identifier: Apache-2.0
#include "diffraction/ring_cells.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace contrejour::inline internal {
namespace {

// The borders of cells on both sides of a sharp direction, in pixels at the octave's outer radius: the first cell
// contains it.
constexpr std::array<double, 10> kEdges_px{0.03, 0.09, 0.16, 0.24, 0.34, 0.46, 0.6, 0.76, 0.95, 1.18};
constexpr double kCutPast_px = 1.2;  // of a sharp direction, at the outer radius: bins within it are divided
constexpr double kMin_px = 1e-3;   // between edges
// Pixels reach 0.71 pixels from their middles, which is 2.1 bins at an octave's inner radius.
constexpr std::size_t kReach = 3;  // bins

std::vector<SharpBins> sharp_bins(std::size_t bins, std::span<const double> sharp, double bins_per_px) {
  const auto past = static_cast<std::ptrdiff_t>(std::ceil(kCutPast_px * bins_per_px));
  const auto count = static_cast<std::ptrdiff_t>(bins);
  std::vector<bool> is_sharp(bins, false);
  for (const double turn : sharp) {
    const auto bin = static_cast<std::ptrdiff_t>(turn * static_cast<double>(bins));
    for (std::ptrdiff_t b = bin - past; b <= bin + past; ++b)
      is_sharp[static_cast<std::size_t>((b % count + count) % count)] = true;
  }
  std::vector<SharpBins> runs;
  for (std::size_t b = 0; b < bins; ++b) {
    if (!is_sharp[b] || (b > 0 && is_sharp[b - 1])) continue;
    std::size_t end = b;
    while (end < bins && is_sharp[end]) ++end;
    runs.push_back({b, end});
  }
  // Runs on both sides of straight down are one.
  if (runs.size() > 1 && runs.front().first == 0 && runs.back().end == bins) {
    runs.back().end += runs.front().end;
    runs.erase(runs.begin());
  }
  return runs;
}

}  // namespace

RingCells cut_into_cells(std::size_t bins, std::span<const double> sharp, double bins_per_px) {
  RingCells cells{bins, {}, sharp_bins(bins, sharp, bins_per_px)};
  const double per_px = bins_per_px / static_cast<double>(bins);  // half turns
  std::vector<double> cuts;
  for (const double turn : sharp)
    for (const double px : kEdges_px)
      for (const double at : {turn - px * per_px, turn + px * per_px}) cuts.push_back(at - std::floor(at));
  std::sort(cuts.begin(), cuts.end());
  auto cut = cuts.begin();
  for (std::size_t b = 0; b < bins; ++b) {
    const double from = static_cast<double>(b) / static_cast<double>(bins);
    const double to = static_cast<double>(b + 1) / static_cast<double>(bins);
    cells.edge.push_back(from);
    for (; cut != cuts.end() && *cut < to; ++cut)
      if (*cut > cells.edge.back() + kMin_px * per_px && *cut < to - kMin_px * per_px) cells.edge.push_back(*cut);
  }
  cells.edge.push_back(1.0);
  return cells;
}

namespace {

// First cell of a bin.
std::size_t cell_at(const RingCells& cells, std::size_t bin) {
  const double from = static_cast<double>(bin) / static_cast<double>(cells.bins);
  return static_cast<std::size_t>(std::lower_bound(cells.edge.begin(), cells.edge.end(), from) - cells.edge.begin());
}

SharpZone zone_of(const RingCells& cells, const SharpBins& sharp, std::span<const float> rgb0, std::size_t rows) {
  const std::size_t bins = cells.bins, all = cells.cells(), margin = 2 * kReach;
  SharpZone zone;
  zone.first_bin = (sharp.first + bins - margin) % bins;
  const double last = static_cast<double>(sharp.end - sharp.first + 2 * margin);
  const std::size_t first_cell = cell_at(cells, zone.first_bin);
  std::vector<std::size_t> of;  // the octave's
  for (std::size_t k = first_cell;; ++k) {
    const double turns = cells.edge[k % all] + static_cast<double>(k / all);
    const double at = (turns * static_cast<double>(bins)) - static_cast<double>(zone.first_bin);
    zone.edge.push_back(static_cast<float>(at));
    if (at > last - 1e-6) break;
    of.push_back(k % all);
  }
  zone.rgb0.resize(rows * of.size() * 4);
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t k = 0; k < of.size(); ++k)
      std::copy_n(rgb0.data() + (row * all + of[k]) * 4, 4, zone.rgb0.data() + (row * of.size() + k) * 4);
  return zone;
}

}  // namespace

void add_sharp_zones(const RingCells& cells, std::span<const float> rgb0, std::size_t rows, StarburstOctave& octave) {
  octave.zone_of_bin.assign(cells.bins, 0);
  for (const SharpBins& sharp : cells.sharp) {
    octave.zones.push_back(zone_of(cells, sharp, rgb0, rows));
    for (std::size_t b = sharp.first + cells.bins - kReach; b < sharp.end + cells.bins + kReach; ++b)
      octave.zone_of_bin[b % cells.bins] = static_cast<std::uint16_t>(octave.zones.size());
  }
}

std::vector<float> means_over_bins(const RingCells& cells, std::span<const float> rgb0, std::size_t rows) {
  std::vector<std::size_t> bin_of(cells.cells());
  std::vector<float> fraction(cells.cells());
  for (std::size_t k = 0; k < cells.cells(); ++k) {
    const auto bins = static_cast<double>(cells.bins);
    bin_of[k] = static_cast<std::size_t>(0.5 * (cells.edge[k] + cells.edge[k + 1]) * bins);
    fraction[k] = static_cast<float>((cells.edge[k + 1] - cells.edge[k]) * bins);
  }
  std::vector<float> means(rows * cells.bins * 4);
  for (std::size_t row = 0; row < rows; ++row) {
    const float* from = rgb0.data() + row * cells.cells() * 4;
    float* const to = means.data() + row * cells.bins * 4;
    for (std::size_t k = 0; k < cells.cells(); ++k, from += 4)
      for (std::size_t c = 0; c < 4; ++c) to[bin_of[k] * 4 + c] += fraction[k] * from[c];
  }
  return means;
}

}  // namespace contrejour::inline internal
