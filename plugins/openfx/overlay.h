// SPDX-License-Identifier: Apache-2.0
// Handles in the host's viewer: a cross in a circle at each light that is on, to be dragged.
// Thread-safety: the host's main thread only.
#pragma once

#include <string_view>

#include "openfx/host.h"

namespace contrejour::openfx {

// has_draw_suite: the host hands a context of its draw suite to the action of drawing.
[[nodiscard]] Status act_on_overlay(const Host& host, std::string_view action, InteractHandle interact,
                                    const Properties& in, bool has_draw_suite);

}  // namespace contrejour::openfx
