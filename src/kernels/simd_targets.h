// Which instruction sets Highway compiles the kernels for. Include it before any header of Highway's.
#pragma once

// Packets are structs of vectors, which vectors without a fixed size do not allow.
#define CONTREJOUR_SIZELESS_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)

// SSSE3 has nothing over SSE2 that the kernels use. Sanitized builds test the code, not each set of instructions.
#ifdef CONTREJOUR_SANITIZED
#define HWY_DISABLED_TARGETS (CONTREJOUR_SIZELESS_TARGETS | HWY_SSSE3 | HWY_SSE4 | HWY_AVX3)
#else
#define HWY_DISABLED_TARGETS (CONTREJOUR_SIZELESS_TARGETS | HWY_SSSE3)
#endif
