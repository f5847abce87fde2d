// SPDX-License-Identifier: Apache-2.0
#include "render/planning/error_bound.h"

#include <string>

namespace contrejour::inline internal {
namespace {

constexpr double kLowestError = 1e-4, kHighestError = 0.1;

}  // namespace

Result<void> check_error_bound(double error) {
  if (error >= kLowestError && error <= kHighestError) return {};
  return failure(ErrorCode::InvalidArgument,
                 "an error of " + std::to_string(error) + " is out of range; choose 0.0001 to 0.1");
}

}  // namespace contrejour::inline internal
