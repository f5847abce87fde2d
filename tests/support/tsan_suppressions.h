// SPDX-License-Identifier: Apache-2.0
// Suppressions for programs of the thread-sanitizer build: included once in each, in the file of its main(). The
// installed TBB is not instrumented, so that accesses of its threads to their own memory as they end are sometimes
// reported as races. The library's code that runs in these threads is still checked.
#pragma once

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
extern "C" const char* __tsan_default_suppressions() { return "called_from_lib:libtbb.so\n"; }  // NOLINT
#endif
#endif
