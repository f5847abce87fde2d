// SPDX-License-Identifier: Apache-2.0
// A task that takes a while: its threads, its cancelling by Ctrl-C, and a progress bar on a terminal.
#pragma once

#include <chrono>
#include <string>

#include "contrejour/context.h"

namespace contrejour::cli {

// The same without a report: for the short steps within a longer one.
[[nodiscard]] Context without_progress(Context context);

class LongTask {
 public:
  // label: the text of the bar, e.g. "rendering". There is no bar if the standard error is not a terminal.
  LongTask(std::string label, int threads);
  ~LongTask();  // wipes the bar
  LongTask(const LongTask&) = delete;
  LongTask& operator=(const LongTask&) = delete;

  [[nodiscard]] const Context& context() const { return context_; }

 private:
  void draw(double done);

  std::string label_;
  Context context_;
  std::chrono::steady_clock::time_point started_;
  std::chrono::steady_clock::time_point drawn_;
  bool shown_ = false;
};

}  // namespace contrejour::cli
