// SPDX-License-Identifier: Apache-2.0
#include "studio/core/plates.h"

#include <algorithm>
#include <utility>

#include "studio/core/plate_frames.h"

namespace contrejour::studio {
namespace {

PlateOrder order_of(const SessionPlate& plate, int frame) {
  return {plate, is_plate_sequence(plate.file) ? std::optional(frame) : std::nullopt, false};
}

bool asks_for_the_same(const PlateOrder& a, const PlateOrder& b) {
  return a.reference == b.reference && a.frame == b.frame;
}

}  // namespace

std::shared_ptr<const Plate> Plates::find(const SessionPlate& plate, int frame) {
  if (plate.file.empty()) return nullptr;
  const PlateOrder order = order_of(plate, frame);
  const auto found = std::find_if(kept_.begin(), kept_.end(),
                                  [&](const PlateAnswer& answer) { return asks_for_the_same(answer.order, order); });
  if (found != kept_.end()) return found->plate;
  if (asked_for_ && asks_for_the_same(*asked_for_, order)) return nullptr;
  asked_for_ = order;
  job_.post(order);
  return nullptr;
}

bool Plates::is_reading(const SessionPlate& plate, int frame) const {
  return asked_for_ && asks_for_the_same(*asked_for_, order_of(plate, frame));
}

std::vector<int> Plates::frames(const SessionPlate& plate) const {
  for (auto kept = kept_.rbegin(); kept != kept_.rend(); ++kept)
    if (kept->order.reference == plate) return kept->frames;
  return {};
}

std::optional<PlateAnswer> Plates::take() {
  auto answer = job_.take();
  if (!answer) return answer;
  const PlateOrder& order = answer->order;
  // One that the user asks for may have come before what was asked for, which is then asked for again.
  if (asked_for_ && (order.is_new || asks_for_the_same(*asked_for_, order))) asked_for_.reset();
  std::erase_if(kept_, [&](const PlateAnswer& kept) { return asks_for_the_same(kept.order, order); });
  if (kept_.size() >= kMostKept) kept_.erase(kept_.begin());
  kept_.push_back(*answer);
  return answer;
}

}  // namespace contrejour::studio
