// SPDX-License-Identifier: Apache-2.0
// Thin-film coatings: which films lie on a surface, and what they reflect and transmit.
// Exact for plane-parallel homogeneous films of any number, s and p (Abeles transfer matrices; Born & Wolf
// 1.6, Byrnes arXiv:1603.02720). Lossless films give R + T = 1 to 1e-12 at any angle.
// Thread-safety: plain values and pure functions.
#pragma once

#include <complex>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "contrejour/expert/film_material.h"
#include "contrejour/expert/glass.h"
#include "contrejour/export.h"

namespace contrejour {

struct FilmLayer {
  FilmMaterial material;
  double thickness_nm = 0.0;
  friend bool operator==(const FilmLayer&, const FilmLayer&) = default;
};

struct Bare {
  friend bool operator==(const Bare&, const Bare&) = default;
};

// One film of index n, a quarter of lambda0 thick at normal incidence: d = lambda0 / (4 n). MgF2 by default.
struct QuarterWave {
  double n = 1.38;
  double lambda0_nm = 550.0;
  friend bool operator==(const QuarterWave&, const QuarterWave&) = default;
};

// Any stack, listed from the low-index side (air) to the glass, whatever the direction of the light.
struct FilmStack {
  std::vector<FilmLayer> layers;
  friend bool operator==(const FilmStack&, const FilmStack&) = default;
};

// The formula printed in hullin2011's supplement, for comparison only: it squares t01 where t01 * t10
// belongs, so it reflects up to a third too much (docs/physics/coatings.md).
struct HullinFresnelAR {
  double n = 1.38;
  double lambda0_nm = 550.0;
  friend bool operator==(const HullinFresnelAR&, const HullinFresnelAR&) = default;
};

// A standard coating, computed for each glass that it lies on (Macleod, Thin-Film Optical Filters, 3):
enum class CoatingDesign {
  VCoat,               // MgF2 on ZrO2: zero reflectance at lambda0
  WCoat,               // a quarter wave of MgF2 on half a wave of SiO: low at two wavelengths about lambda0
  QuarterHalfQuarter,  // MgF2, ZrO2, Al2O3
  Broadband,           // MgF2 outermost, then SiO2 and Ta2O5 alternating; lowest mean from 0.76 to 1.24 lambda0
};
struct DesignedCoating {
  static constexpr int kMinLayers = 4, kMaxLayers = 7;
  CoatingDesign design = CoatingDesign::VCoat;
  double lambda0_nm = 550.0;
  int layers = kMinLayers;  // of Broadband, 4 to 7
  friend bool operator==(const DesignedCoating&, const DesignedCoating&) = default;
};

// Measured unpolarised reflectances by wavelength and angle of incidence in air, interpolated linearly and constant
// beyond the table. The coating absorbs nothing.
struct MeasuredCoating {
  std::vector<double> lambda_nm, angle_deg;  // each rising, one value at least
  std::vector<double> reflectance;           // 0 to 1; all angles of the first wavelength, then of the next
  friend bool operator==(const MeasuredCoating&, const MeasuredCoating&) = default;
};

struct Coating {
  std::string name;  // as the user wrote it, may be empty
  std::variant<Bare, QuarterWave, FilmStack, HullinFresnelAR, DesignedCoating, MeasuredCoating> films;
  friend bool operator==(const Coating&, const Coating&) = default;
};

// A short text for tables and JSON: "none", "quarter-wave 550 nm n=1.38", "stack of 3 layers", ...
[[nodiscard]] CONTREJOUR_API std::string describe(const Coating& coating);

// Computes the films of a design on a glass. Broadband designs are refined for the glass, which takes about 5 ms
// (film_design.h).
[[nodiscard]] CONTREJOUR_API FilmStack designed_for(const DesignedCoating& design, const Glass& glass);

// Replaces a DesignedCoating by its films, designed for the glass with the higher index; other coatings stay as they
// are.
[[nodiscard]] CONTREJOUR_API Coating placed_on(const Coating& coating, const Glass& before, const Glass& after);
// The coating at this wavelength alone, with indices as numbers, which makes later calls faster.
[[nodiscard]] CONTREJOUR_API Coating at_wavelength(const Coating& coating, double lambda_nm);
// True if the coating may absorb light.
[[nodiscard]] CONTREJOUR_API bool may_absorb(const Coating& coating);

// Amplitudes and powers of a stack between two half-spaces, convention exp(-i w t); r_p = -r_s at normal
// incidence; T counts the power that leaves into the last medium per power that comes in.
struct FilmResponse {
  std::complex<double> r_s, r_p, t_s, t_p;
  double R_s = 0, R_p = 0, T_s = 0, T_p = 0;
};

// layers run from the side of n_in to the side of n_out, or the other way; theta_in in n_in (real angle, radians).
enum class FilmOrder { AsListed, Reversed };
[[nodiscard]] CONTREJOUR_API FilmResponse film_response(std::complex<double> n_in, std::span<const FilmLayer> layers,
                                                        std::complex<double> n_out, double theta_in_rad,
                                                        double lambda_nm, FilmOrder order = FilmOrder::AsListed);

// Power reflectance of a coated surface for unpolarised light that comes from n_in at cos_in (0..1);
// 1 under total reflection. T = 1 - R for lossless films. A DesignedCoating is computed anew at every call: use
// placed_on() first.
[[nodiscard]] CONTREJOUR_API double reflectance(const Coating& coating, double n_in, double n_out, double cos_in,
                                                double lambda_nm);

// Unpolarised transmittance: 1 - R unless a film absorbs.
[[nodiscard]] CONTREJOUR_API double transmittance(const Coating& coating, double n_in, double n_out, double cos_in,
                                                  double lambda_nm);

}  // namespace contrejour
