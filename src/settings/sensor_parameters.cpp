// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/parameter_text.h"
#include "settings/parameter_tables.h"
#include "settings/sensor_format.h"

namespace contrejour::params {
namespace {

// clang-format off: each parameter takes two or three lines, with its help in the last.
const Parameter kSensorTable[] = {
    {.name = "cover-glass", .group = "Lens", .unit = "MM[:GLASS[:GAP]]",
     .help = "a plane-parallel plate in front of the sensor: its thickness, its glass or index (default: N-BK7), and "
             "the gap behind it in mm (default: 1), as in 2 or 2:1.52:0.8; may be repeated, from the lens to the "
             "sensor",
     .repeats = true, .check = parses<parse_cover_glass>},
    {.name = "sensor", .group = "Lens", .unit = "NAME|WxH",
     .help = "size of the sensor, in place of the lens file's: mm as 24.9x18.7, or full-frame, aps-c, four-thirds, "
             "one-inch, medium-format, super35, super16, 65mm, imax, alexa-lf, ... (docs/cli.md)",
     .scene = true, .check = parses<parse_sensor>},
    {.name = "sensor-reflectance", .group = "Lens", .kind = Kind::Real, .minimum = 0, .maximum = 1, .fallback = "0",
     .help = "reflectance of the sensor, which makes ghosts of its own; typical: 0.05 to 0.2"},
    {.name = "sensor-orders", .group = "Lens", .kind = Kind::Integer, .minimum = 0,
     .maximum = SensorStack::kMaxOrders, .fallback = "0",
     .help = "highest diffraction order of the pixel grating in each direction: the red dots around a light; 0: the "
             "sensor reflects as a mirror"},
    {.name = "sensor-pitch", .group = "Lens", .kind = Kind::Real, .unit = "um", .minimum = 0.1, .maximum = 1000,
     .fallback = "5", .help = "period of the pixel grating"},
    {.name = "sensor-fill", .group = "Lens", .kind = Kind::Real, .minimum = 0.01, .maximum = 1, .fallback = "0.8",
     .help = "linear fill factor of the pixel grating: side of a reflecting square over the period"},
};
// clang-format on

}  // namespace

std::span<const Parameter> sensor_parameters() { return kSensorTable; }

}  // namespace contrejour::params
