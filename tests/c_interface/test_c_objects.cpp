// SPDX-License-Identifier: Apache-2.0
// The C interface's settings, lenses, ghosts and errors, compared with the C++ functions behind it.
#include <cmath>
#include <cstdint>

#include "c_interface/c_objects.h"
#include "contrejour/expert/first_order.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::c_test;

TEST_CASE("C: the library says which version runs") {
  std::int32_t major = -1, minor = -1, patch = -1;
  cj_version(&major, &minor, &patch);
  CHECK(std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch) == cj_version_string());
  cj_version(nullptr, nullptr, nullptr);
}

TEST_CASE("C: the table has every parameter of the library, and values are checked against it") {
  CObjects objects;
  const auto all = params::all_parameters();
  REQUIRE(cj_parameter_count() == all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    cj_parameter parameter = CJ_INIT(cj_parameter);
    REQUIRE(cj_parameter_get(k, &parameter, &objects.error) == CJ_OK);
    CHECK(parameter.name == std::string(all[k].name));
    CHECK(parameter.help == std::string(all[k].help));
    CHECK(parameter.choice_count == all[k].choices.size());
    if (parameter.choice_count > 0) CHECK(parameter.choices[0] == std::string(all[k].choices[0]));
    CHECK(parameter.maximum == all[k].maximum);
    if (parameter.fallback[0] != '\0' && parameter.repeats == 0)
      CHECK(cj_settings_set(objects.settings, parameter.name, parameter.fallback, &objects.error) == CJ_OK);
  }
  CHECK(cj_settings_set(objects.settings, "fnumber", "0", &objects.error) == CJ_INVALID_ARGUMENT);
  CHECK(std::string(objects.error.message) == "fnumber: 0 is out of range; give a number from 0.1 to 1000");
  CHECK(cj_settings_set(objects.settings, "fnumbr", "8", &objects.error) == CJ_INVALID_ARGUMENT);
  CHECK(std::string(objects.error.message) == "there is no parameter \"fnumbr\"; did you mean fnumber?");
}

TEST_CASE("C: settings are read back, reset, copied and filled by presets") {
  CObjects objects;
  char text[8];
  std::size_t length = 0, count = 0;
  CHECK(cj_settings_get(objects.settings, "light", 0, text, sizeof(text), &length, &objects.error) == CJ_OK);
  CHECK(std::string(text) == "9,5:100");  // cut
  CHECK(length == 8);
  REQUIRE(cj_settings_set(objects.settings, "light", "1,2", &objects.error) == CJ_OK);
  REQUIRE(cj_settings_count(objects.settings, "light", &count, &objects.error) == CJ_OK);
  CHECK(count == 2);
  cj_settings* copy = nullptr;
  REQUIRE(cj_settings_copy(objects.settings, &copy, &objects.error) == CJ_OK);
  REQUIRE(cj_settings_reset(objects.settings, "light", &objects.error) == CJ_OK);
  REQUIRE(cj_settings_count(objects.settings, "light", &count, &objects.error) == CJ_OK);
  CHECK(count == 0);
  REQUIRE(cj_settings_count(copy, "light", &count, &objects.error) == CJ_OK);
  CHECK(count == 2);
  CHECK(cj_settings_get(copy, "light", 2, text, sizeof(text), nullptr, &objects.error) == CJ_INVALID_ARGUMENT);

  REQUIRE(cj_bundled_preset_count() == params::bundled_presets().size());
  REQUIRE(cj_settings_load_preset(copy, cj_bundled_preset_name(0), &objects.error) == CJ_OK);
  CHECK(std::string(cj_settings_lens(copy)) == params::find_preset(cj_bundled_preset_name(0))->lens);
  CHECK(cj_settings_get(copy, "fnumber", 0, text, sizeof(text), nullptr, &objects.error) == CJ_OK);
  CHECK(std::string(text) == "8");  // given, so that the preset does not count
  cj_settings_destroy(copy);
}

TEST_CASE("C: lenses, their surfaces and figures are the library's") {
  CObjects objects;
  const auto prescription = find_lens("cooke-triplet");
  cj_lens_info info = CJ_INIT(cj_lens_info);
  REQUIRE(cj_lens_get_info(objects.lens, &info, &objects.error) == CJ_OK);
  CHECK(info.name == prescription->name);
  REQUIRE(info.surface_count == prescription->surfaces.size());
  for (std::size_t k = 0; k < info.surface_count; ++k) {
    cj_surface surface = CJ_INIT(cj_surface);
    REQUIRE(cj_lens_get_surface(objects.lens, k, &surface, &objects.error) == CJ_OK);
    CHECK(surface.curvature_per_mm == prescription->surfaces[k].curvature_per_mm);
    CHECK((surface.kind == CJ_STOP) == (prescription->surfaces[k].kind == SurfaceKind::Stop));
    CHECK(surface.index_d == refractive_index(prescription->surfaces[k].glass_after, kLineD_nm));
  }
  cj_lens_figures figures = CJ_INIT(cj_lens_figures);
  REQUIRE(cj_lens_state_get_figures(objects.state, 0.0, &figures, &objects.error) == CJ_OK);
  const auto state = configure_lens(*prescription, {.f_number = 8.0});
  CHECK(figures.focal_length_mm == first_order(*state, state->design_wavelength_nm).focal_length_mm);
  CHECK(figures.f_number == test::approx(8.0).epsilon(1e-9));
  CHECK(std::isinf(figures.object_distance_mm));

  CHECK(cj_bundled_lens_count() == bundled_lenses().size());
  CHECK(cj_bundled_lens_name(cj_bundled_lens_count()) == nullptr);
  cj_lens* none = nullptr;
  CHECK(cj_lens_read_toml("name = 3\n", "mine.toml", &none, &objects.error) == CJ_PARSE);
  CHECK(none == nullptr);
  CHECK(objects.error.line == 1);
  CHECK(std::string(objects.error.message).starts_with("mine.toml:1: "));
}

