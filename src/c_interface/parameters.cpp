// SPDX-License-Identifier: Apache-2.0
// The table of parameters for C callers.
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "c_interface/boundary.h"
#include "contrejour/expert/parameter.h"

namespace contrejour {
namespace {

// A parameter's texts with their zero bytes, which views of text need not have.
struct TextsOfParameter {
  explicit TextsOfParameter(const params::Parameter& p)
      : name(p.name), group(p.group), unit(p.unit), fallback(p.fallback), help(p.help),
        choices(p.choices.begin(), p.choices.end()) {
    for (const std::string& choice : choices) choice_pointers.push_back(choice.c_str());
  }
  TextsOfParameter(const TextsOfParameter&) = delete;
  TextsOfParameter(TextsOfParameter&&) = delete;
  TextsOfParameter& operator=(const TextsOfParameter&) = delete;
  TextsOfParameter& operator=(TextsOfParameter&&) = delete;
  ~TextsOfParameter() = default;

  std::string name, group, unit, fallback, help;
  std::vector<std::string> choices;
  std::vector<const char*> choice_pointers;
};

const TextsOfParameter& texts_of_parameter(std::size_t index) {
  static const std::vector<std::unique_ptr<const TextsOfParameter>> kAll = [] {
    std::vector<std::unique_ptr<const TextsOfParameter>> all;
    for (const params::Parameter& p : params::all_parameters()) all.push_back(std::make_unique<TextsOfParameter>(p));
    return all;
  }();
  return *kAll[index];
}

cj_parameter_kind kind_of_parameter(params::Kind kind) {
  switch (kind) {
    case params::Kind::Real: return CJ_REAL;
    case params::Kind::Integer: return CJ_INTEGER;
    case params::Kind::Choice: return CJ_CHOICE;
    case params::Kind::Switch: return CJ_SWITCH;
    case params::Kind::Text: return CJ_TEXT;
  }
  return CJ_TEXT;
}

}  // namespace
}  // namespace contrejour

size_t cj_parameter_count(void) {
  return contrejour::guarded_value(size_t{0}, [] { return contrejour::params::all_parameters().size(); });
}

cj_status cj_parameter_get(size_t index, cj_parameter* parameter, cj_error* error) {
  using namespace contrejour;
  return guarded(error, [&]() -> Result<void> {
    if (const auto good = check_struct(parameter, sizeof(cj_parameter), "cj_parameter"); !good) return good;
    const auto all = params::all_parameters();
    if (index >= all.size())
      return invalid_argument(fmt::format("there is no parameter {}; the table has {}", index, all.size()));
    const params::Parameter& p = all[index];
    const TextsOfParameter& texts = texts_of_parameter(index);
    cj_parameter ours{};
    ours.name = texts.name.c_str();
    ours.group = texts.group.c_str();
    ours.unit = texts.unit.c_str();
    ours.fallback = texts.fallback.c_str();
    ours.help = texts.help.c_str();
    ours.choices = texts.choice_pointers.data();
    ours.choice_count = texts.choice_pointers.size();
    ours.minimum = p.minimum;
    ours.maximum = p.maximum;
    ours.kind = kind_of_parameter(p.kind);
    ours.repeats = p.repeats ? 1 : 0;
    ours.is_scene = p.scene ? 1 : 0;
    write_struct(ours, parameter);
    return {};
  });
}
