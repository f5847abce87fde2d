// SPDX-License-Identifier: Apache-2.0
// The commands of a CODE V file for the whole system: title, units, aperture, fields, wavelengths.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "optics/lens_files/first_error.h"
#include "optics/lens_files/sequential/seq_commands.h"
#include "optics/lens_files/sequential/seq_surface.h"
#include "optics/lens_files/sequential/sequential_design.h"

namespace contrejour::inline internal {

class SeqSystem {
 public:
  // False for a command that is not of these.
  [[nodiscard]] bool read(const SeqCommand& command, SequentialDesign& design, FirstError& errors);
  // Call this after all commands are read.
  void finish(SequentialDesign& design) const;

  // The meaning of S's first number, from here on.
  [[nodiscard]] RadiusMode radius_mode() const { return radius_mode_; }

 private:
  [[nodiscard]] bool read_light(const SeqCommand& command, SequentialDesign& design, FirstError& errors);
  [[nodiscard]] bool read_field(const SeqCommand& command, SequentialDesign& design, FirstError& errors);

  RadiusMode radius_mode_ = RadiusMode::Unsaid;
  std::vector<double> wavelengths_nm_;
  int reference_ = 0;
  std::map<std::string, std::vector<double>> fields_;  // by command
};

// Names, weights, vignetting factors, variables and their limits, derivatives, colours, plots: none changes a ray.
[[nodiscard]] bool seq_is_passed_over(std::string_view name);

// The k-th word as a number; 0, and an error, for none.
[[nodiscard]] double seq_number(const SeqCommand& command, std::size_t k, FirstError& errors);

}  // namespace contrejour::inline internal
