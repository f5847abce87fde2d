// SPDX-License-Identifier: Apache-2.0
#include "polynomial/field_polynomials.h"

#include <algorithm>

namespace contrejour::inline internal::polynomial {
namespace {

constexpr std::size_t kPowers = static_cast<std::size_t>(kMaxPowerDegree) + 1;
static_assert(kMaxPowerDegree >= kMaxDegree && kMaxPowerDegree >= kMaxAsymmetricDegree);
using Powers = std::array<std::array<double, kPowers>, kPowers>;

// The coefficients of x^k in T_n, by n and k.
constexpr Powers chebyshev_powers() {
  Powers t{};
  t[0][0] = 1.0;
  t[1][1] = 1.0;
  for (std::size_t n = 2; n < kPowers; ++n) {
    for (std::size_t k = 0; k < kPowers; ++k) t[n][k] = (k > 0 ? 2.0 * t[n - 1][k - 1] : 0.0) - t[n - 2][k];
  }
  return t;
}
constexpr Powers kChebyshev = chebyshev_powers();

std::size_t count_of_pairs(int degree) { return static_cast<std::size_t>(pair_count(degree)); }

// Adds a times as many values.
void add(float* to, const float* values, std::size_t count, float a) {
  for (std::size_t k = 0; k < count; ++k) to[k] += a * values[k];
}

}  // namespace

PreparedSum::PreparedSum(const ChebyshevSum& sum) : degree(std::max(sum.degree, 0)) {
  if (sum.degree < 0) return;
  wavelength_terms = sum.wavelength_terms;
  std::size_t from = 0;
  for (int l = 0; l < wavelength_terms; ++l) {
    std::vector<std::vector<double>> by_u;
    for (int u = 0; u <= degree; ++u) by_u.emplace_back(count_of_pairs(degree - u));
    for_each_term(degree, [&](int v, int w, int u) {
      const double c = sum.coefficients[from++];
      for (int j = v % 2; j <= v; j += 2)
        for (int k = w % 2; k <= w; k += 2)
          by_u[static_cast<std::size_t>(u)][static_cast<std::size_t>(power_index(j, k))] +=
              c * kChebyshev[static_cast<std::size_t>(v)][static_cast<std::size_t>(j)] *
              kChebyshev[static_cast<std::size_t>(w)][static_cast<std::size_t>(k)];
    });
    for (const auto& powers : by_u)
      for (const double c : powers) coefficients.push_back(static_cast<float>(c));
  }
}

PreparedZone::PreparedZone(const PolynomialZone& zone) : transmittance(zone.transmittance) {
  const auto prepared = [](const ChebyshevVector& vector) {
    return PreparedVector{PreparedSum(vector.along_field), PreparedSum(vector.along_pupil)};
  };
  sensor_mm = prepared(zone.sensor_mm);
  for (const ChebyshevVector& crossing : zone.stop) stop.push_back(prepared(crossing));
  for (const PolynomialRim& rim : zone.rims) rims.emplace_back(rim.squared);
}

FieldSum::FieldSum(const PreparedSum& sum, double field_coordinate)
    : degree(sum.degree), wavelength_terms(sum.wavelength_terms) {
  std::array<double, kPowers> by_u{};
  chebyshev_values(field_coordinate, by_u);
  const std::size_t pairs = count_of_pairs(degree);
  coefficients.assign(pairs * static_cast<std::size_t>(wavelength_terms), 0.0F);
  const float* from = sum.coefficients.data();
  for (int l = 0; l < wavelength_terms; ++l) {
    float* const to = coefficients.data() + static_cast<std::size_t>(l) * pairs;
    for (int u = 0; u <= degree; ++u) {
      const std::size_t count = count_of_pairs(degree - u);
      add(to, from, count, static_cast<float>(by_u[static_cast<std::size_t>(u)]));
      from += count;
    }
  }
}

FieldSum::FieldSum(const ChebyshevSum& sum, const Parities& parities, Vec2 s, const Mirroring& mirrored)
    : degree(std::max(sum.degree, 0)) {
  if (sum.degree < 0) return;
  wavelength_terms = sum.wavelength_terms;
  std::array<double, kPowers> sx{}, sy{};
  chebyshev_values(s.x, sx);
  chebyshev_values(s.y, sy);
  const std::size_t pairs = count_of_pairs(degree);
  coefficients.assign(pairs * static_cast<std::size_t>(wavelength_terms), 0.0F);
  std::size_t from = 0;
  for (int l = 0; l < wavelength_terms; ++l) {
    std::vector<double> chebyshev(pairs), powers(pairs);
    for_each_asymmetric_term(degree, parities, [&](int px, int py, int kx, int ky) {
      chebyshev[static_cast<std::size_t>(power_index(px, py))] += static_cast<double>(sum.coefficients[from++]) *
                                                                  sx[static_cast<std::size_t>(kx)] *
                                                                  sy[static_cast<std::size_t>(ky)];
    });
    for (int px = 0; px <= degree; ++px)
      for (int py = 0; px + py <= degree; ++py)
        for (int j = px % 2; j <= px; j += 2)
          for (int k = py % 2; k <= py; k += 2)
            powers[static_cast<std::size_t>(power_index(j, k))] +=
                chebyshev[static_cast<std::size_t>(power_index(px, py))] *
                kChebyshev[static_cast<std::size_t>(px)][static_cast<std::size_t>(j)] *
                kChebyshev[static_cast<std::size_t>(py)][static_cast<std::size_t>(k)];
    for (int j = 0; j <= degree; ++j)
      for (int k = 0; j + k <= degree; ++k) {
        const int turns = (mirrored.x ? j : 0) + (mirrored.y ? k : 0) + (mirrored.value ? 1 : 0);
        const bool turned = turns % 2 != 0;
        const auto at = static_cast<std::size_t>(power_index(j, k));
        coefficients[static_cast<std::size_t>(l) * pairs + at] = static_cast<float>(turned ? -powers[at] : powers[at]);
      }
  }
}

PowerSum FieldSum::at(double wavelength_coordinate) const {
  std::array<double, kMaxWavelengthTerms> by_wavelength{};
  chebyshev_values(wavelength_coordinate, by_wavelength);
  PowerSum sum{degree, {}};
  const std::size_t pairs = count_of_pairs(degree);
  for (std::size_t l = 0; l < static_cast<std::size_t>(wavelength_terms); ++l)
    add(sum.coefficients.data(), coefficients.data() + l * pairs, pairs, static_cast<float>(by_wavelength[l]));
  return sum;
}

}  // namespace contrejour::inline internal::polynomial
