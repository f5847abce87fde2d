// SPDX-License-Identifier: Apache-2.0
// Parses coatings: one film, stacks of films, designs, measured tables.
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "contrejour/expert/coating_file.h"
#include "contrejour/expert/film_design.h"
#include "contrejour/expert/parameter_text.h"
#include "settings/without_prefix.h"

namespace contrejour::params {
namespace {

constexpr std::size_t kMaxFilms = 1000;

bool is_film_wavelength(double nm) { return nm >= 100.0 && nm <= 10000.0; }
bool is_film_index(double n) { return n >= 1.0 && n <= 10.0; }

// "", ":550" or ":550:1.38"
template <class Film>
Result<Film> parse_film(std::string_view text) {
  Film film;
  if (text.empty()) return film;
  const auto parts = split(text.substr(1), ':');
  const auto lambda = parse_real(parts[0]);
  const auto n = parts.size() > 1 ? parse_real(parts[1]) : Result<double>(film.n);
  if (text[0] != ':' || parts.size() > 2 || !lambda || !n) {
    return invalid_argument(
        fmt::format("\"{}\" is not \":wavelength\" or \":wavelength:index\", as in quarter-wave:550:1.38", text));
  }
  if (!is_film_wavelength(*lambda))
    return invalid_argument(fmt::format("{} is out of range; give a film's wavelength from 100 to 10000 nm", parts[0]));
  if (!is_film_index(*n))
    return invalid_argument(fmt::format("{} is out of range; give a film's index from 1 to 10", parts[1]));
  film.lambda0_nm = *lambda;
  film.n = *n;
  return film;
}

std::optional<FilmMaterial> parse_material(std::string_view text) {
  if (is_film_material(text)) return film_material(text);
  const auto n = parse_real(text);
  if (!n || !is_film_index(*n)) return std::nullopt;
  return FilmMaterial(*n);
}

// "99.6", nm; "0.25w", waves at 550 nm within the film; "0.25w480", at 480 nm.
std::optional<double> parse_thickness(std::string_view text, const FilmMaterial& material) {
  const auto parts = split(text, 'w');
  const auto number = parse_real(parts[0]);
  if (!number || parts.size() > 2) return std::nullopt;
  if (parts.size() == 1) return *number;
  const auto at_nm = parts[1].empty() ? Result<double>(QuarterWave{}.lambda0_nm) : parse_real(parts[1]);
  if (!at_nm || !is_film_wavelength(*at_nm)) return std::nullopt;
  return *number * *at_nm / index_at(material, *at_nm).real();
}

// "v-coat", "broadband-5:520"; nullopt: the text does not name a design.
std::optional<Result<DesignedCoating>> parse_design(std::string_view text) {
  const auto parts = split(text, ':');
  auto design = find_coating_design(parts[0]);
  if (!design) return std::nullopt;
  if (parts.size() == 1) return Result<DesignedCoating>(*design);
  const auto lambda = parts.size() == 2 ? parse_real(parts[1]) : Result<double>(0.0);
  if (!lambda || !(*lambda >= 100.0 && *lambda <= 5000.0))
    return Result<DesignedCoating>(invalid_argument(
        fmt::format("\"{}\" has no valid wavelength; give from 100 to 5000 nm, as in v-coat:550", text)));
  design->lambda0_nm = *lambda;
  return Result<DesignedCoating>(*design);
}

Result<FilmStack> parse_stack(std::string_view text) {
  FilmStack stack;
  for (const std::string_view layer : split(text, ',')) {
    const auto parts = split(layer, '@');
    const auto material = parse_material(parts[0]);
    const auto thickness =
        material && parts.size() == 2 ? parse_thickness(parts[1], *material) : std::optional<double>();
    if (!thickness || !(*thickness >= 0.0 && *thickness <= 1e6)) {
      return invalid_argument(
          fmt::format("\"{}\" is not a film; give an index or material, @, and the thickness in nm or waves, as in "
                      "stack:1.38@99.6,ZrO2@0.5w",
                      layer));
    }
    stack.layers.push_back({*material, *thickness});
  }
  if (stack.layers.size() > kMaxFilms)
    return invalid_argument(fmt::format("the stack has {} films; give at most {}", stack.layers.size(), kMaxFilms));
  return stack;
}

Result<decltype(Coating::films)> parse_films(std::string_view text) {
  using Films = Result<decltype(Coating::films)>;
  const auto as_films = [](auto parsed) -> Films {
    if (!parsed) return tl::unexpected(parsed.error());
    return std::move(*parsed);
  };
  if (text == "none") return Bare{};
  if (const auto film = without_prefix(text, "quarter-wave")) return as_films(parse_film<QuarterWave>(*film));
  if (const auto film = without_prefix(text, "hullin")) return as_films(parse_film<HullinFresnelAR>(*film));
  if (const auto layers = without_prefix(text, "stack:")) return as_films(parse_stack(*layers));
  if (const auto file = without_prefix(text, "measured:"))
    return as_films(read_measured_coating(std::filesystem::path(*file)));
  if (auto design = parse_design(text)) return as_films(std::move(*design));
  return invalid_argument(
      fmt::format("\"{}\" is not a coating; give none, quarter-wave:550:1.38, hullin:550:1.38, "
                  "stack:1.38@99.6,ZrO2@0.5w, measured:FILE or a design ({})",
                  text, fmt::join(coating_design_names(), ", ")));
}

}  // namespace

Result<Coating> parse_coating(std::string_view text) {
  auto films = parse_films(text);
  if (!films) return tl::unexpected(films.error());
  Coating coating;
  coating.name = std::string(text);
  coating.films = std::move(*films);
  return coating;
}

Result<SurfaceCoating> parse_coating_at(std::string_view text) {
  const std::size_t colon = text.find(':');
  const auto surface = parse_integer(text.substr(0, colon));
  if (colon == std::string_view::npos || !surface || *surface < 1)
    return invalid_argument(fmt::format("\"{}\" is not a surface and its coating; write it as 12:v-coat:550", text));
  auto coating = parse_coating(text.substr(colon + 1));
  if (!coating) return tl::unexpected(coating.error());
  return SurfaceCoating{*surface, std::move(*coating)};
}

}  // namespace contrejour::params
