// SPDX-License-Identifier: Apache-2.0
// Runs a compute shader once, on the first device that computes.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace contrejour::test {

// The storage buffer at set 0, binding 0, which holds `values` at first, after one workgroup of the shader's `main`.
// None where there is no device. The file holds SPIR-V.
[[nodiscard]] std::optional<std::vector<float>> run_shader(const std::string& spirv_file,
                                                           const std::vector<float>& values);

}  // namespace contrejour::test
