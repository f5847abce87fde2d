// SPDX-License-Identifier: Apache-2.0
// How quickly the window answers: the time that each frame of the interface took, also that of its thread on a
// processor, which other programs do not lengthen; and the time from an input to the first picture of its effect on the
// window. Thread-safety: the thread of the interface.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

namespace contrejour::studio {

class Pace {
 public:
  // Times in seconds of one clock; processor_s: of the interface's thread during the frame; drawn_part: of the window's
  // pixels.
  void frame(double from_s, double to_s, double processor_s, double drawn_part);
  // An input at that time made this revision of the document.
  void changed(std::uint64_t revision, double input_s);
  // A picture of this revision is on the window.
  void shown(std::uint64_t revision, double now_s);
  void clear();

  struct Summary {
    std::size_t frames = 0, pictures = 0;
    double frame_p50_ms = 0, frame_p99_ms = 0, frame_max_ms = 0;
    double processor_p50_ms = 0, processor_p99_ms = 0;  // of frames
    double drawn_part = 0;  // mean of the frames
    double latency_p50_ms = 0, latency_p99_ms = 0;
    double pictures_per_s = 0;  // from the first to the last
  };
  [[nodiscard]] Summary summary() const;

 private:
  struct Change {
    std::uint64_t revision = 0;
    double input_s = 0;
  };
  std::vector<double> frames_ms_, processor_ms_, drawn_parts_, latencies_ms_;
  std::deque<Change> changes_;
  double first_picture_s_ = 0, last_picture_s_ = 0;
};

// Time of the calling thread on a processor, in seconds; that of the whole program where the system has no such clock.
[[nodiscard]] double processor_time_s();

}  // namespace contrejour::studio
