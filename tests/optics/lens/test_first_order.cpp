// SPDX-License-Identifier: Apache-2.0
// Paraxial figures against values asserted in another program's tests, with the glass files that it used.
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "contrejour/expert/first_order.h"
#include "contrejour/expert/seidel.h"
#include "shared_data.h"
#include "support/approx.h"
#include "support/csv_lens.h"

using namespace contrejour;
using nlohmann::json;

namespace {

// The text after a marker, to the end of its line.
std::optional<std::string> after(const std::string& text, const std::string& marker) {
  const auto at = text.find(marker);
  if (at == std::string::npos) return std::nullopt;
  const auto start = at + marker.size();
  return text.substr(start, text.find('\n', start) - start);
}

// Index from a refractiveindex.info file: formula 2 (Sellmeier) and formula 3 (polynomial) are enough here.
std::optional<double> index_from_file(const std::filesystem::path& file, double lambda_um) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  const auto kind = after(text.str(), "type: formula ");
  const auto coefficients = after(text.str(), "coefficients:");
  if (!kind || !coefficients) return std::nullopt;
  const int formula = std::stoi(*kind);
  std::stringstream numbers(*coefficients);
  std::vector<double> c;
  for (double v = 0; numbers >> v;) c.push_back(v);
  const double l2 = lambda_um * lambda_um;
  double n2 = formula == 3 ? c[0] : 1.0 + c[0];
  for (std::size_t k = 1; k + 1 < c.size(); k += 2) {
    if (formula == 3)
      n2 += c[k] * std::pow(lambda_um, c[k + 1]);
    else if (formula == 2)
      n2 += c[k] * l2 / (l2 - c[k + 1]);
    else if (formula == 1)
      n2 += c[k] * l2 / (l2 - c[k + 1] * c[k + 1]);
    else
      return std::nullopt;
  }
  return std::sqrt(n2);
}

double number(const json& surface, const char* key) {
  if (!surface.contains(key) || surface[key].is_string()) return 0.0;
  return surface[key];
}

// The sample with its glasses as constants at the primary wavelength; nullopt if it has anything but spheres and
// glasses.
std::optional<LensState> state_of(const json& sample, const json& resolution) {
  double lambda_um = 0.0;
  for (const auto& w : sample["wavelengths_um"]) {
    if (!w.is_object()) return std::nullopt;
    if (w.value("is_primary", false)) lambda_um = w["value"];
  }
  const double scale = resolution.value("scale_mm", 1.0);
  Prescription lens;
  const auto& rows = sample["surfaces"];
  for (std::size_t k = 1; k + 1 < rows.size(); ++k) {
    const auto& row = rows[k];
    if (row.contains("conic")) return std::nullopt;
    const double radius = number(row, "radius") * scale;
    const double thickness = number(row, "thickness") * scale;
    double n = 1.0;
    if (row.contains("material")) {
      const std::string material = row["material"].is_string() ? row["material"].get<std::string>() : "";
      if (const auto ideal = after(material, "IdealMaterial(n=")) {
        n = std::stod(*ideal);
      } else {
        std::string key = row["material"].dump();
        for (std::size_t at = 0; (at = key.find("\",\"", at)) != std::string::npos; ++at) key.insert(at + 2, 1, ' ');
        const auto found = resolution["glasses"].find(key);
        if (found == resolution["glasses"].end()) return std::nullopt;
        const auto file = test::shared_data("glass/refractiveindex.info/database/data/" + found->get<std::string>());
        const auto index = file ? index_from_file(*file, lambda_um) : std::nullopt;
        if (!index) return std::nullopt;
        n = *index;
      }
    }
    if (row.value("is_stop", false)) {
      const Glass medium = lens.surfaces.empty() ? air() : lens.surfaces.back().glass_after;
      lens.surfaces.push_back({SurfaceKind::Stop, 0.0, 0.0, 1.0, medium, {}, 0});
    }
    lens.surfaces.push_back(
        {SurfaceKind::Refracting, radius == 0.0 ? 0.0 : 1.0 / radius, thickness, 1.0, {"", ConstantIndex{n}}, {}, 0});
  }
  return test::configured(lens);
}

