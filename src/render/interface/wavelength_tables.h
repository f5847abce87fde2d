// Reflectances of a lens at several wavelengths, for packets of rays.
#pragma once

#include <map>
#include <memory>

#include "optics/trace/packet_trace.h"

namespace contrejour {

using TablesByWavelength = std::map<double, std::shared_ptr<const ReflectanceTables>>;

}  // namespace contrejour
