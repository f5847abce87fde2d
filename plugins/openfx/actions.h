// SPDX-License-Identifier: Apache-2.0
// The plug-in's part in each action of the standard. Functions return the standard's status; exceptions are caught
// at the entry point. Thread-safety: render, identity and regions on any threads at once; the others on one.
#pragma once

#include <memory>

#include "openfx/instance.h"

namespace contrejour::openfx {

inline constexpr const char* kPluginIdentifier = "org.contrejour.LensFlare";

// The entry points of the handles in the viewer: of hosts that draw by OpenGL, and of those with the draw suite.
struct OverlayEntries {
  EntryPoint opengl, draw_suite;
};
[[nodiscard]] Status describe(const Host& host, EffectHandle effect, const OverlayEntries& overlays);
[[nodiscard]] Status describe_in_context(const LoadedPlugin& loaded, EffectHandle effect, const Properties& in);

[[nodiscard]] Status render(Instance& instance, const Properties& in);
// Replies that the source is the result where there can be no flare.
[[nodiscard]] Status is_identity(const Instance& instance, const Properties& in, const Properties& out);
[[nodiscard]] Status region_of_definition(const Instance& instance, const Properties& in, const Properties& out);
[[nodiscard]] Status regions_of_interest(const Instance& instance, const Properties& in, const Properties& out);
[[nodiscard]] Status clip_preferences(const Instance& instance, const Properties& out);
// Does what the button does that loads a look.
[[nodiscard]] Status instance_changed(Instance& instance, const Properties& in);

}  // namespace contrejour::openfx
