// SPDX-License-Identifier: Apache-2.0
// The plates of a studio's documents: read in the background, and the last few kept, so that undo finds them again.
// Thread-safety: one thread; reading is on another one.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "studio/core/plate_job.h"

namespace contrejour::studio {

class Plates {
 public:
  explicit Plates(std::function<void()> wake) : job_(plate_work(), std::move(wake)) {}

  // Reads a plate that the user asks for, or one of a document.
  void open(const SessionPlate& plate) { job_.post({plate, true}); }
  // Null while it is read, and where it cannot be.
  [[nodiscard]] std::shared_ptr<const Plate> find(const SessionPlate& plate);

  [[nodiscard]] std::optional<PlateAnswer> take();
  [[nodiscard]] bool is_idle() const { return job_.is_idle(); }

 private:
  static constexpr std::size_t kMostKept = 4;

  std::vector<PlateAnswer> kept_;  // the latest last
  SessionPlate asked_for_;
  PlateJob job_;
};

}  // namespace contrejour::studio
