// SPDX-License-Identifier: Apache-2.0
// Lenses whose files mark no stop, and lenses whose files lack a gap.
#include "optics/lens_files/missing_stop.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "contrejour/expert/first_order.h"
#include "optics/lens_files/complete.h"
#include "optics/lens_files/lost_gap.h"
#include "optics/lens_files/reader_checks.h"
#include "shared_data.h"
#include "support/approx.h"

namespace contrejour::test::missing_stop {
namespace {

std::size_t stop_of(const Prescription& lens) {
  const auto is_stop = [](const Surface& s) { return s.kind == SurfaceKind::Stop; };
  return static_cast<std::size_t>(std::find_if(lens.surfaces.begin(), lens.surfaces.end(), is_stop) -
                                  lens.surfaces.begin());
}

double vertex_mm(const Prescription& lens, std::size_t surface) {
  double z_mm = 0.0;
  for (std::size_t k = 0; k < surface; ++k) z_mm += lens.surfaces[k].thickness_mm;
  return z_mm;
}

double length_mm(const Prescription& lens) { return vertex_mm(lens, lens.surfaces.size() - 1); }

// The stop's gap is added to that of the surface in front.
Prescription without_stop(Prescription lens) {
  const std::size_t stop = stop_of(lens);
  REQUIRE(stop > 0);
  lens.surfaces[stop - 1].thickness_mm += lens.surfaces[stop].thickness_mm;
  lens.surfaces.erase(lens.surfaces.begin() + static_cast<std::ptrdiff_t>(stop));
  return lens;
}

// In the form of the files: a lens in air, f/8, with given rims.
Prescription doublet(double rim_mm) {
  const auto text = "# f/8\nname: x\nsurfaces:\n60 5 1.5 60 " + std::to_string(rim_mm) + " 0\n-200 80 1 0 " +
                    std::to_string(rim_mm) + " 0\n";
  return read_or_fail(read_flaresim, text);
}

}  // namespace

TEST_CASE("a stop that a file does not mark is put where the rims say") {
  int same_gap = 0, near = 0, primes = 0;
  for (const BundledLens& bundled : bundled_lenses()) {
    CAPTURE(bundled.name);
    const auto lens = find_lens(std::string(bundled.name));
    REQUIRE(lens.has_value());
    if (!lens->zoom.empty()) continue;
    ++primes;
    Prescription blind = without_stop(*lens);
    blind.warnings.clear();
    const auto placed = place_missing_stop(blind);
    REQUIRE_MESSAGE(placed.has_value(), (placed ? "" : placed.error().to_string()));
    REQUIRE(blind.warnings.size() == 1);
    check_warns(blind, "no surface is the stop");
    CHECK(blind.surfaces.size() == lens->surfaces.size());
    same_gap += stop_of(blind) == stop_of(*lens);
    near += std::abs(vertex_mm(blind, stop_of(blind)) - vertex_mm(*lens, stop_of(*lens))) < 0.1 * length_mm(*lens);
    CHECK(length_mm(blind) == test::approx(length_mm(*lens)).epsilon(1e-12));
  }
  MESSAGE("of ", primes, " primes ", same_gap, " have it in their own gap, ", near, " within a tenth of the length");
  CHECK(same_gap * 10 >= primes * 7);
  CHECK(near * 10 >= primes * 8);
}

TEST_CASE("a lens without a gap for an iris has its stop in front, a plane opening becomes the stop") {
  const Prescription single = doublet(6.0);
  CHECK(stop_of(single) == 0);
  check_warns(single, "in front of the first surface");
  CHECK(configure_lens(single)->f_number == 8.0);
  const Prescription opened = read_or_fail(read_flaresim,
                                           "# f/8\nname: x\nsurfaces:\n60 5 1.5 60 12 0\n-200 4 1 0 12 0\n0 4 1 0 8 0\n"
                                           "200 3 1.5 60 12 0\n-90 80 1 0 12 0\n");
  CHECK(stop_of(opened) == 2);
  CHECK(opened.surfaces.size() == 5);
  check_warns(opened, "opening 3 (line 6)");
  // Without an f-number the stop is as wide as the rims allow.
  const Prescription untold = read_or_fail(read_flaresim, "name: x\nsurfaces:\n60 5 1.5 60 8 0\n-200 80 1 0 8 0\n");
  CHECK(untold.surfaces[0].semi_diameter_mm == test::approx(8.0).epsilon(1e-12));
  CHECK(configure_lens(untold)->f_number == test::approx(configure_lens(untold)->focal_length_mm / 16.0).epsilon(1e-3));
}

TEST_CASE("a stop in a gap that zooming changes moves with the lens in front of it") {
  auto zoom = find_lens("canon-70-200");
  REQUIRE(zoom.has_value());
  Prescription blind = *zoom;
  const std::size_t stop = stop_of(blind);
  blind.surfaces.erase(blind.surfaces.begin() + static_cast<std::ptrdiff_t>(stop));
  for (ZoomPosition& position : blind.zoom)
    for (auto& [index, thickness_mm] : position.thickness_mm)
      if (index >= static_cast<int>(stop)) --index;
  const Prescription before = blind;
  REQUIRE(place_missing_stop(blind).has_value());
  blind = completed(blind).value();
  for (std::size_t z = 0; z < blind.zoom.size(); ++z) {
    const auto at = configure_lens(blind, {.focal_length_mm = blind.zoom[z].focal_length_mm});
    REQUIRE_MESSAGE(at.has_value(), (at ? "" : at.error().to_string()));
    // A stop has no first-order effect.
    const auto own = configure_lens(*zoom, {.focal_length_mm = blind.zoom[z].focal_length_mm});
    double total_mm = 0.0, own_mm = 0.0;
    for (const auto& [index, thickness_mm] : blind.zoom[z].thickness_mm) total_mm += thickness_mm;
    for (const auto& [index, thickness_mm] : before.zoom[z].thickness_mm) own_mm += thickness_mm;
    CHECK(total_mm == test::approx(own_mm).epsilon(1e-12));
    CHECK(own.has_value());
  }
}

TEST_CASE("parts of lenses are refused, by name of what they lack") {
  const auto refused = [](const std::string& rows, int line, const std::string& words) {
    check_refused_by(read_flaresim, "name: x\nsurfaces:\n" + rows, line, words);
  };
  refused("-60 2 1.5 60 12 0\n90 80 1 0 12 0\n", 3, "forms no image of distant objects behind it, nor of any other");
  refused("60 5 1.5 60 12 0\n-200 -4.7 1 0 12 0\n-60 5 1.5 60 12 0\n-90 80 1 0 12 0\n", 4, "as behind a mirror");
  check_refused_by(read_flaresim, "name: x\nfocal_length: 500\nsurfaces:\n60 5 1.5 60 12 0\n-200 80 1 0 12 0\n", 4,
                   "this is not all of the lens");
}

TEST_CASE("FlareSim's samples without their stops: most are put within a tenth of the lens of where they were") {
  const auto folder = shared_data("lenses/flaresim_nuke");
  if (!folder) return;
  int read = 0, accepted = 0, same_gap = 0, near = 0;
  for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
    if (entry.path().extension() != ".lens") continue;
    const auto lens = read_lens(entry.path());
    if (!lens || lens->sensor_distance_mm || stop_of(*lens) == 0) continue;
    std::ostringstream bytes;
    bytes << std::ifstream(entry.path(), std::ios::binary).rdbuf();
    if (bytes.str().find("\n  stop ") == std::string::npos) continue;
    CAPTURE(entry.path().filename().string());
    ++read;
    Prescription blind = without_stop(*lens);
    if (!place_missing_stop(blind)) continue;
    ++accepted;
    same_gap += stop_of(blind) == stop_of(*lens);
    near += std::abs(vertex_mm(blind, stop_of(blind)) - vertex_mm(*lens, stop_of(*lens))) < 0.1 * length_mm(*lens);
  }
  MESSAGE("read ", read, ", placed ", accepted, ", same gap ", same_gap, ", near ", near);
  CHECK(accepted >= read - 2);
  CHECK(same_gap >= 0.7 * read);
  CHECK(near >= 0.7 * read);
}

