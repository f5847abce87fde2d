// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/pupil_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "base/tasks.h"
#include "ghosts/meridian.h"

namespace contrejour::inline internal::pupils {
namespace {

constexpr int kFirstAngles = 5;  // searched over the whole window
constexpr int kMaxDepth = 6;     // bisections of the interval between two of them
// An interval is bisected if linear interpolation misses the middle by more than this fraction of the region's size.
constexpr double kMaxInterpolationError = 0.1;
// Margin on all sides for nonlinearity within an interval: the search's own cells add about as much again.
constexpr double kMarginFraction = 0.05;
// Margin around an interpolated region in which the next is searched, over its size.
constexpr double kGuessMargin = 0.3;
// Ends of an interval whose sizes differ by less are taken for the same part of the pupil, which moves.
constexpr double kAlikeSizes = 1.3;
// A grid over the window finds a pupil that spans this number of its cells.
constexpr double kCellsToFind = 2.0;

Vec2 size_of(const Rectangle& r) { return r.high - r.low; }

Rectangle widened(const Rectangle& r, Vec2 by) { return {r.low - by, r.high + by}; }

Rectangle between(const Rectangle& a, const Rectangle& b, double t) {
  return {a.low + (b.low - a.low) * t, a.high + (b.high - a.high) * t};
}

void add(std::optional<PupilRegion>& sum, const std::optional<PupilRegion>& region) {
  if (!region) return;
  if (!sum) {
    sum = region;
  } else {
    sum->pupil_mm = both(sum->pupil_mm, region->pupil_mm);
    sum->sensor_mm = both(sum->sensor_mm, region->sensor_mm);
  }
}

struct AtWavelength {
  OpticalPath path;
  const ReflectanceTables* tables;
};

// Builds the intervals of one ghost.
class EntryBuilder {
 public:
  EntryBuilder(const LensState& lens, std::vector<AtWavelength> paths, double largest_angle_rad, const Context& context)
      : lens_(lens), paths_(std::move(paths)), largest_angle_rad_(largest_angle_rad), context_(context) {}

  [[nodiscard]] PupilBounds::Entry build() {
    std::vector<Node> nodes = first_nodes(PupilEffort::Finer);
    search_again(nodes);
    for (std::size_t k = 1; k < nodes.size(); ++k) lay(nodes[k - 1], nodes[k], 0);
    return std::move(entry_);
  }

 private:
  struct Node {
    double angle_rad = 0;
    std::optional<PupilRegion> region;
  };

  [[nodiscard]] std::vector<Node> first_nodes(PupilEffort effort) {
    std::vector<Node> nodes;
    for (int k = 0; k < kFirstAngles; ++k) {
      nodes.push_back(search(largest_angle_rad_ * k / (kFirstAngles - 1), std::nullopt, effort));
    }
    return nodes;
  }

  // Repeats the search where no pupil was found although those at other angles are small enough to be missed by the
  // grid, or were not found either.
  void search_again(std::vector<Node>& nodes) {
    std::optional<PupilEffort> needed;
    for (const Node& node : nodes) {
      if (node.region) needed = std::max(needed.value_or(PupilEffort::Once), effort_for(node));
    }
    if (needed.value_or(PupilEffort::Finest) != PupilEffort::Finest) return;
    for (Node& node : nodes) {
      if (!node.region) node = search(node.angle_rad, std::nullopt, PupilEffort::Finest);
    }
  }

  // The effort that finds a pupil of the node's size in the whole window.
  [[nodiscard]] PupilEffort effort_for(const Node& node) const {
    if (!node.region) return PupilEffort::Once;
    const Vec2 size = size_of(node.region->pupil_mm);
    const double window_mm = 2.0 * lens_.surfaces.front().semi_diameter_mm;
    const double cells_needed = kCellsToFind * window_mm / std::min(size.x, size.y);
    for (const PupilEffort effort : {PupilEffort::Once, PupilEffort::Finer}) {
      if (cells_needed < first_grid_side(effort)) return effort;
    }
    return PupilEffort::Finest;
  }

