// SPDX-License-Identifier: Apache-2.0
// The test host's parameters.
#include <cstdarg>
#include <cstring>

#include "host_suites.h"
#include "test_host.h"

namespace contrejour::openfx {
namespace {

Status define_param(ParamSetHandle set, const char* type, const char* name, PropertySetHandle* properties) {
  if (set == nullptr) return status::kErrBadHandle;
  if (set->find(name) != nullptr) return status::kErrExists;
  auto param = std::make_unique<ParamStruct>();
  param->name = name;
  param->type = type;
  param->properties.known = set->properties.known;
  param->properties.put<std::string>(name::kName, {name});
  if (properties != nullptr) *properties = &param->properties;
  set->params.push_back(std::move(param));
  return status::kOk;
}

Status find_param(ParamSetHandle set, const char* name, ParamHandle* param, PropertySetHandle* properties) {
  ParamStruct* const found = set != nullptr ? set->find(name) : nullptr;
  if (found == nullptr) return status::kErrUnknown;
  *param = found;
  if (properties != nullptr) *properties = &found->properties;
  return status::kOk;
}

bool is_text(const ParamStruct& param) { return std::strcmp(param.type.c_str(), type::kString) == 0; }

Status give_value(ParamHandle param, Time time, va_list arguments) {
  if (is_text(*param)) {
    *va_arg(arguments, char**) = const_cast<char*>(param->text.c_str());
    return status::kOk;
  }
  for (const double number : param->at(time)) {
    if (param->is_whole())
      *va_arg(arguments, int*) = static_cast<int>(number);
    else
      *va_arg(arguments, double*) = number;
  }
  return status::kOk;
}

Status take_value(ParamHandle param, va_list arguments) {
  if (is_text(*param)) {
    param->text = va_arg(arguments, const char*);
    return status::kOk;
  }
  for (double& number : param->numbers) number = param->is_whole() ? va_arg(arguments, int) : va_arg(arguments, double);
  return status::kOk;
}

Status get_value_now(ParamHandle param, ...) {
  va_list arguments;
  va_start(arguments, param);
  const Status given = param != nullptr ? give_value(param, 0.0, arguments) : status::kErrBadHandle;
  va_end(arguments);
  return given;
}

Status get_value_at(ParamHandle param, Time time, ...) {
  va_list arguments;
  va_start(arguments, time);
  const Status given = param != nullptr ? give_value(param, time, arguments) : status::kErrBadHandle;
  va_end(arguments);
  return given;
}

Status set_value_now(ParamHandle param, ...) {
  va_list arguments;
  va_start(arguments, param);
  const Status taken = param != nullptr ? take_value(param, arguments) : status::kErrBadHandle;
  va_end(arguments);
  return taken;
}

Status count_keys(ParamHandle param, unsigned int* count) {
  *count = static_cast<unsigned int>(param->keys.size());
  return status::kOk;
}

}  // namespace

const ParameterSuite& parameter_suite() {
  static const ParameterSuite suite = [] {
    ParameterSuite functions{};
    functions.define = &define_param;
    functions.get_handle = &find_param;
    functions.get_value = &get_value_now;
    functions.get_value_at_time = &get_value_at;
    functions.set_value = &set_value_now;
    functions.get_num_keys = &count_keys;
    functions.edit_begin = [](ParamSetHandle, const char*) { return status::kOk; };
    functions.edit_end = [](ParamSetHandle) { return status::kOk; };
    return functions;
  }();
  return suite;
}

}  // namespace contrejour::openfx
