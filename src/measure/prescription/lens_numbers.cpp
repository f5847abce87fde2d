// SPDX-License-Identifier: Apache-2.0
#include "measure/prescription/lens_numbers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "optics/lens/carried.h"

namespace contrejour::inline internal {
namespace {

struct Body {
  std::size_t first = 0, last = 0;  // vector indices
};

// Surfaces with glass between them, the stop among them or not.
std::vector<Body> bodies_of(const Prescription& lens) {
  std::vector<Body> bodies;
  for (std::size_t k = 0; k < lens.surfaces.size(); ++k) {
    const bool is_stop = lens.surfaces[k].kind == SurfaceKind::Stop;
    if (is_stop || is_air(lens.surfaces[k].glass_after)) continue;
    Body body{k, k};
    while (body.last + 1 < lens.surfaces.size() &&
           (lens.surfaces[body.last].kind == SurfaceKind::Stop || !is_air(lens.surfaces[body.last].glass_after)))
      ++body.last;
    bodies.push_back(body);
    k = body.last;
  }
  return bodies;
}

// Vertices by the rows' distances.
std::vector<double> vertices_of(const Prescription& lens) {
  std::vector<double> z{0.0};
  for (const Surface& s : lens.surfaces) z.push_back(z.back() + s.thickness_mm);
  return z;
}

// Rotates about x, then about y, right-handed, as a file's tilt_deg.
Vec3 tilted_axis(double about_x, double about_y) {
  return {std::sin(about_y) * std::cos(about_x), -std::sin(about_x), std::cos(about_y) * std::cos(about_x)};
}

void move_body(Prescription& lens, const Body& body, const std::vector<double>& z, Vec2 tilt_rad, Vec2 decentre_mm) {
  if (tilt_rad == Vec2{} && decentre_mm == Vec2{}) return;
  const SurfacePose pose{{decentre_mm.x, decentre_mm.y, 0.0}, tilted_axis(tilt_rad.x, tilt_rad.y)};
  const double middle_mm = 0.5 * (z[body.first] + z[body.last]);
  for (std::size_t k = body.first; k <= body.last; ++k) {
    if (lens.surfaces[k].kind == SurfaceKind::Stop) continue;
    lens.surfaces[k].pose = carried(pose, z[k] - middle_mm, lens.surfaces[k].pose);
  }
}

int number_of(std::size_t index) { return static_cast<int>(index) + 1; }

void add_body_numbers(const Prescription& lens, const LensTolerances& of, std::vector<LearntNumber>& numbers) {
  for (const Body& body : bodies_of(lens)) {
    for (const auto& [kind, tolerance] :
         {std::pair{LearntKind::TiltX, of.tilt_rad}, std::pair{LearntKind::TiltY, of.tilt_rad},
          std::pair{LearntKind::DecentreX, of.decentre_mm}, std::pair{LearntKind::DecentreY, of.decentre_mm}})
      numbers.push_back({kind, number_of(body.first), number_of(body.last), 0, 0, tolerance, false});
  }
}

// A gap with the stop in it changes behind the stop.
void add_gaps(const Prescription& lens, const LensTolerances& of, std::vector<LearntNumber>& numbers) {
  const std::vector<Body> bodies = bodies_of(lens);
  for (std::size_t n = 0; n + 1 < bodies.size(); ++n)
    numbers.push_back(
        {LearntKind::Gap, number_of(bodies[n].last), number_of(bodies[n + 1].first), 0, 0, of.gap_mm, false});
}

std::size_t stop_of(const Prescription& lens) {
  return static_cast<std::size_t>(std::ranges::find(lens.surfaces, SurfaceKind::Stop, &Surface::kind) -
                                  lens.surfaces.begin());
}

bool stop_is_between(const Prescription& lens) {
  const std::size_t stop = stop_of(lens);
  return stop > 0 && stop + 1 < lens.surfaces.size() && is_air(lens.surfaces[stop - 1].glass_after);
}

}  // namespace

std::vector<LearntNumber> numbers_of(const Prescription& lens, const LensTolerances& tolerances) {
  std::vector<LearntNumber> numbers;
  add_body_numbers(lens, tolerances, numbers);
  if (lens.zoom.empty()) add_gaps(lens, tolerances, numbers);
  const int stop = number_of(stop_of(lens)), last = number_of(lens.surfaces.size() - 1);
  numbers.push_back({LearntKind::Focus, last, last, 0, 0, tolerances.focus_mm, false});
  numbers.push_back({LearntKind::StopRadius, stop, stop, 0, 0, tolerances.stop_radius, false});
  if (lens.zoom.empty() && stop_is_between(lens))
    numbers.push_back({LearntKind::StopPosition, stop, stop, 0, 0, tolerances.stop_position_mm, false});
  std::erase_if(numbers, [](const LearntNumber& n) { return !(n.tolerance > 0.0); });
  return numbers;
}

double difference_step(const LearntNumber& number) {
  switch (number.kind) {
    case LearntKind::TiltX:
    case LearntKind::TiltY: return 1e-3;
    case LearntKind::DecentreX:
    case LearntKind::DecentreY: return 0.03;
    case LearntKind::StopRadius: return 0.02;
    case LearntKind::Gap:
    case LearntKind::Focus:
    case LearntKind::StopPosition: return 0.05;
  }
  return 0.0;
}

Result<AdjustableLens> adjustable_lens(const Prescription& lens, const LensSettings& settings,
                                       const LensTolerances& tolerances) {
  Result<LensState> nominal = configure_lens(lens, settings);
  if (!nominal) return tl::unexpected(nominal.error());
  LensSettings distant = settings;  // without plates, which move the sensor
  distant.object_distance_mm = std::numeric_limits<double>::infinity();
  distant.sensor = {};
  const Result<LensState> in_focus = configure_lens(lens, distant);
  if (!in_focus) return tl::unexpected(in_focus.error());
  AdjustableLens adjustable{lens, settings, std::move(*nominal), numbers_of(lens, tolerances), 0.0};
  adjustable.sensor_distance_mm = in_focus->sensor_z_mm - in_focus->surfaces.back().z_mm;
  return adjustable;
}

Prescription AdjustableLens::prescription(const Eigen::VectorXd& values) const {
  Prescription changed = lens;
  changed.sensor_distance_mm = sensor_distance_mm;
  const std::vector<double> z = vertices_of(lens);
  for (const Body& body : bodies_of(lens)) {
    Vec2 tilt{}, decentre{};
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      if (numbers[k].first != number_of(body.first)) continue;
      const double value = values[static_cast<Eigen::Index>(k)];
      if (numbers[k].kind == LearntKind::TiltX) tilt.x = value;
      if (numbers[k].kind == LearntKind::TiltY) tilt.y = value;
      if (numbers[k].kind == LearntKind::DecentreX) decentre.x = value;
      if (numbers[k].kind == LearntKind::DecentreY) decentre.y = value;
    }
    move_body(changed, body, z, tilt, decentre);
  }
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const double value = values[static_cast<Eigen::Index>(k)];
    const auto before_next = static_cast<std::size_t>(numbers[k].last - 2);  // the surface in front of `last`
    if (numbers[k].kind == LearntKind::Gap) changed.surfaces[before_next].thickness_mm += value;
    if (numbers[k].kind == LearntKind::StopPosition) {
      changed.surfaces[before_next].thickness_mm += value;
      changed.surfaces[before_next + 1].thickness_mm -= value;
    }
    if (numbers[k].kind == LearntKind::Focus) *changed.sensor_distance_mm += value;
  }
  return changed;
}

