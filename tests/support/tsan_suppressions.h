// What ThreadSanitizer is to leave out, for programs of the thread-sanitizer build: once in each, beside its main().
// The installed TBB is built without it, so that what its threads do with their own memory as they end looks like a
// race, now and then. Our code that runs in them is watched as ever.
#pragma once

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
extern "C" const char* __tsan_default_suppressions() { return "called_from_lib:libtbb.so\n"; }  // NOLINT
#endif
#endif
