// The multi-configuration editor of a Zemax file: positions of a zoom, if thicknesses are all that moves.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "optics/lens_files/sequential/zmx_row.h"
#include "optics/lens_files/sequential/zmx_surface.h"

namespace contrejour {

// One line behind MNUM: an operand, what it is about, which configuration, its value as text.
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

// Each configuration; empty where there is one, or where more than thicknesses
// changes: then a warning says that the current one is read.
[[nodiscard]] std::vector<DesignPosition> zmx_positions(const ZmxConfigurations& configurations,
                                                        const std::vector<ZmxSurface>& surfaces,
                                                        std::vector<std::string>& warnings);

}  // namespace contrejour
