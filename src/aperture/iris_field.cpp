// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/iris_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "aperture/half_tones.h"
#include "aperture/iris_samples.h"

namespace contrejour {
namespace {

constexpr float kEdge = 0.5F;       // of the brightest: the level of an antialiased edge
constexpr double kNearEdge = 2.0;   // samples: beyond, only the sign counts
constexpr double kMinSlope = 0.5;  // of a field whose edge may be straight: a distance's is 1
constexpr int kHullEdges = 24;
constexpr double kFar = std::numeric_limits<double>::infinity();

using Polygon = std::vector<Vec2>;

Polygon open_part(const IrisPiece& piece) {
  Polygon polygon{piece.low, {piece.high.x, piece.low.y}, piece.high, {piece.low.x, piece.high.y}};
  for (int c = 0; c < piece.cuts; ++c) {
    const IrisBound& cut = piece.cut[static_cast<std::size_t>(c)];
    Polygon kept;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vec2 a = polygon[k];
      const Vec2 b = polygon[(k + 1) % polygon.size()];
      const double fa = cut.distance(a);
      const double fb = cut.distance(b);
      if (fa <= 0.0) kept.push_back(a);
      if ((fa <= 0.0) != (fb <= 0.0)) kept.push_back(a + (b - a) * (fa / (fa - fb)));
    }
    polygon = std::move(kept);
  }
  return polygon;
}

double area_of(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t k = 2; k < polygon.size(); ++k) twice += cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]);
  return 0.5 * std::abs(twice);
}

// The half-plane beyond the line through a and b, on the side of `inner`; none if a and b are one point.
bool half_plane(Vec2 a, Vec2 b, Vec2 inner, IrisBound& out) {
  const double size = length(b - a);
  if (!(size > 0.0)) return false;
  out.normal = Vec2{b.y - a.y, a.x - b.x} * (1.0 / size);
  if (dot(out.normal, inner - a) > 0.0) out.normal = out.normal * -1.0;
  out.apothem = dot(out.normal, a);
  return true;
}

}  // namespace

// Builds the tree from the field: rectangles of cells are split until each is closed, open, or has a straight edge.
class IrisFieldBuilder {
 public:
  // half_tones: null where there are none.
  IrisFieldBuilder(StopSamples distances, std::shared_ptr<const HalfTones> half_tones)
      : side_(distances.side), pitch_(2.0 / (distances.side - 2)) {
    field_.side_ = side_;
    field_.field_ = std::move(distances.value);
    for (int j = 0; j < side_; ++j)
      for (int i = 0; i < side_; ++i) {
        float& v = field_.field_[at(i, j)];
        v = static_cast<float>(std::max(v * pitch_, length(position(i, j)) - 1.0));
      }
    int size = 1;
    while (size < side_ - 1) size *= 2;
    field_.nodes_.emplace_back();
    fill(0, 0, 0, size);
    field_.area_ = half_tones ? half_tones->flux() : field_.nodes_[0].open_area;
    field_.half_tones_ = std::move(half_tones);
    find_hull();
  }

  [[nodiscard]] IrisField take() { return std::move(field_); }

 private:
  [[nodiscard]] std::size_t at(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(i);
  }
  [[nodiscard]] Vec2 position(int i, int j) const { return {(i - 0.5) * pitch_ - 1.0, (j - 0.5) * pitch_ - 1.0}; }
  [[nodiscard]] double value(int i, int j) const { return field_.field_[at(i, j)]; }

  // Cells i0 to i1 - 1 and j0 to j1 - 1.
  struct Cells {
    int i0, j0, i1, j1;
  };

  template <class Visit>
  void for_each_sample(const Cells& c, const Visit& visit) const {
    for (int j = c.j0; j <= c.j1; ++j)
      for (int i = c.i0; i <= c.i1; ++i) visit(i, j, value(i, j));
  }

  // Fills node `index` with the cells from (i, j) on, `size` a side.
  void fill(std::size_t index, int i, int j, int size) {
    const Cells cells{i, j, std::min(i + size, side_ - 1), std::min(j + size, side_ - 1)};
    IrisField::Node node{position(cells.i0, cells.j0), position(cells.i1, cells.j1)};
    double lowest = kFar;
    double highest = -kFar;
    for_each_sample(cells, [&](int, int, double v) {
      lowest = std::min(lowest, v);
      highest = std::max(highest, v);
    });
    node.first = static_cast<std::int32_t>(field_.pieces_.size());
    IrisPiece whole{node.low, node.high, {}, 0, 1.0};
    if (highest <= 0.0) {
      add(whole, node);
    } else if (lowest <= 0.0 && size == 1) {
      add_cell(cells, whole, node);
    } else if (lowest <= 0.0) {
      const StraightEdge edge = straight_edge(cells, whole);
      if (edge.error <= IrisField::kTolerance)
        add(edge.piece, node);
      else
        split(node, i, j, size, edge);
    }
    field_.nodes_[index] = node;
  }

