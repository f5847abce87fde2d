// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/seq_commands.h"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace contrejour::inline internal {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f,";
constexpr std::size_t kMaxWords = 300, kLongestName = 3;

// Reads physical lines, joined where a line is continued.
class Splitter {
 public:
  std::vector<SeqCommand> split(std::string_view text) {
    for (int line = 1; !text.empty() && commands_.size() < kMaxSeqCommands; ++line) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      split_line(text.substr(0, end), line);
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    finish();
    return std::move(commands_);
  }

 private:
  void split_line(std::string_view line, int number) {
    bool goes_on = false;
    std::size_t k = 0;
    while (k < line.size()) {
      const char c = line[k];
      if (c == '!') break;
      if (c == '&') {
        goes_on = true;
        break;  // the rest is a comment
      }
      if (c == ';') {
        finish();
        ++k;
      } else if (kBlanks.find(c) != std::string_view::npos) {
        ++k;
      } else {
        k = add_word(line, k, number);
      }
    }
    if (!goes_on) finish();
  }

  // Adds a word, or the text between quotes, from line[k] on; returns the index behind it.
  std::size_t add_word(std::string_view line, std::size_t k, int number) {
    if (words_.empty()) line_ = number;
    std::string word;
    if (line[k] == '\'' || line[k] == '"') {
      const std::size_t end = std::min(line.find(line[k], k + 1), line.size());
      word = line.substr(k + 1, end - k - 1);
      k = std::min(end + 1, line.size());
    } else {
      while (k < line.size() && kBlanks.find(line[k]) == std::string_view::npos && line[k] != ';' && line[k] != '!' &&
             line[k] != '&') {
        // A label such as S'front' or L'A' is one word.
        if (line[k] == '\'' || line[k] == '"') {
          const std::size_t end = std::min(line.find(line[k], k + 1), line.size());
          word += line.substr(k, end - k);
          k = std::min(end + 1, line.size());
          continue;
        }
        word += line[k++];
      }
    }
    if (words_.size() < kMaxWords) words_.push_back(std::move(word));
    return k;
  }

  void finish() {
    if (words_.empty() || commands_.size() >= kMaxSeqCommands) return words_.clear();
    SeqCommand command;
    command.line = line_;
    command.first = words_.front();
    const std::string first = capitals(command.first);
    const bool surface = seq_surface_name(first).is;
    command.name = surface ? std::string("S") : first.substr(0, kLongestName);
    command.words.assign(words_.begin() + (surface ? 0 : 1), words_.end());
    commands_.push_back(std::move(command));
    words_.clear();
  }

  std::vector<SeqCommand> commands_;
  std::vector<std::string> words_;
  int line_ = 0;
};

}  // namespace

std::vector<SeqCommand> seq_commands(std::string_view text) { return Splitter().split(text); }

std::string capitals(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return out;
}

SeqSurfaceName seq_surface_name(std::string_view word) {
  if (word.size() < 2 || (word[0] != 'S' && word[0] != 's')) return {};
  const std::string rest = capitals(word.substr(1));
  if (rest == "O") return {true, 0};
  if (rest == "I") return {true, kSeqImage};
  int index = 0;
  const auto [end, code] = std::from_chars(rest.data(), rest.data() + rest.size(), index);
  if (code != std::errc{} || end != rest.data() + rest.size() || index < 0) return {};
  return {true, index};
}

}  // namespace contrejour::inline internal
