// SPDX-License-Identifier: Apache-2.0
// A table of the fringes along an iris's edges, for wavelengths that are drawn together and for all channels. Differs:
// where two edges meet, the channels' means are multiplied instead of each wavelength's values.
#pragma once

#include <cstdint>

#include "render/polygons/polygon_list.h"
#include "render/stop_patterns/band_stop_pattern.h"

namespace contrejour::inline internal::adaptive {

// Adds a table to a list, and the iris's bounds with its first one; returns the table's index. band: has edges'
// fringes. width: of a pixel, stop radii.
[[nodiscard]] std::uint32_t add_edge_table(const stop_patterns::BandStopPattern& band, double width, PolygonList& list);

}  // namespace contrejour::inline internal::adaptive
