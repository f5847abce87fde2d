// SPDX-License-Identifier: Apache-2.0
#include "base/shared_library.h"

#if defined(_WIN32)
#define WIN32_LEAN_AND_MEAN
#define NOMINMAX
#include <windows.h>
#else
#include <dlfcn.h>
#endif

namespace contrejour::inline internal {

#if defined(_WIN32)

namespace {
void* open_shared_library(const char* name) { return reinterpret_cast<void*>(LoadLibraryA(name)); }
}  // namespace

SharedLibrary::~SharedLibrary() { FreeLibrary(static_cast<HMODULE>(handle_)); }

void* SharedLibrary::function(const char* name) const {
  return reinterpret_cast<void*>(GetProcAddress(static_cast<HMODULE>(handle_), name));
}

#else

namespace {
void* open_shared_library(const char* name) { return dlopen(name, RTLD_NOW | RTLD_LOCAL); }
}  // namespace

SharedLibrary::~SharedLibrary() { dlclose(handle_); }

void* SharedLibrary::function(const char* name) const { return dlsym(handle_, name); }

#endif

std::unique_ptr<SharedLibrary> SharedLibrary::open(std::initializer_list<const char*> names) {
  for (const char* const name : names)
    if (void* const handle = open_shared_library(name); handle != nullptr)
      return std::unique_ptr<SharedLibrary>(new SharedLibrary(handle));
  return nullptr;
}

}  // namespace contrejour::inline internal
