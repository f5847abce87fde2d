// SPDX-License-Identifier: Apache-2.0
#include "studio/core/plates.h"

#include <algorithm>
#include <utility>

namespace contrejour::studio {

std::shared_ptr<const Plate> Plates::find(const SessionPlate& plate) {
  if (plate.file.empty()) return nullptr;
  const auto found = std::find_if(kept_.begin(), kept_.end(),
                                  [&](const PlateAnswer& answer) { return answer.order.reference == plate; });
  if (found != kept_.end()) return found->plate;
  if (asked_for_ != plate) job_.post({plate, false});
  asked_for_ = plate;
  return nullptr;
}

std::optional<PlateAnswer> Plates::take() {
  auto answer = job_.take();
  if (!answer) return answer;
  asked_for_ = {};
  std::erase_if(kept_, [&](const PlateAnswer& kept) { return kept.order.reference == answer->order.reference; });
  if (kept_.size() >= kMostKept) kept_.erase(kept_.begin());
  kept_.push_back(*answer);
  return answer;
}

}  // namespace contrejour::studio
