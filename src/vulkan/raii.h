// SPDX-License-Identifier: Apache-2.0
// vulkan_raii.hpp without its own way to open the loader, which may be a caller's. Every file that uses vulkan.hpp
// includes it from here, since its classes depend on this choice.
#pragma once

#define VULKAN_HPP_ENABLE_DYNAMIC_LOADER_TOOL 0
#include <vulkan/vulkan_raii.hpp>