  struct StraightEdge {
    IrisPiece piece;
    double error = kFar;
  };

  void split(IrisField::Node& node, int i, int j, int size, const StraightEdge& instead) {
    node.leaf = false;
    if (instead.error < kFar) {
      node.coarse = static_cast<std::int32_t>(field_.pieces_.size());
      node.coarse_error = instead.error;
      field_.pieces_.push_back(instead.piece);
    }
    node.first = static_cast<std::int32_t>(field_.nodes_.size());
    const int half = size / 2;
    std::vector<Vec2> begins;
    for (const int dj : {0, half})
      for (const int di : {0, half})
        if (i + di < side_ - 1 && j + dj < side_ - 1)
          begins.push_back({static_cast<double>(i + di), static_cast<double>(j + dj)});
    node.count = static_cast<std::int32_t>(begins.size());
    field_.nodes_.resize(field_.nodes_.size() + begins.size());
    for (std::size_t k = 0; k < begins.size(); ++k) {
      const std::size_t child = static_cast<std::size_t>(node.first) + k;
      fill(child, static_cast<int>(begins[k].x), static_cast<int>(begins[k].y), half);
      node.open_area += field_.nodes_[child].open_area;
    }
  }

  void add(const IrisPiece& piece, IrisField::Node& node) {
    const double area = area_of(open_part(piece));
    if (!(area > 0.0)) return;
    node.open_area += area;
    ++node.count;
    field_.pieces_.push_back(piece);
  }

  // One line in place of the edge, and its error: an upper bound of the distance from the edge of all points on the
  // wrong side of the line.
  [[nodiscard]] StraightEdge straight_edge(const Cells& c, const IrisPiece& whole) const {
    StraightEdge edge{whole};
    const Vec2 size = whole.high - whole.low;
    Vec2 gradient;
    double mean = 0.0;
    const double rows = c.j1 - c.j0 + 1, columns = c.i1 - c.i0 + 1;
    for (int j = c.j0; j <= c.j1; ++j) gradient.x += (value(c.i1, j) - value(c.i0, j)) / (size.x * rows);
    for (int i = c.i0; i <= c.i1; ++i) gradient.y += (value(i, c.j1) - value(i, c.j0)) / (size.y * columns);
    for_each_sample(c, [&](int, int, double v) { mean += v / (rows * columns); });
    const double slope = length(gradient);
    if (!(slope > kMinSlope)) return edge;
    const Vec2 middle = (whole.low + whole.high) * 0.5;
    IrisBound line{gradient * (1.0 / slope), 0.0, {}};
    line.apothem = dot(line.normal, middle) - mean / slope;
    edge.error = 0.0;
    for_each_sample(c, [&](int i, int j, double v) {
      const double d = line.distance(position(i, j));
      if ((d > 0.0) != (v > 0.0)) edge.error = std::max(edge.error, std::abs(v));
      if (std::abs(v) < kNearEdge * pitch_) edge.error = std::max(edge.error, std::abs(d - v));
    });
    edge.piece.cut[0] = line;
    edge.piece.cuts = 1;
    return edge;
  }

  // Within one cell of the field the edge is straight to a small fraction of the cell.
  void add_cell(const Cells& cell, const IrisPiece& whole, IrisField::Node& node) {
    const std::array<Vec2, 4> corner{whole.low, {whole.high.x, whole.low.y}, whole.high, {whole.low.x, whole.high.y}};
    const std::array<double, 4> v{value(cell.i0, cell.j0), value(cell.i1, cell.j0), value(cell.i1, cell.j1),
                                  value(cell.i0, cell.j1)};
    const auto open = [&](std::size_t k) { return v[k % 4] <= 0.0; };
    const auto crossing = [&](std::size_t k) {  // between corners k and k + 1
      const std::size_t a = k % 4, b = (k + 1) % 4;
      return corner[a] + (corner[b] - corner[a]) * (v[a] / (v[a] - v[b]));
    };
    const int count = open(0) + open(1) + open(2) + open(3);
    const bool opposite = count == 2 && open(0) == open(2);
    if (opposite && v[0] + v[1] + v[2] + v[3] > 0.0) {  // two opposite corners
      for (std::size_t k = 0; k < 4; ++k) {
        IrisPiece piece = whole;
        if (!open(k) || !half_plane(crossing(k + 3), crossing(k), corner[k], piece.cut[0])) continue;
        piece.cuts = 1;
        add(piece, node);
      }
      return;
    }
    IrisPiece piece = whole;
    if (count == 1 || (count == 2 && !opposite)) {
      std::size_t first = 0;  // the first of the open corners, counter-clockwise
      while (!open(first) || open(first + 3)) ++first;
      const std::size_t last = count == 1 ? first : first + 1;
      if (!half_plane(crossing(first + 3), crossing(last), corner[first], piece.cut[0])) return;
      piece.cuts = 1;
    } else {  // the closed corners are clipped
      for (std::size_t k = 0; k < 4; ++k)
        if (!open(k) && half_plane(crossing(k + 3), crossing(k), corner[(k + 2) % 4],
                                   piece.cut[static_cast<std::size_t>(piece.cuts)]))
          ++piece.cuts;
    }
    add(piece, node);
  }

