// SPDX-License-Identifier: Apache-2.0
// Versions, and the flag that stops calls.
#include <string_view>

#include "c_interface/boundary.h"
#include "c_interface/objects.h"

#define CJ_TEXT_OF(x) #x
#define CJ_DOTTED(major, minor, patch) CJ_TEXT_OF(major) "." CJ_TEXT_OF(minor) "." CJ_TEXT_OF(patch)
static constexpr const char* kVersion = CJ_DOTTED(CJ_VERSION_MAJOR, CJ_VERSION_MINOR, CJ_VERSION_PATCH);
static_assert(std::string_view(kVersion) == CONTREJOUR_VERSION, "contrejour.h states another version than the project");

const char* cj_version_string(void) { return kVersion; }

void cj_version(int32_t* major, int32_t* minor, int32_t* patch) {
  if (major != nullptr) *major = CJ_VERSION_MAJOR;
  if (minor != nullptr) *minor = CJ_VERSION_MINOR;
  if (patch != nullptr) *patch = CJ_VERSION_PATCH;
}

cj_status cj_cancel_create(cj_cancel** cancel, cj_error* error) {
  return contrejour::guarded(error, [&]() -> contrejour::Result<void> {
    if (const auto given = contrejour::require(cancel, "cancel"); !given) return given;
    *cancel = new cj_cancel;
    return {};
  });
}

void cj_cancel_destroy(cj_cancel* cancel) { delete cancel; }

void cj_cancel_set(cj_cancel* cancel, int32_t stop) {
  if (cancel != nullptr) cancel->stop.store(stop != 0);
}
