// SPDX-License-Identifier: Apache-2.0
// Calls every function of the public headers that takes numbers, with numbers that no caller would pass.
#include <array>
#include <chrono>

#include "contrejour/expert/check_lens.h"
#include "contrejour/expert/clear_aperture.h"
#include "contrejour/expert/dirt.h"
#include "contrejour/expert/film_design.h"
#include "contrejour/expert/first_order.h"
#include "contrejour/expert/fractional_fourier.h"
#include "contrejour/expert/fraunhofer.h"
#include "contrejour/expert/fresnel.h"
#include "contrejour/expert/glass_catalogue.h"
#include "contrejour/expert/iris_field.h"
#include "contrejour/expert/lens_starburst.h"
#include "contrejour/expert/light_detection.h"
#include "contrejour/expert/machine_speed.h"
#include "contrejour/expert/metrics.h"
#include "contrejour/expert/seidel.h"
#include "contrejour/expert/starburst.h"
#include "contrejour/expert/surface_shape.h"
#include "contrejour/ghost_figures.h"
#include "robustness/strange.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

const std::vector<int> kStrangeCounts = {0, -1, std::numeric_limits<int>::max(), std::numeric_limits<int>::min(),
                                         1 << 20};

// An image with a stated size larger than its pixels.
Image hollow(int width, int height, int channels) {
  Image image;
  image.width = width;
  image.height = height;
  image.channels = channels;
  return image;
}

bool is_finite(const Image& image) {
  return std::all_of(image.pixels.begin(), image.pixels.end(), [](float v) { return std::isfinite(v); });
}

std::vector<Image> hollow_images() {
  std::vector<Image> all = {Image{}, hollow(1000, 1000, 3), hollow(-5, 7, 3), hollow(4, 4, 0),
                            hollow(1 << 30, 1 << 30, 3)};
  all.push_back(Image(4, 4, 1));
  all.push_back(Image(4, 4, 7));
  return all;
}

}  // namespace

TEST_CASE("a light's value of any kind ends in a picture or an error, soon") {
  const LensState lens = bundled("canon-70-200", {.f_number = 8.0});
  const test::Settings plain = settings_for(lens, 96, 64, 32);
  for (const double value : {-1.0, 1e300, -1e300, kNan, kInfinity, 1e17, -1e-300}) {
    CAPTURE(value);
    for (const std::string_view method : render_methods()) {
      if (method_traits(method)->is_slow) continue;  // it has the same checks, and takes long for valid input
      Light light = light_at(lens, plain.frame, {0.7, 0.35});
      light.value = {value, value, value};
      const auto began = std::chrono::steady_clock::now();
      CHECK_FALSE(render(method, lens, {&light, 1}, plain).has_value());
      CHECK(std::chrono::steady_clock::now() - began < std::chrono::seconds(10));
    }
  }
  for (const double value : {0.0, 1e-300, 1e-40, 1e15}) {
    CAPTURE(value);
    Light light = light_at(lens, plain.frame, {0.7, 0.35});
    light.value = {value, value, value};
    const auto flare = render("adaptive", lens, {&light, 1}, plain);
    REQUIRE(flare.has_value());
    CHECK(is_finite(flare->image));
  }
}

