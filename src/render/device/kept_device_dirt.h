// SPDX-License-Identifier: Apache-2.0
// A lens's dirt as a device gets it, a section of RenderCache: it is made again only when the dirt changes, so that a
// device uploads it once. Thread-safety: one thread at a time.
#pragma once

#include <cstddef>
#include <memory>

#include "render/device/device_dirt.h"
#include "render/planning/dirt_field.h"

namespace contrejour::inline internal {

class KeptDeviceDirt {
 public:
  struct Key {
    friend bool operator==(const Key&, const Key&) = default;
  };
  explicit KeptDeviceDirt(const Key& /*key*/) {}

  // field: null where the lens is clean, for which the result is null.
  [[nodiscard]] std::shared_ptr<const DeviceDirt> get(const std::shared_ptr<const DirtField>& field);

  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  std::shared_ptr<const DirtField> field_;  // from which the dirt was made
  std::shared_ptr<const DeviceDirt> dirt_;
};

}  // namespace contrejour::inline internal
