// SPDX-License-Identifier: Apache-2.0
// The stop patterns of a frame's ghosts as a device gets them, a section of RenderCache: they are made again only when
// they change, so that a device uploads them once. Thread-safety: one thread at a time.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "render/device/frame_device.h"
#include "render/stop_patterns/stop_pattern.h"

namespace contrejour::inline internal {

class KeptPatterns {
 public:
  struct Key {
    friend bool operator==(const Key&, const Key&) = default;
  };
  explicit KeptPatterns(const Key& /*key*/) {}

  // One for each of these, in their order; none is null. Those of a picture as the iris follow. Null if there are none
  // at all.
  [[nodiscard]] std::shared_ptr<const DevicePatterns> get(const std::vector<std::shared_ptr<const StopPattern>>& wanted,
                                                          const Iris& iris);

  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  // A table, and the scale with which it is used: they identify a pattern while its owner lives.
  struct Identity {
    const void* table = nullptr;
    double scale = 0.0;
    friend bool operator==(const Identity&, const Identity&) = default;
  };
  [[nodiscard]] static Identity identity_of(const StopPattern& pattern);

  std::vector<Identity> identities_;
  Iris iris_;  // for which the patterns were made
  std::shared_ptr<const DevicePatterns> patterns_;
};

}  // namespace contrejour::inline internal
