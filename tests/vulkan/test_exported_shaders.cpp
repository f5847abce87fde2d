// SPDX-License-Identifier: Apache-2.0
// Exported GLSL and HLSL, compiled to SPIR-V and run on a device, against the library.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include "contrejour/expert/polynomial.h"
#include "device.h"
#include "run_shader.h"
#include "support/coarse_polynomials.h"
#include "support/scratch_folder.h"

using namespace contrejour;

namespace {

constexpr std::array<std::array<double, 4>, 3> kExportedRays{
    {{0.02, 1.0, 0.5, 550.0}, {0.11, -2.0, 1.5, 450.0}, {0.2, 0.3, -2.0, 640.0}}};  // field, x, y, wavelength
constexpr std::size_t kRayFloats = 11;  // whether the ghost is fitted, and the ray

// The coefficients that exported C has as an array.
std::vector<float> coefficients_in(const std::string& c_code) {
  std::vector<float> values;
  std::istringstream text(c_code.substr(c_code.find('{', c_code.find("_coefficients[] =")) + 1));
  for (float value = 0.0F; text >> value; text.ignore()) values.push_back(value);
  REQUIRE(!values.empty());
  return values;
}

// A buffer of four numbers for each ray, followed by room for what is written and by the coefficients.
template <class Rays>
std::vector<float> buffer_of(const Rays& rays, std::size_t written, const std::vector<float>& coefficients) {
  std::vector<float> values;
  for (const auto& ray : rays)
    for (const double value : ray) values.push_back(static_cast<float>(value));
  values.resize(values.size() + written);
  values.insert(values.end(), coefficients.begin(), coefficients.end());
  return values;
}

// Exported code as a compute shader with a buffer `values`, in which the coefficients are after `first` numbers: with a
// table of them in the shader, lavapipe takes minutes to compile it.
std::string compute_shader(PolynomialLanguage language, const std::string& code, std::size_t first,
                           const std::string& body) {
  const bool is_hlsl = language == PolynomialLanguage::Hlsl;
  const std::string buffer =
      is_hlsl
          ? "[[vk::binding(0, 0)]] RWStructuredBuffer<float> values;\n"
          : "#version 450\nlayout(local_size_x = 1) in;\nlayout(std430, binding = 0) buffer B { float values[]; };\n";
  return buffer + fmt::format("#define flare_COEFFICIENT(i) values[{0} + (i)]\n", first) + code +
         (is_hlsl ? "[numthreads(1, 1, 1)]\n" : "") + "void main() {\n" + body + "}\n";
}

constexpr const char* kRayBody = R"(  float r[10];
  for (int k = 0; k < 3; ++k) {
    int at = 4 * k, to = 12 + 11 * k;
    bool ok = flare_ray(int(values[to]), values[at], values[at + 1], values[at + 2], values[at + 3], r);
    values[to] = ok ? 1.0 : 0.0;
    for (int i = 0; i < 10; ++i) values[to + 1 + i] = r[i];
  }
)";

void check_rays(const LensPolynomials& fit, const Ghost& ghost, const std::vector<float>& values) {
  // Sums of a hundred floats, over the largest values that occur.
  constexpr double kSensor_mm = 2e-4, kStop = 2e-5, kTransmittance = 1e-5;
  auto at = values.begin() + 4 * kExportedRays.size();
  int compared = 0;
  const GhostPolynomials& of = test::polynomials_of(fit, ghost);
  for (const auto& [field, x, y, lambda_nm] : kExportedRays) {
    const PolynomialZone* const zone = find_zone(of, field);
    const bool fitted = zone != nullptr && zone->state == PolynomialZone::State::Fitted;
    CHECK((at[0] != 0.0F) == fitted);
    if (fitted) {
      const PolynomialRay ray = evaluate(fit, *zone, field, {x, y}, lambda_nm);
      CHECK(std::hypot(at[1] - ray.sensor_mm.x, at[2] - ray.sensor_mm.y) < kSensor_mm);
      CHECK(std::hypot(at[3] - ray.stop[0].x, at[4] - ray.stop[0].y) < kStop);
      CHECK(std::abs(std::sqrt(std::max(at[9], 0.0F)) - ray.relative_height) < kStop);
      CHECK(std::abs(at[10] - ray.transmittance) < kTransmittance);
      ++compared;
    }
    at += kRayFloats;
  }
  CHECK(compared > 0);
}

// The floats that a shader writes; none where it cannot be compiled or run, which skips the test.
std::optional<std::vector<float>> written_by(PolynomialLanguage language, const std::string& text,
                                             const std::vector<float>& buffer) {
  const test::ScratchFolder folder;
  const std::string source = (folder / "rays.comp").string(), spirv = (folder / "rays.spv").string();
  std::ofstream(source) << text;
  const char* const is_hlsl = language == PolynomialLanguage::Hlsl ? "-D" : "";
  REQUIRE(std::system(
              fmt::format("glslangValidator --quiet {} -V -S comp -e main -o {} {} > /dev/null", is_hlsl, spirv, source)
                  .c_str()) == 0);
  auto values = test::run_shader(spirv, buffer);
  if (!values) MESSAGE("skipped, as no device is usable");
  return values;
}

bool has_compiler() {
  const bool found = std::system("glslangValidator --version > /dev/null 2>&1") == 0;
  if (!found) MESSAGE("skipped: there is no glslangValidator");
  return found;
}

}  // namespace

TEST_CASE("exported GLSL and HLSL give the library's values on a device [slow]") {
  if (!has_compiler()) return;
  const LensPolynomials fit = test::coarse_triplet_polynomials(5);
  const Ghost ghost = test::fitted_ghosts(fit, 1).front();
  const auto coefficients = coefficients_in(*export_polynomials(fit, {ghost}, PolynomialLanguage::C));
  for (const auto language : {PolynomialLanguage::Glsl, PolynomialLanguage::Hlsl}) {
    const auto code = export_polynomials(fit, {ghost}, language);
    REQUIRE(code.has_value());
    const auto values =
        written_by(language, compute_shader(language, *code, 12 + kRayFloats * kExportedRays.size(), kRayBody),
                   buffer_of(kExportedRays, kRayFloats * kExportedRays.size(), coefficients));
    if (!values) return;
    check_rays(fit, ghost, *values);
  }
  test::check_no_messages();
}
