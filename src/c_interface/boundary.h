// SPDX-License-Identifier: Apache-2.0
// The boundary between C callers and the library: errors and exceptions become statuses, structs of the caller's
// version become those of this one. Thread-safety: pure functions.
#pragma once

#include <algorithm>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <utility>

#include <contrejour.h>

#include "contrejour/result.h"

namespace contrejour::inline internal {

// Describes a failure to the caller, as far as the struct of the caller's version can.
void describe_failure(cj_error* to, cj_status status, const Error& error) noexcept;

// The status of the exception that is being handled; describes it.
cj_status status_of_exception(cj_error* to) noexcept;

cj_status status_of(ErrorCode code) noexcept;

// Calls body(), which returns a Result<void>. No exception leaves.
template <class Body>
cj_status guarded(cj_error* error, const Body& body) noexcept {
  try {
    const Result<void> done = body();
    if (done) return CJ_OK;
    const cj_status status = status_of(done.error().code);
    describe_failure(error, status, done.error());
    return status;
  } catch (...) {
    return status_of_exception(error);
  }
}

// As guarded(), for a body that returns the Result of an object, whose ownership passes to *to.
template <class Object, class Body>
cj_status guarded_create(Object** to, cj_error* error, const Body& body) noexcept {
  return guarded(error, [&]() -> Result<void> {
    if (to == nullptr) return invalid_argument("the pointer that receives the object is NULL");
    auto made = body();
    if (!made) return tl::unexpected(std::move(made.error()));
    *to = new Object(std::move(*made));
    return {};
  });
}

// The value that body() returns, or, where it throws, another one.
template <class Value, class Body>
Value guarded_value(Value otherwise, const Body& body) noexcept {
  try {
    return body();
  } catch (...) {
    return otherwise;
  }
}

// The text of this index, NULL beyond the last.
template <class Texts>
const char* text_at(const Texts& texts, std::size_t index) {
  return index < texts.size() ? texts[index].c_str() : nullptr;
}

// Errors: InvalidArgument if a required pointer is NULL.
[[nodiscard]] inline Result<void> require(const void* pointer, std::string_view what) {
  if (pointer != nullptr) return {};
  return invalid_argument(std::string(what) + " is NULL");
}

// The bytes that the caller's version of a struct and this one have in common.
template <class Struct>
[[nodiscard]] std::size_t common_size(const Struct& given) {
  return std::min(given.struct_size, sizeof(Struct));
}

// Errors: InvalidArgument for a NULL pointer, and for a struct that is smaller than that of the first version, as one
// is whose struct_size was not set.
template <class Struct>
[[nodiscard]] Result<void> check_struct(const Struct* given, std::size_t first_version, std::string_view name) {
  if (given == nullptr) return invalid_argument(std::string(name) + " is NULL");
  if (given->struct_size >= first_version) return {};
  return invalid_argument(std::string(name) + ": struct_size is too small; set it to sizeof(" + std::string(name) +
                          "), as CJ_INIT does");
}

// The caller's struct in this version: members that it does not have are zero.
template <class Struct>
[[nodiscard]] Struct in_this_version(const Struct& given) {
  static_assert(std::is_trivially_copyable_v<Struct>);
  Struct ours{};
  std::memcpy(&ours, &given, common_size(given));
  return ours;
}

// Writes the members that the caller's struct has, and leaves its struct_size.
template <class Struct>
void write_struct(Struct ours, Struct* to) {
  static_assert(std::is_trivially_copyable_v<Struct>);
  ours.struct_size = to->struct_size;
  std::memcpy(to, &ours, common_size(*to));
}

}  // namespace contrejour::inline internal
