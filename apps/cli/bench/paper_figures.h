// SPDX-License-Identifier: Apache-2.0
// The figures of bodonyi2023 that `bench tables` compares with ours: tables 2 to 8. They were measured on an NVIDIA
// GeForce RTX 3060 at 1920 x 1080, with grids of 256 x 256 rays reduced by eq. 13.
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace contrejour::cli {

// By merging: none, light (gamma 0.001), heavy (0.1). 0: missing in the copy of the text.
using ByMerging = std::array<double, 3>;

struct PaperFigures {
  // Table 2, ms. "Our method" is the paper's tiled one, "previous method" is hullin2011's, our `bundle`.
  double tiled_trace_ms, tiled_dense_ms, tiled_traverse_ms, tiled_total_ms;
  double bundle_trace_ms, bundle_raster_ms, bundle_total_ms;
  double tiled_psnr_db;  // table 3, against the previous method
  ByMerging primitives;  // table 5
  ByMerging indices;     // table 6
};

struct PaperSystem {
  std::string_view key;    // for --systems
  std::string_view name;   // the paper's name
  std::string_view lens;   // our lens
  double focal_length_mm;  // 0: a prime
  double f_number;
  std::array<PaperFigures, 2> by_lights;  // for one and for two lights
  std::array<double, 4> tiles_ms;         // table 4: 8 x 8 without and with coarse tiles, then 16 x 16
  ByMerging merging_ms, merging_db;       // table 7
  std::array<double, 5> traverse_ms;  // table 8: triangle, mean value, homogeneous triangle, Wachspress, Loop-DeRose
};

// The bytes of an entry, which follow from the MiB of tables 5 and 6.
inline constexpr double kPaperPrimitiveBytes = 144;
inline constexpr double kPaperIndexBytes = 4;

[[nodiscard]] std::span<const PaperSystem> paper_systems();

}  // namespace contrejour::cli
