// SPDX-License-Identifier: Apache-2.0
// contrejour_optics.h against the C++ interface.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "c_objects.h"
#include "contrejour/expert/coated_glass.h"
#include "contrejour/expert/film_design.h"
#include "contrejour/expert/glass_catalogue.h"
#include "contrejour/expert/lens_section.h"
#include "contrejour/expert/seidel.h"
#include "contrejour/expert/trace.h"
#include "contrejour/expert/write_lens.h"
#include "contrejour_optics.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::c_test;

namespace {

struct GlassAndCoating {
  GlassAndCoating(const char* glass_text, const char* coating_text) {
    REQUIRE(cj_glass_find(glass_text, &glass, &error) == CJ_OK);
    REQUIRE(cj_coating_read(coating_text, &coating, &error) == CJ_OK);
  }
  GlassAndCoating(const GlassAndCoating&) = delete;
  GlassAndCoating& operator=(const GlassAndCoating&) = delete;
  ~GlassAndCoating() {
    cj_coating_destroy(coating);
    cj_glass_destroy(glass);
  }
  cj_error error = CJ_INIT(cj_error);
  cj_glass* glass = nullptr;
  cj_coating* coating = nullptr;
};

}  // namespace

TEST_CASE("C: glasses by name, code and index; the table of the makers' names") {
  cj_error error = CJ_INIT(cj_error);
  REQUIRE(cj_bundled_glass_count() == bundled_glasses().size());
  CHECK(cj_bundled_glass_name(cj_bundled_glass_count()) == nullptr);
  const double wavelengths[] = {450.0, 587.5618, 650.0};
  for (const char* const text : {"N-BK7", "SCHOTT N-SF11", "517642", "1.5168,64.17"}) {
    CAPTURE(text);
    cj_glass* glass = nullptr;
    REQUIRE(cj_glass_find(text, &glass, &error) == CJ_OK);
    double n[3] = {};
    REQUIRE(cj_glass_indices(glass, wavelengths, 3, n, &error) == CJ_OK);
    CHECK((n[0] > n[1] && n[1] > n[2]));
    cj_glass_info info = CJ_INIT(cj_glass_info);
    REQUIRE(cj_glass_get_info(glass, &info, &error) == CJ_OK);
    CHECK(info.n_d == test::approx(n[1]).epsilon(1e-9));
    CHECK(info.v_d > 20.0);
    double t[1] = {};
    CHECK(cj_glass_transmittances(glass, 10.0, wavelengths, 1, t, &error) == CJ_OK);
    CHECK((t[0] > 0.8 && t[0] <= 1.0));
    cj_glass_destroy(glass);
  }
  cj_glass* glass = nullptr;
  CHECK(cj_glass_find("N-BK77", &glass, &error) == CJ_INVALID_ARGUMENT);
  CHECK(std::string(error.message).find("N-BK7") != std::string::npos);
  CHECK(glass == nullptr);
}

TEST_CASE("C: coatings: bare glass by Fresnel's equation, a v-coat dark at its wavelength, targets reached") {
  const GlassAndCoating bare("1.5", "none");
  const double nm[] = {550.0, 550.0}, angles[] = {0.0, 1.0};
  double r[2] = {}, t[2] = {};
  cj_error error = CJ_INIT(cj_error);
  REQUIRE(cj_coating_reflectances(bare.coating, bare.glass, nm, angles, 2, r, &error) == CJ_OK);
  REQUIRE(cj_coating_transmittances(bare.coating, bare.glass, nm, angles, 2, t, &error) == CJ_OK);
  CHECK(r[0] == test::approx(0.04).epsilon(1e-12));
  const double inside = std::asin(std::sin(1.0) / 1.5);  // Snell and Fresnel
  const double r_s = -std::sin(1.0 - inside) / std::sin(1.0 + inside);
  const double r_p = std::tan(1.0 - inside) / std::tan(1.0 + inside);
  CHECK(r[1] == test::approx(0.5 * (r_s * r_s + r_p * r_p)).epsilon(1e-9));
  CHECK(r[1] + t[1] == test::approx(1.0).epsilon(1e-12));
  const double beyond[] = {2.0, 2.0};
  CHECK(cj_coating_reflectances(bare.coating, bare.glass, nm, beyond, 2, r, &error) == CJ_INVALID_ARGUMENT);

  const GlassAndCoating dark("N-BK7", "v-coat:550");
  REQUIRE(cj_coating_reflectances(dark.coating, dark.glass, nm, angles, 1, r, &error) == CJ_OK);
  CHECK(r[0] < 1e-6);
  CHECK(cj_coating_film_count(dark.coating) == 0);
  cj_coating *films = nullptr, *refined = nullptr;
  REQUIRE(cj_coating_on_glass(dark.coating, dark.glass, &films, &error) == CJ_OK);
  REQUIRE(cj_coating_film_count(films) == 2);
  cj_film film = CJ_INIT(cj_film);
  REQUIRE(cj_coating_get_film(films, 0, &film, &error) == CJ_OK);
  CHECK(std::string(film.material) == "MgF2");
  CHECK(film.n == test::approx(1.38).epsilon(0.01));
  const double wanted[] = {450.0}, target[] = {0.01};
  REQUIRE(cj_coating_refine(dark.coating, dark.glass, wanted, target, nullptr, 1, &refined, &error) == CJ_OK);
  REQUIRE(cj_coating_reflectances(refined, dark.glass, wanted, angles, 1, r, &error) == CJ_OK);
  CHECK(r[0] == test::approx(0.01).epsilon(1e-3));
  CHECK(cj_coating_on_glass(bare.coating, bare.glass, &films, &error) == CJ_INVALID_ARGUMENT);
  cj_coating_destroy(refined);
  cj_coating_destroy(films);
  CHECK(cj_coating_design_count() == coating_design_names().size());
}

