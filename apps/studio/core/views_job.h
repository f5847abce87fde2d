// SPDX-License-Identifier: Apache-2.0
// The displays and views that the OpenColorIO configuration offers ($OCIO, or the built-in one), read in the
// background: a configuration may take a second. Thread-safety: as of LatestJob.
#pragma once

#include <string>
#include <vector>

#include "contrejour/expert/colour_view.h"
#include "studio/core/latest_job.h"

namespace contrejour::studio {

struct ViewsOrder {};

struct ViewsAnswer {
  std::string config;  // the file; empty: the built-in one
  std::vector<ColourDisplay> displays;
  std::string error;
};

using ViewsJob = LatestJob<ViewsOrder, ViewsAnswer>;
[[nodiscard]] ViewsJob::Work views_work();

}  // namespace contrejour::studio
