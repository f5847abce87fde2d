// SPDX-License-Identifier: Apache-2.0
#include "optics/glass/formulas.h"

#include <array>
#include <cmath>

namespace contrejour::inline internal {
namespace {

constexpr double kHerzberger_um2 = 0.028;  // square of Herzberger's common resonance (Herzberger 1959)
constexpr double kBuchdahlAlpha_per_um = 2.5;  // Robb & Mercado 1983

struct Entry {
  DispersionFormula formula;
  std::string_view name;
  CoefficientCount count;
};

using enum DispersionFormula;
constexpr std::size_t kMany = 100;  // refractiveindex.info's longest has 17
constexpr std::size_t kTableMax = 2 * 50000;
// Coefficient counts as in AGF files: up to ten, of which those that a formula does not use are 0 and dropped.
constexpr std::array kFormulas{
    Entry{Schott, "schott", {1, 6}},
    Entry{Sellmeier1, "sellmeier-1", {1, 6}},
    Entry{Herzberger, "herzberger", {1, 6}},
    Entry{Sellmeier2, "sellmeier-2", {1, 5}},
    Entry{Conrady, "conrady", {1, 3}},
    Entry{Sellmeier3, "sellmeier-3", {1, 8}},
    Entry{HandbookOfOptics1, "handbook-1", {1, 4}},
    Entry{HandbookOfOptics2, "handbook-2", {1, 4}},
    Entry{Sellmeier4, "sellmeier-4", {1, 5}},
    Entry{Extended1, "extended-1", {1, 8}},
    Entry{Sellmeier5, "sellmeier-5", {1, 10}},
    Entry{Extended2, "extended-2", {1, 8}},
    Entry{Extended3, "extended-3", {1, 9}},
    Entry{Rii1, "rii-1", {1, kMany, true}},
    Entry{Rii2, "rii-2", {1, kMany, true}},
    Entry{Rii3, "rii-3", {1, kMany, true}},
    Entry{Rii4, "rii-4", {9, kMany, true}},
    Entry{Rii5, "rii-5", {1, kMany, true}},
    Entry{Rii6, "rii-6", {1, kMany, true}},
    Entry{Rii7, "rii-7", {1, 6}},
    Entry{Rii8, "rii-8", {4, 4}},
    Entry{Rii9, "rii-9", {6, 6}},
    Entry{Cauchy, "cauchy", {1, kMany}},
    Entry{Buchdahl, "buchdahl", {2, 10}},
    Entry{Table, "table", {2, kTableMax, false, true}},
};

constexpr auto formulas_alone() {
  std::array<DispersionFormula, kFormulas.size()> alone{};
  for (std::size_t k = 0; k < alone.size(); ++k) alone[k] = kFormulas[k].formula;
  return alone;
}
constexpr auto kAlone = formulas_alone();

// The coefficients, 0 after the last.
struct Coefficients {
  std::span<const double> values;
  [[nodiscard]] double operator[](std::size_t k) const { return k < values.size() ? values[k] : 0.0; }
  [[nodiscard]] std::size_t size() const { return values.size(); }
};

// c[0] + c[1] x + c[2] x^2 + ... of `count` coefficients from `first`.
double polynomial(const Coefficients& c, std::size_t first, std::size_t count, double x) {
  double sum = 0.0;
  for (std::size_t k = first + count; k-- > first;) sum = sum * x + c[k];
  return sum;
}

// Sum of B l2 / (l2 - C) over pairs B, C from `first`.
double resonances(const Coefficients& c, std::size_t first, std::size_t count, double l2) {
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) sum += c[first + 2 * k] * l2 / (l2 - c[first + 2 * k + 1]);
  return sum;
}

// As above with the resonance's wavelength itself, C^2 (refractiveindex.info 1).
double resonances_of_wavelengths(const Coefficients& c, double l2) {
  double sum = 0.0;
  for (std::size_t k = 1; k + 1 < c.size(); k += 2) sum += c[k] * l2 / (l2 - c[k + 1] * c[k + 1]);
  return sum;
}

// Sum of A lambda^B over pairs from `first`.
double powers(const Coefficients& c, std::size_t first, double lambda_um) {
  double sum = 0.0;
  for (std::size_t k = first; k + 1 < c.size(); k += 2) sum += c[k] * std::pow(lambda_um, c[k + 1]);
  return sum;
}

// refractiveindex.info 4: two terms A l^B / (l^2 - C^D), then powers.
double rii4_squared(const Coefficients& c, double lambda_um) {
  double sum = c[0] + powers(c, 9, lambda_um);
  for (std::size_t k = 1; k < 9; k += 4)
    if (c[k] != 0.0)
      sum += c[k] * std::pow(lambda_um, c[k + 1]) / (lambda_um * lambda_um - std::pow(c[k + 2], c[k + 3]));
  return sum;
}

double herzberger(const Coefficients& c, double l2) {
  const double l = 1.0 / (l2 - kHerzberger_um2);
  return c[0] + l * (c[1] + c[2] * l) + l2 * (c[3] + l2 * (c[4] + c[5] * l2));
}

double gases(const Coefficients& c, double l2) {
  double sum = 1.0 + c[0];
  for (std::size_t k = 1; k + 1 < c.size(); k += 2) sum += c[k] / (c[k + 1] - 1.0 / l2);
  return sum;
}

// (n^2 - 1) / (n^2 + 2) = s, solved for n.
double of_lorentz_lorenz(double s) { return std::sqrt((1.0 + 2.0 * s) / (1.0 - s)); }

double rii9_squared(const Coefficients& c, double lambda_um) {
  const double off = lambda_um - c[4];
  return c[0] + c[1] / (lambda_um * lambda_um - c[2]) + c[3] * off / (off * off + c[5]);
}

double buchdahl(const Coefficients& c, double lambda_um) {
  const double off = lambda_um - c[0];
  return polynomial(c, 1, c.size(), off / (1.0 + kBuchdahlAlpha_per_um * off));
}

}  // namespace

