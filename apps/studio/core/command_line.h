// SPDX-License-Identifier: Apache-2.0
// The command lines that make a document's picture, for a shell. Thread-safety: pure.
#pragma once

#include <string>

#include "studio/core/document.h"

namespace contrejour::studio {

// `contrejour render --session FILE -o flare.exr`, of a session that was saved.
[[nodiscard]] std::string command_of_session(const std::string& file, const std::string& output);

// Every value as an option; empty for a document whose lens was edited, which only a session holds.
[[nodiscard]] std::string command_of_values(const Document& document, const std::string& output);

}  // namespace contrejour::studio
