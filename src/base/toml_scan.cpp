// SPDX-License-Identifier: Apache-2.0
#include "base/toml_scan.h"

#include <algorithm>

namespace contrejour::inline internal {

namespace {

constexpr int kMaxKeyParts = 8;

// Scans the text by TOML's rules for strings and comments. For text that is not TOML the scan may differ from the
// parser, but there the parser stops.
class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text) {}

  int line_of_deep_key() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        pass_string(c);
      } else if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else {
        if (c == '.' && ++dots_ >= kMaxKeyParts) return line_;
        if (std::string_view(",=[]{}\n").find(c) != std::string_view::npos) dots_ = 0;
        if (c == '\n') ++line_;
        ++at_;
      }
    }
    return 0;
  }

 private:
  void pass_string(char quote) {
    const bool many_lines = three_quotes(quote);
    at_ += many_lines ? 3 : 1;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      // A one-line string that is not closed: the parser will refuse it here.
      if (c == '\n' && !many_lines) return;
      if (c == quote && (!many_lines || three_quotes(quote))) return pass_closing_quotes(quote, many_lines);
      if (c == '\n') ++line_;
      // An escaped quote closes nothing; an escaped newline is a newline.
      const bool escapes = c == '\\' && quote == '"' && at_ + 1 < text_.size() && text_[at_ + 1] != '\n';
      at_ += escapes ? 2 : 1;
    }
  }

  [[nodiscard]] bool three_quotes(char quote) const {
    return text_.substr(at_, 3) == std::string_view(quote == '"' ? "\"\"\"" : "\'\'\'");
  }

  // Up to two quotes of the string itself may precede the closing three.
  void pass_closing_quotes(char quote, bool many_lines) {
    at_ += many_lines ? 3 : 1;
    while (many_lines && at_ < text_.size() && text_[at_] == quote) ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
  int dots_ = 0;
};

}  // namespace

int line_of_deep_key(std::string_view text) { return Scan(text).line_of_deep_key(); }

}  // namespace contrejour::inline internal
