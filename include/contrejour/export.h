// SPDX-License-Identifier: Apache-2.0
// CONTREJOUR_API marks what a shared library exports; everything else stays hidden.
// CONTREJOUR_STATIC is defined for users of the static library, CONTREJOUR_BUILDING while the library is compiled; both
// come from the build system.
#pragma once

#if !defined(_WIN32)
#define CONTREJOUR_API __attribute__((visibility("default")))
#elif defined(CONTREJOUR_STATIC)
#define CONTREJOUR_API
#elif defined(CONTREJOUR_BUILDING)
#define CONTREJOUR_API __declspec(dllexport)
#else
#define CONTREJOUR_API __declspec(dllimport)
#endif
