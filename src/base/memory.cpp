// SPDX-License-Identifier: Apache-2.0
#include "base/memory.h"

#include <memory>
#include <new>

#if defined(__unix__) || defined(__APPLE__)
#include <sys/resource.h>
#endif
#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kLine = 64;  // of a cache, or a multiple

// Allocates memory at a multiple of `alignment`, and stores the pointer that operator new returned in front of it. The
// C library's aligned allocation would never reuse freed memory.
void* allocate_at(std::size_t alignment, std::size_t bytes) {
  void* const memory = ::operator new(bytes + sizeof(void*) + alignment);
  void* first = static_cast<std::byte*>(memory) + sizeof(void*);
  std::size_t space = bytes + alignment;
  first = std::align(alignment, bytes, first, space);
  static_cast<void**>(first)[-1] = memory;
  return first;
}

}  // namespace

void* allocate_large(std::size_t bytes) {
#if defined(__linux__)
  // The memory starts at a large page, so that all but its end lies in large pages: otherwise a frame of 25 MB had a
  // thousand small pages at both ends, each of which costs a page fault when first written.
  constexpr std::size_t kLargePage = std::size_t{2} << 20U;
  if (bytes >= kLargePage) {
    void* const memory = allocate_at(kLargePage, bytes);
    madvise(memory, bytes, MADV_HUGEPAGE);  // a hint: if it is refused, the memory still works
    return memory;
  }
#endif
  return allocate_at(kLine, bytes);
}

void free_large(void* memory) noexcept {
  if (memory != nullptr) ::operator delete(static_cast<void**>(memory)[-1]);
}

std::uint64_t peak_memory_bytes() {
#if defined(__unix__) || defined(__APPLE__)
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#if defined(__APPLE__)
  return static_cast<std::uint64_t>(usage.ru_maxrss);  // bytes on macOS, KiB elsewhere
#else
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
#endif
#else
  return 0;
#endif
}

}  // namespace contrejour::inline internal
