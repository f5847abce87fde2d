// Reflectances of a lens at every wavelength of a plan, for packets of rays.
#pragma once

#include <map>
#include <memory>

#include "optics/trace/packet_trace.h"
#include "render/interface/frame_plan.h"

namespace contrejour {

using TablesByWavelength = std::map<double, std::unique_ptr<ReflectanceTables>>;

// Incomplete when the context is cancelled.
[[nodiscard]] TablesByWavelength tables_for(const FramePlan& plan, const LensState& lens, const Context& context);

}  // namespace contrejour
