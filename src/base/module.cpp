// SPDX-License-Identifier: Apache-2.0
#include "base/module.h"

#include <filesystem>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#if !defined(_WIN32)
#include <dlfcn.h>
#endif

namespace contrejour::inline internal {

#if defined(_WIN32)

Result<void*> module_function(const std::string& name, const std::string& /*function*/) {
  return failure(ErrorCode::Unsupported, fmt::format("the module {} cannot be loaded on this system", name));
}

#else

namespace {

namespace fs = std::filesystem;

// The folders of the program and of the shared library that this code is in, and where modules are installed relative
// to these.
std::vector<fs::path> module_folders() {
  std::vector<fs::path> homes;
  std::error_code error;
  Dl_info info{};
  if (dladdr(reinterpret_cast<void*>(&module_function), &info) != 0 && info.dli_fname != nullptr)
    homes.push_back(fs::weakly_canonical(info.dli_fname, error).parent_path());
  if (const fs::path program = fs::read_symlink("/proc/self/exe", error); !error)
    homes.push_back(program.parent_path());
  std::vector<fs::path> folders;
  for (const fs::path& home : homes)
    for (const char* below : {".", "contrejour", CONTREJOUR_MODULES_FROM_BIN}) folders.push_back(home / below);
  return folders;
}

}  // namespace

Result<void*> module_function(const std::string& name, const std::string& function) {
  const std::string file = fmt::format("contrejour-{}.so", name);
  for (const fs::path& folder : module_folders()) {
    std::error_code error;
    const fs::path path = folder / file;
    if (!fs::is_regular_file(path, error)) continue;
    void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* const found = module == nullptr ? nullptr : dlsym(module, function.c_str());
    if (found != nullptr) return found;
    const char* const reason = dlerror();
    return failure(ErrorCode::Unsupported,
                   fmt::format("the module cannot be loaded: {}", reason == nullptr ? "unknown reason" : reason),
                   {path.string()});
  }
  return failure(ErrorCode::Unsupported, fmt::format("{} is not installed", file));
}

#endif

}  // namespace contrejour::inline internal