  [[nodiscard]] Node search(double angle_rad, const std::optional<Rectangle>& guess, PupilEffort effort) {
    const Vec3 direction{std::sin(angle_rad), 0.0, std::cos(angle_rad)};
    const EntranceWindow window = entrance_window(lens_, direction);
    Node node{angle_rad, std::nullopt};
    for (const AtWavelength& at : paths_) {
      if (context_.cancelled()) break;  // a ghost's intervals take tenths of a second, and are then not used
      PupilRays rays(at.path, *at.tables, direction, circle_, window);
      std::optional<PupilRegion> region;
      if (guess) region = region_of(find_pupil(rays, {.hint = *guess}, scratch_));
      if (!region) region = region_of(find_pupil(rays, {.effort = effort}, scratch_));
      count_rays(region, at.path);
      add(node.region, region);
    }
    if (node.region) make_symmetric(node.region->pupil_mm);
    return node;
  }

  void count_rays(const std::optional<PupilRegion>& region, const OpticalPath& path) {
    const std::uint64_t rays = region ? region->rays : 0;
    entry_.rays += rays;
    entry_.surface_hits += rays * path.steps.size();
  }

  static void make_symmetric(Rectangle& r) {
    r.high.y = std::max(std::abs(r.low.y), std::abs(r.high.y));
    r.low.y = -r.high.y;
  }

  // The region in which the middle of an interval is searched. If the ends differ in size, part of the pupil may close
  // between them, so the region contains both.
  static std::optional<Rectangle> guess_between(const Node& a, const Node& b) {
    if (!a.region && !b.region) return std::nullopt;
    const Rectangle& from = a.region ? a.region->pupil_mm : b.region->pupil_mm;
    const Rectangle& to = b.region ? b.region->pupil_mm : a.region->pupil_mm;
    const auto alike = [](double p, double q) { return p < kAlikeSizes * q && q < kAlikeSizes * p; };
    const Vec2 size = size_of(from);
    const bool moves = alike(size.x, size_of(to).x) && alike(size.y, size_of(to).y);
    const Rectangle middle = moves ? between(from, to, 0.5) : both(from, to);
    return widened(middle, size_of(middle) * kGuessMargin);
  }

  // Adds intervals from a to b, bisected until linear interpolation is accurate, or the angle at which the pupil closes
  // is known well enough.
  void lay(const Node& a, const Node& b, int depth) {
    const Node middle =
        search(0.5 * (a.angle_rad + b.angle_rad), guess_between(a, b), std::max(effort_for(a), effort_for(b)));
    const bool all = a.region && middle.region && b.region;
    const bool none = !a.region && !middle.region && !b.region;
    if (all) {
      const Vec2 size = size_of(middle.region->pupil_mm);
      const Rectangle line = between(a.region->pupil_mm, b.region->pupil_mm, 0.5);
      const Vec2 curve = farthest_apart(line, middle.region->pupil_mm);
      if (curve.x <= kMaxInterpolationError * size.x && curve.y <= kMaxInterpolationError * size.y) {
        push(a, middle, curve + size * kMarginFraction);
        push(middle, b, curve + size * kMarginFraction);
        return;
      }
    }
    if (none || depth == kMaxDepth) {
      push_unsteady(a, middle);
      push_unsteady(middle, b);
    } else {
      lay(a, middle, depth + 1);
      lay(middle, b, depth + 1);
    }
  }

  // The largest distance between corresponding edges.
  static Vec2 farthest_apart(const Rectangle& a, const Rectangle& b) {
    const Vec2 low = a.low - b.low;
    const Vec2 high = a.high - b.high;
    return {std::max(std::abs(low.x), std::abs(high.x)), std::max(std::abs(low.y), std::abs(high.y))};
  }

  void push(const Node& a, const Node& b, Vec2 margin_mm) {
    entry_.stretches.push_back({a.angle_rad, b.angle_rad, a.region, b.region, margin_mm});
  }

  // Adds an interval in which all or part of the pupil closes, with a region that contains both ends.
  void push_unsteady(const Node& a, const Node& b) {
    const auto& known = a.region ? a.region : b.region;
    Vec2 margin_mm = known ? size_of(known->pupil_mm) : Vec2{};
    if (a.region && b.region) {
      margin_mm = farthest_apart(a.region->pupil_mm, b.region->pupil_mm) + margin_mm * kMarginFraction;
    }
    push(a, b, margin_mm);
  }

