// SPDX-License-Identifier: Apache-2.0
#include "studio/core/coating_curves.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/settings.h"
#include "studio/core/prescription_table.h"

namespace contrejour::studio {
namespace {

constexpr int kColourBands = 24;

double lambda_of_point(std::size_t k) {
  return kFirstCurve_nm + (kLastCurve_nm - kFirstCurve_nm) * static_cast<double>(k) / (kCurvePoints - 1);
}

// The angle is in the thinner medium, so that it exists on both sides.
double reflectance_at(const SurfaceState& s, const Coating& coating, double angle_deg, double lambda_nm) {
  const double before = refractive_index(s.before, lambda_nm), after = refractive_index(s.after, lambda_nm);
  const double from = std::fmin(before, after), to = std::fmax(before, after);
  return reflectance(coating, from, to, std::cos(angle_deg * params::kDegree_rad), lambda_nm);
}

Coating placed(const SurfaceState& s) { return placed_on(s.coating, s.before, s.after); }

// A coating that a file has given a name, as a value; empty where no value says it.
std::string value_of(const Coating& coating) {
  if (const auto* film = std::get_if<QuarterWave>(&coating.films))
    return fmt::format("quarter-wave:{}:{}", film->lambda0_nm, film->n);
  const auto* stack = std::get_if<FilmStack>(&coating.films);
  if (stack == nullptr) return "";
  std::vector<std::string> layers;
  for (const FilmLayer& layer : stack->layers) {
    if (layer.material.name.empty() && layer.material.n.imag() != 0) return "";
    const std::string material =
        layer.material.name.empty() ? fmt::format("{}", layer.material.n.real()) : layer.material.name;
    layers.push_back(fmt::format("{}@{}", material, layer.thickness_nm));
  }
  return fmt::format("stack:{}", fmt::join(layers, ","));
}

std::string number_of(const std::string& text) { return text.substr(0, text.find(':')); }

}  // namespace

ReflectanceCurves reflectance_curves(const SurfaceState& surface) {
  ReflectanceCurves curves;
  const Coating coating = placed(surface);
  for (std::size_t a = 0; a < kCurveAngles_deg.size(); ++a)
    for (std::size_t k = 0; k < kCurvePoints; ++k) {
      const double r = reflectance_at(surface, coating, kCurveAngles_deg[a], lambda_of_point(k));
      curves.reflectance[a][k] = r;
      curves.largest = std::fmax(curves.largest, r);
    }
  return curves;
}

double luminous_reflectance(const SurfaceState& surface) {
  return luminance(reflected_rgb(surface), ColourSpace::Rec709);
}

Rgb reflected_rgb(const SurfaceState& surface) {
  const Coating coating = placed(surface);
  Rgb sum{};
  for (const SpectralBand& band : spectral_bands(kColourBands, IlluminantD65{}, ColourSpace::Rec709))
    for (std::size_t c = 0; c < sum.size(); ++c)
      sum[c] += band.weight[c] * reflectance_at(surface, coating, 0, band.lambda_nm);
  return sum;
}

std::string coating_of_surface(const Document& document, int surface) {
  const std::string number = std::to_string(surface);
  const auto texts = document.list("coating-at");
  for (auto text = texts.rbegin(); text != texts.rend(); ++text)
    if (number_of(*text) == number) return text->substr(number.size() + 1);
  if (const std::string all = document.text("coating"); !all.empty()) return all;
  return own_coating(document, surface);
}

std::string own_coating(const Document& document, int surface) {
  return cell_text(*document.lens, static_cast<std::size_t>(surface) - 1, LensColumn::Coating);
}

bool is_only_a_name(const std::string& coating) { return !params::parse_coating(coating); }

Result<Document> with_surface_coating(Document document, int surface, const std::string& coating) {
  const std::string number = std::to_string(surface);
  auto texts = document.list("coating-at");
  std::erase_if(texts, [&](const std::string& text) { return number_of(text) == number; });
  const bool is_own = is_only_a_name(coating) && coating == own_coating(document, surface);
  const std::string all = document.text("coating");
  const std::string films =
      is_own ? value_of(document.lens->surfaces[static_cast<std::size_t>(surface) - 1].coating) : coating;
  if (films.empty() && !all.empty())
    return invalid_argument(
        fmt::format("the coating {} of all surfaces stands in place of \"{}\"; reset it first (Parameters, coating)",
                    all, coating));
  if (!is_own || !all.empty()) texts.push_back(number + ":" + films);
  return with_values(std::move(document), "coating-at", texts);
}

std::optional<double> design_wavelength_nm(const Document& document, int surface) {
  const auto coating = params::parse_coating(coating_of_surface(document, surface));
  if (!coating) return std::nullopt;
  if (const auto* design = std::get_if<DesignedCoating>(&coating->films)) return design->lambda0_nm;
  if (const auto* film = std::get_if<QuarterWave>(&coating->films)) return film->lambda0_nm;
  return std::nullopt;
}

std::string with_design_wavelength(const std::string& coating, double lambda_nm) {
  const auto parts = params::split(coating, ':');
  std::string text = fmt::format("{}:{:.1f}", parts[0], lambda_nm);
  for (std::size_t k = 2; k < parts.size(); ++k) text += fmt::format(":{}", parts[k]);
  return text;
}

}  // namespace contrejour::studio
