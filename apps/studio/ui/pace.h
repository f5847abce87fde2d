// SPDX-License-Identifier: Apache-2.0
// How quickly the window answers: the time that each frame of the interface took, and the time from an input to the
// first picture of its effect on the window. Thread-safety: the thread of the interface.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

namespace contrejour::studio {

class Pace {
 public:
  // Times in seconds of one clock.
  void frame(double from_s, double to_s);
  // An input at that time made this revision of the document.
  void changed(std::uint64_t revision, double input_s);
  // A picture of this revision is on the window.
  void shown(std::uint64_t revision, double now_s);
  void clear();

  struct Summary {
    std::size_t frames = 0, pictures = 0;
    double frame_p50_ms = 0, frame_p99_ms = 0, frame_max_ms = 0;
    double latency_p50_ms = 0, latency_p99_ms = 0;
    double pictures_per_s = 0;  // from the first to the last
  };
  [[nodiscard]] Summary summary() const;

 private:
  struct Change {
    std::uint64_t revision = 0;
    double input_s = 0;
  };
  std::vector<double> frames_ms_, latencies_ms_;
  std::deque<Change> changes_;
  double first_picture_s_ = 0, last_picture_s_ = 0;
};

}  // namespace contrejour::studio
