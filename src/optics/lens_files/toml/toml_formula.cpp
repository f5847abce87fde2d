// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/toml/toml_formula.h"

#include <fmt/format.h>

#include "base/near_name.h"
#include "optics/lens/validate.h"

namespace contrejour::inline internal {
namespace {

// make_glass() checks plausibility; here any finite number is accepted.
constexpr double kLargestCoefficient = 1e30;
constexpr NumberRange kFiniteCoefficient{-kLargestCoefficient, kLargestCoefficient};
constexpr std::size_t kMaxNumbers = 100000;

std::vector<double> read_list(TomlFields& fields, std::string_view key, std::size_t min, std::size_t max) {
  std::vector<double> values;
  const toml::array* list = fields.array(key);
  if (list == nullptr || list->size() < min || list->size() > max) {
    const std::string how_many = min == max ? fmt::format("{}", min) : fmt::format("{} to {}", min, max);
    fields.fail_here(fmt::format("{} must be a list of {} numbers", key, how_many));
    return values;
  }
  for (const toml::node& node : *list) values.push_back(fields.number_at(node, key, kFiniteCoefficient));
  return values;
}

void read_absorption(TomlFields& fields, GlassData& data) {
  const std::vector<double> pairs = read_list(fields, "absorption_per_mm", 2, kMaxNumbers);
  if (pairs.size() % 2 != 0)
    return fields.fail_here("absorption_per_mm must be pairs of a wavelength (nm) and a figure");
  for (std::size_t k = 0; k + 1 < pairs.size(); k += 2) data.absorption.push_back({pairs[k], pairs[k + 1]});
}

GlassData read_data(TomlFields& fields, TomlErrors& errors) {
  GlassData data;
  const std::string name = fields.required_text("formula", "name one, e.g. \"schott\"");
  const auto formula = formula_of_name(name);
  if (!formula && !errors.failed()) {
    std::vector<std::string_view> names;
    for (const DispersionFormula known : all_formulas()) names.push_back(formula_name(known));
    const std::string near = nearest_name(name, names);
    fields.fail_here(
        fmt::format("no formula is called '{}'; {}", shortened(name),
                    near.empty() ? "see docs/formats/lens-toml.md" : fmt::format("did you mean '{}'?", near)));
  }
  data.formula = formula.value_or(DispersionFormula::Schott);
  data.coefficients = read_list(fields, "coefficients", 1, kMaxNumbers);
  if (fields.has("range_nm")) {
    const auto range = read_list(fields, "range_nm", 2, 2);
    if (range.size() == 2) data.range_nm = WavelengthRange{range[0], range[1]};
  }
  if (fields.has("thermal")) {
    const auto t = read_list(fields, "thermal", 6, 6);
    if (t.size() == 6) data.thermal = ThermalDispersion{t[0], t[1], t[2], t[3], t[4], t[5]};
  }
  data.reference_temperature_c =
      fields.number("temperature_c", kFiniteCoefficient).value_or(data.reference_temperature_c);
  data.index_in_vacuum = fields.boolean("index_in_vacuum").value_or(false);
  data.wavelength_in_vacuum = fields.boolean("wavelength_in_vacuum").value_or(false);
  if (fields.has("absorption_per_mm")) read_absorption(fields, data);
  return data;
}

template <class Values>
std::string list_text(const Values& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + toml_number(value);
  return fmt::format("[{}]", text);
}

}  // namespace

Glass read_formula_keys(const toml::table& table, std::string name, const std::string& what, TomlErrors& errors) {
  TomlFields fields(table, what,
                    {"name", "formula", "coefficients", "range_nm", "temperature_c", "thermal", "index_in_vacuum",
                     "wavelength_in_vacuum", "absorption_per_mm"},
                    errors);
  std::string own_name = fields.text("name").value_or(std::move(name));
  GlassData data = read_data(fields, errors);
  if (errors.failed()) return air();
  auto glass = make_glass(std::move(own_name), std::move(data));
  if (!glass) {
    fields.fail_here(glass.error().message);
    return air();
  }
  if (const auto problem = glass_problem(*glass)) fields.fail_here(*problem);
  return std::move(*glass);
}

std::string formula_text(const GlassData& data) {
  std::string text = fmt::format("formula = {}, coefficients = {}", toml_string(formula_name(data.formula)),
                                 list_text(data.coefficients));
  if (data.range_nm) text += ", range_nm = " + list_text(std::array{data.range_nm->first_nm, data.range_nm->last_nm});
  if (data.reference_temperature_c != GlassData{}.reference_temperature_c) {
    text += ", temperature_c = " + toml_number(data.reference_temperature_c);
  }
  if (data.thermal) {
    const ThermalDispersion& t = *data.thermal;
    text += ", thermal = " + list_text(std::array{t.d0, t.d1, t.d2, t.e0, t.e1, t.lambda_tk_um});
  }
  if (data.index_in_vacuum) text += ", index_in_vacuum = true";
  if (data.wavelength_in_vacuum) text += ", wavelength_in_vacuum = true";
  if (!data.absorption.empty()) {
    std::vector<double> pairs;
    for (const Absorption& row : data.absorption) pairs.insert(pairs.end(), {row.lambda_nm, row.per_mm});
    text += ", absorption_per_mm = " + list_text(pairs);
  }
  return text;
}

}  // namespace contrejour::inline internal
