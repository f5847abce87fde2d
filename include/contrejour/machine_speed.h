// How fast this machine can go: what no renderer of a frame can go below, measured now.
// Rates and times are the best of a few rounds on the context's threads, in about a third of a second; they vary by
// some per cent with what else the machine does. Thread-safety: safe, but measurements side by side spoil each other.
#pragma once

#include "contrejour/context.h"
#include "contrejour/lens.h"

namespace contrejour {

// Surfaces hit per millisecond by rays traced in packets (float, the widest instruction set there is) along the lens's
// longest ghost at 550 nm, from buffers that stay in the cache: RenderStatistics::surface_hits counts the same.
// 0 for a lens without ghosts, a state that is none (check_lens.h), or when cancelled.
[[nodiscard]] double peak_hits_per_ms(const LensState& lens, const Context& context = {});

// Milliseconds to write width x height RGB floats once, into memory that is there already; 0 for no pixels or more than
// 2^28.
[[nodiscard]] double frame_pass_ms(int width, int height, const Context& context = {});

}  // namespace contrejour
