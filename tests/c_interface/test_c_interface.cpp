// SPDX-License-Identifier: Apache-2.0
// The C interface as a program uses it, compared with the C++ functions behind it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <contrejour.h>
#include <doctest/doctest.h>

#include "contrejour/contrejour.h"
#include "contrejour/expert/first_order.h"
#include "contrejour/expert/parameter.h"
#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"

namespace {

using namespace contrejour;

constexpr int kWidth = 48, kHeight = 32;

using Texts = std::initializer_list<std::pair<const char*, const char*>>;

// A small, quick picture.
const Texts kQuick = {{"fnumber", "8"}, {"size", "48x32"}, {"wavelengths", "3"}, {"error", "0.02"}};

params::Values quick_values(const char* light = nullptr) {
  params::Values values;
  for (const auto& [name, text] : kQuick) REQUIRE(values.set(name, text).has_value());
  if (light != nullptr) REQUIRE(values.set("light", light).has_value());
  return values;
}

// The objects of a test, destroyed at its end.
struct CObjects {
  CObjects() {
    REQUIRE(cj_settings_create(&settings, &error) == CJ_OK);
    for (const auto& [name, text] : kQuick) REQUIRE(cj_settings_set(settings, name, text, &error) == CJ_OK);
    REQUIRE(cj_settings_set(settings, "light", "9,5:1000", &error) == CJ_OK);
    REQUIRE(cj_lens_find("cooke-triplet", &lens, &error) == CJ_OK);
    REQUIRE(cj_lens_configure(lens, settings, &state, &error) == CJ_OK);
    REQUIRE(cj_renderer_create(&renderer, &error) == CJ_OK);
    REQUIRE(cj_renderer_set_lens(renderer, state, &error) == CJ_OK);
  }
  CObjects(const CObjects&) = delete;
  CObjects& operator=(const CObjects&) = delete;
  ~CObjects() {
    cj_renderer_destroy(renderer);
    cj_lens_state_destroy(state);
    cj_lens_destroy(lens);
    cj_settings_destroy(settings);
  }

  cj_error error = CJ_INIT(cj_error);
  cj_settings* settings = nullptr;
  cj_lens* lens = nullptr;
  cj_lens_state* state = nullptr;
  cj_renderer* renderer = nullptr;
};

cj_image image_over(std::vector<float>& pixels) {
  cj_image image = CJ_INIT(cj_image);
  image.pixels = pixels.data();
  image.width = kWidth;
  image.height = kHeight;
  return image;
}

Image picture_in_cpp(const std::vector<float>& pixels) {
  Image image(kWidth, kHeight);
  std::copy(pixels.begin(), pixels.end(), image.pixels.begin());
  return image;
}

std::vector<float> black() { return std::vector<float>(std::size_t{3} * kWidth * kHeight, 0.0F); }

std::vector<float> rendered(const CObjects& objects, cj_error* error) {
  std::vector<float> pixels = black();
  const cj_image image = image_over(pixels);
  REQUIRE(cj_renderer_render(objects.renderer, objects.settings, nullptr, 0, &image, nullptr, nullptr, error) == CJ_OK);
  return pixels;
}

// The same picture by the C++ interface.
Image rendered_in_cpp(const char* light) {
  const params::Values values = quick_values(light);
  const auto lens = params::lens_of(*find_lens("cooke-triplet"), values);
  auto renderer = Renderer::create(params::method_options(values));
  REQUIRE(renderer->set_lens(*lens).has_value());
  return render_picture(*picture_request(values, *lens), *renderer)->image;
}

bool same_bits(const std::vector<float>& a, const Image& b) {
  return a.size() == b.pixels.size() && std::memcmp(a.data(), b.pixels.data(), a.size() * sizeof(float)) == 0;
}

}  // namespace

TEST_CASE("C: a picture has the bits of the C++ interface's") {
  CObjects objects;
  const std::vector<float> pixels = rendered(objects, &objects.error);
  CHECK(same_bits(pixels, rendered_in_cpp("9,5:1000")));

  // The same light as a struct, in place of the settings' own. Two elements whose size is that of a later version.
  struct LaterLight {
    cj_light light;
    double member_of_later_version;
  };
  LaterLight lights[2] = {};
  for (LaterLight& later : lights) {
    later.light.struct_size = sizeof(LaterLight);
    REQUIRE(cj_direction_from_angles(9.0 * params::kDegree_rad, 5.0 * params::kDegree_rad, later.light.direction,
                                     nullptr) == CJ_OK);
    std::fill(std::begin(later.light.value), std::end(later.light.value), 500.0);
  }
  REQUIRE(cj_settings_reset(objects.settings, "light", &objects.error) == CJ_OK);
  std::vector<float> halves = black();
  const cj_image image = image_over(halves);
  REQUIRE(cj_renderer_render(objects.renderer, objects.settings, &lights[0].light, 2, &image, nullptr, nullptr,
                             &objects.error) == CJ_OK);
  double difference = 0.0, sum = 0.0;
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    difference += std::abs(static_cast<double>(pixels[k]) - static_cast<double>(halves[k]));
    sum += std::abs(static_cast<double>(pixels[k]));
  }
  CHECK(sum > 0.0);
  CHECK(difference < 1e-2 * sum);  // the method's error, for which 0.02 was asked
}

