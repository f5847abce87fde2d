// SPDX-License-Identifier: Apache-2.0
// Camera rays from polynomials: against the tracer, which shares no code with the rays of the fit's path through the
// lens backwards; against closed forms; as exported source code.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <random>
#include <string>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "contrejour/expert/direct_polynomials.h"
#include "contrejour/expert/trace.h"
#include "support/approx.h"
#include "support/scratch_folder.h"

using namespace contrejour;

namespace {

const LensState& direct_lens() {
  static const LensState made = [] {
    const auto lens = configure_lens(*find_lens("tessar"), {.object_distance_mm = 3000.0});
    REQUIRE(lens.has_value());
    return *lens;
  }();
  return made;
}
const DirectPolynomials& direct_fit() {
  static const DirectPolynomials made = [] {
    const auto fit = fit_direct_polynomials(direct_lens());
    if (!fit) FAIL(fit.error().message);
    return *fit;
  }();
  return made;
}

// Any point of the sensor's circle and of the open stop, at any wavelength.
struct CameraSample {
  Vec2 sensor_mm, stop;
  double lambda_nm;
};
std::vector<CameraSample> camera_samples(int count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto in_disc = [&](double radius) {
    const double r = radius * std::sqrt(unit(random)), turn = 2.0 * std::numbers::pi * unit(random);
    return Vec2{r * std::cos(turn), r * std::sin(turn)};
  };
  std::vector<CameraSample> samples;
  const double height_mm = 0.5 * std::hypot(direct_lens().sensor_width_mm, direct_lens().sensor_height_mm);
  for (int k = 0; k < count; ++k) samples.push_back({in_disc(height_mm), in_disc(1.0), 400.0 + 300.0 * unit(random)});
  return samples;
}

// In radii of the widest stop.
Vec2 traced_stop(const TracedRay& ray) {
  return ray.stop[0] * (direct_lens().stop_radius_mm / direct_fit().stop_radius_mm);
}

bool succeeds(const std::string& command) { return std::system((command + " > /dev/null 2>&1").c_str()) == 0; }

// Compares what a program printed for camera_samples(), a ray and the sensor's point for the scene's point 2 m along it
// each.
void check_printed_rays(const std::string& file, int count) {
  std::ifstream printed(file);
  for (const auto& [sensor_mm, stop, lambda_nm] : camera_samples(count)) {
    const auto ray = direct_ray(direct_fit(), sensor_mm, stop, lambda_nm);
    REQUIRE(ray.has_value());
    std::array<double, 11> got{};
    for (double& value : got) REQUIRE(static_cast<bool>(printed >> value));
    const std::array<double, 9> expected{
        ray->origin_mm.x, ray->origin_mm.y, ray->origin_mm.z,   ray->direction.x,
        ray->direction.y, ray->direction.z, ray->transmittance, ray->relative_height * ray->relative_height,
        ray->weight};
    for (std::size_t k = 0; k < expected.size(); ++k)
      CHECK(std::abs(got[k] - expected[k]) <= 1e-9 * std::max(1.0, std::abs(expected[k])));
    CHECK(std::hypot(got[9] - sensor_mm.x, got[10] - sensor_mm.y) < 1e-7);
  }
}

}  // namespace

TEST_CASE("camera rays of polynomials land where the tracer says") {
  const DirectPolynomials& fit = direct_fit();
  CHECK(fit.accuracy.rays > 500);
  CHECK(fit.accuracy.sensor_p95_px < 0.01);
  std::vector<double> sensor_px;
  int open = 0, wrong = 0;
  for (const auto& [sensor_mm, stop, lambda_nm] : camera_samples(400)) {
    const auto ray = direct_ray(fit, sensor_mm, stop, lambda_nm);
    REQUIRE(ray.has_value());
    const OpticalPath path = direct_path(direct_lens(), lambda_nm);
    const TracedRay traced = trace(path, {ray->origin_mm, -ray->direction});
    if (traced.status != RayStatus::Ok) {
      CHECK(ray->relative_height > 1.0);
      continue;
    }
    if (std::abs(traced.relative_height - 1.0) > 0.01 && (traced.relative_height > 1.0) != (ray->relative_height > 1.0))
      ++wrong;
    if (traced.relative_height > 1.0) continue;
    ++open;
    sensor_px.push_back(length(traced.sensor_mm - sensor_mm) / fit.pixel_mm);
    CHECK(length(traced_stop(traced) - stop) < 1e-3);
    CHECK(ray->transmittance == test::approx(traced.transmission).epsilon(2e-3));
  }
  CHECK(open > 200);
  CHECK(wrong == 0);
  std::ranges::sort(sensor_px);
  CHECK(sensor_px[sensor_px.size() * 95 / 100] < 0.02);
  CHECK(sensor_px.back() < 0.25);
}

