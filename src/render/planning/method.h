// SPDX-License-Identifier: Apache-2.0
// A renderer as the registry knows it (render/session/registry.h): a name, traits, default options, and a function that
// draws a plan. A renderer that has options of its own type exports method_of<Options, draw>(traits).
#pragma once

#include <string>
#include <string_view>

#include "contrejour/expert/methods.h"
#include "render/planning/frame_plan.h"

namespace contrejour::inline internal {

struct Method {
  std::string_view name;
  MethodTraits traits;
  MethodOptions (*default_options)();
  // Errors: those of the renderer; InvalidArgument if the options are not of the type of the default ones.
  Result<DrawnFlare> (*draw)(const PlannedFrame& frame, const MethodOptions& options, const Context& context);
};

template <OptionsOfMethod Options>
using DrawWithOptions = Result<DrawnFlare> (*)(const PlannedFrame& frame, const Options& options,
                                               const Context& context);

template <OptionsOfMethod Options, DrawWithOptions<Options> kDraw>
[[nodiscard]] constexpr Method method_of(const MethodTraits& traits) {
  return {Options::kMethod, traits, [] { return MethodOptions(Options{}); },
          [](const PlannedFrame& frame, const MethodOptions& options, const Context& context) -> Result<DrawnFlare> {
            const Options* const own = options.get_if<Options>();
            if (own != nullptr) return kDraw(frame, *own, context);
            return failure(ErrorCode::InvalidArgument,
                           std::string("these are not the options of method ").append(Options::kMethod));
          }};
}

}  // namespace contrejour::inline internal
