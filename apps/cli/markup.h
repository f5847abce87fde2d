// SPDX-License-Identifier: Apache-2.0
// Text for HTML and SVG.
#pragma once

#include <string>
#include <string_view>

namespace contrejour::cli {

// The text with the characters escaped that mean something in markup, quotes included, so that it may stand in an
// attribute; control characters, which XML does not allow, become spaces.
[[nodiscard]] std::string markup_text(std::string_view text);

}  // namespace contrejour::cli
