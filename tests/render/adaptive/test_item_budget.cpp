// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <doctest/doctest.h>

#include "render/adaptive/budget/item_budget.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::adaptive;

TEST_CASE("negligible items are drawn in preview quality as long as all of it is a small part of the error") {
  std::vector<ItemEstimate> sizes(5);
  const auto size = [](double level, double area_px) {
    ItemEstimate s;
    s.level = level, s.area_px = area_px;
    return s;
  };
  sizes[0] = size(1e-6, 100.0);
  sizes[1] = size(1e-6, 1e10);    // dim, but with much light
  sizes[2] = size(1e-3, 1.0);     // bright
  sizes[3] = size(2e-5, 100.0);
  sizes[4] = size(0.0, 0.0);      // no light was found
  CHECK(negligible_items(sizes, {0.003, 1.0, 1e4}) == std::vector<bool>{true, false, false, true, false});
}

TEST_CASE("errors above the peak count less, but not those of a ghost of a few pixels") {
  const ErrorBudget frame{1.0, 2.0, {}};
  const auto peak = [&](double level, double area_px) {
    ItemEstimate estimate;
    estimate.level = level, estimate.area_px = area_px;
    return budget_of(estimate, false, false, frame).peak;
  };
  CHECK(peak(60.0, 1.0) == test::approx(60.0).epsilon(0.01));
  CHECK(peak(60.0, 16.0) == test::approx(30.0));
  CHECK(peak(60.0, 400.0) == 2.0);
  CHECK(peak(1.0, 1.0) == 2.0);
  CHECK(peak(0.0, 0.0) == 2.0);  // the preview shows nothing of it
}