TEST_CASE("render settings of any kind are errors or render") {
  const LensState lens = bundled("heliar", {.f_number = 8.0});
  test::Settings sound = settings_for(lens, 12, 8, 16);
  sound.wavelengths = 1;
  sound.reference.density = 0.05;
  const Light light = light_at(lens, sound.frame, {0.7, 0.35});
  const auto attempt = [&](const std::function<void(test::Settings&)>& change) {
    test::Settings settings = sound;
    change(settings);
    for (const std::string_view method : render_methods()) {
      test::Settings asked = settings;
      // All ghosts by one method are enough: for the others they take most of this test's time.
      if (method != "adaptive" && std::holds_alternative<SelectAll>(asked.selection))
        asked.selection = SelectList{{{1, 2}, {2, 5}}};
      const auto flare = render(method, lens, {&light, 1}, asked);
      if (!flare) continue;
      CHECK(is_finite(flare->image));
    }
  };
  CHECK_FALSE(render("", lens, {&light, 1}, sound).has_value());
  CHECK_FALSE(render("adaptive", lens, {&light, 1}, FrameSettings{}).has_value());
  for (const double v : kStrange) {
    CAPTURE(v);
    attempt([v](test::Settings& s) { s.frame.pixel_pitch_mm = v; });
    attempt([v](test::Settings& s) { s.frame.shift_mm = {v, v}; });
    attempt([v](test::Settings& s) { s.set_error(v); });
    attempt([v](test::Settings& s) { s.reference.density = v > 4.0 ? kInfinity : v; });
    attempt([v](test::Settings& s) { s.lambda_nm = {v}; });
    attempt([v](test::Settings& s) { s.tiled.merge_threshold = v; });
    attempt([v](test::Settings& s) { s.starburst.on = true, s.starburst.gain = v; });
    attempt([v](test::Settings& s) { s.glare = {v, v}; });
    attempt([v](test::Settings& s) { s.ghosts.gain = v; });
    attempt([v](test::Settings& s) { s.ghosts.edge_gain = v; });
    attempt([v](test::Settings& s) { s.ghosts.jitter = v; });
    attempt([v](test::Settings& s) { s.ghosts.adjustments = {{Ghost{2, 3}, v, {v, v, v}, {v, v}}}; });
    attempt([v](test::Settings& s) { s.ghosts.ramp = {{v, {1, 1, 1}}, {v, {v, v, v}}}; });
    attempt([v](test::Settings& s) { s.selection = SelectByFlux{v}; });
    attempt([v](test::Settings& s) { s.ringing = {RingingMode::Hullin, v}; });
  }
  for (const int n : {0, -1, std::numeric_limits<int>::max(), std::numeric_limits<int>::min(), 400}) {
    CAPTURE(n);
    attempt([n](test::Settings& s) { s.frame.width = n; });
    attempt([n](test::Settings& s) { s.frame.full_height = n; });
    attempt([n](test::Settings& s) { s.frame.origin_x = n, s.frame.origin_y = n; });
    attempt([n](test::Settings& s) { s.lambda_nm = {}, s.wavelengths = n == 400 ? 20 : n; });
    attempt([n](test::Settings& s) { s.set_grid(n); });
    attempt([n](test::Settings& s) { s.tiled.merge_steps = n; });
    attempt([n](test::Settings& s) { s.tiled.dense_tile = n; });
    attempt([n](test::Settings& s) { s.tiled.coarse_tile = n; });
    attempt([n](test::Settings& s) { s.selection = SelectBrightest{n}; });
    attempt([n](test::Settings& s) { s.selection = SelectSurface{n}; });
    attempt([n](test::Settings& s) { s.selection = SelectList{{Ghost{n, n}}}; });
  }
  attempt([](test::Settings& s) { s.starburst.on = true, s.starburst.left_out = std::make_shared<const Image>(); });
  attempt([](test::Settings& s) {
    s.starburst.on = true;
    s.starburst.lights = std::make_shared<const std::vector<Light>>(3, Light{{kNan, 0.0, 1.0}});
  });
}

