#include "render/adaptive/pupil_boxes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "render/adaptive/extremes.h"

namespace contrejour::adaptive {
namespace {

constexpr int kFirstColumns = 20;     // cells of the first lattice across the window; half as many from y = 0 up
constexpr int kSecondColumns = 64;    // of a second one, where the first meets nothing
constexpr int kDeepest = 14;          // quarterings
constexpr std::size_t kFewCells = 12;
constexpr std::size_t kMostCells = 1500;
constexpr double kTight = 0.4;         // share of the cells with an open corner at which boxes fit well enough
// How many times its variation over a cell what blocks may be below its lowest corner.
constexpr float kFirstReach = 4.0F;
constexpr float kReach = 1.0F;
// Rays closer than this at the entrance are searched in double: float places them to about 2e-6 mm.
constexpr double kFloatStep_mm = 1e-3;

// A cell of the lattice of some depth: [column, column + 1) x [row, row + 1) cells, rows from y = 0 up.
struct Cell {
  int column = 0, row = 0;
};

// What blocks a ray, <= 0 where it passes: rims together, then each crossing of the stop.
struct Blocking {
  std::array<float, 1 + kMaxStopCrossings> value{};
  bool failed = false;
};

class Search {
 public:
  Search(const OpticalPath& path, const ReflectanceTables& tables, const LightFrame& light,
         const EntranceWindow& window)
      : path_(path), tables_(tables), direction_(light.direction), window_(window),
        half_height_mm_(std::max(std::abs(window.min_mm.y), window.max_mm.y)) {}

  PupilBoxes run() {
    start(kFirstColumns, kFirstReach);
    if (cells_.empty()) start(kSecondColumns, kReach);
    if (cells_.size() <= kFewCells) add_neighbours();
    refine(0);
    return {std::move(boxes_), rays_};
  }

 private:
  [[nodiscard]] Vec2 cell_size() const {
    return {(window_.max_mm.x - window_.min_mm.x) / columns_, half_height_mm_ / (columns_ / 2)};
  }

  // Quarters cells until those that are left hold mostly open ones; what falls apart goes on piece by piece.
  void refine(int depth) {
    while (!cells_.empty() && depth < kDeepest && cells_.size() < kMostCells) {
      quarter();
      ++depth;
      if (static_cast<double>(open_) >= kTight * static_cast<double>(cells_.size())) break;
      const auto pieces = connected();
      if (pieces.size() < 2) continue;
      const int columns = columns_;
      for (const auto& piece : pieces) {
        cells_ = piece;
        columns_ = columns;
        refine(depth);
      }
      return;
    }
    for (const auto& piece : connected()) add_box(piece);
  }

  // All cells of a lattice that may let light through.
  void start(int columns, float reach) {
    columns_ = columns;
    x_mm_.clear();
    y_mm_.clear();
    const Vec2 size = cell_size();
    for (int row = 0; row <= columns / 2; ++row) {
      for (int column = 0; column <= columns; ++column) {
        x_mm_.push_back(static_cast<float>(column * size.x));
        y_mm_.push_back(static_cast<float>(row * size.y));
      }
    }
    trace();
    cells_.clear();
    for (int row = 0; row < columns / 2; ++row) {
      for (int column = 0; column < columns; ++column) {
        const auto at = [&](int c, int r) { return static_cast<std::size_t>(r * (columns + 1) + c); };
        if (may_pass({at(column, row), at(column + 1, row), at(column, row + 1), at(column + 1, row + 1)}, reach)) {
          cells_.push_back({column, row});
        }
      }
    }
  }

  // A pupil of about a cell's size may reach into cells whose corners are far from it.
  void add_neighbours() {
    std::set<std::pair<int, int>> all;
    for (const Cell& cell : cells_) {
      for (int k = 0; k < 9; ++k) {
        const int column = cell.column + k % 3 - 1;
        const int row = std::max(cell.row + k / 3 - 1, 0);
        if (column >= 0 && column < columns_ && row < columns_ / 2) all.emplace(row, column);
      }
    }
    cells_.clear();
    for (const auto& [row, column] : all) cells_.push_back({column, row});
  }

  // Each cell by nine rays, shared with its neighbours, into four, of which those stay that may let light through.
  void quarter() {
    columns_ *= 2;
    std::vector<std::uint64_t> places;
    const auto place = [](const Cell& cell, int k) {
      return static_cast<std::uint64_t>(2 * cell.row + k / 3) << 32U |
             static_cast<std::uint32_t>(2 * cell.column + k % 3);
    };
    for (const Cell& cell : cells_) {
      for (int k = 0; k < 9; ++k) places.push_back(place(cell, k));
    }
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    x_mm_.clear();
    y_mm_.clear();
    const Vec2 size = cell_size();
    for (const std::uint64_t p : places) {
      x_mm_.push_back(static_cast<float>(static_cast<double>(p & 0xFFFFFFFFU) * size.x));
      y_mm_.push_back(static_cast<float>(static_cast<double>(p >> 32U) * size.y));
    }
    trace();
    std::vector<Cell> kept;
    open_ = 0;
    for (const Cell& cell : cells_) {
      std::array<std::size_t, 9> ray{};
      for (int row = 0; row < 3; ++row) {  // the three of a row are neighbours
        const auto first = std::lower_bound(places.begin(), places.end(), place(cell, 3 * row)) - places.begin();
        for (int k = 0; k < 3; ++k) ray[static_cast<std::size_t>(3 * row + k)] = static_cast<std::size_t>(first + k);
      }
      for (int k = 0; k < 4; ++k) {
        const auto at = static_cast<std::size_t>(k % 2 + 3 * (k / 2));
        const std::array<std::size_t, 4> corners{ray[at], ray[at + 1], ray[at + 3], ray[at + 4]};
        if (!may_pass(corners, kReach)) continue;
        if (std::any_of(corners.begin(), corners.end(), [&](std::size_t v) { return is_open(v); })) ++open_;
        kept.push_back({2 * cell.column + k % 2, 2 * cell.row + k / 2});
      }
    }
    cells_.swap(kept);
  }