double formula_index(DispersionFormula formula, std::span<const double> coefficients, double lambda_um) {
  const Coefficients c{coefficients};
  const double l2 = lambda_um * lambda_um;
  switch (formula) {
    case Schott: return std::sqrt(c[0] + c[1] * l2 + polynomial(c, 2, 4, 1.0 / l2) / l2);
    case Sellmeier1: return std::sqrt(1.0 + resonances(c, 0, 3, l2));
    case Herzberger:
    case Rii7: return herzberger(c, l2);
    case Sellmeier2: return std::sqrt(1.0 + c[0] + c[1] * l2 / (l2 - c[2] * c[2]) + c[3] / (l2 - c[4] * c[4]));
    case Conrady: return c[0] + c[1] / lambda_um + c[2] / std::pow(lambda_um, 3.5);
    case Sellmeier3: return std::sqrt(1.0 + resonances(c, 0, 4, l2));
    case HandbookOfOptics1: return std::sqrt(c[0] + c[1] / (l2 - c[2]) - c[3] * l2);
    case HandbookOfOptics2: return std::sqrt(c[0] + c[1] * l2 / (l2 - c[2]) - c[3] * l2);
    case Sellmeier4: return std::sqrt(c[0] + resonances(c, 1, 2, l2));
    case Extended1: return std::sqrt(c[0] + c[1] * l2 + polynomial(c, 2, 6, 1.0 / l2) / l2);
    case Sellmeier5: return std::sqrt(1.0 + resonances(c, 0, 5, l2));
    case Extended2:
      return std::sqrt(c[0] + c[1] * l2 + polynomial(c, 2, 4, 1.0 / l2) / l2 + l2 * l2 * (c[6] + c[7] * l2));
    case Extended3: return std::sqrt(polynomial(c, 0, 3, l2) + polynomial(c, 3, 6, 1.0 / l2) / l2);
    case Rii1: return std::sqrt(1.0 + c[0] + resonances_of_wavelengths(c, l2));
    case Rii2: return std::sqrt(1.0 + c[0] + resonances(c, 1, c.size() / 2, l2));
    case Rii3: return std::sqrt(c[0] + powers(c, 1, lambda_um));
    case Rii4: return std::sqrt(rii4_squared(c, lambda_um));
    case Rii5: return c[0] + powers(c, 1, lambda_um);
    case Rii6: return gases(c, l2);
    case Rii8: return of_lorentz_lorenz(c[0] + c[1] * l2 / (l2 - c[2]) + c[3] * l2);
    case Rii9: return std::sqrt(rii9_squared(c, lambda_um));
    case Cauchy: return polynomial(c, 0, c.size(), 1.0 / l2);
    case Buchdahl: return buchdahl(c, lambda_um);
    case Table: return table_value(coefficients, lambda_um);
  }
  return std::nan("");
}

CoefficientCount coefficient_count(DispersionFormula formula) {
  for (const Entry& entry : kFormulas)
    if (entry.formula == formula) return entry.count;
  return {};
}

}  // namespace contrejour::inline internal

namespace contrejour {

std::string_view formula_name(DispersionFormula formula) {
  for (const Entry& entry : kFormulas)
    if (entry.formula == formula) return entry.name;
  return "";
}

std::optional<DispersionFormula> formula_of_name(std::string_view name) {
  for (const Entry& entry : kFormulas)
    if (entry.name == name) return entry.formula;
  return std::nullopt;
}

std::span<const DispersionFormula> all_formulas() { return kAlone; }

}  // namespace contrejour