TEST_CASE("lights of any kind are errors or render") {
  const LensState lens = bundled("heliar", {.f_number = 8.0});
  const test::Settings settings = settings_for(lens, 24, 16, 16);
  const auto attempt = [&](const std::function<void(Light&)>& change) {
    Light light = light_at(lens, settings.frame, {0.7, 0.35});
    change(light);
    use(check_light(light, ColourSpace::AcesCg));
    use(check_extent(light));
    const auto flare = render("adaptive", lens, {&light, 1}, settings);
    if (!flare) return;
    CHECK(is_finite(flare->image));
  };
  attempt([](Light& l) { l = Light{}; });
  for (const double v : kStrange) {
    CAPTURE(v);
    attempt([v](Light& l) { l.direction.x = v; });
    attempt([v](Light& l) { l.direction = {v, v, v}; });
    attempt([v](Light& l) { l.distance_mm = v; });
    attempt([v](Light& l) { l.radius_rad = v; });
    attempt([v](Light& l) { l.spectrum = BlackBody{v}; });
    attempt([v](Light& l) { l.value[1] = v; });
    attempt([v](Light& l) {
      LightShape shape;
      shape.level = Image(3, 3, 1);
      shape.level.at(1, 1) = static_cast<float>(v);
      shape.right = {v, v};
      l.shape = std::make_shared<const LightShape>(shape);
    });
    use(offset_direction({0.0, 0.0, 1.0}, {v, v}));
    use(offset_direction({v, v, v}, {1.0, 1.0}));
    use(angles_from_direction({v, v, v}));
    use(offset_source(LightSource({0.0, 0.0, 1.0}, v), {v, v}));
  }
  attempt([](Light& l) { l.spectrum = TabulatedSpectrum{}; });
  attempt([](Light& l) { l.spectrum = TabulatedSpectrum{std::make_shared<const std::vector<SpectrumPoint>>()}; });
  attempt([](Light& l) { l.shape = std::make_shared<const LightShape>(); });
  for (const Image& image : hollow_images()) {
    LightShape shape;
    shape.level = image;
    attempt([&](Light& l) { l.shape = std::make_shared<const LightShape>(shape); });
    for (const int by : kStrangeCounts) use(coarser(shape, by));
  }
}

TEST_CASE("tracing stands any numbers") {
  const LensState lens = bundled("heliar", {.f_number = 8.0});
  for (const double v : kStrange) {
    CAPTURE(v);
    for (const OpticalPath& path :
         {direct_path(lens, v), ghost_path(lens, {2, 3}, v), direct_path(lens, 550.0), OpticalPath{}}) {
      use(trace(path, {{v, v, v}, {v, v, v}}));
      use(trace_recorded(path, {{v, v, v}, {0.0, 0.0, 1.0}}));
    }
    const LightSource light({0.0, 0.0, 1.0}, v);
    use(check_source(lens, light));
    use(check_source(lens, LightSource({v, v, 1.0})));
    use(entrance_window(lens, light));
    use(direction_for_image_point(lens, {v, v}, 550.0));
    use(direction_for_image_point(lens, {1.0, 1.0}, v, v));
    use(chief_ray_image_point(lens, light, v));
    use(chief_ray_image_point(lens, LightSource({v, v, 1.0}), 550.0));
    use(first_order(lens, v));
    use(seidel_sums(lens, {v, v, v, v}));
    use(exit_pupil(lens, LightSource({v, v, 1.0}), 550.0));
    use(exit_pupil(lens, LightSource({0.0, 0.0, 1.0}), v));
    use(lens_starburst(lens, LightSource({0.0, 0.0, 1.0}), {}, {v, v}));
    const std::vector<SpectralBand> bands = {{v, {v, v, v}, v}};
    use(lens_starburst(lens, LightSource({0.0, 0.0, 1.0}), bands, {0.01, 10.0}));
    const GhostMeter meter(lens, v);
    use(meter.direct_flux(LightSource({0.0, 0.0, 1.0})));
    FiguresRequest request;
    request.frame = frame_on_sensor(lens, 24, 16);
    request.bands = bands;
    use(ghost_figures(lens, request, {}));
    request.frame.pixel_pitch_mm = v;
    request.light.direction = {v, v, v};
    use(ghost_figures(lens, request, {}));
  }
  for (const int samples : kStrangeCounts) use(exit_pupil(lens, LightSource({0.0, 0.0, 1.0}), 550.0, samples));
  for (const int side : kStrangeCounts) use(frame_on_sensor(lens, side, side));
}

