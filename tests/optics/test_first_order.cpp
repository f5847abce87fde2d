// Paraxial figures against values asserted in another program's tests, with the glass files it used.
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "contrejour/first_order.h"
#include "support/csv_lens.h"
#include "shared_data.h"

using namespace contrejour;
using nlohmann::json;

namespace {

// What follows a marker, to the end of its line.
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
    if (formula == 3) n2 += c[k] * std::pow(lambda_um, c[k + 1]);
    else if (formula == 2) n2 += c[k] * l2 / (l2 - c[k + 1]);
    else if (formula == 1) n2 += c[k] * l2 / (l2 - c[k + 1] * c[k + 1]);
    else return std::nullopt;
  }
  return std::sqrt(n2);
}

double number(const json& surface, const char* key) {
  if (!surface.contains(key) || surface[key].is_string()) return 0.0;
  return surface[key];
}

// The sample with its glasses as constants at the primary wavelength; none if it is beyond spheres and glasses.
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
  return test::place(lens);
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
  const LensState state = test::place(ball);
  CHECK(state.focal_length_mm == doctest::Approx(n * radius / (2 * (n - 1))).epsilon(1e-12));
  CHECK(state.sensor_z_mm == doctest::Approx(radius + n * radius / (2 * (n - 1))).epsilon(1e-12));
}
