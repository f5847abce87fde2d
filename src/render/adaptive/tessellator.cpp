// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/tessellator.h"

namespace contrejour::inline internal::adaptive {

void Tessellator::emit() {
  cells_.make_conforming();
  for (std::size_t k = 0; k < cells_.count(); ++k)
    for (const ChosenCell& cell : cells_[k].cells) {
      if (context_ != nullptr && context_->cancelled()) break;
      emitter_.emit(cells_[k], cell);
    }
  cells_.clear();
  budget_.start_band();
}

void Tessellator::set_stop_pattern(std::shared_ptr<const stop_patterns::BandStopPattern> pattern, double unit) {
  if (pattern == band_.pattern) return;
  band_.pattern = std::move(pattern);
  band_.stop_unit = unit;
}

}  // namespace contrejour::inline internal::adaptive
