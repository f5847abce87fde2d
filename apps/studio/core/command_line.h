// SPDX-License-Identifier: Apache-2.0
// The command lines that make a document's picture, for a shell. Thread-safety: pure.
#pragma once

#include <string>

#include "studio/core/exports.h"

namespace contrejour::studio {

struct CommandChoice {
  ExportKind kind = ExportKind::Picture;
  std::string output = "flare.exr";
  LayersBy layers_by = LayersBy::Part;
  int first = 1, last = 1;  // of the frames
  int frame = 1;  // the one at hand, of a plate that is a sequence
  bool skips_missing = false;  // frames that such a plate has not
};

// `contrejour render --session FILE -o flare.exr`, of a session that was saved; `apply` where it has a plate. Empty for
// what no command makes (the report).
[[nodiscard]] std::string command_of_session(const Document& document, const std::string& file,
                                             const CommandChoice& choice);

// Every value as an option; empty for a document whose lens was edited, or that has keys, which only a session holds,
// and for frames that are all alike.
[[nodiscard]] std::string command_of_values(const Document& document, const CommandChoice& choice);

}  // namespace contrejour::studio
