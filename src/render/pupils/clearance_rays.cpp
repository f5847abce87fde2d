// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/clearance_rays.h"

namespace contrejour::inline internal::pupils {

void ClearanceRays::resize(std::size_t count) {
  count_ = count;
  padded_ = clearance_padded(count);
  x_mm_.assign(padded_, 0.0F);
  y_mm_.assign(padded_, 0.0F);
  fields_.resize(kFields * padded_);
}

void ClearanceRays::trace(Vec2 origin_mm, PacketPrecision precision) {
  const auto to = [&](std::size_t k) { return fields_.data() + k * padded_; };
  ClearanceArrays out{to(kFailing), to(kPassed), to(kRim), to(kRim + 1), {}, {}};
  for (std::size_t c = 0; c < static_cast<std::size_t>(crossings()); ++c) {
    out.stop_x[c] = to(kStop + 2 * c);
    out.stop_y[c] = to(kStop + 2 * c + 1);
  }
  source_->clearances(origin_mm, precision, x_mm_.data(), y_mm_.data(), count_, out);
  if (source_->surfaces() > 0) rays_ += count_;
}

}  // namespace contrejour::inline internal::pupils
