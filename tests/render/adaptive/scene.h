// SPDX-License-Identifier: Apache-2.0
// Shared by the tests of this folder: drawing of polygons, and a ghost's exact rays.
#pragma once

#include <algorithm>
#include <limits>

#include <doctest/doctest.h>

#include "ghosts/pupils/pupil_boxes.h"
#include "ghosts/pupils/ray_sheet.h"
#include "optics/trace/by_wavelength.h"
#include "render/adaptive/tiles/tiles.h"
#include "support/scenes.h"
#include "support/sum_of_channel.h"

namespace contrejour::test {

inline LensState lens_at_f(const char* name, double f_number, double focal_length_mm = 0.0, Iris iris = {}) {
  LensSettings settings;
  settings.f_number = f_number;
  if (focal_length_mm > 0.0) settings.focal_length_mm = focal_length_mm;
  settings.iris = iris;
  return bundled(name, settings);
}

// Draws lists of polygons in order.
inline Image drawn(std::span<const adaptive::PolygonList> lists, int width, int height,
                   const adaptive::PatternAtlas* atlas = nullptr) {
  adaptive::TileRasteriser rasteriser;
  const auto batch = rasteriser.new_batch(width, height, atlas);
  batch->extend(lists.size());
  for (std::size_t k = 0; k < lists.size(); ++k) batch->set(k, lists[k]);
  Image image = Image::unwritten(width, height);
  std::fill(image.pixels.begin(), image.pixels.end(), std::numeric_limits<float>::quiet_NaN());  // all get written
  batch->draw(adaptive::RasterMode::Write, {.threads = 1}, {image});
  return image;
}

inline Image drawn(const adaptive::PolygonList& list, int width, int height,
                   const adaptive::PatternAtlas* atlas = nullptr) {
  return drawn({&list, 1}, width, height, atlas);
}

// Positive where the corners turn from +x to +y.
inline double signed_area(std::span<const adaptive::Point> polygon) {
  double twice = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const adaptive::Point a = polygon[k];
    const adaptive::Point b = polygon[(k + 1) % polygon.size()];
    twice += static_cast<double>(a.x) * b.y - static_cast<double>(b.x) * a.y;
  }
  return 0.5 * twice;
}

// Rays of one ghost and light at one wavelength, ready for sheets.
struct GhostScene {
  LensState lens;
  Ghost ghost;
  double lambda_nm = 550.0;
  Vec3 direction;  // of the light, as in the lens's own coordinates
  LightFrame light;
  EntranceWindow window;
  OpticalPath path;
  TablesByWavelength tables;
  std::vector<Rectangle> boxes;

  GhostScene(LensState state, Ghost of, Vec3 towards, double wavelength_nm = 550.0)
      : lens(std::move(state)), ghost(of), lambda_nm(wavelength_nm), direction(towards), light(towards),
        window(entrance_window(lens, light.source)), path(ghost_path(lens, ghost, lambda_nm)), tables(lens) {
    boxes = pupils::find_pupil_boxes(packets(), window).boxes;
  }

  [[nodiscard]] PacketPath packets() const {
    return {path, tables.at(lambda_nm), {{0.0, 0.0, window.z_mm}, light.source}};
  }

  [[nodiscard]] pupils::RaySheet sheet(const Rectangle& box, int nodes, Rgb gain = {1, 1, 1}) const {
    pupils::SheetTracer tracer(packets(), light);
    pupils::RaySheet sheet = tracer.trace(box, nodes, PacketPrecision::Double);
    pupils::add_light(sheet, sheet.transmission, gain);
    return sheet;
  }

  // The ray through a point of the meridional entrance plane, traced in the lens's own coordinates.
  [[nodiscard]] RayRecord exact(Vec2 entrance_mm) const {
    const Vec2 p = light.into_place(entrance_mm);
    return trace_recorded(path, {{p.x, p.y, window.z_mm}, direction});
  }
};

}  // namespace contrejour::test
