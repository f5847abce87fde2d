// What `bench tables` measures of a system apart from its pictures; into the rows' probes.
//   prepare_ms         to find, read and set up the lens and render 64 x 36 pixels with adaptive, the first time that
//                      this run sees the lens: all that is worked out for a lens and no more pixels than that
//   peak_hits_per_ms   of packets along its longest ghost, all threads
//   frame_pass_ms      to write the frame's floats once, all threads
//   peak_memory_bytes  of the last system only (Canon at 200 mm, if it is asked for, which needs most): the process's
//                      high-water mark after adaptive with two lights at the paper's f-number, the first picture of
//                      full size in the run; the program itself included
#pragma once

#include <vector>

#include "cli/bench/rows.h"
#include "contrejour/parameter_values.h"
#include "contrejour/result.h"

namespace contrejour::cli {

// Must come before any other picture of the run.
[[nodiscard]] Result<void> probe(const std::vector<const PaperSystem*>& systems, const params::Values& values,
                                 int threads, BenchRows& rows);

}  // namespace contrejour::cli
