// SPDX-License-Identifier: Apache-2.0
// A shared library of the system that is opened at run time, since a machine may lack it. Thread-safety: one thread at
// a time uses an object.
#pragma once

#include <initializer_list>
#include <memory>

namespace contrejour::inline internal {

class SharedLibrary {
 public:
  // The first of these files that the system finds; null if there is none.
  [[nodiscard]] static std::unique_ptr<SharedLibrary> open(std::initializer_list<const char*> names);
  ~SharedLibrary();
  SharedLibrary(const SharedLibrary&) = delete;
  SharedLibrary& operator=(const SharedLibrary&) = delete;

  // Null if the library has none of this name.
  [[nodiscard]] void* function(const char* name) const;

 private:
  explicit SharedLibrary(void* handle) : handle_(handle) {}

  void* handle_;
};

}  // namespace contrejour::inline internal