  void find_hull() {
    for (int k = 0; k < kHullEdges; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kHullEdges;
      field_.hull_.push_back({{std::cos(angle), std::sin(angle)}, -kFar, {}});
    }
    field_.for_each_piece({-2.0, -2.0}, {2.0, 2.0}, 0.0, [&](const IrisPiece& piece) {
      for (const Vec2 p : open_part(piece))
        for (IrisBound& bound : field_.hull_) bound.apothem = std::max(bound.apothem, dot(bound.normal, p));
    });
    for (IrisBound& bound : field_.hull_) bound.apothem += IrisField::kTolerance;
  }

  int side_;
  double pitch_;
  IrisField field_;
};

Result<std::shared_ptr<const IrisField>> IrisField::from_levels(std::span<const float> level, int width, int height) {
  const auto refused = [](const std::string& what) { return failure(ErrorCode::InvalidArgument, what); };
  const std::size_t count =
      static_cast<std::size_t>(std::max(width, 0)) * static_cast<std::size_t>(std::max(height, 0));
  if (count == 0 || level.size() != count) return refused("the picture of the iris is empty");
  float highest = 0.0F;
  for (std::size_t k = 0; k < count; ++k) {
    if (!(level[k] >= 0.0F) || !std::isfinite(level[k]))
      return refused(fmt::format("the picture of the iris has the value {} at {},{}; values are 0 and more", level[k],
                                 k % static_cast<std::size_t>(width), k / static_cast<std::size_t>(width)));
    highest = std::max(highest, level[k]);
  }
  if (!(highest > 0.0F))
    return refused("the picture of the iris is black: nothing would pass; draw what is open white");
  const StopSamples samples = samples_over_stop(level, width, height);
  std::shared_ptr<const HalfTones> half_tones;
  const bool is_averaged = samples.side - 2 < std::max(width, height);
  if (is_averaged ? contains_half_tones(samples.value, samples.side, samples.side, highest)
                  : contains_half_tones(level, width, height, highest))
    half_tones = std::make_shared<const HalfTones>(samples, highest);
  IrisFieldBuilder maker(distances_from_level(samples, (half_tones ? HalfTones::kDark : kEdge) * highest), half_tones);
  auto field = std::make_shared<const IrisField>(maker.take());
  if (!(field->area() > 0.0))
    return refused("the picture of the iris leaves nothing open within the stop's circle, or too fine to see");
  return field;
}

double IrisField::transmittance(Vec2 p, double width) const {
  if (half_tones_) return half_tones_->mean(p, width);
  return distance(p) <= 0.0 ? 1.0 : 0.0;
}

double IrisField::distance(Vec2 p) const {
  const double scale = 0.5 * samples();
  const double last = side_ - 1;
  const double u = (p.x + 1.0) * scale + 0.5;
  const double v = (p.y + 1.0) * scale + 0.5;
  const double x = std::fmin(std::fmax(u, 0.0), last);  // 0 for a NaN
  const double y = std::fmin(std::fmax(v, 0.0), last);
  const int i = std::min(static_cast<int>(x), side_ - 2);
  const int j = std::min(static_cast<int>(y), side_ - 2);
  const float* row = field_.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(side_) + i;
  const double below = std::lerp(static_cast<double>(row[0]), static_cast<double>(row[1]), x - i);
  const double above = std::lerp(static_cast<double>(row[side_]), static_cast<double>(row[side_ + 1]), x - i);
  const double inside = std::lerp(below, above, y - j);
  return u == x && v == y ? inside : inside + length(Vec2{u - x, v - y}) / scale;
}

}  // namespace contrejour
