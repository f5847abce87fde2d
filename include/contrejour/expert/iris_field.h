// SPDX-License-Identifier: Apache-2.0
// A picture as the opening of the aperture stop: a signed distance field over the stop plane, the same opening as
// convex pieces, and its transmittance. The picture is upright as the photographer sees the stop. Its longer side spans
// the stop's diameter, the rim cuts its corners off, and outside it no light passes. Units: stop radii. A picture of
// black and white whose edges are drawn smoothly is a mask: open where it is at least half as bright as at its
// brightest. A picture with half-tones has at each point the transmittance of its level over the brightest; it is then
// open where it is brighter than 1/256.
// Accuracy: the edge lies where the picture, interpolated, crosses its level, to a fifth of a sample (2 / samples());
// pieces to kTolerance more. Thread-safety: constant after it is made. docs/physics/diffraction.md.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/expert/iris.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

inline namespace internal {
class HalfTones;
}

// Part of an opening: a rectangle clipped by up to two half-planes.
struct IrisPiece {
  Vec2 low, high;
  std::array<IrisBound, 2> cut;
  int cuts = 0;
  double open = 1.0;  // transmittance; less than 1 where finer details were not requested
};

class CONTREJOUR_API IrisField {
 public:
  static constexpr double kTolerance = 3e-4;  // stop radii, distance between a piece's edge and the field's

  // level: of width x height pixels, rows from the top, linear light.
  // Errors: no pixels, levels that are negative or not finite, pictures that let nothing through.
  [[nodiscard]] static Result<std::shared_ptr<const IrisField>> from_levels(std::span<const float> level, int width,
                                                                            int height);

  // Signed distance from the edge, negative inside, bilinear between samples; inside a lower bound, exact near edges.
  [[nodiscard]] double distance(Vec2 p) const;
  // Integral of the transmittance over the rim's circle: pi when all is open.
  [[nodiscard]] double area() const { return area_; }
  [[nodiscard]] bool has_half_tones() const { return half_tones_ != nullptr; }
  // Transmittance, 0 to 1, as the mean over an upright square about p. Half-tones are bilinear between samples and
  // continue beyond the rim, also in means of squares that the rim crosses, because whoever draws clips at the rim.
  // Without half-tones: 1 where distance() <= 0 and else 0, whatever the width.
  [[nodiscard]] double transmittance(Vec2 p, double width = 0.0) const;
  [[nodiscard]] const std::vector<IrisBound>& hull() const { return hull_; }  // half-planes that contain the opening
  [[nodiscard]] int samples() const { return side_ - 2; }  // across the stop's diameter

  // Calls visit(const IrisPiece&) for the pieces that may overlap a box; pieces do not overlap one another. Regions no
  // larger than `detail` come as rectangles with the fraction of their area that is open; edges may be off by a quarter
  // of it.
  template <class Visit>
  void for_each_piece(Vec2 low, Vec2 high, double detail, const Visit& visit) const {
    visit_node(nodes_[0], low, high, detail, visit);
  }

 private:
  friend class IrisFieldBuilder;

  static constexpr double kCoarseEdge = 0.25;  // largest error of an edge, as a fraction of `detail`

  // A node of a tree of rectangles, each divided into at most four.
  struct Node {
    Vec2 low, high;
    double open_area = 0;
    std::int32_t first = 0;  // of pieces_ if a leaf, else of nodes_
    std::int32_t count = 0;
    std::int32_t coarse = 0;  // of pieces_: one piece with a straight edge in place of all
    double coarse_error = std::numeric_limits<double>::infinity();
    bool leaf = true;
  };

  template <class Visit>
  void visit_node(const Node& node, Vec2 low, Vec2 high, double detail, const Visit& visit) const {
    if (!(node.open_area > 0.0) || node.low.x > high.x || node.low.y > high.y || node.high.x < low.x ||
        node.high.y < low.y)
      return;
    const Vec2 size = node.high - node.low;
    if (!node.leaf && size.x <= detail && size.y <= detail) {
      visit(IrisPiece{node.low, node.high, {}, 0, node.open_area / (size.x * size.y)});
      return;
    }
    if (!node.leaf && node.coarse_error <= kCoarseEdge * detail)
      return visit(pieces_[static_cast<std::size_t>(node.coarse)]);
    for (std::int32_t k = node.first; k < node.first + node.count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (node.leaf)
        visit(pieces_[at]);
      else
        visit_node(nodes_[at], low, high, detail, visit);
    }
  }

  double area_ = 0.0;
  std::shared_ptr<const HalfTones> half_tones_;
  int side_ = 0;  // samples of the field along a side: the picture's, and one more at each end
  std::vector<float> field_;  // [row from below * side_ + column]
  std::vector<Node> nodes_;  // the root first
  std::vector<IrisPiece> pieces_;
  std::vector<IrisBound> hull_;
};

}  // namespace contrejour
