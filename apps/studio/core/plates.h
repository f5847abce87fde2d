// SPDX-License-Identifier: Apache-2.0
// The plates of a studio's documents: read in the background, and the last few kept, so that undo and a step back to
// the frame before find them again. Thread-safety: one thread; reading is on another one.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "studio/core/plate_job.h"

namespace contrejour::studio {

class Plates {
 public:
  explicit Plates(JobHost host) : job_(plate_work(), std::move(host)) {}

  // Reads a plate that the user asks for. frame: of a sequence; none: its first one.
  void open(const SessionPlate& plate) { job_.post({plate, std::nullopt, true}); }
  // The plate of a document at a frame. Null while it is read, and where it cannot be.
  [[nodiscard]] std::shared_ptr<const Plate> find(const SessionPlate& plate, int frame);
  // Whether find() has asked for it, and there is no answer yet.
  [[nodiscard]] bool is_reading(const SessionPlate& plate, int frame) const;
  // The frames of a sequence that were there when one of them was read last.
  [[nodiscard]] std::vector<int> frames(const SessionPlate& plate) const;

  [[nodiscard]] std::optional<PlateAnswer> take();
  [[nodiscard]] bool is_idle() const { return job_.is_idle(); }

 private:
  static constexpr std::size_t kMostKept = 4;

  std::vector<PlateAnswer> kept_;  // the latest last
  std::optional<PlateOrder> asked_for_;
  PlateJob job_;
};

}  // namespace contrejour::studio
