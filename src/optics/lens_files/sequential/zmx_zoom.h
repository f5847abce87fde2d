// SPDX-License-Identifier: Apache-2.0
// The multi-configuration editor of a Zemax file: positions of a zoom, if only thicknesses change.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "optics/lens_files/sequential/zmx_row.h"
#include "optics/lens_files/sequential/zmx_surface.h"

namespace contrejour::inline internal {

// One line behind MNUM: an operand, its target, the configuration, and the value as text.
struct ZmxOperand {
  int line = 0;
  std::string name;
  int subject = 0;
  int configuration = 0;
  std::string value;
};

struct ZmxConfigurations {
  bool is_there = false;  // MNUM: all rows that follow are operands
  int count = 1, current = 1;
  std::vector<ZmxOperand> operands;

  void begin(const ZmxRow& row);
  void add(const ZmxRow& row);
};

// All configurations; empty if there is one, or if more than thicknesses change: a warning then says that the current
// one is read.
[[nodiscard]] std::vector<DesignPosition> zmx_positions(const ZmxConfigurations& configurations,
                                                        const std::vector<ZmxSurface>& surfaces,
                                                        std::vector<std::string>& warnings);

}  // namespace contrejour::inline internal
