// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/dirt_fringes.h"

#include <algorithm>
#include <cmath>

#include "base/tasks.h"

namespace contrejour::inline internal::stop_patterns {
namespace {

constexpr double kPlanesPerOctave = 8.0;  // fringes of successive planes differ by 4 per cent
constexpr double kPlaneSpreadStep = 0.004;

double lambda_z_at(int node) { return std::exp2(node / kPlanesPerOctave); }

}  // namespace

DirtFringes::PlaneKey DirtFringes::key_of(const Request& requested) {
  return {static_cast<int>(std::lround(kPlanesPerOctave * std::log2(requested.lambda_z_mm2))),
          static_cast<int>(std::lround(requested.spread / kPlaneSpreadStep))};
}

bool DirtFringes::make(const DirtField& field, std::span<const Request> requested, const Context& context) {
  std::map<PlaneKey, std::shared_ptr<const DirtDiffraction>> missing;
  for (const Request& w : requested) {
    const PlaneKey key = key_of(w);
    if (planes_.contains(key) || !missing.try_emplace(key).second) continue;
    auto& edge = edges_[key.spread];
    if (!edge) edge = std::make_shared<const StraightEdge>(key.spread * kPlaneSpreadStep);
  }
  std::vector<std::pair<const PlaneKey, std::shared_ptr<const DirtDiffraction>>*> list;
  for (auto& entry : missing) list.push_back(&entry);
  const bool done = parallel_for(list.size(), context, [&](std::size_t k) {
    const PlaneKey& key = list[k]->first;
    list[k]->second = std::make_shared<const DirtDiffraction>(field.shapes(), field.extent_mm(), lambda_z_at(key.node),
                                                              edges_.at(key.spread));
  });
  if (!done) return false;
  planes_.merge(missing);
  return true;
}

std::shared_ptr<const DirtDiffraction> DirtFringes::plane(const Request& requested) const {
  const auto found = planes_.find(key_of(requested));
  return found == planes_.end() ? nullptr : found->second;
}

std::size_t DirtFringes::memory_bytes() const {
  std::size_t sum = 0;
  for (const auto& [key, plane] : planes_) sum += plane->bytes();
  return sum;
}

}  // namespace contrejour::inline internal::stop_patterns