TEST_CASE("glasses, films and shapes stand any numbers") {
  for (const double v : kStrange) {
    CAPTURE(v);
    std::vector<Glass> glasses = {{"", ConstantIndex{v}},
                                  {"", AbbeGlass{v, v}},
                                  {"", Sellmeier{{v, v, v}, {v, v, v}}},
                                  {"", ModelGlass{v, v, v}}};
    for (const DispersionFormula formula : all_formulas()) {
      for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{3}, std::size_t{40}}) {
        GlassData data = glass_data(formula, count, v);
        data.absorption.assign(count, {v, v});
        glasses.push_back({"", CatalogueGlass(data)});
        use(make_glass("x", data));
      }
    }
    for (const Glass& glass : glasses) {
      use(refractive_index(glass, 550.0));
      use(refractive_index(glass, v));
      use(refractive_index(glass, v, {v, v}));
      use(internal_transmittance(glass, v, v));
      use(wavelength_range_nm(glass));
      use(glass_figures(glass));
      use(placed_on({"", DesignedCoating{CoatingDesign::VCoat, v, 4}}, glass, air()));
    }
    use(air_index(v, {v, v}));
    const FilmStack stack{{{FilmMaterial(v, v), v}, {FilmMaterial(1.38), v}}};
    std::vector<Coating> coatings = {{"", QuarterWave{v, v}},
                                     {"", HullinFresnelAR{v, v}},
                                     {"", stack},
                                     {"", MeasuredCoating{{v}, {v}, {v}}},
                                     {"", MeasuredCoating{}},
                                     {"", MeasuredCoating{{1.0, 2.0}, {0.0}, {}}}};
    for (const int layers : kStrangeCounts)
      coatings.push_back({"", DesignedCoating{CoatingDesign::Broadband, 550.0, layers}});
    for (const Coating& coating : coatings) {
      use(describe(coating));
      use(reflectance(coating, 1.0, 1.5, v, 550.0));
      use(reflectance(coating, v, v, 1.0, v));
      use(transmittance(coating, 1.0, 1.5, 0.9, v));
      use(at_wavelength(coating, v));
      use(may_absorb(coating));
    }
    use(designed_for({CoatingDesign::WCoat, v, 4}, {"", ConstantIndex{1.5}}));
    use(film_response(v, stack.layers, v, v, v));
    const std::vector<double> nm = {v, 550.0};
    use(reflectances(stack, {"", ConstantIndex{v}}, nm));
    use(reflectances(stack, {"", ConstantIndex{1.5}}, {}));
    SurfaceShape shape{
        .conic = v, .powers = std::vector<double>(40, v), .curvature_x_per_mm = v, .conic_x = v, .rotation_rad = v};
    for (const ShapeKind kind : {ShapeKind::Revolution, ShapeKind::Toroid, ShapeKind::Biconic}) {
      shape.kind = kind;
      use(surface_at(v, shape, {v, v}));
      use(sag_range(v, shape, v));
      use(vertex_curvature(v, shape, Section::X));
    }
    use(rims_of({ApertureKind::Rectangle, {v, v}, {v, v}, v}, v));
    use(rim_of({{v, v}, {v, v}, v}));
    use(bundled_glasses().closest(v, v, 3));
  }
  use(film_material("unobtainium"));
  FilmMaterial unknown;
  unknown.name = "unobtainium";
  use(index_at(unknown, 550.0));
  use(design_name({static_cast<CoatingDesign>(77), 550.0, -3}));
  use(formula_name(static_cast<DispersionFormula>(999)));
  use(refined({}, {"", ConstantIndex{1.5}}, {}));
  use(refined({{{FilmMaterial(1.38), 100.0}}}, {"", ConstantIndex{1.5}}, {{550.0}, nullptr}));
  const GlassCatalogue none;
  CHECK_FALSE(none.find("N-BK7").has_value());
  CHECK(none.closest(1.5, 60.0).empty());
  use(none.summary(5));
  use(none.entry(std::numeric_limits<std::size_t>::max()));
  use(none.is_of(3, {}));
}

