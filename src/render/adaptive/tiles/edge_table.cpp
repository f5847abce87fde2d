// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/tiles/edge_table.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kStep = 1.0 / 24.0;  // in units of the finest edge
constexpr double kFadeFrom = 0.7;     // of the way to where the light is uniform: no step must be visible there

double fade(double way) {
  const double t = std::clamp((1.0 - way) / (1.0 - kFadeFrom), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

EdgeTable::EdgeTable(const stop_patterns::BandStopPattern& band, double width)
    : iris_(&band.edges->iris()), grey_(band.is_grey()), dark_beyond_(band.dark_beyond + 0.5 * width),
      level_within_(band.level_within + 0.5 * width), per_step_(1.0 / (kStep * band.unit)),
      count_(static_cast<std::size_t>((dark_beyond_ + level_within_) * per_step_) + 2) {
  const std::size_t stride = grey_ ? 1 : kStride;
  entries_.assign(count_ * stride, 0.0F);
  for (std::size_t k = 1; k + 1 < count_; ++k) {
    const double distance = dark_beyond_ - static_cast<double>(k) / per_step_;
    float* const entry = &entries_[stride * k];
    for (const stop_patterns::BandStopPattern::Part& part : band.parts) {
      const double share = part.pattern->edges()->edge(distance, width);
      const double faded = distance > 0.0 ? share * fade(distance / dark_beyond_)
                                          : 1.0 + (share - 1.0) * fade(-distance / level_within_);
      for (std::size_t c = 0; c < std::min<std::size_t>(stride, 3); ++c)
        entry[c] += part.channel[c] * static_cast<float>(faded);
    }
  }
  std::fill_n(&entries_[stride * (count_ - 1)], stride, 1.0F);
  if (!grey_) return;
  for (std::size_t k = 0; k < count_; ++k)
    steps_.push_back({entries_[k], k + 1 < count_ ? entries_[k + 1] - entries_[k] : 0.0F});
  entries_ = {};
}

}  // namespace contrejour::inline internal::adaptive