TEST_CASE("C: ghosts and detected lights are those of the C++ functions") {
  CObjects objects;
  cj_ghost_list* ghosts = nullptr;
  REQUIRE(cj_measure_ghosts(objects.state, objects.settings, nullptr, nullptr, &ghosts, &objects.error) == CJ_OK);
  const params::Values values = quick_values("9,5");
  const auto lens = params::lens_of(*find_lens("cooke-triplet"), values);
  const auto figures = ghost_figures(*lens, *figures_request(values, *lens), {});
  REQUIRE(cj_ghost_list_count(ghosts) == figures->size());
  for (std::size_t k = 0; k < figures->size(); ++k) {
    cj_ghost ghost = CJ_INIT(cj_ghost);
    REQUIRE(cj_ghost_list_get(ghosts, k, &ghost, &objects.error) == CJ_OK);
    CHECK(ghost.relative_flux == (*figures)[k].relative_flux);
    CHECK(ghost.surfaces[1] == (*figures)[k].ghost.j);
  }
  cj_ghost_list_destroy(ghosts);

  std::vector<float> pixels(black().size(), 0.1F);
  pixels[std::size_t{3} * (5 * kWidth + 7)] = 900.0F;
  const cj_image image = image_over(pixels);
  cj_light_list* lights = nullptr;
  REQUIRE(cj_detect_lights(nullptr, &image, &lights, &objects.error) == CJ_OK);
  REQUIRE(cj_light_list_count(lights) == 1);
  cj_detected_light light = CJ_INIT(cj_detected_light);
  REQUIRE(cj_light_list_get(lights, 0, &light, &objects.error) == CJ_OK);
  CHECK(light.x_px == test::approx(7.5));
  CHECK(light.peak == 900.0);
  CHECK(cj_light_list_threshold(lights) == detect_lights(picture_in_cpp(pixels))->threshold);
  cj_light_list_destroy(lights);
}

TEST_CASE("C: what is wrong with a call is said, and nothing is thrown") {
  CObjects objects;
  cj_error& error = objects.error;
  const auto message = [&] { return std::string(error.message); };
  CHECK(cj_lens_find(nullptr, &objects.lens, &error) == CJ_INVALID_ARGUMENT);
  CHECK(message() == "name_or_file is NULL");
  CHECK(cj_lens_find("heliar", nullptr, &error) == CJ_INVALID_ARGUMENT);
  CHECK(cj_lens_find("no-such-lens", &objects.lens, nullptr) == CJ_INVALID_ARGUMENT);  // no error object
  cj_parameter parameter{};
  CHECK(cj_parameter_get(0, &parameter, &error) == CJ_INVALID_ARGUMENT);
  CHECK(message() == "cj_parameter: struct_size is too small; set it to sizeof(cj_parameter), as CJ_INIT does");
  CHECK(cj_parameter_get(100000, &(parameter = CJ_INIT(cj_parameter)), &error) == CJ_INVALID_ARGUMENT);
  std::vector<float> pixels = black();
  cj_image image = image_over(pixels);
  image.row_step = 1;
  const auto render_once = [&](cj_renderer* renderer) {
    return cj_renderer_render(renderer, objects.settings, nullptr, 0, &image, nullptr, nullptr, &error);
  };
  CHECK(render_once(objects.renderer) == CJ_INVALID_ARGUMENT);
  image.row_step = 0;
  image.width = 1 << 20;
  image.height = 1 << 20;
  CHECK(render_once(objects.renderer) == CJ_INVALID_ARGUMENT);
  image = image_over(pixels);
  cj_renderer* bare = nullptr;
  REQUIRE(cj_renderer_create(&bare, &error) == CJ_OK);
  CHECK(render_once(bare) == CJ_INVALID_ARGUMENT);
  CHECK(message() == "the renderer has no lens; call cj_renderer_set_lens() first");
  cj_renderer_destroy(bare);
  cj_light light = CJ_INIT(cj_light);
  CHECK(cj_renderer_render(objects.renderer, nullptr, &light, 1, &image, nullptr, nullptr, &error) ==
        CJ_INVALID_ARGUMENT);
  // A message that is longer than the struct holds is cut at a whole character.
  std::string name;
  for (int k = 0; k < CJ_MESSAGE_SIZE; ++k) name += "\u00e4";
  CHECK(cj_lens_find((name + ".toml").c_str(), &objects.lens, &error) == CJ_IO);
  CHECK(std::strlen(error.message) < CJ_MESSAGE_SIZE);
}
