// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/meridian_scan.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal::pupils {
namespace {

constexpr int kFirstIntervals = 47;
constexpr int kParts = 3;  // parts of an interval that is refined
constexpr int kRounds = 2;
constexpr std::size_t kMaxExamined = 12;  // intervals a round
constexpr float kIntervalMargin = 0.5F;          // of the difference of an interval's ends, beyond them
constexpr int kDeepRounds = 12;         // refinements about rays that fail last, each kParts times finer
constexpr std::size_t kMaxRuns = 3;    // runs of rays that fail last, a round
constexpr double kHopeless = 0.25;      // of the least failing: rays between would still fail by more than this

bool reaches(const Interval& i, std::span<const Rectangle> boxes) {
  return std::any_of(boxes.begin(), boxes.end(), [&](const Rectangle& b) {
    return b.low.y <= 0.0 && b.high.y >= 0.0 && i.low < b.high.x && i.high > b.low.x;
  });
}

}  // namespace

void MeridianScan::trace(const std::vector<double>& x_mm) {
  const std::size_t count = x_mm.size();
  rays_.resize(count);
  const std::span<float> from_first_mm = rays_.x_mm();
  double closest = x_mm.back() - x_mm.front();
  for (std::size_t k = 0; k < count; ++k) {
    from_first_mm[k] = static_cast<float>(x_mm[k] - x_mm.front());
    if (k > 0) closest = std::min(closest, x_mm[k] - x_mm[k - 1]);
  }
  rays_.trace({x_mm.front(), 0.0}, search_precision(closest));
  const std::size_t known = nodes_.size();
  for (std::size_t k = 0; k < count; ++k) {
    Node node{x_mm[k], rays_.field(ClearanceRays::kFailing)[k], rays_.field(ClearanceRays::kPassed)[k], {}};
    for (std::size_t c = 0; c <= static_cast<std::size_t>(rays_.crossings()); ++c)
      node.point[c] = rays_.in_circle(c, k)[0];
    nodes_.push_back(node);
  }
  std::inplace_merge(nodes_.begin(), nodes_.begin() + static_cast<std::ptrdiff_t>(known), nodes_.end(),
                     [](const Node& a, const Node& b) { return a.x_mm < b.x_mm; });
}

bool MeridianScan::is_open(const Node& node) const {
  if (node.failing != 0.0F) return false;
  for (std::size_t c = 0; c < 1 + static_cast<std::size_t>(rays_.crossings()); ++c) {
    if (!(std::abs(node.point[c]) <= 1.0F)) return false;
  }
  return true;
}

// True if light may pass between node k and the next. If one of them fails, the other one must be open.
bool MeridianScan::may_transmit(std::size_t k) const {
  const Node& a = nodes_[k];
  const Node& b = nodes_[k + 1];
  if (a.failing != 0.0F && b.failing != 0.0F) return false;
  if (a.failing != 0.0F) return is_open(b);
  if (b.failing != 0.0F) return is_open(a);
  for (std::size_t c = 0; c < 1 + static_cast<std::size_t>(rays_.crossings()); ++c) {
    const float more = kIntervalMargin * std::abs(a.point[c] - b.point[c]);
    if (std::min(a.point[c], b.point[c]) - more > 1.0F || std::max(a.point[c], b.point[c]) + more < -1.0F) return false;
  }
  return true;
}

// True if rays between node k and the next must be traced to decide.
bool MeridianScan::may_hide_light(std::size_t k) const {
  const Node& a = nodes_[k];
  const Node& b = nodes_[k + 1];
  if (a.failing == 0.0F && b.failing == 0.0F) return may_transmit(k) && !(is_open(a) && is_open(b));
  if (a.failing == 0.0F || b.failing == 0.0F || a.passed != b.passed) return true;
  // Both fail at the same test: a ray between them may pass if `failing` falls fast enough from either side.
  const auto falls_to_zero = [&](const Node& outer, const Node& inner) {
    const double steps = (b.x_mm - a.x_mm) / std::abs(inner.x_mm - outer.x_mm);
    return outer.passed == inner.passed && inner.failing < (outer.failing - inner.failing) * steps;
  };
  return (k > 0 && falls_to_zero(nodes_[k - 1], a)) || (k + 2 < nodes_.size() && falls_to_zero(nodes_[k + 2], b));
}

