// SPDX-License-Identifier: Apache-2.0
// The paths of a lens's ghosts as a device gets them, a section of RenderCache: they depend on the lens, but not on the
// lights. Thread-safety: one thread at a time.
#pragma once

#include <memory>
#include <vector>

#include "contrejour/expert/ghost.h"
#include "optics/trace/by_wavelength.h"
#include "render/device/frame_device.h"
#include "render/pupils/kept_pupils.h"

namespace contrejour::inline internal::adaptive {

class KeptPaths {
 public:
  struct Key {
    pupils::KeptPupils::Key lens;  // with the coatings
    std::vector<Ghost> ghosts;
    std::vector<double> lambda_nm;
    friend bool operator==(const Key&, const Key&) = default;
  };

  explicit KeptPaths(const Key& key) : ghosts_(key.ghosts), lambda_nm_(key.lambda_nm) {}

  // By ghost, then by wavelength. lens and tables: those of the key; the first call's are kept.
  [[nodiscard]] std::shared_ptr<const DevicePaths> get(const LensState& lens, const TablesByWavelength& tables,
                                                       double entrance_z_mm);

  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  std::vector<Ghost> ghosts_;
  std::vector<double> lambda_nm_;
  std::shared_ptr<const DevicePaths> paths_;
};

}  // namespace contrejour::inline internal::adaptive
