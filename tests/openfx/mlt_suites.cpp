// SPDX-License-Identifier: Apache-2.0
// The tables of functions of a host that acts as MLT does (mlt_host.h).
#include <cstdarg>
#include <cstdlib>
#include <string>

#include "host_suites.h"
#include "mlt_host.h"

namespace contrejour::openfx {
namespace {

bool has_index(const PropertySetStruct& set, int index) {
  for (const auto& [name, values] : set.values)
    if (static_cast<int>(values.size()) > index) return true;
  return false;
}

template <class T>
Status mlt_set_one(PropertySetHandle set, const char* property, int index, T value) {
  if (set == nullptr) return status::kErrBadHandle;
  if (index < 0) return status::kErrBadIndex;
  auto& values = set->values[property];
  if (static_cast<int>(values.size()) <= index) values.resize(static_cast<std::size_t>(index) + 1);
  values[static_cast<std::size_t>(index)] = std::move(value);
  return status::kOk;
}

Status get_one(PropertySetHandle set, const char* property, int index, PropertyValue** value) {
  if (set == nullptr) return status::kErrBadHandle;
  if (index < 0 || !has_index(*set, index)) return status::kErrBadIndex;
  const auto found = set->values.find(property);
  if (found == set->values.end() || static_cast<int>(found->second.size()) <= index) return status::kErrUnknown;
  *value = &found->second[static_cast<std::size_t>(index)];
  return status::kOk;
}

double number_of(const PropertyValue& value) {
  if (const int* whole = std::get_if<int>(&value)) return *whole;
  if (const double* number = std::get_if<double>(&value)) return *number;
  const std::string* text = std::get_if<std::string>(&value);
  return text != nullptr ? std::strtod(text->c_str(), nullptr) : 0.0;
}

template <class Number>
Status get_number(PropertySetHandle set, const char* property, int index, Number* to) {
  PropertyValue* value = nullptr;
  const Status got = get_one(set, property, index, &value);
  if (got == status::kOk) *to = static_cast<Number>(number_of(*value));
  return got;
}

// A number that is read as text is text from then on.
Status mlt_get_text(PropertySetHandle set, const char* property, int index, char** to) {
  PropertyValue* value = nullptr;
  const Status got = get_one(set, property, index, &value);
  if (got != status::kOk) return got;
  if (!std::holds_alternative<std::string>(*value)) *value = std::to_string(number_of(*value));
  *to = std::get<std::string>(*value).data();
  return status::kOk;
}

Status get_pointer(PropertySetHandle set, const char* property, int index, void** to) {
  PropertyValue* value = nullptr;
  const Status got = get_one(set, property, index, &value);
  if (got != status::kOk) return got;
  void** const pointer = std::get_if<void*>(value);
  *to = pointer != nullptr ? *pointer : nullptr;
  return status::kOk;
}

const PropertySuite& properties() {
  static const PropertySuite suite = [] {
    PropertySuite functions{};
    functions.set_pointer = &mlt_set_one<void*>;
    functions.set_string = [](PropertySetHandle set, const char* property, int index, const char* value) {
      return mlt_set_one<std::string>(set, property, index, value);
    };
    functions.set_double = &mlt_set_one<double>;
    functions.set_int = &mlt_set_one<int>;
    functions.get_pointer = &get_pointer;
    functions.get_string = &mlt_get_text;
    functions.get_double = &get_number<double>;
    functions.get_int = &get_number<int>;
    functions.get_dimension = [](PropertySetHandle set, const char* property, int* count) {
      *count = static_cast<int>(set->count(property));
      return status::kOk;
    };
    return functions;
  }();
  return suite;
}

// The image is the clip's property set.
const ImageEffectSuite& effects() {
  static const ImageEffectSuite suite = [] {
    ImageEffectSuite functions = effect_suite();
    functions.clip_get_property_set = [](ClipHandle clip, PropertySetHandle* set) {
      *set = &clip->properties;
      return status::kOk;
    };
    functions.clip_get_image = [](ClipHandle clip, Time, const RectD*, PropertySetHandle* image) {
      if (clip == nullptr) return status::kErrBadHandle;
      *image = &clip->properties;
      return status::kOk;
    };
    functions.clip_release_image = [](PropertySetHandle) { return status::kOk; };
    functions.clip_get_region_of_definition = [](ClipHandle clip, Time, RectD* region) {
      if (clip == nullptr) return status::kErrBadHandle;
      const double aspect = clip->properties.get<double>(name::kImagePixelAspectRatio, 0, 1.0);
      const auto side = [&](std::size_t k) {
        return static_cast<double>(clip->properties.get<int>("OfxImagePropRegionOfDefinition", k));
      };
      *region = {side(0) * aspect, side(1), side(2) * aspect, side(3)};
      return status::kOk;
    };
    functions.abort = [](EffectHandle) { return 0; };
    return functions;
  }();
  return suite;
}

int index_of_label(const ParamStruct& param) {
  for (std::size_t k = 0; k < param.properties.count(name::kChoiceOption); ++k)
    if (param.properties.get<std::string>(name::kChoiceOption, k) == param.text) return static_cast<int>(k);
  return param.properties.get<int>(name::kDefault);
}

Status give(ParamHandle param, va_list arguments) {
  if (param->type == type::kString) {
    *va_arg(arguments, char**) = param->text.data();
  } else if (param->type == type::kChoice) {
    *va_arg(arguments, int*) = index_of_label(*param);
  } else {
    for (const double number : param->numbers)
      if (param->is_whole())
        *va_arg(arguments, int*) = static_cast<int>(number);
      else
        *va_arg(arguments, double*) = number;
  }
  return status::kOk;
}

// The value was set for the frame that is rendered.
Status get_value_at_any_time(ParamHandle param, Time time, ...) {
  if (param == nullptr) return status::kErrBadHandle;
  va_list arguments;
  va_start(arguments, time);
  const Status given = give(param, arguments);
  va_end(arguments);
  return given;
}

Status no_derivative(ParamHandle, Time, ...) { return status::kErrUnsupported; }
Status no_integral(ParamHandle, Time, Time, ...) { return status::kErrUnsupported; }

const ParameterSuite& parameters() {
  static const ParameterSuite suite = [] {
    ParameterSuite functions = parameter_suite();
    functions.get_value_at_time = &get_value_at_any_time;
    functions.get_num_keys = [](ParamHandle, unsigned int* count) {
      *count = 0;
      return status::kOk;
    };
    functions.get_derivative = &no_derivative;
    functions.get_integral = &no_integral;
    return functions;
  }();
  return suite;
}

}  // namespace

// The draw suite is the one that MLT declares and does not give.
const void* mlt_suite(PropertySetHandle /*host*/, const char* name, int version) {
  const std::string wanted = name + std::to_string(version);
  if (wanted == "OfxPropertySuite1") return &properties();
  if (wanted == "OfxParameterSuite1") return &parameters();
  if (wanted == "OfxImageEffectSuite1") return &effects();
  if (wanted == "OfxMultiThreadSuite1") return &thread_suite();
  if (wanted == "OfxInteractSuite1") return &interact_suite();
  if (wanted == "OfxMessageSuite2" || wanted == "OfxMessageSuite1") return &message_suite();
  return nullptr;
}

}  // namespace contrejour::openfx
