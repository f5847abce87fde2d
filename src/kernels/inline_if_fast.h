// For the large pieces of packet kernels. One within the other they are what makes a kernel quick, and what takes clang
// minutes to compile. Sanitized builds, which test the code and not its speed, call them.
#pragma once

#include <hwy/base.h>

#ifdef CONTREJOUR_SANITIZED
#define CONTREJOUR_INLINE_IF_FAST inline HWY_NOINLINE
#else
#define CONTREJOUR_INLINE_IF_FAST HWY_INLINE
#endif
