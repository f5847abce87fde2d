// SPDX-License-Identifier: Apache-2.0
// The rows of a Zemax file for the whole system: names, units, catalogues, aperture, fields, wavelengths.
#pragma once

#include <string>
#include <vector>

#include "optics/lens_files/sequential/sequential_design.h"
#include "optics/lens_files/sequential/zmx_row.h"

namespace contrejour::inline internal {

class ZmxSystem {
 public:
  // Reads a row outside the SURF blocks; the merit function and tolerances follow them, with keywords of their own.
  void read(const ZmxRow& row, bool is_behind_surfaces, SequentialDesign& design);
  // Call this after all rows are read.
  void finish(SequentialDesign& design) const;

  [[nodiscard]] const std::vector<std::string>& makers() const { return makers_; }  // of glasses, as GCAT lists them

 private:
  void read_light(const ZmxRow& row, SequentialDesign& design);
  void set_wavelength(int k, double um);

  std::string notes_;
  std::vector<std::string> makers_;
  std::vector<double> wavelengths_um_, x_field_, y_field_;
  int primary_ = 1, fields_ = 0, field_type_ = 0;
};

}  // namespace contrejour::inline internal
