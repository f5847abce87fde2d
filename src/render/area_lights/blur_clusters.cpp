// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/blur_clusters.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace contrejour::inline internal::area {
namespace {

constexpr double kSharpFraction = 0.1;  // of the error that a separate image may save: error of leaving a blur out
constexpr double kPicture_px = 60000.0;  // pixels whose cost equals the constant cost of an image
constexpr double kPixelsCost = 0.3;  // cost of an image in the frame's pixels, relative to the allowed error

struct Group {
  bool is_sharp = false;
  int level = 0;
  std::size_t seed = 0;  // its brightest ghost,
  LinearMap map = kZeroMap;  // and that ghost's map in pixels of the frame, with which all are drawn
  std::size_t spot = 0;  // for a negative level
  std::vector<std::size_t> ghosts;
};

// The cost of an image at this level over that of an image at the frame's own resolution.
double cost_of(int level, const Frame& frame) {
  const double px = static_cast<double>(frame.width) * frame.height;
  return (std::exp2(-2 * std::max(level, 0)) * px + kPicture_px) / (px + kPicture_px);
}

class Grouping {
 public:
  Grouping(const LightPiece& piece, const Frame& frame, double peak, double allowed_squares)
      : piece_(piece), frame_(frame), peak_(peak), allowed_(allowed_squares) {}

  void add(std::size_t index, const PieceGhost& one) {
    const double own = map_error(*one.blur, one.blur->px, piece_, peak_);
    Group* group = group_for(one, as_drawn(*one.blur, piece_), own);
    if (group == nullptr) {
      const bool is_sharp = map_error(*one.blur, kZeroMap, piece_, peak_) - own <= kSharpFraction * allowed_;
      group = &groups.emplace_back(Group{is_sharp, is_sharp ? 0 : one.level, index, one.blur->px, one.spot, {}});
    } else
      squares += cheapest_;
    group->ghosts.push_back(index);
  }

  std::vector<Group> groups;
  double squares = 0.0;

 private:
  // The group in which a ghost costs least: in error, and in work, which grows with the number of a level's pixels.
  // Null where every group makes more error than a separate image may save. Sums of errors end where they exceed what
  // would still be cheapest: nearly all groups differ from a ghost by far more.
  Group* group_for(const PieceGhost& one, const GhostBlur& drawn, double own) {
    Group* best = nullptr;
    double cheapest = std::numeric_limits<double>::infinity();
    const double limit = allowed_ * cost_of(one.level, frame_);
    const BlurredGhost ghost = one.blur->over(peak_);
    for (Group& group : groups) {
      const bool is_window = group.level < 0 || one.level < 0;
      if (is_window && (group.level != one.level || group.spot != one.spot)) continue;
      const double coarse =
          group.level > one.level ? level_error(ghost, group.level) + spot_error(ghost, group.level) : 0.0;
      const double pixels_cost = kPixelsCost * std::exp2(-2 * std::max(group.level, 0));
      const double enough = std::min(limit, (cheapest - pixels_cost) * allowed_) - coarse;
      if (!(enough >= 0.0)) continue;
      const LinearMap& map = group.is_sharp ? kZeroMap : group.map;
      // A ghost that its own map fits badly may fit another's as well, but changes visibly between the two.
      const double enough_of_one = enough / one.overlapping,
                   change = map_error(drawn, map, piece_, peak_, enough_of_one);
      if (change > enough_of_one) continue;
      const double error =
          std::max(map_error(*one.blur, map, piece_, peak_, own + enough_of_one) - own, change) * one.overlapping +
          coarse;
      const double cost = error / allowed_ + pixels_cost;
      if (!(error <= limit && cost < cheapest)) continue;
      cheapest = cost;
      cheapest_ = error;
      best = &group;
    }
    return best;
  }

  const LightPiece& piece_;
  const Frame& frame_;
  double peak_, allowed_;
  double cheapest_ = 0.0;
};

}  // namespace

BlurClusters blur_clusters(std::span<const PieceGhost> ghosts, const LightPiece& piece, const Frame& frame, double peak,
                           double allowed_squares) {
  std::vector<std::size_t> by_level(ghosts.size());
  std::iota(by_level.begin(), by_level.end(), std::size_t{0});
  std::ranges::stable_sort(by_level, std::greater(), [&](std::size_t k) { return ghosts[k].blur->level; });
  Grouping grouping(piece, frame, peak, allowed_squares);
  for (const std::size_t k : by_level) grouping.add(k, ghosts[k]);

  BlurClusters out;
  out.squares = grouping.squares;
  for (Group& group : grouping.groups) {
    BlurCluster made;
    made.is_sharp = group.is_sharp;
    made.level = group.level;
    made.px_from_tangents = group.map * std::exp2(-made.level);
    made.seed = group.seed;
    std::sort(group.ghosts.begin(), group.ghosts.end());
    made.light_fractions.assign(group.ghosts.size(), 1.0);
    made.ghosts = std::move(group.ghosts);
    out.clusters.push_back(std::move(made));
  }
  return out;
}

namespace {

// Adds a part of a cluster's light to another cluster with the same blur.
void add_light(BlurCluster& to, const BlurCluster& from, double part) {
  std::map<std::size_t, double> fractions;
  for (std::size_t k = 0; k < to.ghosts.size(); ++k) fractions[to.ghosts[k]] = to.light_fractions[k];
  for (std::size_t k = 0; k < from.ghosts.size(); ++k) fractions[from.ghosts[k]] += part * from.light_fractions[k];
  to.ghosts.clear();
  to.light_fractions.clear();
  for (const auto& [ghost, fraction] : fractions) {
    to.ghosts.push_back(ghost);
    to.light_fractions.push_back(fraction);
  }
}

bool are_alike(const BlurCluster& a, const BlurCluster& b) {
  return a.is_sharp && b.is_sharp ? true : a.is_sharp == b.is_sharp && a.seed == b.seed;
}

}  // namespace

BlurClusters mean_of(const BlurClusters& first, const BlurClusters& second, double part) {
  if (!(part > 0.0)) return first;
  if (!(part < 1.0)) return second;
  BlurClusters out;
  out.squares = std::lerp(first.squares, second.squares, part);
  for (const auto& [from, times] : {std::pair(&first, 1.0 - part), std::pair(&second, part)}) {
    for (const BlurCluster& cluster : from->clusters) {
      auto to = std::ranges::find_if(out.clusters, [&](const BlurCluster& one) { return are_alike(one, cluster); });
      if (to == out.clusters.end()) {
        to = out.clusters.insert(to, cluster);
        to->ghosts.clear();
        to->light_fractions.clear();
      }
      add_light(*to, cluster, times);
    }
  }
  return out;
}

}  // namespace contrejour::inline internal::area
