// SPDX-License-Identifier: Apache-2.0
// Spectra and working colour spaces: CIE 1931 2 degree observer -> linear RGB (docs/physics/colour.md).
// Accuracy: chromaticities of D65 and A within 1e-4 of CIE 15. Thread-safety: pure functions.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

using Rgb = std::array<double, 3>;
using Xyz = std::array<double, 3>;

// Both scene-linear. White is illuminant D65 in both: ACEScg's own white is reached by Bradford adaptation.
enum class ColourSpace { Rec709, AcesCg };

// Relative spectral power by wavelength. D65 is 0 outside 300..830 nm; the others have no bounds.
struct IlluminantD65 {
  friend bool operator==(const IlluminantD65&, const IlluminantD65&) = default;
};
struct IlluminantA {
  friend bool operator==(const IlluminantA&, const IlluminantA&) = default;
};
struct EqualEnergy {
  friend bool operator==(const EqualEnergy&, const EqualEnergy&) = default;
};
struct BlackBody {
  double temperature_k = 6500;  // > 0
  friend bool operator==(const BlackBody&, const BlackBody&) = default;
};
// A measured spectrum: linear between its points, 0 beyond them.
struct SpectrumPoint {
  double lambda_nm = 0;
  double power = 0;
  friend bool operator==(const SpectrumPoint&, const SpectrumPoint&) = default;
};
struct TabulatedSpectrum {
  // At least two points with rising wavelengths and powers >= 0, some of it visible (read by spectrum_file.h).
  std::shared_ptr<const std::vector<SpectrumPoint>> points;
  friend bool operator==(const TabulatedSpectrum& a, const TabulatedSpectrum& b) {
    return a.points == b.points || (a.points && b.points && *a.points == *b.points);
  }
};
using Spectrum = std::variant<IlluminantD65, IlluminantA, EqualEnergy, BlackBody, TabulatedSpectrum>;

// Relative power, 1 at 560 nm; a tabulated spectrum is returned unscaled.
[[nodiscard]] CONTREJOUR_API double spectral_power(const Spectrum& spectrum, double lambda_nm);
// The mean power about a wavelength, with the weights of linear interpolation between whole nanometres, so that no
// narrow line falls between samples. Equal to spectral_power for all but tabulated spectra.
[[nodiscard]] CONTREJOUR_API double spectral_power_near(const Spectrum& spectrum, double lambda_nm);
[[nodiscard]] CONTREJOUR_API bool is_visible(const TabulatedSpectrum& spectrum);  // has power within 360 to 830 nm
[[nodiscard]] CONTREJOUR_API Xyz colour_matching(double lambda_nm);  // CIE 1931, 360..830 nm, 0 outside
[[nodiscard]] CONTREJOUR_API Xyz xyz_of(const Spectrum& spectrum);  // Y = 1
[[nodiscard]] CONTREJOUR_API std::array<double, 2> chromaticity(const Xyz& xyz);

[[nodiscard]] CONTREJOUR_API Rgb rgb_from_xyz(const Xyz& xyz, ColourSpace space);
[[nodiscard]] CONTREJOUR_API Xyz xyz_from_rgb(const Rgb& rgb, ColourSpace space);
[[nodiscard]] CONTREJOUR_API double luminance(const Rgb& rgb, ColourSpace space);

// RGB of a light of this spectrum, scaled so that its luminance is 1. D65 is (1, 1, 1) in both spaces. A channel may
// be negative: the spectrum's colour then lies outside the space's gamut (in Rec709, black bodies below 1900 K).
[[nodiscard]] CONTREJOUR_API Rgb rgb_of(const Spectrum& spectrum, ColourSpace space);

// N wavelengths that represent N bands of the visible spectrum, and the weight of each in each channel.
// Each channel's weights sum to 1 for any N, so a lens without wavelength dependence keeps the light's colour exactly;
// N -> infinity converges to the integral over the light's spectrum. Where a light has almost no power in a channel
// (the blue of a candle), the weights are bounded instead of exact.
struct SpectralBand {
  double lambda_nm = 550;
  Rgb weight{};  // the fraction of the light's channel value in the band; may be negative
  double spread_nm = 0;  // RMS width of the band about its wavelength, weighted by visibility
};
[[nodiscard]] CONTREJOUR_API std::vector<SpectralBand> spectral_bands(int count, const Spectrum& light,
                                                                      ColourSpace space);

// "D65", "A", "E", "3200K" -> spectrum. Errors: unknown name; temperature outside 500 to 100000 K.
[[nodiscard]] CONTREJOUR_API Result<Spectrum> parse_spectrum(const std::string& text);

}  // namespace contrejour
