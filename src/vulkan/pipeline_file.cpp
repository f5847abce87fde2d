// SPDX-License-Identifier: Apache-2.0
#include "vulkan/pipeline_file.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

namespace contrejour::inline internal::vulkan {
namespace {

std::filesystem::path cache_folder() {
  for (const auto& [variable, below] : {std::pair{"XDG_CACHE_HOME", ""}, {"HOME", ".cache"}, {"LOCALAPPDATA", ""}}) {
    const char* const value = std::getenv(variable);
    if (value != nullptr && *value != '\0') return std::filesystem::path(value) / below / "contrejour";
  }
  return {};
}

// The identifier changes with the driver; shaders that have changed are recognised by Vulkan itself.
std::filesystem::path file_of(const vk::PhysicalDeviceProperties& device) {
  const std::filesystem::path folder = cache_folder();
  if (folder.empty()) return {};
  std::string name = "vulkan-";
  for (const std::uint8_t byte : device.pipelineCacheUUID) name += fmt::format("{:02x}", byte);
  return folder / (name + ".bin");
}

std::vector<std::uint8_t> contents_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

std::vector<std::uint8_t> read_pipeline_file(const vk::PhysicalDeviceProperties& device) {
  const std::filesystem::path path = file_of(device);
  return path.empty() ? std::vector<std::uint8_t>{} : contents_of(path);
}

void write_pipeline_file(const vk::PhysicalDeviceProperties& device, std::span<const std::uint8_t> data) {
  const std::filesystem::path path = file_of(device);
  if (path.empty() || data.empty()) return;
  const std::vector<std::uint8_t> present = contents_of(path);
  if (std::ranges::equal(present, data)) return;
  std::error_code ignored;
  std::filesystem::create_directories(path.parent_path(), ignored);
  // Another process may read the file: it is replaced as a whole.
  std::filesystem::path fresh = path;
  fresh += fmt::format(".{:x}", reinterpret_cast<std::uintptr_t>(data.data()));
  std::ofstream file(fresh, std::ios::binary);
  file.write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(data.size()));
  file.close();
  if (file)
    std::filesystem::rename(fresh, path, ignored);
  else
    std::filesystem::remove(fresh, ignored);
}

}  // namespace contrejour::inline internal::vulkan
