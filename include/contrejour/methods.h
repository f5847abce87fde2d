// The rendering methods by name: which there are, their traits and their default options.
// Errors: InvalidArgument. Thread-safety: pure functions.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "contrejour/method_options.h"
#include "contrejour/result.h"

namespace contrejour {

// Properties of a method, for code that would otherwise compare its name.
struct MethodTraits {
  bool is_exact = false;  // converges to the true flare as its density rises: the others are judged by it
  bool is_slow = false;  // takes minutes where others take seconds
  bool integrates_pixels = true;  // a pixel holds all the light that falls on it; false: it is sampled at its middle
  bool spends_error =
      false;  // spreads the error that it is allowed over the frame: a ghost's own differs from frame to frame
};

[[nodiscard]] std::vector<std::string_view> render_methods();  // the default first
[[nodiscard]] std::optional<MethodTraits> method_traits(std::string_view method);  // none: there is no such method

// The method's default options. Errors: there is no such method.
[[nodiscard]] Result<MethodOptions> method_options(std::string_view method);

}  // namespace contrejour
