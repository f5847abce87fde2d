// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/kept_paths.h"

namespace contrejour::inline internal::adaptive {
namespace {

// The data that the paths refer to.
struct Owner {
  LensState lens;
  TablesByWavelength tables;
  StepsByWavelength steps;

  Owner(const LensState& of, const TablesByWavelength& with) : lens(of), tables(with), steps(lens, tables) {}
};

}  // namespace

std::shared_ptr<const DevicePaths> KeptPaths::get(const LensState& lens, const TablesByWavelength& tables,
                                                  double entrance_z_mm) {
  if (paths_) return paths_;
  const auto owner = std::make_shared<const Owner>(lens, tables);
  auto made = std::make_shared<DevicePaths>();
  made->owner = owner;
  const LightRays any{{0.0, 0.0, entrance_z_mm}, {}};
  for (const Ghost& ghost : ghosts_)
    for (const double lambda_nm : lambda_nm_) made->paths.emplace_back(owner->steps.at(lambda_nm), ghost, any);
  paths_ = std::move(made);
  return paths_;
}

std::size_t KeptPaths::memory_bytes() const {
  std::size_t bytes = 0;
  if (paths_)
    for (const PacketPath& path : paths_->paths) bytes += path.steps().capacity() * sizeof(PacketStep);
  return bytes;
}

}  // namespace contrejour::inline internal::adaptive
