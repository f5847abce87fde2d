// Reflectances of a lens at several wavelengths, for packets of rays.
#pragma once

#include <map>
#include <memory>
#include <span>

#include "contrejour/context.h"
#include "optics/trace/packet_trace.h"

namespace contrejour {

using TablesByWavelength = std::map<double, std::shared_ptr<const ReflectanceTables>>;

// Incomplete when the context is cancelled.
[[nodiscard]] TablesByWavelength tables_for(const LensState& lens, std::span<const double> lambda_nm,
                                            const Context& context);

}  // namespace contrejour
