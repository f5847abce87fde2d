// SPDX-License-Identifier: Apache-2.0
// Checks the data that a reader found, and makes a glass of them.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/scalar.h"
#include "contrejour/expert/glass.h"
#include "optics/glass/formulas.h"

namespace contrejour {
namespace {

constexpr double kShortest_nm = 1e-4;  // tables of a few materials extend from X-rays to microwaves
constexpr double kLongest_nm = 1e9;
constexpr double kHuge = 1e30;       // of a coefficient
constexpr double kMaxIndex = 100.0;
constexpr int kSamples = 33;         // of the range, at which n must be a number
constexpr double kColdest_c = -273.15, kHottest_c = 3000.0;

std::string count_problem(const GlassData& data) {
  const CoefficientCount count = coefficient_count(data.formula);
  const std::size_t size = data.coefficients.size();
  if (count.max == 0) return "a formula that is not known";
  if (size < count.min || size > count.max || (count.odd && size % 2 == 0) || (count.even && size % 2 != 0)) {
    return fmt::format("{} coefficients of {}; it takes {}{} to {}", size, formula_name(data.formula),
                       count.odd    ? "an odd number from "
                       : count.even ? "pairs, from "
                                    : "",
                       count.min, count.max);
  }
  for (const double c : data.coefficients)
    if (!within(c, -kHuge, kHuge)) return fmt::format("a coefficient is {}; check its figures", c);
  return "";
}

std::string range_problem(const GlassData& data) {
  if (data.formula == DispersionFormula::Table) {
    const auto& c = data.coefficients;
    for (std::size_t k = 0; k < c.size(); k += 2) {
      if (!within(c[k] * 1e3, kShortest_nm, kLongest_nm)) return fmt::format("a wavelength of {} um", c[k]);
      if (k > 0 && !(c[k] > c[k - 2])) return fmt::format("wavelengths do not rise at {} um", c[k]);
    }
  }
  if (!data.range_nm) return "";
  const auto [first, last] = *data.range_nm;
  if (within(first, kShortest_nm, kLongest_nm) && within(last, first, kLongest_nm)) return "";
  return fmt::format("a wavelength range from {} to {} nm; give the shorter first, within {} to {}", first, last,
                     kShortest_nm, kLongest_nm);
}

std::string other_problem(const GlassData& data) {
  if (!within(data.reference_temperature_c, kColdest_c, kHottest_c))
    return fmt::format("a reference temperature of {} deg C", data.reference_temperature_c);
  if (data.thermal) {
    const ThermalDispersion& t = *data.thermal;
    for (const double value : {t.d0, t.d1, t.d2, t.e0, t.e1, t.lambda_tk_um})
      if (!within(value, -1e3, 1e3)) return fmt::format("a thermal coefficient is {}", value);
  }
  double before_nm = 0.0;
  for (const Absorption& row : data.absorption) {
    if (!(row.lambda_nm > before_nm))
      return fmt::format("transmittance: wavelengths do not rise at {} nm", row.lambda_nm);
    if (!within(row.per_mm, 0.0, 1e12))
      return fmt::format("an absorption of {} per mm at {} nm", row.per_mm, row.lambda_nm);
    before_nm = row.lambda_nm;
  }
  return "";
}

std::string index_problem(const Glass& glass) {
  const auto range = wavelength_range_nm(glass);
  const WavelengthRange asked = range.value_or(WavelengthRange{kLineD_nm, kLineD_nm});
  for (int k = 0; k < kSamples; ++k) {
    const double nm = asked.first_nm + (asked.last_nm - asked.first_nm) * k / (kSamples - 1);
    const double n = refractive_index(glass, nm);
    if (n > 0.0 && n <= kMaxIndex) continue;
    return fmt::format("the index is {} at {:.6g} nm, where the glass says that its formula holds; check its figures",
                       n, nm);
  }
  return "";
}

}  // namespace

Result<Glass> make_glass(std::string name, GlassData data) {
  const auto refuse = [&](const std::string& problem) {
    return failure(ErrorCode::InvalidArgument, fmt::format("glass '{}': {}", shortened(name), problem));
  };
  for (const auto check : {count_problem, range_problem, other_problem})
    if (const std::string problem = check(data); !problem.empty()) return refuse(problem);
  if (!data.range_nm && data.formula == DispersionFormula::Table) {
    data.range_nm = {data.coefficients.front() * 1e3, data.coefficients[data.coefficients.size() - 2] * 1e3};
  }
  Glass glass{std::move(name), CatalogueGlass(std::move(data))};
  if (const std::string problem = index_problem(glass); !problem.empty()) {
    return failure(ErrorCode::InvalidArgument, fmt::format("glass '{}': {}", shortened(glass.name), problem));
  }
  return glass;
}

}  // namespace contrejour
