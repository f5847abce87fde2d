// SPDX-License-Identifier: Apache-2.0
// The surfaces and first-order properties of a lens as text and as JSON. Thread-safety: pure functions.
#pragma once

#include <string>
#include <vector>

#include "cli/console.h"
#include "contrejour/expert/first_order.h"
#include "contrejour/expert/seidel.h"
#include "contrejour/lens.h"

namespace contrejour::cli {

struct LensInfo {
  Prescription lens;
  LensState state;
  FirstOrder figures;
  double lambda_nm = 0;
  std::vector<SeidelSums> seidel;  // by surface
};

[[nodiscard]] std::string info_text(const LensInfo& info);
[[nodiscard]] std::string seidel_text(const LensInfo& info);  // a table by surface, with a heading
[[nodiscard]] Json info_json(const LensInfo& info);

// The words for parts of a surface.
[[nodiscard]] std::string glass_name(const Glass& glass);  // "N-BK7", "n_d 1.51680" for a glass without a name, "air"
[[nodiscard]] std::string shape_name(double curvature_per_mm, const SurfaceShape& shape);  // "" for a sphere
[[nodiscard]] const char* kind_name(ApertureKind kind);
[[nodiscard]] const char* kind_name(SurfaceKind kind);

// The distance along the axis from surface k, 0-based, to the next surface or the sensor.
[[nodiscard]] double thickness_mm(const LensState& lens, std::size_t k);

}  // namespace contrejour::cli
