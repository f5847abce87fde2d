// SPDX-License-Identifier: Apache-2.0
// A line of a Zemax file: a keyword and its cells.
#pragma once

#include <initializer_list>
#include <string_view>
#include <vector>

#include "optics/lens_files/first_error.h"

namespace contrejour::inline internal {

// The text and the errors must outlive it.
class ZmxRow {
 public:
  ZmxRow(std::string_view text, int line, FirstError& errors);

  [[nodiscard]] bool is_empty() const { return words_.empty(); }
  [[nodiscard]] bool is_set_in() const { return text_.front() == ' ' || text_.front() == '\t'; }
  [[nodiscard]] int line() const { return line_; }
  [[nodiscard]] std::string_view text() const { return text_; }

  // The keyword is word 0. Empty where there is none.
  [[nodiscard]] std::string_view word(std::size_t k) const {
    return k < words_.size() ? words_[k] : std::string_view();
  }
  [[nodiscard]] std::size_t size() const { return words_.size(); }
  [[nodiscard]] bool is(std::string_view keyword) const { return word(0) == keyword; }
  [[nodiscard]] bool is_one_of(std::initializer_list<std::string_view> keywords) const;

  // The k-th word as a number; 0 if it is missing, an error if it is no number.
  [[nodiscard]] double number(std::size_t k) const { return read(k, false); }
  [[nodiscard]] double number_or_infinity(std::size_t k) const { return read(k, true); }
  // The same truncated to an integer; 0 for numbers beyond a million.
  [[nodiscard]] int whole(std::size_t k) const;

  void fail(std::string message, ErrorCode code = ErrorCode::Parse) const {
    errors_.fail(line_, std::move(message), code);
  }

 private:
  [[nodiscard]] double read(std::size_t k, bool may_be_infinite) const;

  std::string_view text_;
  int line_;
  FirstError& errors_;
  std::vector<std::string_view> words_;
};

}  // namespace contrejour::inline internal
