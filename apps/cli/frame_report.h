// SPDX-License-Identifier: Apache-2.0
// The report on a sequence: a line for each frame, and each warning once.
// Thread-safety: one thread at a time.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "cli/console.h"

namespace contrejour::cli {

class FrameReport {
 public:
  // json: lines of JSON instead of text.
  explicit FrameReport(bool json) : json_(json) {}

  void warn(const std::vector<std::string>& warnings);

  // Rendered: a frame that frame_json() and frame_text() describe.
  template <class Rendered>
  void add(int frame, const Rendered& rendered) {
    if (!json_) return print_summary(frame_text(rendered));
    Json line = {{"frame", frame}};
    line.update(frame_json(rendered));
    print(json_line(line));
  }

 private:
  bool json_;
  std::set<std::string> warned_;
};

}  // namespace contrejour::cli
