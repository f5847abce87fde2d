// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/emit/shared_edges.h"

#include <algorithm>
#include <bit>
#include <vector>

namespace contrejour::inline internal::adaptive {
namespace {

// An edge of a polygon, directed from a to b. In a neighbour of the same orientation it is directed from b to a.
struct Edge {
  std::uint32_t polygon = 0, corner = 0;
  Point a, b;
  bool turns_left = false;  // its polygon
};

// The most recent edges by their ends. Each slot holds one; a new edge replaces an older one.
class RecentEdges {
 public:
  explicit RecentEdges(std::size_t edges)
      : slots_(std::min(std::bit_ceil(kSlotsPerEdge * std::max<std::size_t>(edges, 1)), kMaxSlots)) {}

  // Returns the kept edge with the same ends and forgets it; if there is none, keeps this edge and returns null.
  [[nodiscard]] const Edge* take_or_keep(const Edge& edge) {
    Slot& slot = slots_[(hash(edge.a) + hash(edge.b)) & (slots_.size() - 1)];
    if (slot.used && same(slot.edge, edge)) {
      slot.used = false;
      return &slot.edge;
    }
    slot = {true, edge};
    return nullptr;
  }

 private:
  static constexpr std::size_t kSlotsPerEdge = 8, kMaxSlots = 4096;  // slots an edge; a power of two
  struct Slot {
    bool used = false;
    Edge edge;
  };
  static std::size_t hash(Point p) {
    return (std::bit_cast<std::uint32_t>(p.x) * 0x9E3779B1U ^ std::bit_cast<std::uint32_t>(p.y) * 0x85EBCA77U) >> 7U;
  }
  // Returns whether the two polygons lie on opposite sides of the edge.
  static bool same(const Edge& e, const Edge& f) {
    const bool along = e.a == f.a && e.b == f.b;
    const bool against = e.a == f.b && e.b == f.a;
    return e.turns_left == f.turns_left ? against : along;
  }
  std::vector<Slot> slots_;
};

bool meets_frame(std::span<const Point> corners, int width, int height) {
  const auto [left, right] = std::ranges::minmax(corners, {}, &Point::x);
  const auto [top, bottom] = std::ranges::minmax(corners, {}, &Point::y);
  return right.x >= 0.0F && bottom.y >= 0.0F && left.x < static_cast<float>(width) &&
         top.y < static_cast<float>(height);
}

}  // namespace

void share_edges(PolygonList& list, int width, int height) {
  list.neighbour.assign(list.corners.size(), PolygonList::kUnshared);
  if (list.polygons.size() < 2) return;
  RecentEdges recent(list.corners.size());
  for (std::size_t p = 0; p < list.polygons.size(); ++p) {
    const Polygon& polygon = list.polygons[p];
    if (polygon.count < 3 || polygon.pattern != 0) continue;
    const std::span<const Point> corners = list.corners_of(polygon);
    if (!meets_frame(corners, width, height)) continue;  // not drawn
    for (std::uint32_t k = 0; k < polygon.count; ++k) {
      const Edge edge{static_cast<std::uint32_t>(p), polygon.first + k, corners[k],
                      corners[k + 1 == polygon.count ? 0 : k + 1], polygon.turns_left != 0};
      const Edge* const other = recent.take_or_keep(edge);
      if (other == nullptr) continue;
      list.neighbour[edge.corner] = PolygonList::kSkipped;
      const bool changes = list.irradiance_of(list.polygons[other->polygon]) != list.irradiance_of(polygon);
      list.neighbour[other->corner] = changes ? edge.polygon : PolygonList::kSkipped;
    }
  }
}

}  // namespace contrejour::inline internal::adaptive
