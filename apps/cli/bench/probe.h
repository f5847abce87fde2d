// SPDX-License-Identifier: Apache-2.0
// Measurements of a system that `bench tables` makes apart from its pictures; they go into the rows' probes.
//   prepare_ms         the time to find, read and configure the lens and to render 64 x 36 pixels with adaptive, the
//                      first time in this run: all preparation for a lens, and hardly any pixels
//   peak_hits_per_ms   surface hits of packets along the lens's longest ghost, all threads
//   frame_pass_ms      the time to write the frame's floats once, all threads
//   peak_memory_bytes  for the last system only (Canon at 200 mm, if requested, which needs most): the process's
//                      high-water mark after adaptive with two lights at the paper's f-number, the first picture of
//                      full size in the run; the program itself is included
#pragma once

#include <vector>

#include "cli/bench/rows.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/result.h"

namespace contrejour::cli {

// Must be called before any other picture of the run.
[[nodiscard]] Result<void> probe(const std::vector<const PaperSystem*>& systems, const params::Values& values,
                                 int threads, BenchRows& rows);

}  // namespace contrejour::cli
