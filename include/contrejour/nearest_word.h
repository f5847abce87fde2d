// The nearest of some words to one that was not understood, for "did you mean".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace contrejour::params {

// Empty if none is near: more than a third of the letters, and more than two, differ.
[[nodiscard]] std::string nearest_word(std::string_view word, const std::vector<std::string>& words);

}  // namespace contrejour::params
