// The figures of bodonyi2023 that `bench tables` prints beside ours: tables 2, 3 and 5.
// Measured there on an NVIDIA GeForce RTX 3060 at 1920 x 1080, grids of 256 x 256 reduced by its eq. 13.
#pragma once

#include <span>
#include <string_view>

namespace contrejour::cli {

struct PaperFigures {
  // Table 2, ms. "Our method" is the paper's tiled one, "previous method" is hullin2011's, our `bundle`.
  double tiled_trace_ms, tiled_dense_ms, tiled_traverse_ms, tiled_total_ms;
  double bundle_trace_ms, bundle_raster_ms, bundle_total_ms;
  double tiled_psnr_db;                                    // table 3, against the previous method
  int primitives, primitives_light_merge, primitives_heavy_merge;  // table 5
};

struct PaperSystem {
  std::string_view key;    // for --systems
  std::string_view name;   // the paper's
  std::string_view lens;   // ours
  double focal_length_mm;  // 0: a prime
  double f_number;
  PaperFigures by_lights[2];  // one and two lights
};

[[nodiscard]] std::span<const PaperSystem> paper_systems();

}  // namespace contrejour::cli
