// SPDX-License-Identifier: Apache-2.0
// The renderers of a sequence, one for each of the frames that a device draws at once.
// Thread-safety: create() from one thread; use() from as many at a time as there are renderers.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "cli/frame_lens.h"

namespace contrejour::cli {

class FrameRenderers {
 public:
  // in_flight: how many there are if a device draws the frames; there is one for the CPU and for a measured flare.
  [[nodiscard]] static Result<FrameRenderers> create(const FrameLens& lens, const params::Values& values,
                                                     int in_flight);

  [[nodiscard]] int count() const { return count_; }

  // Calls a function with a renderer that no other thread uses meanwhile.
  template <class Draw>
  auto use(Draw draw) {
    const Turn turn(*this);
    return draw(*turn.renderer);
  }

 private:
  struct Turn {
    explicit Turn(FrameRenderers& of) : all(of), renderer(of.take()) {}
    ~Turn() { all.give_back(std::move(renderer)); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

    FrameRenderers& all;
    std::unique_ptr<FrameRenderer> renderer;
  };

  FrameRenderers() = default;
  void add(FrameRenderer renderer);
  [[nodiscard]] std::unique_ptr<FrameRenderer> take();
  void give_back(std::unique_ptr<FrameRenderer> renderer);

  int count_ = 0;
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();
  std::vector<std::unique_ptr<FrameRenderer>> free_;
};

}  // namespace contrejour::cli
