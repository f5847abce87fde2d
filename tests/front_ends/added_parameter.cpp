// SPDX-License-Identifier: Apache-2.0
// One more parameter in the table, and nothing else: every front end has to show it.
#include "settings/added_parameters.h"

namespace contrejour::params {
namespace {

// clang-format off
const Parameter kAdded[] = {
    {.name = "flare-wobble", .group = "Rendering", .kind = Kind::Real, .unit = "mm", .minimum = -3, .maximum = 7,
     .fallback = "1.5", .help = "a parameter that a test added"},
    {.name = "light-wobble", .group = "Lights", .kind = Kind::Real, .fallback = "0", .help = "another one"},
};
// clang-format on

}  // namespace

std::span<const Parameter> added_parameters() { return kAdded; }

}  // namespace contrejour::params
