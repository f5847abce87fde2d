// SPDX-License-Identifier: Apache-2.0
// Tables and names of exported source code.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "contrejour/expert/polynomial.h"

namespace contrejour::inline internal::polynomial {

// A table in a language; type: of its numbers. Its name begins with @, which stands for the prefix of all names.
[[nodiscard]] std::string table_text(PolynomialLanguage language, std::string_view type, std::string_view name,
                                     const std::vector<int>& values);
[[nodiscard]] std::string table_text(PolynomialLanguage language, std::string_view type, std::string_view name,
                                     const std::vector<double>& values);

// The coefficients' table, in shaders unless the program defines @COEFFICIENT(i) to read it from elsewhere.
[[nodiscard]] std::string coefficients_text(PolynomialLanguage language, const std::vector<double>& values);

// Code for C, GLSL and HLSL with its words of export_code.h, REAL and the others, in a language.
[[nodiscard]] std::string translated(std::string code, PolynomialLanguage language);

// The polynomials' tables. `sums` holds the degree, the wavelength terms and the first coefficient of each.
struct SumTables {
  std::vector<int> sums;
  std::vector<double> coefficients;  // those of float, whose decimals are exact: Python has no float

  void add(const ChebyshevSum& sum);
  void add(const ChebyshevVector& vector);
  void add(const AsymmetricVector& vector);
};

void replace_all(std::string& text, std::string_view from, std::string_view to);
[[nodiscard]] bool is_identifier(std::string_view name);
// Fit for a comment of one line.
[[nodiscard]] std::string one_line(std::string text);
[[nodiscard]] std::string inverse_square_text(double nm);

}  // namespace contrejour::inline internal::polynomial
