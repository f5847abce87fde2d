// SPDX-License-Identifier: Apache-2.0
// The rendering methods by name: which there are, their traits and their default options.
// Errors: InvalidArgument. Thread-safety: pure functions.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "contrejour/export.h"
#include "contrejour/method_options.h"
#include "contrejour/result.h"

namespace contrejour {

// Properties of a method, for code that would otherwise compare its name.
struct MethodTraits {
  bool is_exact = false;  // converges to the true flare as its density rises: the reference for the others
  bool is_slow = false;  // takes minutes where others take seconds
  bool integrates_pixels = true;  // a pixel is the integral of its light; false: it is sampled at its middle
  bool spends_error =
      false;  // distributes its allowed error over the frame: a ghost's error differs from frame to frame
};

[[nodiscard]] CONTREJOUR_API std::vector<std::string_view> render_methods();  // the default first
[[nodiscard]] CONTREJOUR_API std::optional<MethodTraits> method_traits(
    std::string_view method);  // nullopt: there is no such method

// The method's default options. Errors: there is no such method.
[[nodiscard]] CONTREJOUR_API Result<MethodOptions> method_options(std::string_view method);

}  // namespace contrejour
