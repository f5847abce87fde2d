// SPDX-License-Identifier: Apache-2.0
// How a scene-linear picture is looked at on a display: the displays and views of an OpenColorIO configuration, as
// image programs offer them. The configuration is a file, or empty for the ACES output transforms that OpenColorIO has
// built in (PlateColour, colour_config()). Pictures are triples of R, G, B; the codes of a display are from 0 to 1.
// Errors: Unsupported where OpenColorIO is not installed; Parse and Io for a configuration; InvalidArgument for a
// display or a view that it has not. Accuracy: OpenColorIO's default optimisations, below one code of 8 bits.
// Thread-safety: pure functions; apply() from any number of threads.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "contrejour/expert/colour.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

struct ColourDisplay {
  std::string name;
  std::vector<std::string> views;  // the configuration's default first
};

// The default display first.
[[nodiscard]] CONTREJOUR_API Result<std::vector<ColourDisplay>> colour_displays(const std::string& config);

struct ColourViewName {
  std::string display, view;
  friend bool operator==(const ColourViewName&, const ColourViewName&) = default;
};

class ColourView {
 public:
  [[nodiscard]] CONTREJOUR_API static Result<ColourView> open(const std::string& config, const ColourViewName& name);

  // From scene-linear values of the space to the display's codes, in place. Codes beyond 0 and 1 are not clipped.
  [[nodiscard]] CONTREJOUR_API Result<void> apply(std::span<float> rgb, ColourSpace space) const;

 private:
  ColourSpace working_ = ColourSpace::AcesCg;
  std::shared_ptr<const void> transform_;
};

}  // namespace contrejour
