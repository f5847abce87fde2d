// SPDX-License-Identifier: Apache-2.0
// Exact camera rays: from a point of the sensor backwards through a point of the stop to the front of the lens.
#pragma once

#include <optional>
#include <vector>

#include "contrejour/expert/trace.h"

namespace contrejour::inline internal::polynomial {

// A camera ray that was traced.
struct CameraRay {
  Vec2 origin_mm;  // in the front plane
  Vec2 direction, inner;  // x and y of the unit vectors to the scene, and at the sensor
  double transmittance = 0.0;
  std::vector<double> rim_squared;  // squared relative height by step of direct_path()
  double largest_height = 0.0;  // of them, not squared
};

// The camera rays of a lens at one wavelength. The lens must be centred.
class CameraRays {
 public:
  CameraRays(const LensState& lens, double lambda_nm, double front_z_mm);

  // The direction, x and y, with which a ray leaves a sensor point to cross a stop point, in stop radii: Newton's
  // method from a direction near it. None if it does not converge.
  [[nodiscard]] std::optional<Vec2> aimed(Vec2 sensor_mm, Vec2 stop, Vec2 start) const;
  // The direction as if there were no glass, to start from.
  [[nodiscard]] Vec2 straight(Vec2 sensor_mm, Vec2 stop) const;
  [[nodiscard]] std::optional<CameraRay> trace_from(Vec2 sensor_mm, Vec2 inner) const;

 private:
  [[nodiscard]] std::optional<Vec2> stop_point(Vec2 sensor_mm, Vec2 inner) const;

  OpticalPath whole_, to_stop_;
  double sensor_z_mm_, stop_z_mm_;
};

}  // namespace contrejour::inline internal::polynomial
