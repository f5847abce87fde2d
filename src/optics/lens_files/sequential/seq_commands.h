// SPDX-License-Identifier: Apache-2.0
// The text of a CODE V sequence file as commands.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace contrejour::inline internal {

struct SeqCommand {
  int line = 0;
  std::string first;  // as it is written
  std::string name;  // in capitals, its first three letters: TIT, STO; S for SO, S12 and SI, which are then words[0]
  std::vector<std::string> words;  // behind it; quoted ones without their quotes

  [[nodiscard]] std::string_view word(std::size_t k) const {
    return k < words.size() ? std::string_view(words[k]) : std::string_view();
  }
};

// Lines that end with & continue in the next; ! starts a comment; ; separates commands. At most kMaxSeqCommands.
inline constexpr std::size_t kMaxSeqCommands = 50'000;
[[nodiscard]] std::vector<SeqCommand> seq_commands(std::string_view text);

[[nodiscard]] std::string capitals(std::string_view text);

// The surface named by "SO", "S0", "S12" or "SI".
struct SeqSurfaceName {
  bool is = false;
  int index = 0;
};
inline constexpr int kSeqImage = -1;
[[nodiscard]] SeqSurfaceName seq_surface_name(std::string_view word);

}  // namespace contrejour::inline internal
