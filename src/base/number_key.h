// SPDX-License-Identifier: Apache-2.0
// Numbers as a key to what was computed from them: they are compared by their bits, since 0 and -0 may lead to results
// that differ in the last bit.
// Thread-safety: a plain value.
#pragma once

#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace contrejour::inline internal {

class NumberKey {
 public:
  NumberKey() = default;
  NumberKey(std::initializer_list<double> numbers) {
    for (const double number : numbers) add(number);
  }

  void add(double number) { bits_.push_back(std::bit_cast<std::uint64_t>(number)); }
  [[nodiscard]] std::size_t bytes() const { return bits_.size() * sizeof(std::uint64_t); }

  friend auto operator<=>(const NumberKey&, const NumberKey&) = default;

 private:
  std::vector<std::uint64_t> bits_;
};

}  // namespace contrejour::inline internal
