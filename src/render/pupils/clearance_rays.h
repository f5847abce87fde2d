// SPDX-License-Identifier: Apache-2.0
// Rays through points of the entrance plane and their clearances: whether each fails, and where it passes the stop and
// the rim that it comes closest to. The iris counts as its circumscribed circle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "contrejour/expert/trace.h"
#include "render/pupils/ray_source.h"

namespace contrejour::inline internal::pupils {

class ClearanceRays {
 public:
  // Fields of a ray: of kRim and, from kStop on, of every crossing of the stop, x and y over the radius.
  static constexpr std::size_t kFailing = 0, kPassed = 1, kRim = 2, kStop = 4, kFields = kStop + 2 * kMaxStopCrossings;

  // path: from any point of the entrance plane.
  explicit ClearanceRays(PacketPath path) : source_(std::make_shared<TracedRays>(std::move(path))) {}
  explicit ClearanceRays(std::shared_ptr<RaySource> source) : source_(std::move(source)) {}

  // Makes room for the starts of this number of rays, all at the origin.
  void resize(std::size_t count);
  // The starts, relative to the origin, in mm.
  [[nodiscard]] std::span<float> x_mm() { return {x_mm_.data(), count_}; }
  [[nodiscard]] std::span<float> y_mm() { return {y_mm_.data(), count_}; }
  void trace(Vec2 origin_mm, PacketPrecision precision);

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] int crossings() const { return source_->stop_crossings(); }
  [[nodiscard]] std::size_t steps() const { return source_->surfaces(); }
  [[nodiscard]] std::uint64_t rays() const { return rays_; }  // traced so far
  [[nodiscard]] const float* field(std::size_t k) const { return fields_.data() + k * padded_; }
  [[nodiscard]] bool fails(std::size_t ray) const { return field(kFailing)[ray] != 0.0F; }
  // The point at the rim (0) or at a crossing of the stop (1 and up), over the radius.
  [[nodiscard]] std::array<float, 2> in_circle(std::size_t circle, std::size_t ray) const {
    return {field(kRim + 2 * circle)[ray], field(kRim + 2 * circle + 1)[ray]};
  }

 private:
  std::shared_ptr<RaySource> source_;  // which copies share
  std::size_t count_ = 0, padded_ = 0;
  std::uint64_t rays_ = 0;
  std::vector<float> x_mm_, y_mm_, fields_;
};

}  // namespace contrejour::inline internal::pupils
