// Converters that leave out openings (flare stops) leave out the gap behind them, too: the lens is then shorter than
// its stated figures want it.
#pragma once

#include "contrejour/lens.h"

namespace contrejour {

// A warning where neither the focal length nor the back focal distance is the stated one and one gap in air, made wider,
// gives both: which gap, and how wide. None where several gaps nearly do. The lens itself stays as its file has it.
void warn_of_lost_gap(Prescription& lens);

}  // namespace contrejour
