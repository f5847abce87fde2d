// SPDX-License-Identifier: Apache-2.0
// The page about a fit: its figures, captured, fitted and residual pictures by angle, curves. One file of HTML that
// needs no other.
#pragma once

#include <optional>
#include <string>

#include "cli/flare_table.h"
#include "contrejour/expert/fit_comparison.h"

namespace contrejour::cli {

// comparison: with walch2018's descent, if it was made.
[[nodiscard]] Result<std::string> fit_report(const FitOutcome& outcome, const std::optional<FitComparison>& comparison);

// The costs of both fits over the pictures evaluated, as a chart (walch2018 figure 11) and as CSV.
[[nodiscard]] std::string comparison_chart(const FitComparison& comparison);
[[nodiscard]] std::string comparison_csv(const FitComparison& comparison);

// How much brighter pictures of a flare are shown than they are, so that its bright parts are near white, in stops.
[[nodiscard]] double exposure_of(const FittedFlare& fit);

// The difference's size, to look at.
[[nodiscard]] Image residual_of(const FittedStation& station);

}  // namespace contrejour::cli