TEST_CASE("the weights of camera rays sum to the projected solid angle of the exit pupil") {
  // On the axis it is pi sin^2 of the marginal ray's angle, which a ray traced from the front has.
  const DirectPolynomials& fit = direct_fit();
  constexpr double kLambda_nm = 550.0;
  const auto marginal = direct_ray(fit, {}, {1.0, 0.0}, kLambda_nm);
  REQUIRE(marginal.has_value());
  const TracedRay traced = trace(direct_path(direct_lens(), kLambda_nm), {marginal->origin_mm, -marginal->direction});
  const double expected =
      std::numbers::pi * (traced.direction.x * traced.direction.x + traced.direction.y * traced.direction.y);
  double sum = 0.0;
  constexpr int kRings = 200;
  for (int k = 0; k < kRings; ++k) {
    const double radius = (k + 0.5) / kRings;
    sum += direct_ray(fit, {}, {radius, 0.0}, kLambda_nm)->weight * 2.0 * std::numbers::pi * radius / kRings;
  }
  CHECK(sum == test::approx(expected).epsilon(2e-4));
}

TEST_CASE("a point of the scene is found on the sensor where its rays land") {
  // Rays that are traced from the front: points of the scene on them, near and at infinity.
  const DirectPolynomials& fit = direct_fit();
  int compared = 0;
  for (const auto& [sensor_mm, stop, lambda_nm] : camera_samples(60)) {
    const auto near = direct_ray(fit, sensor_mm, stop, lambda_nm);
    const TracedRay traced = trace(direct_path(direct_lens(), lambda_nm), {near->origin_mm, -near->direction});
    if (traced.status != RayStatus::Ok || traced.relative_height > 1.0) continue;
    for (const double distance_mm : {200.0, 3000.0, 1e5}) {
      const auto found =
          direct_sensor_point(fit, {near->origin_mm + distance_mm * near->direction}, traced_stop(traced), lambda_nm);
      REQUIRE(found.has_value());
      CHECK(length(*found - traced.sensor_mm) < 0.25 * fit.pixel_mm);
    }
    const auto distant = direct_sensor_point(fit, {7.0 * near->direction, true}, traced_stop(traced), lambda_nm);
    REQUIRE(distant.has_value());
    CHECK(length(*distant - traced.sensor_mm) < 0.25 * fit.pixel_mm);
    ++compared;
  }
  CHECK(compared > 20);
  // Behind the front, and outside of the field.
  CHECK(!direct_sensor_point(fit, {{0.0, 0.0, 100.0}}, {}, 550.0).has_value());
  CHECK(!direct_sensor_point(fit, {{1000.0, 0.0, -10.0}, true}, {}, 550.0).has_value());
  CHECK(!direct_ray(fit, {1000.0, 0.0}, {}, 550.0).has_value());
  CHECK(!direct_ray(fit, {std::nan(""), 0.0}, {}, 550.0).has_value());
}

TEST_CASE("polynomials of one wavelength give its values") {
  const DirectPolynomials one = at_wavelength(direct_fit(), 480.0);
  CHECK(static_cast<double>(write_direct_polynomials(one).size()) <
        0.6 * static_cast<double>(write_direct_polynomials(direct_fit()).size()));
  for (const auto& sample : camera_samples(20)) {
    const auto all = direct_ray(direct_fit(), sample.sensor_mm, sample.stop, 480.0);
    const auto ray = direct_ray(one, sample.sensor_mm, sample.stop, 650.0);
    CHECK(length(all->origin_mm - ray->origin_mm) < 1e-3);
    CHECK(length(all->direction - ray->direction) < 1e-6);
    CHECK(all->transmittance == test::approx(ray->transmittance).epsilon(1e-3));
  }
}

TEST_CASE("files of the direct image are read as they were written, and damaged ones refused") {
  const std::string bytes = write_direct_polynomials(direct_fit());
  const auto read = read_direct_polynomials(bytes, "file");
  REQUIRE(read.has_value());
  CHECK(write_direct_polynomials(*read) == bytes);
  const auto ray = direct_ray(*read, {5.0, 3.0}, {0.3, -0.2}, 500.0);
  CHECK(ray->direction == direct_ray(direct_fit(), {5.0, 3.0}, {0.3, -0.2}, 500.0)->direction);
  CHECK(!read_direct_polynomials(bytes.substr(0, bytes.size() / 2), "file").has_value());
  std::string other = bytes;
  other.replace(other.find("max_height_mm"), 13, "max_heighT_mm");
  CHECK(!read_direct_polynomials(other, "file").has_value());
  CHECK(!read_polynomials(bytes, "file").has_value());
  CHECK(!read_direct_polynomials(write_polynomials({}), "file").has_value());
}

TEST_CASE("lenses whose direct image has no fit are refused") {
  LensState tilted = direct_lens();
  tilted.surfaces[1].pose.shift_mm.x = 0.1;
  CHECK(fit_direct_polynomials(tilted).error().code == ErrorCode::Unsupported);
  CHECK(!fit_direct_polynomials(direct_lens(), {.max_order = 6}).has_value());
  CHECK(!fit_direct_polynomials(direct_lens(), {.max_height_mm = -1.0}).has_value());
  CHECK(!export_direct_polynomials(direct_fit(), PolynomialLanguage::C, "2x").has_value());
  std::atomic<bool> cancel{true};
  CHECK(fit_direct_polynomials(direct_lens(), {}, {.cancel = &cancel}).error().code == ErrorCode::Cancelled);
}

