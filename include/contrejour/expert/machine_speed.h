// SPDX-License-Identifier: Apache-2.0
// Measures this machine's speed: a lower bound of the time of any renderer.
// Rates and times are the best of a few rounds on the context's threads, in about a third of a second; they vary by a
// few per cent with other load. Thread-safety: safe, but measurements side by side spoil each other.
#pragma once

#include "contrejour/context.h"
#include "contrejour/export.h"
#include "contrejour/lens.h"

namespace contrejour {

// Surfaces hit per millisecond by rays traced in packets (float, the widest instruction set available) along the lens's
// longest ghost at 550 nm, from buffers that fit the cache: RenderStatistics::surface_hits counts the same.
// 0 for a lens without ghosts, an invalid state (check_lens.h), or when cancelled.
[[nodiscard]] CONTREJOUR_API double peak_hits_per_ms(const LensState& lens, const Context& context = {});

// Milliseconds to write width x height RGB floats once, into memory already mapped; 0 for no pixels or more than 2^28.
[[nodiscard]] CONTREJOUR_API double frame_pass_ms(int width, int height, const Context& context = {});

}  // namespace contrejour
