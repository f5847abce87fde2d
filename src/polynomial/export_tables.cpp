// SPDX-License-Identifier: Apache-2.0
#include "polynomial/export_tables.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

namespace contrejour::inline internal::polynomial {
namespace {

template <class Number>
std::string table_of(PolynomialLanguage language, std::string_view type, std::string_view name,
                     const std::vector<Number>& values) {
  std::string text, line = "  ";
  for (std::size_t k = 0; k < std::max<std::size_t>(values.size(), 1); ++k) {
    const Number value = values.empty() ? Number{} : values[k];  // only Python has arrays without elements
    const bool in_float = type == "float" && language != PolynomialLanguage::Python;  // has fewer decimals
    std::string number = in_float ? fmt::format("{}", static_cast<float>(value)) : fmt::format("{}", value);
    const bool is_whole = number.find_first_of(".en") == std::string::npos;
    if (!std::is_integral_v<Number> && is_whole) number += ".0";
    if (line.size() + number.size() > 116) {
      text += line + "\n";
      line = "  ";
    }
    line += number + ", ";
  }
  text += line;
  // GLSL allows no comma behind the last element.
  if (language != PolynomialLanguage::Python) text.resize(text.size() - 2);
  const std::size_t count = std::max<std::size_t>(values.size(), 1);
  switch (language) {
    case PolynomialLanguage::C: return fmt::format("static const {} @{}[] = {{\n{}\n}};\n", type, name, text);
    case PolynomialLanguage::Glsl:
      return fmt::format("const {0} @{1}[{2}] = {0}[{2}](\n{3}\n);\n", type, name, count, text);
    case PolynomialLanguage::Hlsl:
      return fmt::format("static const {} @{}[{}] = {{\n{}\n}};\n", type, name, count, text);
    case PolynomialLanguage::Python: break;
  }
  return fmt::format("@{} = (\n{}\n)\n", name, text);
}

}  // namespace

std::string table_text(PolynomialLanguage language, std::string_view type, std::string_view name,
                       const std::vector<int>& values) {
  return table_of(language, type, name, values);
}
std::string table_text(PolynomialLanguage language, std::string_view type, std::string_view name,
                       const std::vector<double>& values) {
  return table_of(language, type, name, values);
}

std::string coefficients_text(PolynomialLanguage language, const std::vector<double>& values) {
  const std::string table = table_of(language, "float", "coefficients", values);
  if (language == PolynomialLanguage::C || language == PolynomialLanguage::Python) return table;
  return "#ifndef @COEFFICIENT\n" + table + "#define @COEFFICIENT(i) @coefficients[i]\n#endif\n";
}

std::string translated(std::string code, PolynomialLanguage language) {
  const bool is_c = language == PolynomialLanguage::C;
  const std::array<std::pair<std::string_view, std::string_view>, 9> words{
      {{"OUTREAL", is_c ? "double" : "out float"},
       {"INREAL", is_c ? "const double" : "float"},
       {"REAL", is_c ? "double" : "float"},
       {"BOOL", is_c ? "int" : "bool"},
       {"LOCAL", is_c ? "static " : ""},
       {"YES", is_c ? "1" : "true"},
       {"NO;", is_c ? "0;" : "false;"},
       {"@COEFFICIENT(c)", is_c ? "@coefficients[c]" : "@COEFFICIENT(c)"},
       {"ABS", is_c ? "fabs" : "abs"}}};
  for (const auto& [from, to] : words) replace_all(code, from, to);
  return code;
}

void SumTables::add(const ChebyshevSum& sum) {
  for (const int value : {sum.degree, sum.wavelength_terms, static_cast<int>(coefficients.size())})
    sums.push_back(value);
  coefficients.insert(coefficients.end(), sum.coefficients.begin(), sum.coefficients.end());
}
void SumTables::add(const ChebyshevVector& vector) {
  add(vector.along_field);
  add(vector.along_pupil);
}
void SumTables::add(const AsymmetricVector& vector) {
  add(vector.x);
  add(vector.y);
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

bool is_identifier(std::string_view name) {
  const auto fits = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  return !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0 &&
         std::ranges::all_of(name, fits);
}

std::string one_line(std::string text) {
  std::ranges::replace_if(text, [](unsigned char c) { return std::iscntrl(c) != 0 || c == '\\'; }, ' ');
  return text;
}

std::string inverse_square_text(double nm) { return fmt::format("{}", 1.0 / (nm * nm)); }

}  // namespace contrejour::inline internal::polynomial
