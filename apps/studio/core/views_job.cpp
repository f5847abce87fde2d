// SPDX-License-Identifier: Apache-2.0
#include "studio/core/views_job.h"

#include <utility>

#include "contrejour/expert/plate.h"

namespace contrejour::studio {

ViewsJob::Work views_work() {
  return [](const ViewsOrder&, ViewsJob::Control& control) {
    ViewsAnswer answer{colour_config({}), {}, {}};
    auto displays = colour_displays(answer.config);
    if (displays)
      answer.displays = std::move(*displays);
    else
      answer.error = displays.error().to_string();
    control.publish(std::move(answer));
  };
}

}  // namespace contrejour::studio