TEST_CASE("colours stand any numbers") {
  for (const double v : kStrange) {
    CAPTURE(v);
    for (const Spectrum& spectrum :
         {Spectrum(IlluminantD65{}), Spectrum(BlackBody{v}), Spectrum(TabulatedSpectrum{}),
          Spectrum(TabulatedSpectrum{std::make_shared<const std::vector<SpectrumPoint>>(3, SpectrumPoint{v, v})})}) {
      use(spectral_power(spectrum, v));
      use(spectral_power_near(spectrum, v));
      use(xyz_of(spectrum));
      use(rgb_of(spectrum, ColourSpace::AcesCg));
      for (const int count : kStrangeCounts) use(spectral_bands(count, spectrum, ColourSpace::Rec709));
      use(spectral_bands(3, spectrum, ColourSpace::Rec709));
    }
    use(colour_matching(v));
    use(chromaticity({v, v, v}));
    use(luminance({v, v, v}, ColourSpace::Rec709));
  }
  use(is_visible(TabulatedSpectrum{}));
}

TEST_CASE("irises and dirt stand any numbers") {
  for (const double v : kStrange) {
    CAPTURE(v);
    for (const int blades : {-5, 0, 3, 7, 1 << 20}) {
      Iris iris;
      iris.blades = blades;
      iris.rotation_rad = iris.curvature = iris.blade_radius = iris.asymmetry = iris.slope_spread = v;
      iris.blade_offset = {v, v};
      use(iris_distance(iris, {v, v}));
      use(iris_area_fraction(iris) + iris_slope_spread_rad(iris));
      const std::vector<IrisBound> cut = {{{v, v}, v, {v, v}, v}};
      const IrisOpening opening(iris, cut);
      use(opening.distance({v, v}));
      use(opening.area() + opening.perimeter() + opening.outer_radius());
    }
    const std::vector<float> levels(12, static_cast<float>(v));
    use(IrisField::from_levels(levels, 4, 3));
    use(DirtPicture::from_levels(levels, 4, 3));
    Dirt dirt;
    dirt.dust_per_cm2 = dirt.scratches_per_cm2 = dirt.dust_mm = dirt.scratch_length_mm = v;
    use(check_dirt(dirt));
    use(dirt_within(dirt, {-1.0, -1.0}, {1.0, 1.0}));
    dirt = {.dust_per_cm2 = 20.0, .scratch_angle_rad = v, .phase = v, .drift_mm = v};
    use(check_dirt(dirt));
    use(dirt_within(dirt, {-1.0, -1.0}, {1.0, 1.0}));
    use(dirt_within({.dust_per_cm2 = 20.0}, {v, v}, {-v, -v}));
    const DirtStroke stroke{{v, v}, v, v, v, v, v};
    use(stroke.distance_mm({v, v}));
    use(stroke.along_and_across_mm({v, v}));
    use(dirt_outline(stroke));
    use(dirt_outline({{0.0, 0.0}, 0.0, 1.0, 0.01}, v, v));
  }
  for (const int side : kStrangeCounts) {
    CHECK_FALSE(IrisField::from_levels({}, side, side).has_value());
    CHECK_FALSE(DirtPicture::from_levels({}, side, side).has_value());
  }
}