TEST_CASE("C: a changed lens, and lenses as text") {
  CObjects objects;
  const Prescription lens = *find_lens("cooke-triplet");
  for (const char* const format : {"toml", "zmx", "seq"}) {
    cj_text* text = nullptr;
    REQUIRE(cj_lens_write(objects.lens, format, &text, &objects.error) == CJ_OK);
    const std::string expected = std::strcmp(format, "toml") == 0  ? write_lens_toml(lens)
                                 : std::strcmp(format, "zmx") == 0 ? write_lens_zmx(lens)->text
                                                                   : write_lens_seq(lens)->text;
    CHECK(std::string(cj_text_data(text), cj_text_size(text)) == expected);
    cj_text_destroy(text);
  }
  cj_text* text = nullptr;
  CHECK(cj_lens_write(objects.lens, "obj", &text, &objects.error) == CJ_INVALID_ARGUMENT);
  const int32_t surfaces[4] = {1, 3, 0, 0}, missing[4] = {1, 90, 0, 0};
  REQUIRE(cj_lens_state_write_ghost(objects.state, surfaces, "zmx", &text, &objects.error) == CJ_OK);
  CHECK(cj_text_size(text) > 100);
  cj_text_destroy(text);
  CHECK(cj_lens_state_write_ghost(objects.state, missing, "zmx", &text, &objects.error) == CJ_INVALID_ARGUMENT);

  cj_surface_change change = CJ_INIT(cj_surface_change);
  change.what = CJ_CHANGE_CURVATURE | CJ_CHANGE_GLASS | CJ_CHANGE_COATING;
  change.curvature_per_mm = lens.surfaces[0].curvature_per_mm * 0.9;
  change.glass_behind = "N-BK7";
  change.coating = "none";
  cj_lens* changed = nullptr;
  REQUIRE(cj_lens_with_surface(objects.lens, 0, &change, &changed, &objects.error) == CJ_OK);
  cj_surface surface = CJ_INIT(cj_surface);
  REQUIRE(cj_lens_get_surface(changed, 0, &surface, &objects.error) == CJ_OK);
  CHECK(surface.curvature_per_mm == change.curvature_per_mm);
  CHECK(std::string(surface.glass_behind) == "N-BK7");
  CHECK(surface.thickness_mm == lens.surfaces[0].thickness_mm);
  cj_lens_destroy(changed);
  CHECK(cj_lens_with_surface(objects.lens, 99, &change, &changed, &objects.error) == CJ_INVALID_ARGUMENT);
}

TEST_CASE("C: Seidel's sums and rays are those of C++") {
  CObjects objects;
  const LensState lens = *params::lens_of(*find_lens("cooke-triplet"), quick_values());
  SeidelRequest request;
  request.lambda_nm = lens.design_wavelength_nm;
  request.half_field_rad = 0.2;
  cj_seidel sums = CJ_INIT(cj_seidel);
  REQUIRE(cj_lens_state_get_seidel(objects.state, 0.0, 0.2, -1, &sums, &objects.error) == CJ_OK);
  CHECK(sums.spherical == seidel_sums(lens, request).spherical);
  REQUIRE(cj_lens_state_get_seidel(objects.state, 0.0, 0.2, 2, &sums, &objects.error) == CJ_OK);
  CHECK(sums.coma == seidel_by_surface(lens, request)[2].coma);
  CHECK(cj_lens_state_get_seidel(objects.state, 0.0, 0.2, 50, &sums, &objects.error) == CJ_INVALID_ARGUMENT);

  const double origins[] = {0, 1, -5, 0, 2, -5}, directions[] = {0, 0, 1, 0, 0, 3};
  const int32_t ghost[4] = {1, 3, 0, 0};
  for (const int32_t* const surfaces : {static_cast<const int32_t*>(nullptr), ghost}) {
    const OpticalPath path = surfaces == nullptr ? direct_path(lens, 550.0) : ghost_path(lens, {.i = 1, .j = 3}, 550.0);
    cj_traced_ray rays[2] = {CJ_INIT(cj_traced_ray), CJ_INIT(cj_traced_ray)};
    REQUIRE(cj_trace(objects.state, surfaces, 550.0, origins, directions, 2, rays, &objects.error) == CJ_OK);
    for (int k = 0; k < 2; ++k) {
      const TracedRay expected = trace(path, {{0, 1.0 + k, -5}, {0, 0, 1}});
      CHECK(rays[k].sensor_mm[1] == expected.sensor_mm.y);
      CHECK(rays[k].transmission == expected.transmission);
      CHECK(rays[k].blocked_by == blocked_by(expected, path, lens.iris));
    }
  }
}

