#include "optics/lens/toml_scan.h"

#include <algorithm>

namespace contrejour {

namespace {

// A key of our format has at most two parts (glass.NAME); eight leave room for other people's tables, so that
// those get the message about unknown keys. Each part is a table, and tables are destroyed recursively.
constexpr int kMaxKeyParts = 8;

using Message = std::optional<std::string_view>;

bool is_ascii(char c) { return static_cast<unsigned char>(c) < 0x80; }

// Goes over the text, inside and outside strings and comments, as far as TOML's rules for those go.
class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text) {}

  [[nodiscard]] int line() const { return line_; }

  // What is wrong at line(), or nothing.
  Message find_fault() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      Message fault;
      if (c == '"' || c == '\'') {
        fault = pass_string(c);
      } else if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else {
        fault = pass_plain(c);
      }
      if (fault) return fault;
    }
    return {};
  }

 private:
  // TOML allows other letters in strings and comments only; the parser has undefined behaviour for some.
  Message pass_plain(char c) {
    if (!is_ascii(c) || c == 0x7F || (c < 0x20 && c != '\n' && c != '\r' && c != '\t')) {
      return "not valid TOML: a letter or sign that must stand in quotes; put the name in quotes";
    }
    if (c == '.' && ++dots_ >= kMaxKeyParts) {
      return "a key has too many parts; a lens needs no more than two, as in glass.NAME";
    }
    if (std::string_view(",=[]{}\n").find(c) != std::string_view::npos) dots_ = 0;
    if (c == '\n') ++line_;
    ++at_;
    return {};
  }

  Message pass_string(char quote) {
    // Elsewhere the parser reads on as if the quote were a letter, and what follows were not in quotes.
    if (at_ > 0 && std::string_view(" \t\r\n=,[{.").find(text_[at_ - 1]) == std::string_view::npos) {
      return "not valid TOML: a quote in the middle of a word; put all of it in quotes";
    }
    const bool many_lines = three_quotes(quote);
    at_ += many_lines ? 3 : 1;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      // A one-line string that is not closed: the parser will refuse it here.
      if (c == '\n' && !many_lines) return {};
      if (c == '\n') ++line_;
      if (c == '\\' && quote == '"') {
        if (const Message fault = pass_escape()) return fault;
      } else if (c == quote && (!many_lines || three_quotes(quote))) {
        pass_closing_quotes(quote, many_lines);
        return {};
      } else {
        ++at_;
      }
    }
    return {};
  }

  // A backslash with what it escapes, or the line end and the white space that it swallows. Behind that the
  // parser asks of a letter whether it is white space, and some letters (U+FC26 to U+FEFE) are undefined behaviour.
  Message pass_escape() {
    ++at_;
    std::size_t next = at_;
    while (next < text_.size() && std::string_view(" \t\r\n").find(text_[next]) != std::string_view::npos) ++next;
    if (next < text_.size() && !is_ascii(text_[next])) {
      return "a backslash before a letter that is not ASCII; leave the backslash out";
    }
    if (next == at_ && next < text_.size()) ++at_;
    return {};
  }

  [[nodiscard]] bool three_quotes(char quote) const {
    return text_.substr(at_, 3) == std::string_view(quote == '"' ? "\"\"\"" : "\'\'\'");
  }

  // Up to two quotes of the text itself may stand right before the closing three.
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

std::optional<TomlFault> find_toml_fault(std::string_view text) {
  Scan scan(text);
  if (const Message fault = scan.find_fault()) return TomlFault{scan.line(), *fault};
  return std::nullopt;
}

}  // namespace contrejour
