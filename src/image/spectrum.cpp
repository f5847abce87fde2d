// SPDX-License-Identifier: Apache-2.0
// Spectra and the standard observer: docs/physics/colour.md.
#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "contrejour/expert/colour.h"
#include "image/cie_tables.h"

namespace contrejour {
namespace {

constexpr double kNormalisationNm = 560;  // spectral power is 1 here, as the CIE tabulates illuminants A and D65
constexpr double kSecondRadiationNmK = 1.438776877e7;  // c2 = h c / k, CODATA 2018
constexpr double kIlluminantAExponentNm = 1.435e7 / 2848;  // CIE 15:2018 eq. 4.1: c2 / T as of 1931

// (560 / lambda)^5 (exp(b / 560) - 1) / (exp(b / lambda) - 1), Planck's law relative to 560 nm; b = c2 / T.
// expm1 keeps hot bodies exact; the exponential of the difference keeps cold ones from overflowing.
double relative_planck(double lambda_nm, double b_nm) {
  if (!(lambda_nm > 0) || !(b_nm > 0)) return 0;
  const double at_560 = b_nm / kNormalisationNm;
  const double at_lambda = b_nm / lambda_nm;
  const double exponent = std::clamp(at_560 - at_lambda, -700.0, 700.0);
  const double bracket = std::expm1(-at_560) / std::expm1(-at_lambda);
  return std::pow(kNormalisationNm / lambda_nm, 5) * std::exp(exponent) * bracket;
}

double illuminant_d65(double lambda_nm) {
  const double position = (lambda_nm - cie::kD65FirstNm) / cie::kD65StepNm;
  if (!(position >= 0) || position > cie::kD65Count - 1) return 0;
  const auto i = std::min(static_cast<std::size_t>(position), cie::kIlluminantD65.size() - 2);
  const double t = position - static_cast<double>(i);
  return ((1 - t) * cie::kIlluminantD65[i] + t * cie::kIlluminantD65[i + 1]) / 100;
}

// The table's points; empty without a table.
const std::vector<SpectrumPoint>& points_of(const TabulatedSpectrum& table) {
  static const std::vector<SpectrumPoint> kNone;
  return table.points ? *table.points : kNone;
}

double tabulated(const std::vector<SpectrumPoint>& points, double lambda_nm) {
  const auto after = std::lower_bound(points.begin(), points.end(), lambda_nm,
                                      [](const SpectrumPoint& p, double nm) { return p.lambda_nm < nm; });
  if (after == points.end() || (after == points.begin() && after->lambda_nm != lambda_nm)) return 0;
  if (after->lambda_nm == lambda_nm) return after->power;
  const SpectrumPoint& before = *(after - 1);
  const double t = (lambda_nm - before.lambda_nm) / (after->lambda_nm - before.lambda_nm);
  return (1 - t) * before.power + t * after->power;
}

// Integral of the table times max(0, 1 - |l - lambda|) over l: both are straight between the points, lambda and
// lambda +- 1, and Simpson's rule is exact for their product.
double tabulated_near(const std::vector<SpectrumPoint>& points, double lambda_nm) {
  if (points.empty() || !std::isfinite(lambda_nm)) return 0;
  std::vector<double> knots{lambda_nm - 1, lambda_nm, lambda_nm + 1};
  const auto first = std::lower_bound(points.begin(), points.end(), lambda_nm - 1,
                                      [](const SpectrumPoint& p, double nm) { return p.lambda_nm < nm; });
  for (auto p = first; p != points.end() && p->lambda_nm < lambda_nm + 1; ++p) knots.push_back(p->lambda_nm);
  std::sort(knots.begin(), knots.end());
  const auto product = [&](double nm) { return tabulated(points, nm) * std::max(0.0, 1 - std::abs(nm - lambda_nm)); };
  // A table may begin or end above 0: wavelengths beyond its ends count as 0.
  const double from = points.front().lambda_nm, to = points.back().lambda_nm;
  double sum = 0;
  for (std::size_t k = 1; k < knots.size(); ++k) {
    const double a = knots[k - 1], b = knots[k];
    if (!(b > a) || b <= from || a >= to) continue;
    sum += (b - a) / 6 * (product(a) + 4 * product(0.5 * (a + b)) + product(b));
  }
  return sum;
}

struct PowerAt {
  double lambda_nm;
  double operator()(IlluminantD65) const { return illuminant_d65(lambda_nm); }
  double operator()(IlluminantA) const { return relative_planck(lambda_nm, kIlluminantAExponentNm); }
  double operator()(EqualEnergy) const { return 1; }
  double operator()(BlackBody body) const {
    return relative_planck(lambda_nm, kSecondRadiationNmK / body.temperature_k);
  }
  double operator()(const TabulatedSpectrum& table) const { return tabulated(points_of(table), lambda_nm); }
};

}  // namespace

double spectral_power(const Spectrum& spectrum, double lambda_nm) { return std::visit(PowerAt{lambda_nm}, spectrum); }

double spectral_power_near(const Spectrum& spectrum, double lambda_nm) {
  const auto* const table = std::get_if<TabulatedSpectrum>(&spectrum);
  return table != nullptr ? tabulated_near(points_of(*table), lambda_nm) : spectral_power(spectrum, lambda_nm);
}

bool is_visible(const TabulatedSpectrum& spectrum) {
  if (!spectrum.points || spectrum.points->size() < 2) return false;
  for (int nm = cie::kObserverFirstNm + 1; nm < cie::kObserverLastNm; ++nm)
    if (spectral_power_near(spectrum, nm) > 0) return true;
  return false;
}

Xyz colour_matching(double lambda_nm) {
  const double position = lambda_nm - cie::kObserverFirstNm;
  if (!(position >= 0) || position > cie::kObserverCount - 1) return {};
  const auto i = std::min(static_cast<std::size_t>(position), cie::kObserver1931.size() - 2);
  const double t = position - static_cast<double>(i);
  Xyz xyz{};
  for (std::size_t c = 0; c < 3; ++c) xyz[c] = (1 - t) * cie::kObserver1931[i][c] + t * cie::kObserver1931[i + 1][c];
  return xyz;
}

// CIE 15:2018 eq. 7.1: sums over 1 nm from 360 to 830.
Xyz xyz_of(const Spectrum& spectrum) {
  Xyz sum{};
  for (int nm = cie::kObserverFirstNm; nm <= cie::kObserverLastNm; ++nm) {
    const double power = spectral_power_near(spectrum, nm);
    const auto& observer = cie::kObserver1931[static_cast<std::size_t>(nm - cie::kObserverFirstNm)];
    for (std::size_t c = 0; c < 3; ++c) sum[c] += power * observer[c];
  }
  return {sum[0] / sum[1], 1.0, sum[2] / sum[1]};
}

std::array<double, 2> chromaticity(const Xyz& xyz) {
  const double sum = xyz[0] + xyz[1] + xyz[2];
  return {xyz[0] / sum, xyz[1] / sum};
}

Result<Spectrum> parse_spectrum(const std::string& text) {
  if (text == "D65" || text == "d65") return Spectrum(IlluminantD65{});
  if (text == "A" || text == "a") return Spectrum(IlluminantA{});
  if (text == "E" || text == "e") return Spectrum(EqualEnergy{});
  double kelvin = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, status] = std::from_chars(text.data(), end, kelvin);
  const bool is_temperature = status == std::errc{} && rest + 1 == end && (*rest == 'K' || *rest == 'k');
  if (!is_temperature)
    return failure(
        ErrorCode::InvalidArgument,
        fmt::format("no spectrum is called '{}'; say D65, A, E, a temperature such as 3200K, led, sodium, sodium-low, "
                    "fluorescent, fluorescent-narrow or a file",
                    text));
  if (!(kelvin >= 500 && kelvin <= 100000))
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("a colour temperature of {} is out of range; say 500K to 100000K", text));
  return Spectrum(BlackBody{kelvin});
}

}  // namespace contrejour