TEST_CASE("exported C of the direct image gives the library's values") {
  if (!succeeds("cc --version")) {
    MESSAGE("skipped: there is no C compiler `cc`");
    return;
  }
  constexpr int kCount = 40;
  const auto code = export_direct_polynomials(direct_fit(), PolynomialLanguage::C);
  REQUIRE(code.has_value());
  std::string main =
      "#include <stdio.h>\nstatic int one(double x, double y, double a, double b, double nm) {\n"
      "  double r[9], s[2];\n  if (!lens_ray(x, y, a, b, nm, r)) return 1;\n"
      "  if (!lens_sensor(r[0] + 2e3 * r[3], r[1] + 2e3 * r[4], r[2] + 2e3 * r[5], 1.0, a, b, nm, s)) return 1;\n"
      "  for (int i = 0; i < 9; ++i) printf(\"%.17g \", r[i]);\n  printf(\"%.17g %.17g\\n\", s[0], s[1]);\n"
      "  return 0;\n}\nint main(void) {\n";
  for (const auto& [sensor_mm, stop, lambda_nm] : camera_samples(kCount))
    main +=
        fmt::format("  if (one({}, {}, {}, {}, {})) return 1;\n", sensor_mm.x, sensor_mm.y, stop.x, stop.y, lambda_nm);
  const test::ScratchFolder folder;
  const std::string source = (folder / "lens.c").string(), program = (folder / "lens").string();
  std::ofstream(source) << *code + main + "  return 0;\n}\n";
  REQUIRE(std::system(fmt::format("cc -std=c99 -Wall -Wextra -Werror -O0 {} -o {} -lm", source, program).c_str()) == 0);
  REQUIRE(std::system(fmt::format("{} > {}", program, (folder / "out").string()).c_str()) == 0);
  check_printed_rays((folder / "out").string(), kCount);
}

TEST_CASE("exported Python of the direct image gives the library's values") {
  if (!succeeds("python3 --version")) {
    MESSAGE("skipped: there is no python3");
    return;
  }
  constexpr int kCount = 8;
  const auto code = export_direct_polynomials(direct_fit(), PolynomialLanguage::Python);
  REQUIRE(code.has_value());
  std::string main =
      "\n\ndef one(x, y, a, b, nm):\n    r = lens_ray(x, y, a, b, nm)\n"
      "    s = lens_sensor(*(r[k] + 2e3 * r[3 + k] for k in range(3)), 1.0, a, b, nm)\n    print(*r, *s)\n\n\n";
  for (const auto& [sensor_mm, stop, lambda_nm] : camera_samples(kCount))
    main += fmt::format("one({}, {}, {}, {}, {})\n", sensor_mm.x, sensor_mm.y, stop.x, stop.y, lambda_nm);
  main += "assert lens_ray(1e3, 0, 0, 0, 550) is None and lens_sensor(0, 0, 1e3, 1, 0, 0, 550) is None\n";
  const test::ScratchFolder folder;
  std::ofstream(folder / "lens.py") << *code + main;
  REQUIRE(std::system(
              fmt::format("python3 {} > {}", (folder / "lens.py").string(), (folder / "out").string()).c_str()) == 0);
  check_printed_rays((folder / "out").string(), kCount);
}

TEST_CASE("exported GLSL and HLSL of the direct image compile") {
  if (!succeeds("glslangValidator --version")) {
    MESSAGE("skipped: there is no glslangValidator");
    return;
  }
  const test::ScratchFolder folder;
  const std::string body =
      "  float r[9];\n  float s[2];\n  bool ok = lens_ray(1.0, 2.0, 0.1, 0.2, 550.0, r);\n"
      "  ok = ok && lens_sensor(0.0, 1.0, -1000.0, 1.0, 0.0, 0.0, 550.0, s);\n";
  std::ofstream(folder / "lens.frag") << "#version 330\n" +
                                             *export_direct_polynomials(direct_fit(), PolynomialLanguage::Glsl) +
                                             "out vec4 colour;\nvoid main() {\n" + body +
                                             "  colour = ok ? vec4(r[0], r[8], s[0], s[1]) : vec4(0.0);\n}\n";
  CHECK(succeeds("glslangValidator " + (folder / "lens.frag").string()));
  std::ofstream(folder / "lens.hlsl") << *export_direct_polynomials(direct_fit(), PolynomialLanguage::Hlsl) +
                                             "float4 main() : SV_Target {\n" + body +
                                             "  return ok ? float4(r[0], r[8], s[0], s[1]) : 0.0;\n}\n";
  CHECK(succeeds("glslangValidator -D -V -S frag -e main -o /dev/null " + (folder / "lens.hlsl").string()));
}