Result<LensState> AdjustableLens::state(const Eigen::VectorXd& values) const {
  Result<LensState> changed = configure_lens(prescription(values), settings);
  if (!changed) return changed;
  changed->stop_radius_mm = nominal.stop_radius_mm;
  for (std::size_t k = 0; k < numbers.size(); ++k)
    if (numbers[k].kind == LearntKind::StopRadius)
      changed->stop_radius_mm *= 1.0 + values[static_cast<Eigen::Index>(k)];
  return changed;
}

}  // namespace contrejour::inline internal

namespace contrejour {

std::string learnt_name(const LearntNumber& number) {
  const std::string body = number.first == number.last ? fmt::format("surface {}", number.first)
                                                       : fmt::format("surfaces {}-{}", number.first, number.last);
  switch (number.kind) {
    case LearntKind::TiltX: return "tilt about x of " + body;
    case LearntKind::TiltY: return "tilt about y of " + body;
    case LearntKind::DecentreX: return "decentre in x of " + body;
    case LearntKind::DecentreY: return "decentre in y of " + body;
    case LearntKind::Gap: return fmt::format("air space from surface {} to {}", number.first, number.last);
    case LearntKind::Focus: return "distance of the sensor";
    case LearntKind::StopRadius: return "radius of the stop";
    case LearntKind::StopPosition: return "position of the stop";
  }
  return {};
}

}  // namespace contrejour
