// SPDX-License-Identifier: Apache-2.0
// Polynomials of a lens's direct image on the command line.
#pragma once

#include <string>

#include "contrejour/expert/direct_polynomials.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/result.h"

namespace contrejour::cli {

struct DirectFitRequest {
  std::string lens, output;
  int max_order = DirectFitOptions{}.max_order, threads = 0;
  bool json = false;
};
[[nodiscard]] Result<int> run_direct_fit(const DirectFitRequest& request, const params::Values& values);
[[nodiscard]] Result<int> run_direct_info(const std::string& file, bool json);

}  // namespace contrejour::cli
