// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/colour_view.h"

#include "plates/colour_module.h"

namespace contrejour {

Result<std::vector<ColourDisplay>> colour_displays(const std::string& config) {
  const auto module = colour_module();
  if (!module) return tl::unexpected(module.error());
  return (*module)->displays(config);
}

Result<ColourView> ColourView::open(const std::string& config, const ColourViewName& name) {
  const auto module = colour_module();
  if (!module) return tl::unexpected(module.error());
  auto conversion = (*module)->open_view(config, name);
  if (!conversion) return tl::unexpected(conversion.error());
  ColourView view;
  view.working_ = conversion->working;
  view.transform_ = std::move(conversion->transform);
  return view;
}

Result<void> ColourView::apply(std::span<float> rgb, ColourSpace space) const {
  if (!transform_) return invalid_argument("this view was not opened");
  const auto module = colour_module();
  if (!module) return tl::unexpected(module.error());
  change_primaries(rgb, space, working_);
  return (*module)->apply({working_, transform_}, rgb.data(), rgb.size() / 3);
}

}  // namespace contrejour