TEST_CASE("C: a section's lines and its drawing") {
  CObjects objects;
  const LensState lens = *params::lens_of(*find_lens("cooke-triplet"), quick_values());
  cj_section* section = nullptr;
  REQUIRE(cj_section_create(objects.state, nullptr, &section, &objects.error) == CJ_OK);
  SectionRequest request;
  request.lambda_nm = lens.design_wavelength_nm;
  CHECK(std::string(cj_section_svg(section)) == section_svg(lens_section(lens, request)));
  int elements = 0, rays = 0;
  for (std::size_t k = 0; k < cj_section_line_count(section); ++k) {
    cj_section_line line = CJ_INIT(cj_section_line);
    REQUIRE(cj_section_get_line(section, k, &line, &objects.error) == CJ_OK);
    REQUIRE(line.point_count >= 2);
    for (std::size_t i = 0; i < 2 * line.point_count; ++i) CHECK(std::isfinite(line.points_mm[i]));
    elements += line.kind == CJ_LINE_ELEMENT ? 1 : 0;
    rays += line.kind == CJ_LINE_AXIS_RAY || line.kind == CJ_LINE_FIELD_RAY ? 1 : 0;
  }
  CHECK(elements == 3);
  CHECK(rays == 10);
  cj_section_destroy(section);
  cj_section_options options = CJ_INIT(cj_section_options);
  options.ghosts = "1-99";
  CHECK(cj_section_create(objects.state, &options, &section, &objects.error) == CJ_INVALID_ARGUMENT);
}

TEST_CASE("C: a measured flare stands for a lens, and says what it does not have") {
  const CObjects objects;
  cj_error error = CJ_INIT(cj_error);
  cj_lens* lens = nullptr;
  cj_lens_state* state = nullptr;
  REQUIRE(cj_lens_find(CONTREJOUR_MEASURED_FLARE, &lens, &error) == CJ_OK);
  cj_lens_info info = CJ_INIT(cj_lens_info);
  REQUIRE(cj_lens_get_info(lens, &info, &error) == CJ_OK);
  CHECK(info.is_measured_flare == 1);
  CHECK(info.surface_count == 0);
  REQUIRE(cj_lens_configure(lens, nullptr, &state, &error) == CJ_OK);
  REQUIRE(cj_renderer_set_lens(objects.renderer, state, &error) == CJ_OK);
  cj_settings* settings = nullptr;
  REQUIRE(cj_settings_create(&settings, &error) == CJ_OK);
  REQUIRE(cj_settings_set(settings, "light", "9,5:1000", &error) == CJ_OK);
  std::vector<float> pixels = black();
  const cj_image image = image_over(pixels);
  REQUIRE(cj_renderer_render(objects.renderer, settings, nullptr, 0, &image, nullptr, nullptr, &error) == CJ_OK);
  CHECK(*std::max_element(pixels.begin(), pixels.end()) > 0.0F);
  // The same renderer with a lens again.
  REQUIRE(cj_renderer_set_lens(objects.renderer, objects.state, &error) == CJ_OK);
  CHECK(same_bits(rendered(objects, &error), rendered_in_cpp("9,5:1000")));

  std::vector<float> photograph(pixels.size(), 0.1F), result = black();
  photograph[std::size_t{3} * (8 * kWidth + 34)] = 50000.0F;
  const cj_image from = image_over(photograph), to = image_over(result);
  REQUIRE(cj_apply(state, nullptr, &from, &to, CJ_FLARE_ONLY, nullptr, nullptr, &error) == CJ_OK);
  CHECK(*std::max_element(result.begin(), result.end()) > 0.0F);

  cj_lens_figures figures = CJ_INIT(cj_lens_figures);
  CHECK(cj_lens_state_get_figures(state, 0.0, &figures, &error) == CJ_UNSUPPORTED);
  CHECK(std::string(error.message).find("measured flare") != std::string::npos);
  cj_ghost_list* ghosts = nullptr;
  CHECK(cj_measure_ghosts(state, settings, nullptr, nullptr, &ghosts, &error) == CJ_UNSUPPORTED);
  REQUIRE(cj_settings_set(settings, "blades", "6", &error) == CJ_OK);
  CHECK(cj_renderer_set_lens(objects.renderer, state, &error) == CJ_OK);
  CHECK(cj_renderer_render(objects.renderer, settings, nullptr, 0, &image, nullptr, nullptr, &error) ==
        CJ_INVALID_ARGUMENT);
  cj_settings_destroy(settings);
  cj_lens_state_destroy(state);
  cj_lens_destroy(lens);
}
