// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/ghost_pupil.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "ghosts/light_frame.h"
#include "render/pupils/pupil_search.h"

namespace contrejour::inline internal::pupils {
namespace {

// A fraction of a box's size, added on every side: polynomials through its rays are least accurate at its border, where
// the ghost's edge would be if the box were tight. Half of this saves no rays and costs a decibel; twice this takes a
// third more rays.
constexpr double kPupilMargin = 0.1;
// The boxes of the sharp stop are widened by the stop's factor up to this one, and for larger factors in proportion to
// its square root: boxes that are then too small grow while they are fitted.
constexpr double kMuchWider = 1.5;

// A ghost that a fine grid did not find at the first wavelength is searched less finely at another.
constexpr PupilEffort kEffortAfterNone = PupilEffort::Finer;

bool overlap(const Rectangle& a, const Rectangle& b) {
  return a.low.x < b.high.x && b.low.x < a.high.x && a.low.y < b.high.y && b.low.y < a.high.y;
}

Rectangle with_margin(const Rectangle& box) {
  const Vec2 margin = (box.high - box.low) * kPupilMargin;
  return {box.low - margin, box.high + margin};
}

// The same for a box of a symmetric pupil, which stays on its side of the axis of symmetry.
Rectangle with_side_margin(const Rectangle& box) {
  Rectangle out = with_margin(box);
  if (box.low.y >= 0.0) out.low.y = std::max(out.low.y, 0.0);
  return out;
}

// Scales a box about its middle; one of a symmetric pupil stays on its side of the axis of symmetry.
Rectangle about_middle(const Rectangle& box, double times) {
  const Vec2 more = (box.high - box.low) * (0.5 * (times - 1.0));
  Rectangle out{box.low - more, box.high + more};
  if (box.low.y >= 0.0) out.low.y = std::max(out.low.y, 0.0);
  return out;
}

// The wavelengths at which a pupil is searched that must serve all.
std::vector<double> outer_wavelengths(std::span<const double> lambda_nm) {
  std::vector<double> outer_nm{lambda_nm.front()};
  if (lambda_nm.size() > 1) outer_nm.push_back(lambda_nm.back());
  return outer_nm;
}

// The wavelengths at which a symmetric pupil is searched until it is found: nearly always the first one. Small ghosts
// may be open at one end of the spectrum only, such as the Canon 70-200's 10-20 at 135 mm and f/32, which is red.
std::vector<double> searched_wavelengths(const PupilRequest& request) {
  const double middle_nm = middle_wavelength(request);
  std::vector<double> order_nm{middle_nm};
  for (const double outer_nm : {request.lambda_nm.back(), request.lambda_nm.front()})
    if (outer_nm != middle_nm) order_nm.push_back(outer_nm);
  return order_nm;
}

bool is_symmetric(const PupilRequest& request) { return has_axial_symmetry(request.steps.lens(), request.ghost); }

// A lens without symmetries has one box, found by grids over the whole window. The first wavelength's box is the guess
// for the others.
GhostPupil find_box_without_symmetry(const PupilRequest& request) {
  const IrisShape circle{Iris{}};
  GhostPupil pupil;
  RayGrid grid;
  std::optional<Rectangle> box;
  bool is_first = true;
  for (const double lambda_nm : outer_wavelengths(request.lambda_nm)) {
    const LensSteps& steps = request.steps.at(lambda_nm);
    OpticalPath path = ghost_path(steps.lens(), request.ghost, lambda_nm);
    path.stop_radius_mm *= request.stop_times;
    PupilRays rays(path, steps.tables(), request.light, circle, request.window);
    Pupil found;
    if (box) found = find_pupil(rays, {.hint = with_margin(*box)}, grid);
    if (found.is_empty())
      found = find_pupil(
          rays, {.effort = box || is_first ? PupilEffort::Finest : kEffortAfterNone, .context = request.context}, grid);
    is_first = false;
    if (found.is_empty()) continue;
    box = box ? both(*box, found.box()) : found.box();
    pupil.rays += found.rays;
    pupil.surface_hits += found.rays * path.steps.size();
  }
  if (box) pupil.boxes.push_back(with_margin(*box));
  return pupil;
}

// Fits boxes to the light near them, at all wavelengths; mirror images follow from their originals.
void fit_boxes(const PupilRequest& request, const std::vector<Rectangle>& near, GhostPupil& pupil) {
  const LightFrame light(request.light);
  const LightRays rays{{0.0, 0.0, request.window.z_mm}, light.source};
  std::vector<std::optional<Rectangle>> fitted(near.size());
  RayGrid grid;  // not used along the meridian
  for (const double lambda_nm : outer_wavelengths(request.lambda_nm)) {
    PupilRays at(PacketPath(request.steps.at(lambda_nm), request.ghost, rays, request.stop_times), request.window);
    for (std::size_t k = 0; k < near.size(); ++k) {
      const Pupil fit = find_pupil(at, {.along_meridian = true, .hint = near[k]}, grid);
      pupil.rays += fit.rays;
      pupil.surface_hits += fit.rays * at.path.steps().size();
      if (!fit.is_empty()) fitted[k] = fitted[k] ? both(*fitted[k], fit.box()) : fit.box();
    }
  }
  for (std::size_t k = 0; k < near.size(); ++k) {
    Rectangle box = fitted[k].value_or(near[k]);
    if (box.low.y < 0.0) box.low.y = -box.high.y;
    pupil.boxes.push_back(box);
    if (box.low.y >= 0.0) pupil.boxes.push_back(mirrored(box));
  }
  pupil.boxes = disjoint(std::move(pupil.boxes));
}

}  // namespace

bool is_mirror_image(const Rectangle& box) { return box.high.y <= 0.0; }

double middle_wavelength(const PupilRequest& request) { return request.lambda_nm[request.lambda_nm.size() / 2]; }

std::vector<Rectangle> disjoint(std::vector<Rectangle> boxes) {
  for (std::size_t a = 0; a < boxes.size(); ++a) {
    for (std::size_t b = a + 1; b < boxes.size(); ++b) {
      if (!overlap(boxes[a], boxes[b])) continue;
      boxes[a] = both(boxes[a], boxes[b]);
      boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(b));
      return disjoint(std::move(boxes));
    }
  }
  return boxes;
}

