// SPDX-License-Identifier: Apache-2.0
// Pictures from published polynomials: the causes of the thesis's wrong one, switched on one by one, and splatted
// points beside cells.
#pragma once

#include <string>

#include "contrejour/context.h"
#include "contrejour/result.h"

namespace contrejour::cli {

struct PolynomialPictureOptions {
  std::string folder;  // for EXR and PNG files
  bool full = false;  // more points
  int threads = 0;
};

// Writes each picture, and two with all of them side by side: `two-lenses`, sabatschus2022's figure 5.11 step by step,
// and `heliar`, its code's faults with a real lens. Returns a table of how far each is from the traced picture.
[[nodiscard]] Result<std::string> draw_polynomial_pictures(const PolynomialPictureOptions& options,
                                                           const Context& context);

// Times of splatted points, traced and from a polynomial, and of cells, and their PSNR against the finest splatting.
[[nodiscard]] Result<std::string> compare_density(const PolynomialPictureOptions& options, const Context& context);

}  // namespace contrejour::cli
