// SPDX-License-Identifier: Apache-2.0
#include "cli/source_choice.h"

#include <utility>

#include "cli/console.h"
#include "cli/lens_choice.h"

namespace contrejour::cli {

Result<FlareSource> open_source(const std::string& lens, const params::Values& values, MeasuredUse use) {
  if (!is_measured_flare(lens)) {
    auto state = open_lens(lens, values);
    if (!state) return tl::unexpected(state.error());
    return FlareSource(std::move(*state));
  }
  auto flare = read_flare(std::filesystem::path(lens));
  if (!flare) return tl::unexpected(flare.error());
  if (const auto ok = check_measured_values(*flare, values, use); !ok) return tl::unexpected(ok.error());
  return FlareSource(std::move(*flare));
}

Result<SourceRenderer> open_renderer(const params::Values& values, const FlareSource& source) {
  auto renderer = renderer_of(values, source);
  if (!renderer) return renderer;
  if (const std::string note = device_note(*renderer); !note.empty()) print_warnings({"the CPU renders: " + note});
  return renderer;
}

const std::string& name_of(const FlareSource& source) {
  if (const auto* flare = std::get_if<MeasuredFlare>(&source)) return flare->name;
  return std::get<LensState>(source).name;
}

Result<std::vector<Light>> scaled_lights(const FlareSource& source, Result<std::vector<Light>> lights,
                                         const params::Values& values) {
  const auto* flare = std::get_if<MeasuredFlare>(&source);
  if (!lights || flare == nullptr) return lights;
  lights = exposed_lights(*flare, std::move(*lights), values);
  if (lights) print_warnings(range_warnings(*flare, *lights));
  return lights;
}

}  // namespace contrejour::cli
