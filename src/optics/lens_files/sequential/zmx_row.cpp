// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/zmx_row.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/near_name.h"
#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/sequential/design_text.h"

namespace contrejour::inline internal {

ZmxRow::ZmxRow(std::string_view text, int line, FirstError& errors)
    : text_(text), line_(line), errors_(errors), words_(words_of(text)) {}

bool ZmxRow::is_one_of(std::initializer_list<std::string_view> keywords) const {
  return std::find(keywords.begin(), keywords.end(), word(0)) != keywords.end();
}

double ZmxRow::read(std::size_t k, bool may_be_infinite) const {
  if (k >= words_.size()) return 0.0;
  const auto value = may_be_infinite ? contrejour::number_or_infinity(words_[k]) : plain_number(words_[k]);
  if (!value) fail(fmt::format("'{}' of {} is no number", shortened(words_[k]), shortened(words_[0])));
  return value.value_or(0.0);
}

int ZmxRow::whole(std::size_t k) const {
  const double value = number(k);
  return std::abs(value) < 1e6 ? static_cast<int>(value) : 0;
}

}  // namespace contrejour::inline internal
