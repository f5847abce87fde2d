// SPDX-License-Identifier: Apache-2.0
// The test host's property sets. A property keeps the type of its first value, as the standard has it.
#include <utility>

#include "host_suites.h"
#include "test_host.h"

namespace contrejour::openfx {
namespace {

template <class T>
Status set_one(PropertySetHandle set, const char* property, int index, T value) {
  if (set == nullptr) return status::kErrBadHandle;
  if (set->known != nullptr && !set->known->has(property)) return status::kErrUnknown;
  auto& values = set->values[property];
  if (index < 0 || index > static_cast<int>(values.size())) return status::kErrBadIndex;
  if (!values.empty() && values.front().index() != PropertyValue(value).index()) return status::kErrValue;
  if (index == static_cast<int>(values.size()))
    values.emplace_back(std::move(value));
  else
    values[static_cast<std::size_t>(index)] = std::move(value);
  return status::kOk;
}

template <class T>
Status get_one(PropertySetHandle set, const char* property, int index, const T** value) {
  if (set == nullptr) return status::kErrBadHandle;
  if (set->known != nullptr && !set->known->has(property)) return status::kErrUnknown;
  const auto found = set->values.find(property);
  if (found == set->values.end()) return status::kErrUnknown;
  if (index < 0 || index >= static_cast<int>(found->second.size())) return status::kErrBadIndex;
  *value = std::get_if<T>(&found->second[static_cast<std::size_t>(index)]);
  return *value != nullptr ? status::kOk : status::kErrValue;
}

template <class T>
Status get_value(PropertySetHandle set, const char* property, int index, T* to) {
  const T* value = nullptr;
  const Status got = get_one<T>(set, property, index, &value);
  if (got == status::kOk) *to = *value;
  return got;
}

Status get_text(PropertySetHandle set, const char* property, int index, char** to) {
  const std::string* value = nullptr;
  const Status got = get_one<std::string>(set, property, index, &value);
  if (got == status::kOk) *to = const_cast<char*>(value->c_str());
  return got;
}

template <class T, class From>
Status set_many(PropertySetHandle set, const char* property, int count, const From* values) {
  for (int k = 0; k < count; ++k)
    if (const Status put = set_one<T>(set, property, k, T(values[k])); put != status::kOk) return put;
  return status::kOk;
}

template <auto get, class To>
Status get_many(PropertySetHandle set, const char* property, int count, To* values) {
  for (int k = 0; k < count; ++k)
    if (const Status got = get(set, property, k, values + k); got != status::kOk) return got;
  return status::kOk;
}

Status reset(PropertySetHandle set, const char* property) {
  set->values.erase(property);
  return status::kOk;
}

Status dimension(PropertySetHandle set, const char* property, int* count) {
  *count = static_cast<int>(set->count(property));
  return *count > 0 ? status::kOk : status::kErrUnknown;
}

}  // namespace

const PropertySuite& property_suite() {
  static const PropertySuite suite{
      &set_one<void*>,
      [](PropertySetHandle set, const char* property, int index, const char* value) {
        return set_one<std::string>(set, property, index, value);
      },
      &set_one<double>,
      &set_one<int>,
      &set_many<void*, void* const>,
      &set_many<std::string, const char* const>,
      &set_many<double, double>,
      &set_many<int, int>,
      &get_value<void*>,
      &get_text,
      &get_value<double>,
      &get_value<int>,
      &get_many<&get_value<void*>, void*>,
      &get_many<&get_text, char*>,
      &get_many<&get_value<double>, double>,
      &get_many<&get_value<int>, int>,
      &reset,
      &dimension,
  };
  return suite;
}

}  // namespace contrejour::openfx
