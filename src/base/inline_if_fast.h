// SPDX-License-Identifier: Apache-2.0
// Marks the large functions of packet kernels. Inlining them makes a kernel fast, but takes clang minutes to compile.
// Sanitized builds, which test the code and not its speed, call them instead.
#pragma once

#include <hwy/base.h>

#ifdef CONTREJOUR_SANITIZED
#define CONTREJOUR_INLINE_IF_FAST inline HWY_NOINLINE
#else
#define CONTREJOUR_INLINE_IF_FAST HWY_INLINE
#endif