TEST_CASE("C: directions of lights are those of the settings' lights") {
  CObjects objects;
  const params::Values values = quick_values();
  const auto lens = params::lens_of(*find_lens("cooke-triplet"), values);
  double direction[3] = {};
  REQUIRE(cj_direction_from_image(objects.state, objects.settings, 0.7, 0.33, 0.0, direction, &objects.error) == CJ_OK);
  const Vec3 expected = picture_request(values, *lens)->lights.front().direction;  // that of the default light
  CHECK(Vec3{direction[0], direction[1], direction[2]} == expected);
  CHECK(cj_direction_from_angles(2.0, 0.0, direction, &objects.error) == CJ_INVALID_ARGUMENT);
  CHECK(direction[0] == expected.x);
}

TEST_CASE("C: the library says which version runs") {
  std::int32_t major = -1, minor = -1, patch = -1;
  cj_version(&major, &minor, &patch);
  CHECK(std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch) == cj_version_string());
  cj_version(nullptr, nullptr, nullptr);
}

TEST_CASE("C: rows from the bottom, in half floats with alpha, hold the same picture") {
  CObjects objects;
  const std::vector<float> pixels = rendered(objects, &objects.error);
  constexpr std::uint16_t kUntouched = 0x3c00;
  std::vector<std::uint16_t> host(std::size_t{4} * kWidth * kHeight, kUntouched);
  cj_image image = CJ_INIT(cj_image);
  image.width = kWidth;
  image.height = kHeight;
  image.sample = CJ_HALF;
  image.pixel_step = 8;
  image.row_step = -8 * kWidth;
  image.pixels = host.data() + std::size_t{4} * kWidth * (kHeight - 1);
  cj_statistics statistics = CJ_INIT(cj_statistics);
  REQUIRE(cj_renderer_render(objects.renderer, objects.settings, nullptr, 0, &image, nullptr, &statistics,
                             &objects.error) == CJ_OK);
  CHECK(statistics.ghosts_rendered > 5);
  CHECK(statistics.rays > 0);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const std::uint16_t* const at =
          host.data() + std::size_t{4} * (std::size_t(kHeight - 1 - y) * kWidth + std::size_t(x));
      REQUIRE(at[3] == kUntouched);
      const float expected = pixels[std::size_t{3} * (std::size_t(y) * kWidth + std::size_t(x))];
      const double value =
          std::ldexp((at[0] & 0x3ff) + ((at[0] & 0x7c00) != 0 ? 1024 : 0), std::max(1, (at[0] & 0x7c00) >> 10) - 25);
      REQUIRE(value == doctest::Approx(std::abs(expected)).epsilon(1e-3).scale(1e-3));
    }
  }
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
  CHECK(figures.f_number == doctest::Approx(8.0).epsilon(1e-9));
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
  CHECK(light.x_px == doctest::Approx(7.5));
  CHECK(light.peak == 900.0);
  CHECK(cj_light_list_threshold(lights) == detect_lights(picture_in_cpp(pixels))->threshold);
  cj_light_list_destroy(lights);
}

TEST_CASE("C: the flare of a photograph in memory") {
  CObjects objects;
  REQUIRE(cj_settings_reset(objects.settings, "light", &objects.error) == CJ_OK);
  std::vector<float> pixels(black().size(), 0.1F);
  pixels[std::size_t{3} * (8 * kWidth + 34)] = 50000.0F;
  pixels[4] = std::numeric_limits<float>::quiet_NaN();
  Picture picture = picture_of(picture_in_cpp(pixels));
  const params::Values values = quick_values();
  const auto lens = params::lens_of(*find_lens("cooke-triplet"), values);
  const auto expected = apply_flare(picture, *lens, values);
  REQUIRE(expected.has_value());

  const cj_image image = image_over(pixels);
  std::vector<float> flare = black();
  const cj_image flare_image = image_over(flare);
  cj_flare_report report = CJ_INIT(cj_flare_report);
  REQUIRE(cj_apply(objects.state, objects.settings, &image, &flare_image, CJ_FLARE_ONLY, nullptr, &report,
                   &objects.error) == CJ_OK);
  CHECK(same_bits(flare, expected->flare.image));
  CHECK(report.lights_found == 1);
  REQUIRE(cj_apply(objects.state, objects.settings, &image, &image, CJ_PICTURE_WITH_FLARE, nullptr, nullptr,
                   &objects.error) == CJ_OK);
  CHECK(same_bits(pixels, picture.rgb));
}

TEST_CASE("C: calls stop when they are cancelled, and the renderer is usable afterwards") {
  CObjects objects;
  cj_cancel* cancel = nullptr;
  REQUIRE(cj_cancel_create(&cancel, &objects.error) == CJ_OK);
  std::vector<float> pixels = black();
  const cj_image image = image_over(pixels);
  cj_context context = CJ_INIT(cj_context);
  context.cancel = cancel;
  cj_cancel_set(cancel, 1);
  const auto render_once = [&] {
    return cj_renderer_render(objects.renderer, objects.settings, nullptr, 0, &image, &context, nullptr,
                              &objects.error);
  };
  CHECK(render_once() == CJ_CANCELLED);
  CHECK(objects.error.status == CJ_CANCELLED);
  cj_cancel_set(cancel, 0);
  CHECK(render_once() == CJ_OK);
  cj_cancel_destroy(cancel);

  double last = -1.0;
  context = CJ_INIT(cj_context);
  context.user = &last;
  context.progress = [](void* user, double done) -> std::int32_t {
    *static_cast<double*>(user) = done;
    return 1;
  };
  CHECK(render_once() == CJ_CANCELLED);
  CHECK(last >= 0.0);
}

TEST_CASE("C: two renderers on two threads draw the same picture") {
  CObjects first, second;
  std::vector<float> of_first, of_second;
  std::thread other([&] { of_second = rendered(second, nullptr); });
  of_first = rendered(first, nullptr);
  other.join();
  CHECK(of_first == of_second);
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
