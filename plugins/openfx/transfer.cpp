// SPDX-License-Identifier: Apache-2.0
#include "openfx/transfer.h"

#include <cmath>

namespace contrejour::openfx {
namespace {

// IEC 61966-2-1.
double srgb_to_linear(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }
double srgb_from_linear(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055; }

// ACES S-2016-001, ACEScct.
double acescct_to_linear(double v) {
  return v <= 0.155251141552511 ? (v - 0.0729055341958355) / 10.5402377416545 : std::exp2(v * 17.52 - 9.72);
}
double acescct_from_linear(double v) {
  return v <= 0.0078125 ? 10.5402377416545 * v + 0.0729055341958355 : (std::log2(v) + 9.72) / 17.52;
}

// ARRI, "ALEXA LogC Curve, Usage in VFX" (2017), table of the parameters for the exposure index 800.
struct LogC3 {
  static constexpr double kCut = 0.010591, kA = 5.555556, kB = 0.052272, kC = 0.247190, kD = 0.385537, kE = 5.367655,
                          kF = 0.092809;
  static double to_linear(double v) {
    return v > kE * kCut + kF ? (std::pow(10.0, (v - kD) / kC) - kB) / kA : (v - kF) / kE;
  }
  static double from_linear(double v) { return v > kCut ? kC * std::log10(kA * v + kB) + kD : kE * v + kF; }
};

// ARRI, "LogC4 Logarithmic Color Space" (2022), section 3.
struct LogC4 {
  double a = (std::exp2(18.0) - 16.0) / 117.45, b = (1023.0 - 95.0) / 1023.0, c = 95.0 / 1023.0;
  double s = 7.0 * std::log(2.0) * std::exp2(7.0 - 14.0 * c / b) / (a * b);
  double t = (std::exp2(14.0 * (-c / b) + 6.0) - 64.0) / a;
  [[nodiscard]] double to_linear(double v) const {
    return v >= 0.0 ? (std::exp2(14.0 * (v - c) / b + 6.0) - 64.0) / a : v * s + t;
  }
  [[nodiscard]] double from_linear(double v) const {
    return v >= t ? (std::log2(a * v + 64.0) - 6.0) / 14.0 * b + c : (v - t) / s;
  }
};

// Sony, "Technical Summary for S-Gamut3.Cine/S-Log3 and S-Gamut3/S-Log3" (2014), appendix.
struct SLog3 {
  static constexpr double kCut = 0.01125, kCodedCut = 171.2102946929;
  static double to_linear(double v) {
    const double code = v * 1023.0;
    return code >= kCodedCut ? std::pow(10.0, (code - 420.0) / 261.5) * 0.19 - 0.01
                             : (code - 95.0) * kCut / (kCodedCut - 95.0);
  }
  static double from_linear(double v) {
    const double code =
        v >= kCut ? 420.0 + std::log10((v + 0.01) / 0.19) * 261.5 : v * (kCodedCut - 95.0) / kCut + 95.0;
    return code / 1023.0;
  }
};

double odd_power(double v, double exponent) { return std::copysign(std::pow(std::abs(v), exponent), v); }

}  // namespace

std::vector<std::string> transfer_menu() {
  return {"linear", "sRGB", "gamma 2.2", "gamma 2.4", "ACEScct", "LogC3 (EI 800)", "LogC4", "S-Log3"};
}

double linear_from(double coded, TransferCurve curve) {
  switch (curve) {
    case TransferCurve::Linear: return coded;
    case TransferCurve::Srgb: return coded < 0.0 ? -srgb_to_linear(-coded) : srgb_to_linear(coded);
    case TransferCurve::Gamma22: return odd_power(coded, 2.2);
    case TransferCurve::Gamma24: return odd_power(coded, 2.4);
    case TransferCurve::AcesCct: return acescct_to_linear(coded);
    case TransferCurve::LogC3: return LogC3::to_linear(coded);
    case TransferCurve::LogC4: return LogC4().to_linear(coded);
    case TransferCurve::SLog3: return SLog3::to_linear(coded);
  }
  return coded;
}

double coded_from(double linear, TransferCurve curve) {
  switch (curve) {
    case TransferCurve::Linear: return linear;
    case TransferCurve::Srgb: return linear < 0.0 ? -srgb_from_linear(-linear) : srgb_from_linear(linear);
    case TransferCurve::Gamma22: return odd_power(linear, 1.0 / 2.2);
    case TransferCurve::Gamma24: return odd_power(linear, 1.0 / 2.4);
    case TransferCurve::AcesCct: return acescct_from_linear(linear);
    case TransferCurve::LogC3: return LogC3::from_linear(linear);
    case TransferCurve::LogC4: return LogC4().from_linear(linear);
    case TransferCurve::SLog3: return SLog3::from_linear(linear);
  }
  return linear;
}

}  // namespace contrejour::openfx
