// A look at a text before toml++ parses it. toml++ 3.3 is not made for hostile files: some it meets with a stack as
// deep as the file is long, some with undefined behaviour. All of them are refused here, none of them a lens.
// Each rule was found by the fuzz harness lens_toml, which holds this to be enough.
#pragma once

#include <optional>
#include <string_view>

namespace contrejour {

struct TomlFault {
  int line = 0;
  std::string_view message;
};

[[nodiscard]] std::optional<TomlFault> find_toml_fault(std::string_view text);

}  // namespace contrejour
