#include "base/memory.h"

#include <memory>
#include <new>

#if defined(__unix__) || defined(__APPLE__)
#include <sys/resource.h>
#endif
#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace contrejour {
namespace {

constexpr std::size_t kLine = 64;  // of a cache, or a multiple

// Where a line begins in memory that has room for one more, with a pointer to that memory before it. Asked for aligned
// memory instead, the C library would never use it twice.
void* at_line(void* memory, std::size_t bytes) {
  void* first = static_cast<std::byte*>(memory) + sizeof(void*);
  std::size_t space = bytes + kLine;
  first = std::align(kLine, bytes, first, space);
  static_cast<void**>(first)[-1] = memory;
  return first;
}

}  // namespace

void* allocate_large(std::size_t bytes) {
  void* memory = at_line(::operator new(bytes + sizeof(void*) + kLine), bytes);
#if defined(__linux__)
  // Those large pages that lie within.
  constexpr std::size_t kLargePage = std::size_t{2} << 20U;
  std::size_t space = bytes;
  void* first = memory;
  if (std::align(kLargePage, kLargePage, first, space) != nullptr)
    madvise(first, space / kLargePage * kLargePage, MADV_HUGEPAGE);  // a wish: refused, the memory is as good
#endif
  return memory;
}

void free_large(void* memory) noexcept {
  if (memory != nullptr) ::operator delete(static_cast<void**>(memory)[-1]);
}

std::uint64_t peak_memory_bytes() {
#if defined(__unix__) || defined(__APPLE__)
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#if defined(__APPLE__)
  return static_cast<std::uint64_t>(usage.ru_maxrss);  // bytes there, KiB elsewhere
#else
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
#endif
#else
  return 0;
#endif
}

}  // namespace contrejour
