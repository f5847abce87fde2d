// SPDX-License-Identifier: Apache-2.0
// The transmittance of a lens's dirt for a ghost's light, by place in the plane that the dirt lies in: with sharp
// shadows (DirtField), or with the fringes that the ghost's defocus gives them at a wavelength. Light meets dirt in the
// stop at every crossing of the stop, dirt on the front once, where it enters. Units: mm of the dirt's plane. A
// renderer multiplies a ghost's light by level(), and by transmission() at places that are not clean.
// Thread-safety: const members may run at once.
#pragma once

#include <cstddef>
#include <span>

#include "contrejour/expert/light_source.h"
#include "contrejour/expert/vec.h"

namespace contrejour::inline internal {

class DirtField;

// A place where light crosses the dirt's plane, and the side of the square about it over which the mean is taken.
struct DirtPlace {
  Vec2 at_mm;
  double width_mm = 0.0;
};

class DirtScreen {
 public:
  // The plane that the dirt lies in.
  struct Plane {
    bool is_front = false;
    double stop_radius_mm = 0.0;
    double front_z_mm = 0.0;
  };

  explicit DirtScreen(const Plane& plane) : plane_(plane) {}
  DirtScreen(const DirtScreen&) = delete;
  DirtScreen& operator=(const DirtScreen&) = delete;
  virtual ~DirtScreen() = default;

  [[nodiscard]] const Plane& plane() const { return plane_; }
  [[nodiscard]] bool on_front() const { return plane_.is_front; }
  [[nodiscard]] double stop_radius_mm() const { return plane_.stop_radius_mm; }
  // Where a light's ray through a point of the plane z = z_mm crosses the front.
  [[nodiscard]] Vec2 front_place(Vec2 entrance_mm, double z_mm, const LightSource& light) const {
    const Vec3 along = light.direction_at({entrance_mm.x, entrance_mm.y, z_mm});
    return entrance_mm + Vec2{along.x, along.y} * ((plane_.front_z_mm - z_mm) / along.z);
  }

  // The transmittance where the plane is clean: 1, or less where weak shadows all over the plane are replaced by their
  // mean.
  [[nodiscard]] virtual double level() const { return 1.0; }
  // The mean transmittance over the square about the place, relative to level(); above 1 on bright fringes.
  [[nodiscard]] virtual double transmission(const DirtPlace& place, std::size_t crossing) const = 0;
  // The product over all crossings.
  [[nodiscard]] double transmission(std::span<const DirtPlace> places) const {
    double all = 1.0;
    for (std::size_t c = 0; c < places.size() && all > 0.0; ++c) all *= transmission(places[c], c);
    return all;
  }
  // Whether transmission() is 1 all over a disc. A large disc counts as not clean where dirt comes near its bounds.
  [[nodiscard]] virtual bool is_clean(Vec2 middle_mm, double radius_mm, std::size_t crossing) const = 0;
  // The shadows' edges: their length per area, times opacity^2, and their approximate width (0: sharp).
  struct Edges {
    double per_mm = 0.0, softness_mm = 0.0;
  };
  [[nodiscard]] virtual Edges edges() const = 0;
  // Not null only where the shadows may be drawn as the shapes' outlines.
  [[nodiscard]] virtual const DirtField* outlines() const { return nullptr; }

 private:
  Plane plane_;
};

}  // namespace contrejour::inline internal
