// SPDX-License-Identifier: Apache-2.0
// The bundled lenses against the figures that their sources state.
#include "optics/lens_files/sample_lens.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <vector>

#include "contrejour/expert/first_order.h"
#include "contrejour/lens.h"
#include "support/approx.h"

namespace contrejour::test::bundled {
namespace {

LensState state_of(std::string_view name, std::optional<double> focal_length_mm = {}) {
  const auto lens = find_lens(std::string(name));
  if (!lens) FAIL(lens.error().to_string());
  LensSettings settings;
  settings.focal_length_mm = focal_length_mm;
  const auto state = configure_lens(*lens, settings);
  if (!state) FAIL(state.error().to_string());
  return *state;
}

TEST_CASE("each loads, is valid and agrees with its stated figures") {
  CHECK(bundled_lenses().size() >= 10);
  for (const BundledLens& bundled : bundled_lenses()) {
    CAPTURE(bundled.name);
    const auto lens = find_lens(std::string(bundled.name));
    if (!lens) FAIL(lens.error().to_string());
    CHECK_FALSE(lens->source.empty());
    const LensState state = state_of(bundled.name);
    CHECK(state.warnings.empty());
    const FirstOrder first = first_order(state, lens->stated.wavelength_nm);
    REQUIRE(lens->stated.focal_length_mm.has_value());
    CHECK(first.focal_length_mm == test::approx(*lens->stated.focal_length_mm).epsilon(lens->stated.tolerance));
    if (lens->stated.back_focal_distance_mm) {
      CHECK(first.back_focal_distance_mm ==
            test::approx(*lens->stated.back_focal_distance_mm).epsilon(lens->stated.tolerance));
    }
    // The widest f-number fits the stop.
    CHECK(state.stop_radius_mm <= state.surfaces[static_cast<std::size_t>(state.stop_index)].semi_diameter_mm);
    CHECK(first.f_number == test::approx(lens->f_number).epsilon(0.01));
  }
}

struct Position {
  const char* name;
  double asked_mm, focal_length_mm, back_focal_distance_mm;
};

// The patents' figures; where those give only a nominal focal length, an independent paraxial trace of the tables.
TEST_CASE("every position of the zooms") {
  constexpr Position kPositions[] = {
      {"canon-70-200", 70, 72.10, 52.43},  {"canon-70-200", 135, 135.00, 52.43}, {"canon-70-200", 200, 194.01, 52.43},
      {"itoh-zoom", 100, 99.92, 149.46},   {"itoh-zoom", 146, 145.73, 189.53},   {"nikon-80-200", 80, 80.0, 40.17},
      {"nikon-80-200", 200, 200.0, 40.18},
  };
  for (const Position& position : kPositions) {
    CAPTURE(position.name);
    CAPTURE(position.asked_mm);
    const LensState state = state_of(position.name, position.asked_mm);
    const FirstOrder first = first_order(state, kLineD_nm);
    CHECK(first.focal_length_mm == test::approx(position.focal_length_mm).epsilon(0.001));
    CHECK(first.back_focal_distance_mm == test::approx(position.back_focal_distance_mm).epsilon(0.001));
    CHECK(first.sensor_position_mm == test::approx(first.back_focal_distance_mm).epsilon(1e-9));
  }
}

// Pairs of refracting surfaces on the same side of the stop; the four counts are those of bodonyi2023.
TEST_CASE("ghosts with both reflections on one side of the stop") {
  const std::map<std::string, int> counts = {
      {"heliar", 13}, {"itoh-zoom", 73}, {"nikon-80-200", 142}, {"canon-70-200", 312}};
  for (const auto& [name, count] : counts) {
    CAPTURE(name);
    const LensState state = state_of(name);
    const int front = state.stop_index;
    const int back = static_cast<int>(state.surfaces.size()) - 1 - front;
    CHECK(front * (front - 1) / 2 + back * (back - 1) / 2 == count);
  }
}

// The sensor of the stated field: 3:2, its half diagonal f tan(field).
TEST_CASE("sensors") {
  const std::map<std::string, double> half_field_deg = {{"heliar", 30.0}, {"itoh-zoom", 42.0}, {"nakamura-22", 38.0}};
  for (const auto& [name, degrees] : half_field_deg) {
    CAPTURE(name);
    const LensState state = state_of(name);
    CHECK(state.sensor_width_mm / state.sensor_height_mm == test::approx(1.5));
    CHECK(first_order(state, kLineD_nm).half_field_rad * 180.0 / 3.14159265358979 ==
          test::approx(degrees).epsilon(1e-3));
  }
  for (const char* name : {"canon-70-200", "nikon-80-200", "planar-50"}) {
    CHECK(state_of(name).sensor_width_mm == 36.0);
    CHECK(state_of(name).sensor_height_mm == 24.0);
  }
}

struct PrintedGlass {
  const char* name;  // "": no glass of the catalogues has these figures
  double n, v_d;
};

struct PrintedTable {
  const char* lens;
  double wavelength_nm;  // of the printed indices
  std::vector<PrintedGlass> glasses;  // front first
};

const std::vector<PrintedTable>& printed_tables() {
  static const std::vector<PrintedTable> kTables = {
      {"canon-rf-50",
       kLineD_nm,
       {{"OHARA S-LAH65V", 1.80400, 46.58},
        {"OHARA S-TIM28", 1.68893, 31.07},
        {"HOYA TAFD55", 2.00100, 29.13},
        {"OHARA S-NBH5", 1.65412, 39.68},
        {"", 1.66565, 35.64},
        {"HOYA TAFD45", 1.95375, 32.32},
        {"OHARA S-FPL51", 1.49700, 81.54},
        {"OHARA S-NBH53", 1.73800, 32.26},
        {"OHARA S-LAH96", 1.76385, 48.51},
        {"", 1.66565, 35.64},
        {"HOYA TAFD30", 1.88300, 40.80},
        {"HOYA TAFD30", 1.88300, 40.80},
        {"OHARA S-TIM8", 1.59551, 39.24},
        {"OHARA S-NBH52", 1.67300, 38.15},
        {"OHARA S-LAH65V", 1.80400, 46.58}}},
      {"planar-50",
       kLineD_nm,
       {{"SCHOTT LAF3", 1.71700, 47.99},
        {"SUMITA K-LaSFn16", 1.78831, 47.37},
        {"SCHOTT SF8", 1.68893, 31.17},
        {"SCHOTT SF53", 1.72830, 28.68},
        {"SUMITA K-LaSFn16", 1.78831, 47.37},
        {"SUMITA K-LaSFn16", 1.78831, 47.37},
        {"SCHOTT LAF2", 1.74400, 44.77}}},
      {"distagon-25",
       kLineD_nm,
       {{"SCHOTT SK16", 1.62041, 60.29},
        {"SCHOTT BASF6", 1.66755, 41.88},
        {"SCHOTT SK5", 1.58913, 61.24},
        {"SUMITA K-BaF9", 1.64328, 47.76},
        {"SCHOTT K10", 1.50137, 56.46},
        {"SCHOTT SF4", 1.75520, 27.53},
        {"SCHOTT SK16", 1.62041, 60.29},
        {"SCHOTT SK11", 1.56384, 60.76}}},
      {"master-prime-50",
       587.0,
       {{"SCHOTT N-FK5", 1.48751, 70.40},
        {"SCHOTT SF4", 1.75528, 27.58},
        {"SCHOTT KZFSN5", 1.65416, 39.63},
        {"SCHOTT N-PK51", 1.52857, 76.97},  // printed 1.52875; the lens file says why this is a misprint
        {"OHARA S-FPL51", 1.49702, 81.54},
        {"OHARA S-LAM52", 1.72005, 43.69},
        {"SCHOTT KZFSN5", 1.65416, 39.63},
        {"SCHOTT N-SF1", 1.71743, 29.62},
        {"SCHOTT SF5", 1.67276, 32.21},
        {"OHARA S-LAL61", 1.74104, 52.64},
        {"SCHOTT N-PK51", 1.52857, 76.97},
        {"OHARA S-FPL51", 1.49702, 81.54}}},
  };
  return kTables;
}

// The index as printed, to five decimals. Abbe numbers to 0.2 per cent: the finest grade in which Schott delivers a
// glass, and more than the difference between its catalogues of different years.
TEST_CASE("named glasses agree with what the patents print") {
  for (const PrintedTable& table : printed_tables()) {
    CAPTURE(table.lens);
    std::vector<Glass> glasses;
    for (const SurfaceState& s : state_of(table.lens).surfaces) {
      if (s.kind == SurfaceKind::Refracting && !is_air(s.after)) glasses.push_back(s.after);
    }
    REQUIRE(glasses.size() == table.glasses.size());
    for (std::size_t i = 0; i < glasses.size(); ++i) {
      CAPTURE(i);
      const PrintedGlass& printed = table.glasses[i];
      const bool named = *printed.name != '\0';
      CHECK(std::holds_alternative<CatalogueGlass>(glasses[i].dispersion) == named);
      if (named) CHECK(glasses[i].name == printed.name);
      CHECK(std::abs(refractive_index(glasses[i], table.wavelength_nm) - printed.n) < 1e-5);
      CHECK(glass_figures(glasses[i]).v_d == test::approx(printed.v_d).epsilon(0.002));
    }
  }
}

TEST_CASE("coatings: on faces to air, none inside a cemented group, several in a modern zoom") {
  std::map<std::string, int> films;
  for (const BundledLens& bundled : bundled_lenses()) {
    CAPTURE(bundled.name);
    std::vector<Coating> seen;
    for (const SurfaceState& s : state_of(bundled.name).surfaces) {
      if (s.kind == SurfaceKind::Stop) continue;
      const bool to_air = is_air(s.before) != is_air(s.after);
      CHECK(std::holds_alternative<Bare>(s.coating.films) != to_air);
      if (to_air && std::find(seen.begin(), seen.end(), s.coating) == seen.end()) seen.push_back(s.coating);
    }
    films[std::string(bundled.name)] = static_cast<int>(seen.size());
  }
  CHECK(films["heliar"] == 1);
  CHECK(films["canon-70-200"] >= 3);
  CHECK(films["itoh-zoom"] >= 3);
  CHECK(films["nikon-80-200"] >= 3);
}

TEST_CASE("reading a bundled lens takes less than 20 ms") {
  using Clock = std::chrono::steady_clock;
  for (const BundledLens& bundled : bundled_lenses()) {
    CAPTURE(bundled.name);
    // The best of five: a busy machine may interrupt one.
    double best_ms = 1e9;
    for (int k = 0; k < 5; ++k) {
      const auto begin = Clock::now();
      CHECK(read_lens_toml(bundled.toml, "x.toml").has_value());
      best_ms = std::min(best_ms, std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
    }
    CHECK(best_ms < 20.0);
  }
}

}  // namespace
}  // namespace contrejour::test::bundled