TEST_CASE("diffraction stands any numbers") {
  PupilMask mask;
  mask.grid = {8, 0.1};
  mask.amplitude.assign(64, 1.0F);
  PupilMask hollow_mask;
  hollow_mask.grid = {1 << 20, 0.1};
  const std::vector<SpectralBand> bands = {{550.0, {1.0, 1.0, 1.0}}};
  for (const double v : kStrange) {
    CAPTURE(v);
    use(grid_over(v, 10));
    use(make_mask({8, v}, [v](Vec2) { return v; }));
    use(make_mask({8, 0.1}, IrisOpening(Iris{}), v));
    FraunhoferSettings settings{v, v, v, {8, v}};
    use(fraunhofer_pattern(mask, settings));
    use(fraunhofer_pattern(hollow_mask, {}));
    use(fresnel_extent(v));
    use(fresnel_number(v, v, v, v));
    use(fresnel_pattern(mask, v, {v, 8, v}));
    use(fresnel_pattern(hollow_mask, 1.0, {}));
    use(hullin_order(v, v));
    const FractionalFourier transform(8);
    const std::vector<std::complex<double>> square(64, v);
    use(transform.transform(square, v));
    use(transform.transform({}, 1.0));
    use(transform.at_order({}, 1.0));
    StarburstSettings starburst{v, v, v, v, 10};
    use(make_starburst(IrisOpening(Iris{}), bands, starburst));
    use(make_starburst(mask, nullptr, bands, starburst));
    use(make_starburst(hollow_mask, nullptr, bands, {}));
    const std::vector<SpectralBand> wild = {{v, {v, v, v}, v}};
    use(make_starburst(IrisOpening(Iris{}), wild, {50.0, 5.0, 0.01, 20.0, 16}));
    Image image(8, 8);
    add_starburst(image, Starburst(), {v, v}, {v, v, v});
    const auto small = make_starburst(IrisOpening(Iris{}), bands, {50.0, 5.0, 0.01, 20.0, 32});
    REQUIRE(small.has_value());
    add_starburst(image, *small, {v, v}, {1.0, 1.0, 1.0});
    const auto sheet = lay_out(*small, 8, 8);
    REQUIRE(sheet.has_value());
    add_starburst(image, *sheet, {v, v}, {1.0, 1.0, 1.0});
  }
  for (const int n : kStrangeCounts) {
    CAPTURE(n);
    use(grid_over(1.0, n));
    use(make_mask({n, 0.1}, [](Vec2) { return -1.0; }));
    use(fraunhofer_pattern(mask, {50.0, 550.0, 1.0, {n, 1e-3}}));
    use(fresnel_pattern(mask, 1.0, {10.0, n, 0.0}));
    const FractionalFourier transform(n);
    use(transform.side());
    use(make_starburst(IrisOpening(Iris{}), bands, {50.0, 5.0, 0.01, 20.0, n}));
    use(lay_out(Starburst(), n, n));
  }
  use(make_starburst(IrisOpening(Iris{}), {}, {}));
  use(hollow_mask.open_area_mm2());
  for (const Image& image : hollow_images()) {
    use(mask_of_image(image, 5, 1.0));
    use(mask_of_image(image, 0, kNan));
    use(with_dirt(mask, image, 0));
    use(with_dirt(hollow_mask, Image(4, 4, 1), 0));
    Image drawn = image;
    const auto small = make_starburst(IrisOpening(Iris{}), bands, {50.0, 5.0, 0.01, 20.0, 32});
    add_starburst(drawn, *small, {1.0, 1.0}, {1.0, 1.0, 1.0});
  }
  MaskPower power;
  PupilMask dimmed = mask;
  dim(dimmed, power, {});
  const std::vector<DimPolygon> polygons = {{}, {{{kNan, 0.0}, {1e300, 1.0}, {0.0, kInfinity}}, kNan}};
  dim(dimmed, power, polygons);
  dim(hollow_mask, power, polygons);
}

TEST_CASE("pictures stand any image") {
  for (const Image& image : hollow_images()) {
    use(compare(image, image));
    use(compare(image, Image(4, 4)));
    use(quantile_of_samples(image, 0.5));
    use(detect_lights(image));
    use(automatic_threshold(image));
    use(light_matte(image, Detection{}));
    use(picture_of_areas(image, {}, {}));
    DetectedLight far;
    far.max_x = far.max_y = 1 << 30;
    far.areas = {77};
    use(picture_of_areas(Image(4, 4), {}, far));
  }
  Image wild(9, 7);
  for (std::size_t k = 0; k < wild.pixels.size(); ++k)
    wild.pixels[k] = static_cast<float>(kStrange[k % kStrange.size()]);
  for (const double v : kStrange) {
    CAPTURE(v);
    DetectionSettings settings;
    settings.threshold = v;
    use(detect_lights(wild, settings));
    settings = {};
    settings.softness = v;
    use(detect_lights(wild, settings));
    settings = {};
    settings.max_value = v;
    use(detect_lights(wild, settings));
    use(quantile_of_samples(wild, v));
  }
  for (const int n : kStrangeCounts) {
    DetectionSettings settings;
    settings.max_lights = n;
    use(detect_lights(wild, settings));
    settings = {};
    settings.min_pixels = n;
    use(detect_lights(wild, settings));
    use(frame_pass_ms(n, n, {1}));
  }
  use(frame_pass_ms(8, 8, {1}));
}
