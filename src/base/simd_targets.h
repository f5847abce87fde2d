// SPDX-License-Identifier: Apache-2.0
// Selects the instruction sets for which Highway compiles the kernels. Include it before any header of Highway's.
#pragma once

// Packets are structs of vectors, which excludes vectors without a fixed size.
#define CONTREJOUR_SIZELESS_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)

// The kernels use nothing that SSSE3 adds to SSE2. Sanitized builds test the code, not each instruction set.
#ifdef CONTREJOUR_SANITIZED
#define HWY_DISABLED_TARGETS (CONTREJOUR_SIZELESS_TARGETS | HWY_SSSE3 | HWY_SSE4 | HWY_AVX3)
#else
#define HWY_DISABLED_TARGETS (CONTREJOUR_SIZELESS_TARGETS | HWY_SSSE3)
#endif
