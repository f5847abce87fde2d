// SPDX-License-Identifier: Apache-2.0
// A lens as polynomials for camera rays: from a point of the sensor and a point of the stop to the ray in front of the
// lens, for path tracers and renderers of bokeh, and back from a point of the scene to the sensor.
// docs/physics/polynomial.md, "Direct image", derives the basis; docs/formats/poly.md describes the file.
// Units: mm, nm; stop points in radii of the widest stop. Frame: that of the lens (lens.h): light travels to +z, x
// points right and y up as the photographer sees them, so that camera rays go to -z, and the image on the sensor is
// upside down. Accuracy: DirectAccuracy, measured on rays left out of the fit. Thread-safety: plain values, pure
// functions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "contrejour/context.h"
#include "contrejour/expert/polynomial.h"
#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/lens.h"

namespace contrejour {

struct DirectFitOptions {
  double max_height_mm = 0.0;  // largest distance of a sensor point from the axis; 0: the corner's, and 2 per cent more
  // Orders rise from 5 in steps of 2 until 95 per cent of errors are below these, or the largest order is reached:
  // where a ray lands, in pixels of the sensor's width / 1920; at the rims in radii; transmittance relative to the
  // largest.
  double position_px = 0.01, edge = 3e-4, transmittance = 5e-4;
  int max_order = 17;  // 5, 7, 9, 11, 13, 15 or 17
};

// Errors of rays that were left out of the fit, at random sensor points, stop points and wavelengths: the ray that the
// polynomials give is traced through the lens, and should land on the sensor point and cross the stop point.
struct DirectAccuracy {
  double sensor_p50_px = 0.0, sensor_p95_px = 0.0, sensor_max_px = 0.0;
  double stop_p95 = 0.0;  // radii
  double rim_p95 = 0.0;  // radii
  double transmittance_p95 = 0.0;  // relative to the largest
  // Fractions of these rays that the polynomials let through though a rim blocks them by more than 1 per cent of its
  // radius, and that they block though all rims let them through by as much.
  double let_through = 0.0, blocked = 0.0;
  int rays = 0;  // that get through
};

// With h = sensor point / max_height_mm and p = stop point / kMargin, vectors are h A + p B and scalars C, functions of
// u = 2 h.h - 1, v = h.p, w = 2 p.p - 1 and the wavelength (ChebyshevSum).
struct DirectPolynomials {
  static constexpr double kMargin = 1.04;  // stop points up to here

  std::string lens;  // its name
  std::uint64_t fingerprint = 0;  // polynomial_fingerprint()
  double focal_length_mm = 0.0;
  double front_z_mm = 0.0;  // plane in front of the lens in which rays are given
  double sensor_z_mm = 0.0;
  double stop_radius_mm = 1.0;  // widest opening, for which the fit was made; smaller ones need no other fit
  double max_height_mm = 0.0;
  double pixel_mm = 0.01;
  double shortest_nm = 380.0, longest_nm = 730.0;
  ChebyshevVector origin_mm;  // x and y in the front plane
  ChebyshevVector direction;  // x and y of the unit vector to the scene
  ChebyshevVector inner;  // x and y of the unit vector with which the camera ray leaves the sensor
  std::vector<PolynomialRim> rims;  // steps of direct_path()
  ChebyshevSum transmittance;
  DirectAccuracy accuracy;
};

// Fits the direct image of a lens, wide open; order and accuracy are those reached. In parallel; the result does not
// depend on the number of threads. Errors: options out of range; Unsupported for a lens without axial symmetry, one
// with obscurations, and one that lets no ray to most of its field; Cancelled.
[[nodiscard]] CONTREJOUR_API Result<DirectPolynomials> fit_direct_polynomials(const LensState& lens,
                                                                              const DirectFitOptions& options = {},
                                                                              const Context& context = {});

// The highest order of the ray's coordinates.
[[nodiscard]] CONTREJOUR_API int order_of(const DirectPolynomials& polynomials);

struct DirectRay {
  Vec3 origin_mm;  // in the front plane
  Vec3 direction;  // unit, to the scene: z < 0
  double relative_height = 0.0;  // the largest at the rims that can block; > 1 is blocked
  double transmittance = 0.0;
  // Projected solid angle at the sensor by area of the stop, in which the widest stop is the unit disc. The irradiance
  // on the sensor is the integral over the opening of radiance * transmittance * weight.
  double weight = 0.0;
};
// The camera ray from a point of the sensor through one of the stop. None beyond max_height_mm or kMargin, and where
// the polynomials give no direction.
[[nodiscard]] CONTREJOUR_API std::optional<DirectRay> direct_ray(const DirectPolynomials& polynomials, Vec2 sensor_mm,
                                                                 Vec2 stop, double lambda_nm);

// A point of the scene, or with `distant` the direction to one at infinity (any length).
struct ScenePoint {
  Vec3 at_mm;
  bool distant = false;
};
// The point of the sensor that the scene's point sends light to through a point of the stop: Newton's method on
// direct_ray(). None if it lies outside the fit, or if the scene's point is not in front of the front plane.
[[nodiscard]] CONTREJOUR_API std::optional<Vec2> direct_sensor_point(const DirectPolynomials& polynomials,
                                                                     const ScenePoint& point, Vec2 stop,
                                                                     double lambda_nm);

// The same polynomials at one wavelength: smaller, and several times faster. Their range of wavelengths stays; they
// give the values at lambda_nm for each.
[[nodiscard]] CONTREJOUR_API DirectPolynomials at_wavelength(const DirectPolynomials& polynomials, double lambda_nm);

// Files, docs/formats/poly.md. Errors: Io; Parse for anything that is not a whole and consistent file.
[[nodiscard]] CONTREJOUR_API std::string write_direct_polynomials(const DirectPolynomials& polynomials);
[[nodiscard]] CONTREJOUR_API Result<DirectPolynomials> read_direct_polynomials(std::string_view bytes,
                                                                               const std::string& file);
[[nodiscard]] CONTREJOUR_API Result<DirectPolynomials> read_direct_polynomial_file(const std::filesystem::path& file);
// Whether a file has the direct image; false for fits of ghosts and for what is no such file.
[[nodiscard]] CONTREJOUR_API bool is_direct_polynomial_file(const std::filesystem::path& file);

// Source code that evaluates the polynomials without this library, in the languages of export_polynomials():
//   ray(sensor_x_mm, sensor_y_mm, stop_x, stop_y, lambda_nm): 9 numbers, the ray's origin and direction, transmittance,
// largest squared relative height and weight;
//   sensor(x, y, z, w, stop_x, stop_y, lambda_nm): 2 numbers, the sensor's point for the scene's point (x, y, z), or
//   for
// the direction if w is 0 (else 1), by at most 12 steps of Newton's method.
// In C, GLSL and HLSL they are written to an array, and the functions return whether there is a ray or a point; Python
// returns None where there is none; COEFFICIENT(i) is as there. Names begin with `prefix`. Errors: InvalidArgument for
// a prefix that is no identifier. Accuracy: that of the fit; GLSL and HLSL in float, the others in double.
[[nodiscard]] CONTREJOUR_API Result<std::string> export_direct_polynomials(const DirectPolynomials& polynomials,
                                                                           PolynomialLanguage language,
                                                                           std::string_view prefix = "lens_");

}  // namespace contrejour