  void trace() {
    const std::size_t count = x_mm_.size();
    rays_ += count;
    constexpr std::size_t kFields = 4 + 2 * kMaxStopCrossings;
    results_.resize(kFields * count);
    const auto field = [&](std::size_t k) { return results_.data() + k * count; };
    const TracedArrays out{
        field(0), field(1), field(2), field(3), {field(4), field(5), field(6)}, {field(7), field(8), field(9)},
        nullptr,  0};
    const Vec2 size = cell_size();
    const PacketPath packets(path_, tables_, {{window_.min_mm.x, 0.0, window_.z_mm}, direction_});
    trace_packets(packets, std::min(size.x, size.y) < kFloatStep_mm ? PacketPrecision::Double : PacketPrecision::Float,
                  x_mm_.data(), y_mm_.data(), count, out);
    blocking_.assign(count, {});
    for (std::size_t k = 0; k < count; ++k) {
      Blocking& b = blocking_[k];
      b.failed = std::isinf(out.r_rel[k]);
      b.value[0] = out.r_rel[k] - 1.0F;
      for (std::size_t c = 0; c < static_cast<std::size_t>(path_.stop_crossings); ++c) {
        b.value[1 + c] = std::hypot(out.stop_x[c][k], out.stop_y[c][k]) - 1.0F;
      }
    }
  }

  [[nodiscard]] bool is_open(std::size_t ray) const {
    const Blocking& b = blocking_[ray];
    return !b.failed && std::all_of(b.value.begin(), b.value.end(), [](float v) { return v <= 0.0F; });
  }

  // A failed corner tells nothing: the others decide.
  [[nodiscard]] bool may_pass(const std::array<std::size_t, 4>& corners, float reach) const {
    std::array<Extremes, 1 + kMaxStopCrossings> extremes;
    bool any = false;
    const auto limits = 1 + static_cast<std::size_t>(path_.stop_crossings);
    for (const std::size_t k : corners) {
      if (blocking_[k].failed) continue;
      any = true;
      for (std::size_t l = 0; l < limits; ++l) extremes[l].add(blocking_[k].value[l]);
    }
    for (std::size_t l = 0; l < limits; ++l) any = any && extremes[l].may_pass(reach);
    return any;
  }

  // Cells that touch, corners included, belong together.
  [[nodiscard]] std::vector<std::vector<Cell>> connected() const {
    std::map<std::pair<int, int>, std::size_t> index;
    for (std::size_t k = 0; k < cells_.size(); ++k) index[{cells_[k].row, cells_[k].column}] = k;
    std::vector<std::size_t> parent(cells_.size());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::size_t k) {
      while (parent[k] != k) k = parent[k] = parent[parent[k]];
      return k;
    };
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      for (const auto& [dr, dc] : {std::pair{0, 1}, std::pair{1, -1}, std::pair{1, 0}, std::pair{1, 1}}) {
        const auto near = index.find({cells_[k].row + dr, cells_[k].column + dc});
        if (near != index.end()) parent[std::max(root(k), root(near->second))] = std::min(root(k), root(near->second));
      }
    }
    std::map<std::size_t, std::vector<Cell>> by_root;
    for (std::size_t k = 0; k < cells_.size(); ++k) by_root[root(k)].push_back(cells_[k]);
    std::vector<std::vector<Cell>> out;
    for (auto& [key, cells] : by_root) out.push_back(std::move(cells));
    return out;
  }

  void add_box(const std::vector<Cell>& cells) {
    const Vec2 size = cell_size();
    Cell low = cells.front();
    Cell high = low;
    for (const Cell& c : cells) {
      low = {std::min(low.column, c.column), std::min(low.row, c.row)};
      high = {std::max(high.column, c.column), std::max(high.row, c.row)};
    }
    const double x0 = window_.min_mm.x + low.column * size.x;
    const double x1 = window_.min_mm.x + (high.column + 1) * size.x;
    const double y0 = low.row * size.y;
    const double y1 = (high.row + 1) * size.y;
    if (low.row == 0) {
      boxes_.push_back({{x0, -y1}, {x1, y1}});
    } else {
      boxes_.push_back({{x0, y0}, {x1, y1}});
      boxes_.push_back({{x0, -y1}, {x1, -y0}});
    }
  }

  const OpticalPath& path_;
  const ReflectanceTables& tables_;
  Vec3 direction_;
  EntranceWindow window_;
  double half_height_mm_;
  int columns_ = 0;
  std::vector<Cell> cells_;
  std::size_t open_ = 0;  // of them with a corner whose ray passes
  std::vector<float> x_mm_, y_mm_, results_;
  std::vector<Blocking> blocking_;
  std::vector<Rectangle> boxes_;
  std::uint64_t rays_ = 0;
};

}  // namespace

PupilBoxes find_pupil_boxes(const OpticalPath& path, const ReflectanceTables& tables, const LightFrame& light,
                            const EntranceWindow& window) {
  return Search(path, tables, light, window).run();
}

}  // namespace contrejour::adaptive
