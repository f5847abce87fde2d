// SPDX-License-Identifier: Apache-2.0
// A lens's ghosts as polynomials, fitted once for the whole field and all visible wavelengths: from a ray of a distant
// light to its point on the sensor, its points at the stop and at the rims that can block it, and its transmittance.
// docs/physics/polynomial.md derives the basis; docs/formats/poly.md describes the file.
// Units: mm, nm; field angles as tangents. Frame: the light's meridional one (light from -x or along the axis).
// Accuracy: that of PolynomialAccuracy, measured on rays left out of the fit; a part of the field in which a ghost does
// not reach it is marked Traced and has no polynomials. Ghosts without axial symmetry (anamorphic and decentred lenses)
// have zones in both directions of the field instead, AsymmetricZone. Thread-safety: plain values, pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/lens.h"

namespace contrejour {

struct PolynomialOptions {
  // The largest angle of a light to the axis; 0: that of the sensor's corner, and a tenth more of its tangent.
  double half_field_rad = 0.0;
  // The errors of rays left out up to which a fit is accepted: of 95 per cent of them, on the sensor in pixels of the
  // sensor's width / 1920, at the stop and the rims in radii, and of the transmittance relative to its largest value.
  double position_px = 0.25;
  double edge = 1e-3;
  double transmittance = 2e-3;
  // Orders rise from 5 in steps of 2 until 95 per cent of errors are below this, or the largest order is reached.
  double target_px = 0.007;
  int max_order = 17;  // 5, 7, 9, 11, 13, 15 or 17
  int max_halvings = 3;  // of the field, where a ghost fails; 0 to 4
  GhostScope scope = GhostScope::All;
  Reflections reflections = Reflections::Two;
  std::vector<Ghost> ghosts = {};  // if any: only these, whatever the scope
  // Whether ghosts without axial symmetry are fitted, too; else they are Traced. This takes about a
  // second each where there is no mirror plane.
  bool asymmetric = true;
};

// A function of u, v, w and the wavelength as a sum of products of Chebyshev polynomials. Coefficients by degree in the
// wavelength's coordinate, then by the degrees in v, w and u, u fastest; the degrees in u, v, w sum to at most
// `degree`.
struct ChebyshevSum {
  int degree = -1;  // -1: no coefficients, the function is 0
  int wavelength_terms = 0;
  float step = 1.0F;  // a power of 2 of which all coefficients are multiples, which makes files small
  std::vector<float> coefficients;
};

// A vector that turns with the lens: h A + p B, where h is the field over its largest value and p the pupil point.
struct ChebyshevVector {
  ChebyshevSum along_field, along_pupil;
};

struct PolynomialAccuracy {
  double position_p50_px = 0.0, position_p95_px = 0.0, position_max_px = 0.0;  // of light in or near the frame
  double edge_p95 = 0.0;  // radii, of the stop and of rims
  double transmittance_p95 = 0.0;  // relative to the largest, of the same light
  int rays = 0;  // left out of the fit, and compared
};

// The squared relative height at one step of the ghost's path, whose rim can block its light.
struct PolynomialRim {
  int step = 0;  // 0-based index in OpticalPath::steps
  ChebyshevSum squared;
};

// The part of the entrance plane within which a ghost's light enters, at one field: symmetric in y.
struct PolynomialBounds {
  float field = 0.0F, low_x_mm = 0.0F, high_x_mm = 0.0F, half_y_mm = 0.0F;  // low_x >= high_x: no light
};

struct PolynomialZone {
  enum class State : std::uint8_t {
    Fitted,
    Traced,  // no fit reaches the accuracy: rays must be traced
    Dark,  // no light gets through
  };
  State state = State::Dark;
  double field_low = 0.0, field_high = 0.0;  // tangents of the light's angle to the axis
  int order = 0;  // of the sensor's position in the field and pupil coordinates
  // p = (e - (centre + centre_slope u) field) / radius for the point e of the entrance plane, along x.
  double centre_mm = 0.0, centre_slope_mm = 0.0, radius_mm = 1.0;
  // Above 0: positions on the sensor and transmittances are polynomials in s = 1 - 2 sqrt(1 - p.p / pupil_end^2), 1
  // beyond |p| = pupil_end, in place of w = 2 p.p - 1.
  double pupil_end = 0.0;
  std::vector<PolynomialBounds> bounds;  // by rising field
  ChebyshevVector sensor_mm;
  std::vector<ChebyshevVector> stop;  // by crossing, over LensPolynomials::stop_radius_mm
  std::vector<PolynomialRim> rims;
  ChebyshevSum transmittance;
  PolynomialAccuracy accuracy;
  double flux_mm2 = 0.0;  // mean over the zone's area of the ghost's flux at 550 nm, by the fit's rays
};

// The part of the entrance plane within which light of one direction enters; low_x >= high_x: no light.
struct AsymmetricBounds {
  float low_x_mm = 0.0F, low_y_mm = 0.0F, high_x_mm = 0.0F, high_y_mm = 0.0F;
};

// Vectors in the lens's frame, without symmetry: a polynomial each for x and y.
struct AsymmetricVector {
  ChebyshevSum x, y;
};

// A rectangle of light directions of a ghost without axial symmetry. Polynomials are sums of products of Chebyshev
// polynomials in s, the direction's tangents scaled to [-1, 1] over the zone, and p, the pupil point. Coefficients by
// degree in the wavelength's coordinate, then by the degrees in p_x, p_y, s_x and s_y, s_y fastest; these sum to at
// most `degree`. Where the zone is even in x, terms that have not the parity of their output in (p_x, s_x) are left
// out: the vectors' x is odd, all else even; likewise in y.
struct AsymmetricZone {
  PolynomialZone::State state = PolynomialZone::State::Dark;
  Vec2 low, high;  // tangents of the light's direction: x / z and y / z
  bool even_x = false, even_y = false;  // the lens has this mirror plane, and the zone is symmetric about it
  int order = 0;  // of the sensor's position
  // p = ((e_x - centre_x) / radius_x, (e_y - centre_y) / radius_y). Centres are cubic polynomials: coefficients of
  // T_i(s_x) T_j(s_y) by i, then j, with i + j <= 3.
  std::array<double, 10> centre_x_mm{}, centre_y_mm{};
  Vec2 radius_mm{1.0, 1.0};
  int bounds_side = 0;  // bounds are of a grid of directions, as many as this in x and y, corners included, x fastest
  std::vector<AsymmetricBounds> bounds;
  AsymmetricVector sensor_mm;
  std::vector<AsymmetricVector> stop;  // by crossing, over LensPolynomials::stop_radius_mm
  std::vector<PolynomialRim> rims;
  ChebyshevSum transmittance;
  PolynomialAccuracy accuracy;
  double flux_mm2 = 0.0;  // mean over the zone's area of the ghost's flux at 550 nm
};

struct GhostPolynomials {
  Ghost ghost;
  // By rising field, adjoining. If the ghost has no axial symmetry, one that is Traced, and `asymmetric` tells more.
  std::vector<PolynomialZone> zones;
  // Rectangles that together cover the field. Where the lens has a mirror plane, zones that are not even are those of
  // one side: light of the other is the mirror image.
  std::vector<AsymmetricZone> asymmetric = {};
  bool mirror_x = false, mirror_y = false;  // x -> -x, y -> -y change nothing
};

struct LensPolynomials {
  std::string lens;  // its name
  std::uint64_t fingerprint = 0;  // of the lens's shapes, glasses and coatings
  double entrance_z_mm = 0.0;  // of the entrance plane
  double stop_radius_mm = 1.0;  // widest opening, for which the fit was made; smaller ones need no other fit
  double pixel_mm = 0.01;  // that accuracies are stated in
  double shortest_nm = 380.0, longest_nm = 730.0;
  double max_field = 0.0;  // tangent
  std::vector<GhostPolynomials> ghosts;
};

// Fits all ghosts of a lens, wide open, in parallel; the result does not depend on the number of threads. Ghosts that
// pass an obscuration and those of a sensor's grating are marked Traced. Errors: options out of range, Cancelled.
[[nodiscard]] CONTREJOUR_API Result<LensPolynomials> fit_polynomials(const LensState& lens,
                                                                     const PolynomialOptions& options = {},
                                                                     const Context& context = {});

// Equal for lenses whose ghosts take the same paths: the stop's opening, the iris and dirt do not count.
[[nodiscard]] CONTREJOUR_API std::uint64_t polynomial_fingerprint(const LensState& lens);

// The fraction of the flux of all ghosts and zones that is Traced, weighted by the zones' areas of the field.
[[nodiscard]] CONTREJOUR_API double traced_flux_fraction(const LensPolynomials& polynomials);

// Files, docs/formats/poly.md. Errors: Io; Parse for anything that is not a whole and consistent file.
[[nodiscard]] CONTREJOUR_API std::string write_polynomials(const LensPolynomials& polynomials);
[[nodiscard]] CONTREJOUR_API Result<LensPolynomials> read_polynomials(std::string_view bytes, const std::string& file);
[[nodiscard]] CONTREJOUR_API Result<LensPolynomials> read_polynomial_file(const std::filesystem::path& file);

struct PolynomialRay {
  Vec2 sensor_mm;
  std::array<Vec2, kMaxStopCrossings> stop{};  // over LensPolynomials::stop_radius_mm
  double relative_height = 0.0;  // the largest at the rims that can block; > 1 is blocked
  double transmittance = 0.0;
};

// Evaluates a zone in double for a light at the tangent `field` along x, for the ray through a point of the entrance
// plane. The field must lie within the zone, which must be Fitted.
[[nodiscard]] CONTREJOUR_API PolynomialRay evaluate(const LensPolynomials& polynomials, const PolynomialZone& zone,
                                                    double field, Vec2 entrance_mm, double lambda_nm);

// Source code that evaluates ghosts' polynomials without this library: C99, GLSL 3.30 or later, HLSL of Shader Model 4
// or later, or Python 3. It defines
//   ray(ghost, field, x_mm, y_mm, lambda_nm): the index of the ghost in `ghosts`, the tangent of the light's angle, the
// point of the entrance plane and the wavelength. The result is 10 numbers: the sensor's x and y in mm, x and y at
// three crossings of the stop in widest radii, the largest squared relative height, and the transmittance; in C, GLSL
// and HLSL they are written to an array, and the function returns whether the ghost is fitted at that field; Python
// returns None where it is not.
//   bounds(ghost, field): 3 numbers in the same way, the lowest and highest x and half the height of the part of the
// entrance plane in which the ghost's light enters, with a margin.
// For ghosts without axial symmetry it defines, in the lens's frame,
//   ray_at(ghost, tangent_x, tangent_y, x_mm, y_mm, lambda_nm): light travels along (tangent_x, tangent_y, 1),
//   bounds_at(ghost, tangent_x, tangent_y): 4 numbers, the lowest x and y and the highest x and y.
// In GLSL and HLSL a program that defines the macro COEFFICIENT(i), with the prefix, before the code has no table of
// coefficients, which it then reads from a buffer of its own: C has them as an array. Names begin with `prefix`.
// Errors: InvalidArgument for a ghost that the fit does not have, and for a prefix that is no identifier. Accuracy:
// that of the fit; GLSL and HLSL in float, the others in double.
enum class PolynomialLanguage : std::uint8_t { C, Glsl, Hlsl, Python };
[[nodiscard]] CONTREJOUR_API Result<std::string> export_polynomials(const LensPolynomials& polynomials,
                                                                    const std::vector<Ghost>& ghosts,
                                                                    PolynomialLanguage language,
                                                                    std::string_view prefix = "flare_");

// The zone of a ghost at a field; null if the ghost has none there.
[[nodiscard]] CONTREJOUR_API const PolynomialZone* find_zone(const GhostPolynomials& ghost, double field);

// The zone of a ghost without axial symmetry for light with these tangents, x / z and y / z, and whether it is that of
// the mirror image. Null if the ghost has none there.
struct FoundAsymmetricZone {
  const AsymmetricZone* zone = nullptr;
  bool mirrored_x = false, mirrored_y = false;
};
// The area of the field that a zone stands for, with its mirror images; of tangents, over pi, as that of a circular
// field is the square of its tangent.
[[nodiscard]] CONTREJOUR_API double area_of(const GhostPolynomials& ghost, const AsymmetricZone& zone);
[[nodiscard]] CONTREJOUR_API FoundAsymmetricZone find_zone(const GhostPolynomials& ghost, Vec2 tangents);

// The same as above for a ghost without axial symmetry, in the lens's frame; none where the ghost is not fitted.
[[nodiscard]] CONTREJOUR_API std::optional<PolynomialRay> evaluate(const LensPolynomials& polynomials,
                                                                   const GhostPolynomials& ghost, Vec2 tangents,
                                                                   Vec2 entrance_mm, double lambda_nm);

}  // namespace contrejour