  const LensState& lens_;
  std::vector<AtWavelength> paths_;
  double largest_angle_rad_;
  const Context& context_;
  IrisShape circle_{Iris{}};
  RayGrid scratch_;
  PupilBounds::Entry entry_;
};

}  // namespace

PupilBounds::PupilBounds(const LensState& lens, const PupilBoundsRange& range, const Context& context) {
  Context quiet = context;
  quiet.progress = {};
  std::vector<std::unique_ptr<const ReflectanceTables>> tables(range.lambda_nm.size());
  parallel_for(tables.size(), quiet,
               [&](std::size_t k) { tables[k] = std::make_unique<const ReflectanceTables>(lens, range.lambda_nm[k]); });
  std::vector<Entry> built(range.ghosts.size());
  const bool done = parallel_for(built.size(), quiet, [&](std::size_t g) {
    std::vector<AtWavelength> paths;
    for (std::size_t k = 0; k < tables.size(); ++k) {
      paths.push_back({ghost_path(lens, range.ghosts[g], range.lambda_nm[k]), tables[k].get()});
    }
    built[g] = EntryBuilder(lens, std::move(paths), range.largest_angle_rad, context).build();
  });
  for (std::size_t g = 0; done && g < built.size(); ++g) entries_[range.ghosts[g]] = std::move(built[g]);
}

std::optional<PupilRegion> PupilBounds::find(Ghost ghost, double angle_rad) const {
  const auto entry = entries_.find(ghost);
  if (entry == entries_.end() || entry->second.stretches.empty()) return std::nullopt;
  const auto& all = entry->second.stretches;
  const auto after = std::upper_bound(all.begin(), all.end() - 1, angle_rad,
                                      [](double angle, const Stretch& s) { return angle < s.to_rad; });
  const Stretch& s = *after;
  if (!s.at_from && !s.at_to) return std::nullopt;
  PupilRegion region = s.at_from ? *s.at_from : *s.at_to;
  region.rays = 0;
  if (s.at_from && s.at_to) {
    const double width = s.to_rad - s.from_rad;
    const double t = width > 0.0 ? std::clamp((angle_rad - s.from_rad) / width, 0.0, 1.0) : 0.0;
    region.pupil_mm = between(s.at_from->pupil_mm, s.at_to->pupil_mm, t);
    region.sensor_mm = between(s.at_from->sensor_mm, s.at_to->sensor_mm, t);
  }
  region.pupil_mm = widened(region.pupil_mm, s.margin_mm);
  return region;
}

std::uint64_t PupilBounds::rays() const {
  std::uint64_t sum = 0;
  for (const auto& [ghost, entry] : entries_) sum += entry.rays;
  return sum;
}

std::uint64_t PupilBounds::surface_hits() const {
  std::uint64_t sum = 0;
  for (const auto& [ghost, entry] : entries_) sum += entry.surface_hits;
  return sum;
}

Result<ZoomPupilBounds> ZoomPupilBounds::build(const Prescription& lens, const Settings& settings,
                                               const PupilBoundsRange& range, const Context& context) {
  ZoomPupilBounds table;
  std::vector<std::optional<double>> zooms(settings.focal_length_mm.begin(), settings.focal_length_mm.end());
  if (zooms.empty()) zooms.emplace_back();
  for (const auto& focal_length_mm : zooms) {
    auto& row = table.by_zoom_.emplace_back();
    for (const double f_number : settings.f_number) {
      LensSettings set = settings.others;
      set.focal_length_mm = focal_length_mm;
      set.f_number = f_number;
      const auto state = configure_lens(lens, set);
      if (!state) return tl::unexpected<Error>(state.error());
      row.push_back({state->focal_length_mm, state->stop_radius_mm, PupilBounds(*state, range, context)});
      if (context.cancelled()) return interrupted();
    }
  }
  return table;
}

namespace {

// The entries on either side of a value; beyond an end the same entry twice.
template <class Row, class Below>
std::array<std::size_t, 2> neighbours(const Row& row, Below below) {
  const auto after = std::find_if_not(row.begin(), row.end(), below);
  const auto high = static_cast<std::size_t>(after - row.begin());
  return {high == 0 ? 0 : high - 1, std::min(high, row.size() - 1)};
}

}  // namespace

std::optional<PupilRegion> ZoomPupilBounds::find(const LensState& lens, Ghost ghost, double angle_rad) const {
  std::optional<PupilRegion> region;
  if (by_zoom_.empty()) return region;
  const auto shorter = [&](const std::vector<Node>& row) { return row.front().focal_length_mm < lens.focal_length_mm; };
  const auto wider = [&](const Node& node) { return node.stop_radius_mm > lens.stop_radius_mm; };
  for (const std::size_t z : neighbours(by_zoom_, shorter)) {
    for (const std::size_t s : neighbours(by_zoom_[z], wider))
      add(region, by_zoom_[z][s].bounds.find(ghost, angle_rad));
  }
  return region;
}

}  // namespace contrejour::inline internal::pupils
