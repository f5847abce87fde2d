// SPDX-License-Identifier: Apache-2.0
// An object of Vulkan that is destroyed with this one, or was lent by a caller and lives on. Whatever is made from it
// is declared after it, so that it is destroyed before. Thread-safety: one thread at a time.
#pragma once

#include <utility>

namespace contrejour::inline internal::vulkan {

template <class T>
struct Lendable {
  T object = nullptr;
  bool is_lent = false;

  Lendable() = default;
  Lendable(const Lendable&) = delete;
  Lendable& operator=(const Lendable&) = delete;
  ~Lendable() {
    if (is_lent) static_cast<void>(object.release());
  }

  void lend(T&& other) {
    is_lent = true;
    object = std::move(other);
  }
};

}  // namespace contrejour::inline internal::vulkan