GhostPupil find_ghost_pupil(const PupilRequest& request) {
  return fit_ghost_pupil(request, search_ghost_pupil(request));
}

GhostPupil search_ghost_pupil(const PupilRequest& request) {
  if (request.lambda_nm.empty()) return {};
  if (!is_symmetric(request)) return find_box_without_symmetry(request);
  const LightFrame light(request.light);
  GhostPupil pupil;
  for (const double lambda_nm : searched_wavelengths(request)) {
    const PupilRays rays(
        PacketPath(request.steps.at(lambda_nm), request.ghost, {{0.0, 0.0, request.window.z_mm}, light.source}),
        request.window);
    const Pupil found = find_pupil(rays, {.along_meridian = true, .only_through_line = pupil.rays > 0});
    pupil.rays += found.rays;
    pupil.surface_hits += found.rays * rays.path.steps().size();
    for (const Rectangle& box : found.boxes) {
      if (is_mirror_image(box)) continue;
      pupil.boxes.push_back(with_side_margin(box));
      if (pupil.boxes.back().low.y >= 0.0) pupil.boxes.push_back(mirrored(pupil.boxes.back()));
    }
    if (!pupil.boxes.empty()) break;
  }
  return pupil;
}

GhostPupil fit_ghost_pupil(const PupilRequest& request, GhostPupil searched) {
  if (searched.boxes.empty() || !is_symmetric(request)) return searched;
  std::erase_if(searched.boxes, is_mirror_image);
  const std::vector<Rectangle> near = std::exchange(searched.boxes, {});
  fit_boxes(request, near, searched);
  return searched;
}

GhostPupil refit_ghost_pupil(const PupilRequest& request, std::vector<Rectangle> boxes) {
  if (request.lambda_nm.empty()) return {};
  if (!is_symmetric(request)) return find_box_without_symmetry(request);
  std::erase_if(boxes, is_mirror_image);
  const double times = std::min(request.stop_times, std::sqrt(kMuchWider * request.stop_times));
  for (Rectangle& box : boxes) box = about_middle(box, times);
  GhostPupil pupil;
  fit_boxes(request, boxes, pupil);
  return pupil;
}

}  // namespace contrejour::inline internal::pupils
