// SPDX-License-Identifier: Apache-2.0
#include "cli/long_task.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include "cli/interrupt.h"
#include "cli/terminal.h"

namespace contrejour::cli {
namespace {

constexpr int kBarCells = 30;
constexpr auto kFirstDelay = std::chrono::milliseconds(400);  // quick tasks show no bar
constexpr auto kRedrawInterval = std::chrono::milliseconds(100);

}  // namespace

Context without_progress(Context context) {
  context.progress = {};
  return context;
}

LongTask::LongTask(std::string label, int threads)
    : label_(std::move(label)), started_(std::chrono::steady_clock::now()), drawn_(started_) {
  context_.threads = threads;
  context_.cancel = &interrupt_flag();
  if (error_stream_is_terminal()) context_.progress = [this](double done) { draw(done); };
}

LongTask::~LongTask() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void LongTask::draw(double done) {
  const auto now = std::chrono::steady_clock::now();
  if (now - started_ < kFirstDelay || now - drawn_ < kRedrawInterval) return;
  drawn_ = now;
  shown_ = true;
  done = std::clamp(done, 0.0, 1.0);
  const int full = static_cast<int>(done * kBarCells);
  std::string bar(static_cast<std::size_t>(full), '#');
  bar.resize(kBarCells, '.');
  const double seconds = std::chrono::duration<double>(now - started_).count();
  const std::string left = done > 0.02 ? fmt::format(", {:.0f} s left", seconds * (1.0 - done) / done) : "";
  const std::string line = fmt::format("\r{} [{}] {:3.0f} %{}\033[K", label_, bar, 100.0 * done, left);
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace contrejour::cli
