// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/parameter_text.h"
#include "settings/parameter_tables.h"

namespace contrejour::params {
namespace {

// clang-format off: each parameter takes two or three lines, with its help in the last.
const Parameter kCoatingTable[] = {
    {.name = "coating", .group = "Lens", .unit = "COATING",
     .help = "the coating of every surface that borders on air, in place of the lens's own coatings: none, "
             "quarter-wave:550:1.38, hullin:550:1.38, stack:MgF2@99.6,ZrO2@0.5w, a design (v-coat, broadband-5:550, "
             "...), measured:FILE (a table of reflectances over nm and degrees)",
     .check = parses<parse_coating>},
    {.name = "coating-at", .group = "Lens", .unit = "SURFACE:COATING",
     .help = "the coating of one surface: 12:v-coat:550, 3:none; may be repeated", .repeats = true,
     .check = parses<parse_coating_at>},
    {.name = "absorption", .group = "Lens", .kind = Kind::Switch,
     .help = "apply the internal transmittance of the glasses, where the catalogue states it"},
};
// clang-format on

}  // namespace

std::span<const Parameter> coating_parameters() { return kCoatingTable; }

}  // namespace contrejour::params