double listed_image_distance(const json& sample, const json& resolution) {
  const auto& rows = sample["surfaces"];
  return number(rows[rows.size() - 2], "thickness") * resolution.value("scale_mm", 1.0);
}

}  // namespace

TEST_CASE("focal lengths, focal points and pupils agree with optiland's asserted values to 1e-6") {
  const auto oracle = test::shared_data("oracles/optiland_paraxial_expected.json");
  const auto samples_file = test::shared_data("lenses/optiland/optiland_samples.json");
  const auto resolution_file = test::shared_data("oracles/optiland_glass_resolution.json");
  if (!oracle || !samples_file || !resolution_file) return;
  const json expected = json::parse(std::ifstream(*oracle))["systems"];
  const json samples = json::parse(std::ifstream(*samples_file));
  const json resolutions = json::parse(std::ifstream(*resolution_file))["systems"];
  int systems = 0;
  for (const auto& [name, e] : expected.items()) {
    CAPTURE(name);
    const json sample = samples[name];
    const json resolution = resolutions.value(name, json::object());
    auto state = state_of(sample, resolution);
    if (!state) {
      MESSAGE("beyond spheres and catalogue glasses: ", name);
      continue;
    }
    ++systems;
    // An expected F2 of zero is a sample that solves for its image plane: the sensor then stays in focus.
    const bool solved = std::abs(e["F2"].get<double>()) < 1e-9;
    if (!solved) state->sensor_z_mm = state->surfaces.back().z_mm + listed_image_distance(sample, resolution);
    state->f_number = std::abs(e["f2"].get<double>() / e["EPD"].get<double>());
    const FirstOrder f = first_order(*state, kLineD_nm);
    const double size = std::abs(e["f2"].get<double>());
    const auto same = [&](double value, const char* key) {
      CAPTURE(key);
      CHECK(std::abs(value - e[key].get<double>()) <= 1e-6 * std::max(std::abs(e[key].get<double>()), size));
    };
    same(f.focal_length_mm, "f2");
    same(f.back_focal_distance_mm - f.sensor_position_mm, "F2");
    same(f.front_focal_distance_mm, "F1");
    same(f.entrance_pupil_position_mm, "EPL");
    same(f.entrance_pupil_diameter_mm, "EPD");
    same(f.exit_pupil_position_mm, "XPL");
    same(f.exit_pupil_diameter_mm, "XPD");
    same(f.f_number, "FNO");
  }
  CHECK(systems >= 8);
}

TEST_CASE("a ball lens focuses at n R / (2 (n - 1)) from its centre") {
  const double n = 1.5;
  const double radius = 5.0;
  Prescription ball;
  ball.surfaces = {{SurfaceKind::Stop, 0.0, 0.0, 4.0, air(), {}, 0},
                   {SurfaceKind::Refracting, 1.0 / radius, 2 * radius, 4.0, {"", ConstantIndex{n}}, {}, 0},
                   {SurfaceKind::Refracting, -1.0 / radius, 0.0, 4.0, air(), {}, 0}};
  const LensState state = test::configured(ball);
  CHECK(state.focal_length_mm == test::approx(n * radius / (2 * (n - 1))).epsilon(1e-12));
  CHECK(state.sensor_z_mm == test::approx(radius + n * radius / (2 * (n - 1))).epsilon(1e-12));
}

