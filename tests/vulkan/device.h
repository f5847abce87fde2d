// SPDX-License-Identifier: Apache-2.0
// The device of the tests, with the validation layer on: any message fails. Where there is no device, tests are
// skipped.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "render/device/kept_device.h"

namespace contrejour::test {

inline std::vector<std::string>& messages() {
  static std::vector<std::string> all;
  return all;
}

// Messages come from all threads that draw.
inline void add_message(const std::string& message) {
  static std::mutex mutex;
  const std::scoped_lock lock(mutex);
  messages().push_back(message);
}

// Null where there is no usable device.
inline std::unique_ptr<FrameDevice> open_device(DeviceOptions options = {}) {
  options.on_message = add_message;
  auto device = open_frame_device(options);
  if (device) return std::move(*device);
  MESSAGE("skipped, as no device is usable: " << device.error().message);
  return nullptr;
}

// Fail as a driver does, and as one that gives no answer.
[[noreturn]] void lose_device();
[[noreturn]] void exhaust_device();
[[noreturn]] void hang_device();

inline void check_no_messages() {
  for (const std::string& message : messages()) FAIL_CHECK(message);
  messages().clear();
}

}  // namespace contrejour::test
