// SPDX-License-Identifier: Apache-2.0
#include "cli/frame_report.h"

namespace contrejour::cli {

void FrameReport::warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings)
    if (warned_.insert(warning).second) print_warnings({warning});
}

}  // namespace contrejour::cli
