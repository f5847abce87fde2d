// SPDX-License-Identifier: Apache-2.0
// The device that a renderer draws its frames on, as a section of its cache.
// Thread-safety: one thread at a time.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "render/device/frame_device.h"
#include "render/planning/frame_plan.h"
#include "render/planning/render_cache.h"

namespace contrejour::inline internal {

struct KeptDevice {
  struct Key {
    friend bool operator==(const Key&, const Key&) = default;
  };
  explicit KeptDevice(const Key& /*key*/) {}
  // The device's own memory is not the session's.
  [[nodiscard]] static std::size_t memory_bytes() { return 0; }

  std::unique_ptr<FrameDevice> device;  // null: frames are drawn by the CPU
  PictureUse use = PictureUse::Read;    // of the next picture of ghosts
  bool has_kept_picture = false;        // instead of having read it
  bool is_required = false;             // if it fails, a frame fails, in place of being drawn by the CPU
  // The starbursts that the device may add to the next picture of ghosts, and whether it has done so.
  std::vector<PlacedStarburst> starbursts;
  bool has_added_starbursts = false;
  std::string reason;                   // why the CPU drew the last frame although there is a device

  // Whether the device draws a frame; lacks: what it cannot do of it ("ringing is"), empty: nothing.
  [[nodiscard]] bool may_draw(const std::string& lacks) {
    reason = lacks.empty() ? "" : lacks + " drawn by the CPU";
    return device != nullptr && lacks.empty();
  }
  // Whether the CPU draws the frame that the device failed to draw.
  [[nodiscard]] bool falls_back(const Result<DrawnFlare>& drawn) {
    if (drawn || is_required || drawn.error().code == ErrorCode::Cancelled) return false;
    reason = drawn.error().message;
    return true;
  }
};

}  // namespace contrejour::inline internal