void MeridianScan::subdivide(Interval i, std::vector<double>& x_mm) {
  for (int p = 1; p < kParts; ++p) x_mm.push_back(i.low + (i.high - i.low) * p / kParts);
}

// True if `failing`, which falls from the preceding node to `least_failing`, may reach 0 beyond it, before the next
// node, which fails at an earlier test; or between the nodes if all three fail at the same test.
bool MeridianScan::may_end(std::size_t least_failing, std::ptrdiff_t step) const {
  const auto at = [&](std::ptrdiff_t by) -> const Node* {
    const std::ptrdiff_t k = static_cast<std::ptrdiff_t>(least_failing) + by;
    const bool exists = k >= 0 && k < static_cast<std::ptrdiff_t>(nodes_.size());
    return exists ? &nodes_[static_cast<std::size_t>(k)] : nullptr;
  };
  const Node &here = *at(0), *const next = at(step), *const before = at(-step);
  if (next == nullptr) return false;
  if (before == nullptr || before->passed != here.passed) return true;  // too few nodes to decide
  const double slope = (here.failing - before->failing) / std::abs(here.x_mm - before->x_mm);
  return here.failing + slope * std::abs(next->x_mm - here.x_mm) < kHopeless * here.failing;
}

// Refines where all rays fail: about those that fail at the last test, where they fail least, since rays that get
// through pass that test as well. False if there is nothing to refine.
bool MeridianScan::refine_near_light(std::vector<double>& x_mm) const {
  const float most_passed = std::ranges::max(nodes_, {}, &Node::passed).passed;
  std::vector<std::size_t> least_failing;  // of each run of nodes at that test, the node that fails least
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    if (nodes_[k].passed != most_passed) continue;
    const bool starts = k == 0 || nodes_[k - 1].passed != most_passed;
    if (starts)
      least_failing.push_back(k);
    else if (nodes_[k].failing < nodes_[least_failing.back()].failing)
      least_failing.back() = k;
  }
  std::ranges::stable_sort(least_failing, {}, [&](std::size_t k) { return nodes_[k].failing; });
  if (least_failing.size() > kMaxRuns) least_failing.resize(kMaxRuns);
  for (const std::size_t k : least_failing) {
    if (k > 0 && may_end(k, -1)) subdivide({nodes_[k - 1].x_mm, nodes_[k].x_mm}, x_mm);
    if (k + 1 < nodes_.size() && may_end(k, 1)) subdivide({nodes_[k].x_mm, nodes_[k + 1].x_mm}, x_mm);
  }
  std::ranges::sort(x_mm);
  const auto [first, last] = std::ranges::unique(x_mm);
  x_mm.erase(first, last);
  return !x_mm.empty();
}

std::vector<Interval> MeridianScan::find(Interval line, std::span<const Rectangle> boxes) {
  std::vector<double> x_mm;
  for (int k = 0; k <= kFirstIntervals; ++k) x_mm.push_back(line.low + (line.high - line.low) * k / kFirstIntervals);
  trace(x_mm);
  for (int round = 0; round < kRounds; ++round) {
    x_mm.clear();
    for (std::size_t k = 0; k + 1 < nodes_.size() && x_mm.size() < kMaxExamined * (kParts - 1); ++k) {
      const Interval i{nodes_[k].x_mm, nodes_[k + 1].x_mm};
      if (!reaches(i, boxes) && may_hide_light(k)) subdivide(i, x_mm);
    }
    if (x_mm.empty()) break;
    trace(x_mm);
  }
  const auto fails = [](const Node& node) { return node.failing != 0.0F; };
  for (int round = 0; boxes.empty() && round < kDeepRounds && std::ranges::all_of(nodes_, fails); ++round) {
    x_mm.clear();
    if (!refine_near_light(x_mm)) break;
    trace(x_mm);
  }
  std::vector<Interval> found;
  for (std::size_t k = 0; k + 1 < nodes_.size(); ++k) {
    const Interval i{nodes_[k].x_mm, nodes_[k + 1].x_mm};
    if (!may_transmit(k) || reaches(i, boxes)) continue;
    if (!found.empty() && found.back().high == i.low) {
      found.back().high = i.high;
    } else {
      found.push_back(i);
    }
  }
  return found;
}

}  // namespace contrejour::inline internal::pupils
