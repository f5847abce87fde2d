// SPDX-License-Identifier: Apache-2.0
// Values that no caller would pass, for calls of every function that the library offers.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/glass.h"
#include "support/scenes.h"

namespace contrejour::test {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline const std::vector<double> kStrange = {kNan, kInfinity, -kInfinity, 1e300, -1e300, 1e-300, 0.0, -1.0, 1e12};

// Uses a value, so that the compiler removes no call.
template <class T>
void use(const T& value) {
  const volatile auto* const at = reinterpret_cast<const volatile unsigned char*>(&value);
  CHECK((at[0] | 1) != 0);
}

struct NamedLens {
  std::string what;
  LensState lens;
};

inline SurfaceState stop_alone() {
  SurfaceState stop;
  stop.kind = SurfaceKind::Stop;
  stop.semi_diameter_mm = 3.0;
  stop.before = stop.after = air();
  return stop;
}

inline GlassData glass_data(DispersionFormula formula, std::size_t coefficients, double value) {
  GlassData data;
  data.formula = formula;
  data.coefficients.assign(coefficients, value);
  return data;
}

// Invalid lens states: each differs from a valid one in what its name says.
inline std::vector<NamedLens> strange_lenses() {
  const LensState sound = bundled("tessar", {.f_number = 8.0});
  std::vector<NamedLens> all;
  const auto add = [&](const std::string& what, const std::function<void(LensState&)>& change) {
    LensState lens = sound;
    change(lens);
    all.push_back({what, std::move(lens)});
  };
  all.push_back({"default", LensState{}});
  add("emptied", [](LensState& l) { l.surfaces.clear(); });
  add("no stop",
      [](LensState& l) { std::erase_if(l.surfaces, [](const auto& s) { return s.kind == SurfaceKind::Stop; }); });
  add("stops alone", [](LensState& l) { l.surfaces.assign(4, stop_alone()), l.stop_index = 1; });
  add("one stop", [](LensState& l) { l.surfaces.assign(1, stop_alone()), l.stop_index = 0; });
  add("default surfaces", [](LensState& l) { l.surfaces.assign(7, SurfaceState{}); });
  add("two stops", [](LensState& l) { l.surfaces.push_back(stop_alone()); });
  add("too many surfaces", [](LensState& l) { l.surfaces.resize(5000, l.surfaces.front()); });
  add("a sensor in the middle", [](LensState& l) { l.surfaces[2].kind = SurfaceKind::Sensor; });
  for (const int index : {-1, 0, 100, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()})
    add("stop_index " + std::to_string(index), [index](LensState& l) { l.stop_index = index; });
  for (const double v : {kNan, kInfinity, 1e300}) {
    const auto number = [&](const char* what, double LensState::* member) {
      add(std::string(what) + " " + std::to_string(v), [=](LensState& l) { l.*member = v; });
    };
    number("stop radius", &LensState::stop_radius_mm);
    number("sensor place", &LensState::sensor_z_mm);
    number("sensor width", &LensState::sensor_width_mm);
    number("design wavelength", &LensState::design_wavelength_nm);
    const auto surface = [&](const char* what, double SurfaceState::* member) {
      add(std::string(what) + " " + std::to_string(v), [=](LensState& l) { l.surfaces[1].*member = v; });
    };
    surface("place", &SurfaceState::z_mm);
    surface("curvature", &SurfaceState::curvature_per_mm);
    surface("semi-diameter", &SurfaceState::semi_diameter_mm);
    add("index", [v](LensState& l) { l.surfaces[1].after = {"", ConstantIndex{v}}; });
    if (v != 1e300) add("asphere", [v](LensState& l) { l.surfaces[1].shape.powers.assign(6, v); });
    add("conic", [v](LensState& l) { l.surfaces[1].shape.conic = v; });
    add("axis", [v](LensState& l) { l.surfaces[1].pose.axis = {v, 0.0, 1.0}; });
    add("aperture", [v](LensState& l) { l.surfaces[1].aperture = {ApertureKind::Ellipse, {v, v}, {v, v}, v}; });
    add("obscuration", [v](LensState& l) { l.surfaces[1].obscuration = {{v, v}, {v, v}, v}; });
    add("film", [v](LensState& l) { l.surfaces[1].coating.films = FilmStack{{{FilmMaterial(v), v}}}; });
    add("rotation", [v](LensState& l) { l.iris.rotation_rad = v; });
    add("dust", [v](LensState& l) { l.dirt.dust_per_cm2 = v; });
  }
  add("focal length", [](LensState& l) { l.focal_length_mm = kNan; });
  add("stop radius 0", [](LensState& l) { l.stop_radius_mm = 0.0; });
  add("powers", [](LensState& l) { l.surfaces[1].shape.powers.assign(1000, 1e-9); });
  add("glass without coefficients",
      [](LensState& l) { l.surfaces[1].after = {"", CatalogueGlass(glass_data(DispersionFormula::Table, 0, 0.0))}; });
  add("measured nowhere", [](LensState& l) { l.surfaces[1].coating.films = MeasuredCoating{}; });
  add("measured in part",
      [](LensState& l) { l.surfaces[1].coating.films = MeasuredCoating{{500.0}, {0.0, 30.0}, {}}; });
  add("a film of no material", [](LensState& l) {
    FilmMaterial material;
    material.name = "unobtainium";
    l.surfaces[1].coating.films = FilmStack{{{material, 100.0}}};
  });
  add("blades", [](LensState& l) { l.iris.blades = 1 << 30; });
  add("orders", [](LensState& l) { l.sensor_grating.orders = 1 << 30; });
  add("scratches", [](LensState& l) { l.dirt.scratches_per_cm2 = 1e9; });
  return all;
}

}  // namespace contrejour::test
