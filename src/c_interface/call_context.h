// SPDX-License-Identifier: Apache-2.0
// A caller's context as the library's. Thread-safety: the progress function may run on any thread.
#pragma once

#include "c_interface/boundary.h"
#include "c_interface/objects.h"
#include "contrejour/context.h"

namespace contrejour::inline internal {

// Lives as long as the call. given: may be NULL. values: the number of threads.
class CallContext {
 public:
  [[nodiscard]] static Result<void> check(const cj_context* given) {
    return given == nullptr ? Result<void>() : check_struct(given, sizeof(cj_context), "cj_context");
  }

  CallContext(const cj_context* given, const params::Values& values) {
    context_.threads = values.integer("threads");
    if (given == nullptr) return;
    cj_cancel* const cancel = given->cancel != nullptr ? given->cancel : &own_cancel_;
    context_.cancel = &cancel->stop;
    if (given->progress == nullptr) return;
    context_.progress = [cancel, progress = given->progress, user = given->user](double done) {
      if (progress(user, done) != 0) cancel->stop.store(true);
    };
  }
  CallContext(const CallContext&) = delete;
  CallContext& operator=(const CallContext&) = delete;

  [[nodiscard]] const Context& context() const { return context_; }

 private:
  cj_cancel own_cancel_;
  Context context_;
};

}  // namespace contrejour::inline internal
