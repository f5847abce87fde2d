// SPDX-License-Identifier: Apache-2.0
// Threads that render must not keep the window waiting, where both share the processor's cores.
#pragma once

namespace contrejour::studio {

// Lowers the priority of the calling thread below the usual one, on Linux also that of the threads that it starts. Does
// nothing where the system has no such call, or refuses it.
void lower_priority_of_this_thread();

}  // namespace contrejour::studio
