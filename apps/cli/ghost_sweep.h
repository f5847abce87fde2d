// SPDX-License-Identifier: Apache-2.0
// The ghosts of a lens as functions of the light's field angle, the focal length or the f-number.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/console.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/ghost_figures.h"

namespace contrejour::cli {

enum class SweepAxis { Field, Focal, FNumber };

struct SweepRange {
  SweepAxis axis = SweepAxis::Field;
  std::optional<std::array<double, 2>> ends;  // nullopt: the whole range
};
// Accepts "field", "focal", "fnumber", "field:FROM:TO".
[[nodiscard]] Result<SweepRange> parse_sweep(std::string_view text);

// One ghost's properties over the sweep, one value for each step.
struct SweptGhost {
  Ghost ghost;
  std::vector<double> relative_flux, peak_irradiance;
};

struct GhostSweep {
  std::string lens;
  SweepAxis axis = SweepAxis::Field;
  std::vector<double> value;  // in increasing order
  std::vector<SweptGhost> ghosts;
};

// Settings that the sweep does not change are those of the values. Field angles are on the light's side of the axis.
// Errors: those of the lens and its settings, a lens without zoom in a sweep of the focal length, Cancelled.
[[nodiscard]] Result<GhostSweep> sweep_ghosts(const std::string& lens, const params::Values& values,
                                              const SweepRange& range, int steps);

// The quantity that a sweep compares: a ghost's flux, or its peak.
enum class SweepQuantity { Flux, Peak };
[[nodiscard]] const std::vector<double>& quantity_of(const SweptGhost& ghost, SweepQuantity quantity);
// The step at which the quantity is largest.
[[nodiscard]] std::size_t worst_step(const SweptGhost& ghost, SweepQuantity quantity);
// Sorts by the largest value over the sweep, in decreasing order.
void sort_by_worst(GhostSweep& sweep, SweepQuantity quantity);

[[nodiscard]] std::string axis_name(SweepAxis axis);  // with its unit, for headings
[[nodiscard]] Json sweep_json(const GhostSweep& sweep);
[[nodiscard]] std::string sweep_text(const GhostSweep& sweep);
[[nodiscard]] std::string sweep_csv(const GhostSweep& sweep);

}  // namespace contrejour::cli