TEST_CASE("Seidel's sums are those that optiland asserts, its signs turned, to 1e-6") {
  const auto oracle = test::shared_data("oracles/optiland_test_assertions.json");
  const auto samples_file = test::shared_data("lenses/optiland/optiland_samples.json");
  const auto resolution_file = test::shared_data("oracles/optiland_glass_resolution.json");
  if (!oracle || !samples_file || !resolution_file) return;
  const json samples = json::parse(std::ifstream(*samples_file));
  const json resolutions = json::parse(std::ifstream(*resolution_file))["systems"];
  std::map<std::string, std::vector<double>> expected;  // of each test's system, S_I to S_V
  const json asserted = json::parse(std::ifstream(*oracle));
  for (const json& line : asserted["tests"]["tests/test_aberrations.py"]) {
    const std::string name = line["test"];
    if (name.ends_with(".test_third_order") && line["quantity"].get<std::string>().starts_with("S["))
      expected[name.substr(0, name.find('.'))].push_back(line["expected"]);
  }
  const struct {
    const char *test, *sample;
    double field_deg, f_number, pupil_mm;
  } kSystems[] = {{"TestDoubleGaussAberrations", "DoubleGauss", 14.0, 5.0, 0.0},
                  {"TestEdmundSinglet", "Edmund_49_847", 14.0, 0.0, 25.4},
                  {"TestSingletStopTwo", "SingletStopSurf2", 5.0, 0.0, 25.0}};
  for (const auto& system : kSystems) {
    const std::string name = system.sample;
    CAPTURE(name);
    auto state = state_of(samples[system.sample], resolutions[system.sample]);
    REQUIRE(state.has_value());
    state->f_number = system.pupil_mm > 0.0 ? state->focal_length_mm / system.pupil_mm : system.f_number;
    const SeidelSums sums = seidel_sums(*state, {.half_field_rad = rad_from_deg(system.field_deg)});
    const double computed[] = {sums.spherical, sums.coma, sums.astigmatism, sums.petzval, sums.distortion};
    const std::vector<double>& wanted = expected[system.test];
    REQUIRE(wanted.size() == 5);
    for (std::size_t k = 0; k < 5; ++k) CHECK(computed[k] == test::approx(-wanted[k]).epsilon(1e-6));
    CHECK(sums.axial_colour == 0.0);  // glasses are constants here
  }
}

TEST_CASE("a thin lens's colour is y^2 power / V, and an ellipsoid of conic -1 / n^2 has no spherical aberration") {
  Prescription lens;
  const Glass glass{"", AbbeGlass{1.6, 40.0}};
  Surface front{.curvature_per_mm = 0.02,
                .thickness_mm = 1e-9,
                .semi_diameter_mm = 1e-3,
                .glass_after = glass};  // small rims: larger ones would cross
  Surface back{.curvature_per_mm = -0.02, .semi_diameter_mm = 1e-3, .glass_after = air()};
  Surface stop{.kind = SurfaceKind::Stop, .semi_diameter_mm = 5.0, .glass_after = air()};
  lens.surfaces = {stop, front, back};
  lens.f_number = 5.0;
  auto state = configure_lens(lens);
  REQUIRE_MESSAGE(state.has_value(), (state ? "" : state.error().to_string()));
  const double y = 0.5 * state->focal_length_mm / 5.0;
  const SeidelSums thin = seidel_sums(*state, {});
  CHECK(thin.axial_colour == test::approx(y * y / state->focal_length_mm / 40.0).epsilon(1e-6));
  CHECK(thin.lateral_colour == test::approx(0.0));
  CHECK(thin.spherical > 0.0);

  const double n = refractive_index(glass, kLineD_nm);
  state->surfaces[1].shape.conic = -1.0 / (n * n);
  CHECK(seidel_by_surface(*state, {})[1].spherical == test::approx(0.0).scale(thin.spherical));
  // The same departure from the sphere, as a coefficient of r^4.
  state->surfaces[1].shape.conic = 0.0;
  state->surfaces[1].shape.powers = {0.0, 0.0, 0.0, -0.02 * 0.02 * 0.02 / (8.0 * n * n)};
  CHECK(seidel_by_surface(*state, {})[1].spherical == test::approx(0.0).scale(thin.spherical));
}
