// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/seq_glass.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/units.h"
#include "optics/lens_files/plain_number.h"

namespace contrejour::inline internal {
namespace {

bool is_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

Glass model_of(std::string_view name, double n_d, double v_d) {
  if (v_d == 0.0) return {std::string(name), ConstantIndex{n_d}};
  return {std::string(name), ModelGlass{n_d, v_d, 0.0}};
}

// The digits of n_d - 1 and of V_d / 100 about a point: 517.642, 517000.642000. The numbers are exact, so that a glass
// keeps them when it is written again.
std::optional<Glass> fictitious(std::string_view word) {
  const std::size_t point = word.find('.');
  if (point == std::string_view::npos || point < 3 || point > 9) return std::nullopt;
  const std::string_view n = word.substr(0, point), v = word.substr(point + 1);
  if (!is_digits(n) || !is_digits(v) || v.size() > 9) return std::nullopt;
  const auto n_d = plain_number("1." + std::string(n));
  const std::string padded = std::string(v) + "00";
  const auto v_d = plain_number(padded.substr(0, 2) + "." + padded.substr(2));
  if (!n_d || !v_d) return std::nullopt;
  return model_of(word, *n_d, *v_d);
}

// 1.517:64.2, or an index alone with the Abbe number behind it, or without one.
std::optional<Glass> by_number(std::string_view word, std::string_view next) {
  const std::size_t colon = word.find(':');
  const auto n_d = plain_number(word.substr(0, colon));
  if (!n_d || !(*n_d >= 1.0 && *n_d < 5.0)) return std::nullopt;
  const auto v_d = colon == std::string_view::npos ? plain_number(next) : plain_number(word.substr(colon + 1));
  if (colon != std::string_view::npos && !v_d) return std::nullopt;
  if (*n_d == 1.0) return air();
  return model_of(colon == std::string_view::npos ? std::string_view() : word, *n_d, v_d.value_or(0.0));
}

Result<Glass> of_formula(const std::string& name, std::string_view kind, std::vector<double> values) {
  GlassData data;
  if (kind == "LAU" || kind == "GML") {  // n^2 = A0 + A1 l^2 + A2 / l^2 + A3 / l^4 + ...: Schott's
    data.formula = DispersionFormula::Schott;
    values.resize(6);
  } else if (kind == "GMS" || kind == "SEL") {  // n^2 = 1 + B1 l^2 / (l^2 - C1) + ...
    data.formula = DispersionFormula::Sellmeier1;
    values.resize(6);
  } else {
    return failure(
        ErrorCode::Unsupported,
        fmt::format("the dispersion formula {} is not computed; LAU, GML, GMS, SEL and indices at wavelengths are",
                    shortened(kind)));
  }
  data.coefficients = std::move(values);
  return make_glass(name, std::move(data));
}

Result<Glass> of_table(const std::string& name, const std::vector<double>& wavelengths_nm,
                       const std::vector<double>& indices) {
  if (wavelengths_nm.size() != indices.size() || indices.empty())
    return failure(ErrorCode::Parse,
                   fmt::format("{} wavelengths (PWL) but {} indices", wavelengths_nm.size(), indices.size()));
  if (indices.size() == 1) return Glass{name, ConstantIndex{indices.front()}};
  std::vector<std::pair<double, double>> rows;
  for (std::size_t k = 0; k < indices.size(); ++k) rows.emplace_back(um_from_nm(wavelengths_nm[k]), indices[k]);
  std::sort(rows.begin(), rows.end());
  GlassData data;
  data.formula = DispersionFormula::Table;
  for (const auto& [um, n] : rows) data.coefficients.insert(data.coefficients.end(), {um, n});
  return make_glass(name, std::move(data));
}

}  // namespace

void SeqPrivateGlasses::add(const SeqCommand& command) {
  if (command.name != "PWL") {
    glasses_.insert_or_assign(capitals(command.first), glass_of(command));
    return;
  }
  wavelengths_nm_.clear();
  for (const std::string& word : command.words) wavelengths_nm_.push_back(plain_number(word).value_or(0.0));
}

// A name, perhaps a formula's, and numbers.
Result<Glass> SeqPrivateGlasses::glass_of(const SeqCommand& command) const {
  std::vector<double> numbers;
  const bool of_kind = !plain_number(command.word(0));
  const std::string kind = of_kind ? capitals(command.word(0)).substr(0, 3) : "";
  const auto wrong = [&](const Error& error) {
    return failure(error.code, fmt::format("the glass '{}': {}", shortened(command.first), error.message),
                   {"", command.line, 0});
  };
  for (std::size_t k = of_kind ? 1 : 0; k < command.words.size(); ++k) {
    const auto value = plain_number(command.words[k]);
    if (!value) return wrong({ErrorCode::Parse, fmt::format("'{}' is no number", shortened(command.words[k])), {}});
    numbers.push_back(*value);
  }
  auto glass =
      of_kind ? of_formula(command.first, kind, std::move(numbers)) : of_table(command.first, wavelengths_nm_, numbers);
  if (!glass) return wrong(glass.error());
  return glass;
}

const Result<Glass>* SeqPrivateGlasses::find(std::string_view name) const {
  const auto at = glasses_.find(capitals(name));
  return at == glasses_.end() ? nullptr : &at->second;
}

Result<Glass> seq_glass(std::string_view word, std::string_view next, const SeqPrivateGlasses& own, GlassFinder& finder,
                        const std::string& file, int line, std::vector<std::string>& warnings) {
  if (word.empty() || capitals(word) == "AIR") return air();
  if (const Result<Glass>* glass = own.find(word)) {
    if (*glass) return **glass;
    return failure(glass->error().code, glass->error().message, {file, glass->error().position.line, 0});
  }
  if (auto glass = fictitious(word)) return std::move(*glass);
  if (auto glass = by_number(word, next)) return std::move(*glass);
  auto found = finder.find(word);
  const std::size_t maker = word.rfind('_');
  if (!found && maker != std::string_view::npos && maker > 0) {
    auto elsewhere = finder.find(word.substr(0, maker));
    if (elsewhere) {
      warnings.push_back(fmt::format("no catalogue {} is known (line {}); {} of another maker is used",
                                     shortened(word.substr(maker + 1)), line, shortened(word.substr(0, maker))));
      return std::move(*elsewhere);
    }
  }
  if (found) return std::move(*found);
  return failure(ErrorCode::InvalidArgument,
                 fmt::format("{}, or give its catalogue by --catalogue", found.error().message), {file, line, 0});
}

}  // namespace contrejour::inline internal
