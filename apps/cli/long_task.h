// Work that takes a while: its threads, its end by Ctrl-C, and a bar on a terminal that shows how far it is.
#pragma once

#include <chrono>
#include <string>

#include "contrejour/context.h"

namespace contrejour::cli {

class LongTask {
 public:
  // label: what the bar says, e.g. "rendering". No bar where the standard error is no terminal.
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
