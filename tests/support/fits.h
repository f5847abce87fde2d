// SPDX-License-Identifier: Apache-2.0
// Fits of ghosts that the frames of a test program share: without them `polynomial` would fit them for each frame.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <variant>
#include <vector>

#include "contrejour/expert/check_lens.h"
#include "contrejour/expert/polynomial.h"
#include "contrejour/render.h"

namespace contrejour::test {

// The first of the ghosts that a frame may draw; the others are traced. In few zones and of a low order, so that it
// takes little time.
inline std::shared_ptr<const LensPolynomials> shared_fit(const LensState& lens, const FrameSettings& settings) {
  if (!check_lens(lens)) return nullptr;
  constexpr std::size_t kMostGhosts = 30;
  static std::map<std::pair<std::uint64_t, std::vector<Ghost>>, std::shared_ptr<const LensPolynomials>> kept;
  PolynomialOptions options{.max_order = 9, .max_halvings = 1};
  options.asymmetric = false;  // test_asymmetric.cpp tests these
  const auto* const list = std::get_if<SelectList>(&settings.selection);
  options.ghosts = list != nullptr ? list->ghosts : enumerate_ghosts(lens, settings.scope);
  if (options.ghosts.size() > kMostGhosts) options.ghosts.resize(kMostGhosts);
  std::shared_ptr<const LensPolynomials>& fit = kept[{polynomial_fingerprint(lens), options.ghosts}];
  if (fit || options.ghosts.empty()) return fit;
  auto made = fit_polynomials(lens, options);
  if (made) fit = std::make_shared<const LensPolynomials>(std::move(*made));
  return fit;  // null: the renderer says what is wrong
}

}  // namespace contrejour::test
