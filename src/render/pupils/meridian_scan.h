// SPDX-License-Identifier: Apache-2.0
// Scans rays along the line y = 0 of the entrance plane, refined where light may get through or where rays begin to
// fail, for small pupils among failing rays, which a grid misses. Nearly all small pupils lie on this line, since the
// lens is symmetric about it.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "ghosts/ray_grid.h"
#include "render/pupils/clearance_rays.h"

namespace contrejour::inline internal::pupils {

struct Interval {
  double low = 0, high = 0;  // x, mm
};

class MeridianScan {
 public:
  // path: from any point of the entrance plane.
  explicit MeridianScan(PacketPath path) : rays_(std::move(path)) {}

  // The parts of the line through which light may pass and that no box covers.
  [[nodiscard]] std::vector<Interval> find(Interval line, std::span<const Rectangle> boxes);

  [[nodiscard]] std::uint64_t rays() const { return rays_.rays(); }

 private:
  struct Node {
    double x_mm = 0;
    float failing = 0, passed = 0;
    std::array<float, 1 + kMaxStopCrossings> point{};  // x at the largest relative height, then at the stop
  };
  void trace(const std::vector<double>& x_mm);
  [[nodiscard]] bool may_transmit(std::size_t k) const;
  [[nodiscard]] bool may_hide_light(std::size_t k) const;
  [[nodiscard]] bool is_open(const Node& node) const;
  static void subdivide(Interval i, std::vector<double>& x_mm);
  [[nodiscard]] bool may_end(std::size_t least_failing, std::ptrdiff_t step) const;
  [[nodiscard]] bool refine_near_light(std::vector<double>& x_mm) const;

  ClearanceRays rays_;
  std::vector<Node> nodes_;  // by rising x
};

}  // namespace contrejour::inline internal::pupils