TEST_CASE("a gap that a converter lost is found by what the file states") {
  auto lens = find_lens("sigler-telephoto-250");
  REQUIRE(lens.has_value());
  const auto state = configure_lens(*lens);
  const FirstOrder figures = first_order(*state, state->design_wavelength_nm);
  lens->stated = {.focal_length_mm = figures.focal_length_mm, .back_focal_distance_mm = figures.back_focal_distance_mm};
  lens->warnings.clear();
  warn_of_lost_gap(*lens);
  CHECK(lens->warnings.empty());
  // The widest air gap is shortened by 5 mm.
  std::size_t widest = 0;
  for (std::size_t k = 0; k + 1 < lens->surfaces.size(); ++k)
    if (is_air(lens->surfaces[k].glass_after) && lens->surfaces[k].thickness_mm > lens->surfaces[widest].thickness_mm)
      widest = k;
  lens->surfaces[widest].thickness_mm -= 5.0;
  warn_of_lost_gap(*lens);
  REQUIRE(lens->warnings.size() == 1);
  check_warns(*lens, fmt::format("a gap of {:.4g} mm behind surface {} ", lens->surfaces[widest].thickness_mm + 5.0,
                                 widest + 1));
  // A different error is not recognised as a missing gap.
  lens->surfaces[widest].thickness_mm += 5.0;
  lens->surfaces[0].curvature_per_mm *= 1.1;
  lens->warnings.clear();
  warn_of_lost_gap(*lens);
  CHECK(lens->warnings.empty());
}

TEST_CASE("gaps that FlareSim's converter lost: the patent's, and Optical Bench's own file's") {
  const auto canon = shared_data("lenses/flaresim_nuke/Canon_72-194mm_F2.923_IZ_(Canon_EF70-200mm_f2.8L_USM).lens");
  const auto nikon =
      shared_data("lenses/flaresim_nuke/Nikon_200mm_F4.07_OS_macro_(Nikon_AF_Micro-Nikkor_200mm_f4D_IF-ED).lens");
  if (!canon || !nikon) return;
  check_warns(*read_lens(*canon), "a gap of 28.21 mm behind surface 28");  // US5537259: 28.17
  check_warns(*read_lens(*nikon), "a gap of 46.39 mm behind surface 18");  // US5751485 example 9: 31.24 + 15.26
}

}  // namespace contrejour::test::missing_stop
