// SPDX-License-Identifier: Apache-2.0
// A configuration of the colour spaces that OpenColorIO has built in: ACES, camera logs, and displays. OpenColorIO 2.1
// has the transforms, but no configuration of them.
#pragma once

#include <OpenColorIO/OpenColorIO.h>

namespace contrejour::inline internal {

[[nodiscard]] OCIO_NAMESPACE::ConstConfigRcPtr aces_config();

}  // namespace contrejour::inline internal
