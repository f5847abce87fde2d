// SPDX-License-Identifier: Apache-2.0
// Converters that omit openings (flare stops) omit the gap behind them, too: the lens is then shorter than its stated
// figures require.
#pragma once

#include "contrejour/lens.h"

namespace contrejour::inline internal {

// Warns if neither the focal length nor the back focal distance is the stated one, and widening one air gap gives both:
// the warning names the gap and its width. There is no warning if several gaps nearly fit. The lens itself is not
// changed.
void warn_of_lost_gap(Prescription& lens);

}  // namespace contrejour::inline internal
