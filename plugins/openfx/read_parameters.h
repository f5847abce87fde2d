// SPDX-License-Identifier: Apache-2.0
// The values of an instance's parameters at a time, as the library's values.
// A parameter counts as set where it is animated or not at its default, so that a look's value holds beneath all
// others; no state but the parameters themselves is needed, as hosts that never report a change demand.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "contrejour/expert/parameter_values.h"
#include "openfx/instance.h"
#include "openfx/transfer.h"

namespace contrejour::openfx {

struct ReadParameters {
  params::Values own;  // without lights
  std::vector<std::pair<std::string, std::string>> lights;  // "light" and "light-at", and their texts
  std::string look, lens, lights_file;  // as FlareRequest has them
  OutputPicture output = OutputPicture::SourceAndFlare;
  OutputAlpha alpha = OutputAlpha::Source;
  TransferCurve transfer = TransferCurve::Linear;
  SensorFrame frame = SensorFrame::Project;
  bool drafts_while_interacting = true;

  // Whether there can be no flare, whatever the source shows.
  [[nodiscard]] bool is_without_lights() const;
};

// Errors: a text that is not a value of its parameter.
[[nodiscard]] Result<ReadParameters> read_parameters(const Instance& instance, Time time);

// The numbers of a parameter of the plug-in's own, or the index of a choice; its default where the host cannot say.
[[nodiscard]] std::array<double, 3> read_numbers(const Instance& instance, std::string_view name, Time time);

}  // namespace contrejour::openfx
