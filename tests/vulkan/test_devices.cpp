// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/devices.h"
#include "contrejour/renderer.h"
#include "device.h"

using namespace contrejour;

TEST_CASE("a usable device has no reason against it, an unusable one has") {
  for (const DeviceInfo& device : list_devices()) {
    CHECK(device.is_usable == device.reason.empty());
    CHECK_FALSE(device.name.empty());
    if (device.is_usable) CHECK(device.storage_range_bytes >= (64U << 20U));
  }
}

TEST_CASE("a device that does not exist is an error that lists the others, and with auto the CPU") {
  const auto required = Renderer::create(BundleOptions{}, Device::Vulkan, "no such device");
  REQUIRE_FALSE(required.has_value());
  CHECK(required.error().code == ErrorCode::Unsupported);
  const auto automatic = Renderer::create(BundleOptions{}, Device::Auto, "no such device");
  REQUIRE(automatic.has_value());
  CHECK(automatic->device_note() == required.error().message);
}
