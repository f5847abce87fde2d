// SPDX-License-Identifier: Apache-2.0
// Parses the texts of optical settings: lights, ghosts, coatings.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "contrejour/expert/coating_file.h"
#include "contrejour/expert/film_design.h"
#include "contrejour/expert/glass_catalogue.h"
#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/spectrum_file.h"

namespace contrejour::params {
namespace {

constexpr double kLargestLight_deg = 90.0;
constexpr double kMostValue = 1e15;         // of a light: colours times this are within kMaxLightValue, or nearly
constexpr double kMostStops = 40.0;
constexpr std::pair<std::string_view, LightValue::Unit> kValueUnits[] = {{"stops", LightValue::Unit::Stops},
                                                                         {"lx", LightValue::Unit::Lux},
                                                                         {"nits", LightValue::Unit::Nits},
                                                                         {"cd", LightValue::Unit::Candela}};
constexpr double kMostGain = 1e12;          // the same as that of the gains in the table
constexpr double kFarthestOffset = 1000.0;  // times the frame's height
constexpr double kFarthestPlace = 1e6;      // of a ramp

std::optional<std::string_view> after(std::string_view text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return std::nullopt;
  return text.substr(prefix.size());
}

Result<Rgb> parse_rgb(std::string_view text, double most = kMostValue) {
  const auto numbers = parse_reals(text, 3);
  if (!numbers) return tl::unexpected(numbers.error());
  if (*std::min_element(numbers->begin(), numbers->end()) < 0.0) {
    return invalid_argument(fmt::format("\"{}\" is negative somewhere; a light has no negative channel", text));
  }
  if (*std::max_element(numbers->begin(), numbers->end()) > most)
    return invalid_argument(fmt::format("\"{}\" is too large somewhere; {:.0e} is the limit", text, most));
  return Rgb{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

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
  if (!(*lambda >= 100.0 && *lambda <= 10000.0))
    return invalid_argument("a film's wavelength must be from 100 to 10000 nm");
  if (!(*n >= 1.0 && *n <= 10.0)) return invalid_argument("a film's index must be from 1 to 10");
  film.lambda0_nm = *lambda;
  film.n = *n;
  return film;
}

std::optional<FilmMaterial> parse_material(std::string_view text) {
  if (is_film_material(text)) return film_material(text);
  const auto n = parse_real(text);
  if (!n || !(*n >= 1.0 && *n <= 10.0)) return std::nullopt;
  return FilmMaterial(*n);
}

// "99.6", nm; "0.25w", waves at 550 nm within the film; "0.25w480", at 480 nm.
std::optional<double> parse_thickness(std::string_view text, const FilmMaterial& material) {
  const auto parts = split(text, 'w');
  const auto number = parse_real(parts[0]);
  if (!number || parts.size() > 2) return std::nullopt;
  if (parts.size() == 1) return *number;
  const auto at_nm = parts[1].empty() ? Result<double>(QuarterWave{}.lambda0_nm) : parse_real(parts[1]);
  if (!at_nm || !(*at_nm >= 100.0 && *at_nm <= 10000.0)) return std::nullopt;
  return *number * *at_nm / index_at(material, *at_nm).real();
}

// "v-coat", "broadband-5:520"
std::optional<Result<DesignedCoating>> parse_design(std::string_view text) {
  const auto parts = split(text, ':');
  auto design = find_coating_design(parts[0]);
  if (!design) return std::nullopt;
  if (parts.size() == 1) return Result<DesignedCoating>(*design);
  const auto lambda = parts.size() == 2 ? parse_real(parts[1]) : Result<double>(0.0);
  if (!lambda || !(*lambda >= 100.0 && *lambda <= 5000.0))
    return Result<DesignedCoating>(
        invalid_argument(fmt::format("\"{}\": write a design's wavelength as in v-coat:550", text)));
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
          fmt::format("\"{}\" is not a film; write index or material @ nanometres or waves, as in "
                      "stack:1.38@99.6,ZrO2@0.5w",
                      layer));
    }
    stack.layers.push_back({*material, *thickness});
  }
  if (stack.layers.size() > 1000) return invalid_argument("a stack may have 1000 films");
  return stack;
}

}  // namespace

Result<LightValue> parse_light_value(std::string_view text) {
  if (text.find(',') != std::string_view::npos) {
    const auto rgb = parse_rgb(text);
    if (!rgb) return tl::unexpected(rgb.error());
    return LightValue{*rgb, true};
  }
  LightValue::Unit unit = LightValue::Unit::Sum;
  std::string_view number = text;
  for (const auto& [suffix, named] : kValueUnits) {
    if (!text.ends_with(suffix)) continue;
    number.remove_suffix(suffix.size());
    unit = named;
    break;
  }
  const auto value = parse_real(number);
  if (!value && unit == LightValue::Unit::Sum)
    return invalid_argument(
        fmt::format("\"{}\" is no brightness; write what the image sums to (5000, or R,G,B), 12stops over "
                    "white, 100000lx at the lens, 800cd or 1.6e9nits",
                    text));
  if (!value) return tl::unexpected(value.error());
  const bool is_stops = unit == LightValue::Unit::Stops;
  if (is_stops && std::abs(*value) > kMostStops)
    return invalid_argument(fmt::format("{} is out of range; choose -{} to {} stops", text, kMostStops, kMostStops));
  if (!is_stops && *value < 0.0)
    return invalid_argument(fmt::format("{} is negative; a light's value is at least 0", text));
  if (*value > kMostValue)
    return invalid_argument(fmt::format("{} is too large; a light's value is at most {:.0e}", text, kMostValue));
  return LightValue{{*value, *value, *value}, false, unit};
}

Result<LightColour> parse_light_colour(std::string_view text) {
  if (text.find(',') != std::string_view::npos) {
    const auto rgb = parse_rgb(text);
    if (!rgb) return tl::unexpected(rgb.error());
    return LightColour{IlluminantD65{}, *rgb};
  }
  auto spectrum = find_spectrum(std::string(text));
  if (!spectrum) return tl::unexpected(spectrum.error());
  return LightColour{*spectrum, std::nullopt};
}

Result<LightText> parse_light(std::string_view text) {
  const auto parts = split(text, ':');
  if (parts.size() > 4)
    return invalid_argument(fmt::format("\"{}\" has too many parts; write A,B:VALUE:COLOUR:SIZE", text));
  const auto place = parse_reals(parts[0], 2);
  if (!place) return tl::unexpected(place.error());
  LightText light;
  light.place = {(*place)[0], (*place)[1]};
  if (parts.size() > 1 && !parts[1].empty()) {
    const auto value = parse_light_value(parts[1]);
    if (!value) return tl::unexpected(value.error());
    light.value = *value;
  }
  if (parts.size() > 2 && !(parts[2].empty() && parts.size() > 3)) {
    const auto colour = parse_light_colour(parts[2]);
    if (!colour) return tl::unexpected(colour.error());
    light.colour = *colour;
  }
  if (parts.size() > 3) {
    const auto size_deg = parse_real(parts[3]);
    if (!size_deg) return tl::unexpected(size_deg.error());
    if (!(*size_deg >= 0.0 && *size_deg <= kLargestLight_deg))
      return invalid_argument(fmt::format("a light {} degrees across is out of range; choose 0 to 90", parts[3]));
    light.size_deg = *size_deg;
  }
  return light;
}

Result<Ghost> parse_ghost(std::string_view text) {
  const std::size_t at = text.find('@');
  const std::string_view surfaces = text.substr(0, at);
  std::vector<int> numbers;
  for (const std::string_view part : split(surfaces, surfaces.find(',') != std::string_view::npos ? ',' : '-')) {
    const auto number = parse_integer(part);
    numbers.push_back(number ? *number : 0);
  }
  // The light meets the later surface of a pair first, in whichever order they are named.
  const auto sorted = [&](std::size_t k) {
    if (numbers[k] > numbers[k + 1]) std::swap(numbers[k], numbers[k + 1]);
    return numbers[k] >= 1 && numbers[k] < numbers[k + 1];
  };
  Ghost ghost;
  bool good = (numbers.size() == 2 || numbers.size() == 4) && sorted(0);
  if (good) ghost = {numbers[0], numbers[1]};
  if (good && numbers.size() == 4) {
    good = sorted(2);
    ghost.k = numbers[2];
    ghost.l = numbers[3];
  }
  if (good && at != std::string_view::npos) {
    const auto orders = split(text.substr(at + 1), ',');
    const auto x = parse_integer(orders[0]);
    const auto y = orders.size() == 2 ? parse_integer(orders[1]) : x;
    good = orders.size() == 2 && x && y;
    if (good) ghost.order = {*x, *y};
  }
  if (good) return ghost;
  return invalid_argument(
      fmt::format("\"{}\" is not a ghost; write its two surfaces, as in 2-5; of four reflections both pairs, as in "
                  "2-5-1-4; an order at the sensor as in 7-12@1,-2",
                  text));
}

// A comma separates two ghosts, or two numbers within one that is written with commas or has more reflections: a number
// that is not part of a pair is joined with the next.
Result<std::vector<Ghost>> parse_ghosts(std::string_view text) {
  const auto parts = split(text, ',');
  const auto lacks_one = [](std::string_view part) {
    return part.find('@') != std::string_view::npos || part.find('-', 1) == std::string_view::npos;
  };
  std::vector<Ghost> ghosts;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    std::string name(parts[k]);
    if (lacks_one(parts[k]) && k + 1 < parts.size()) name.append(",").append(parts[++k]);
    const auto ghost = parse_ghost(name);
    if (!ghost) return tl::unexpected(ghost.error());
    ghosts.push_back(*ghost);
  }
  return ghosts;
}

Result<GhostAdjustment> parse_ghost_adjustment(std::string_view text) {
  const std::size_t colon = text.find(':');
  GhostAdjustment out;
  if (const auto surface = parse_integer(text.substr(0, colon)); surface && *surface >= 1) {
    out.surface = *surface;
  } else {
    const auto ghost = parse_ghost(text.substr(0, colon));
    if (!ghost) return tl::unexpected(ghost.error());
    out.ghost = *ghost;
  }
  if (colon == std::string_view::npos) return out;
  // A part without a name continues the list of the setting before it.
  std::vector<std::pair<std::string_view, std::string>> settings;
  for (const std::string_view part : split(text.substr(colon + 1), ',')) {
    const std::size_t equals = part.find('=');
    if (equals != std::string_view::npos) {
      settings.emplace_back(part.substr(0, equals), part.substr(equals + 1));
    } else if (!settings.empty()) {
      settings.back().second.append(",").append(part);
    } else {
      return invalid_argument(fmt::format("\"{}\" is not a ghost and what to do with it; write 2-5:gain=0.5", text));
    }
  }
  for (const auto& [name, value] : settings) {
    if (name == "gain") {
      const auto gain = parse_real(value);
      if (!gain || !(*gain >= 0.0 && *gain <= kMostGain))
        return invalid_argument(fmt::format("\"{}\" is no gain; give a number from 0 to {:.0e}", value, kMostGain));
      out.gain = *gain;
    } else if (name == "colour") {
      const auto rgb = parse_rgb(value, kMostGain);
      if (!rgb) return tl::unexpected(rgb.error());
      out.colour = *rgb;
    } else if (name == "offset") {
      const auto xy = parse_reals(value, 2);
      if (!xy) return tl::unexpected(xy.error());
      if (std::max(std::abs((*xy)[0]), std::abs((*xy)[1])) > kFarthestOffset)
        return invalid_argument(
            fmt::format("\"{}\" is too far off; {} times the frame's height is the limit", value, kFarthestOffset));
      out.offset = {(*xy)[0], (*xy)[1]};
    } else {
      return invalid_argument(fmt::format("a ghost has no \"{}\"; set gain, colour or offset", name));
    }
  }
  return out;
}

Result<std::vector<GhostRampStop>> parse_ghost_ramp(std::string_view text) {
  std::vector<GhostRampStop> ramp;
  for (const std::string_view part : split(text, '/')) {
    const auto halves = split(part, ':');
    const auto place = parse_real(halves[0]);
    if (halves.size() != 2 || !place)
      return invalid_argument(fmt::format("\"{}\" is not a place and a colour; write -1:1,0.5,0.2/1:1,1,1", part));
    if (std::abs(*place) > kFarthestPlace)
      return invalid_argument(fmt::format("\"{}\" is no place of a ramp; stay within {}", halves[0], kFarthestPlace));
    const auto rgb = parse_rgb(halves[1], kMostGain);
    if (!rgb) return tl::unexpected(rgb.error());
    if (!ramp.empty() && !(*place > ramp.back().place)) return invalid_argument("let the places of a ramp rise");
    ramp.push_back({*place, *rgb});
  }
  return ramp;
}

Result<GhostSelection> parse_selection(std::string_view text) {
  if (text == "all") return SelectAll{};
  if (const auto rest = after(text, "brightest:")) {
    const auto count = parse_integer(*rest);
    if (count && *count >= 0) return SelectBrightest{*count};
  } else if (const auto percent = after(text, "flux:")) {
    const auto share = parse_real(*percent);
    if (share && *share >= 0.0 && *share <= 100.0) return SelectByFlux{*share};
  } else if (const auto number = after(text, "surface:")) {
    const auto surface = parse_integer(*number);
    if (surface && *surface >= 1) return SelectSurface{*surface};
  } else if (const auto list = after(text, "list:")) {
    const auto ghosts = parse_ghosts(*list);
    if (!ghosts) return tl::unexpected(ghosts.error());
    return SelectList{*ghosts};
  }
  return invalid_argument(
      fmt::format("\"{}\" is no choice of ghosts; write all, brightest:N, flux:PERCENT, surface:K or "
                  "list:2-5,3-7",
                  text));
}

Result<Coating> parse_coating(std::string_view text) {
  Coating coating;
  coating.name = std::string(text);
  if (text == "none") {
    coating.films = Bare{};
  } else if (const auto quarter = after(text, "quarter-wave")) {
    const auto film = parse_film<QuarterWave>(*quarter);
    if (!film) return tl::unexpected(film.error());
    coating.films = *film;
  } else if (const auto hullin = after(text, "hullin")) {
    const auto film = parse_film<HullinFresnelAR>(*hullin);
    if (!film) return tl::unexpected(film.error());
    coating.films = *film;
  } else if (const auto layers = after(text, "stack:")) {
    const auto stack = parse_stack(*layers);
    if (!stack) return tl::unexpected(stack.error());
    coating.films = *stack;
  } else if (const auto file = after(text, "measured:")) {
    auto measured = read_measured_coating(std::filesystem::path(*file));
    if (!measured) return tl::unexpected(measured.error());
    coating.films = std::move(*measured);
  } else if (const auto design = parse_design(text)) {
    if (!*design) return tl::unexpected(design->error());
    coating.films = **design;
  } else {
    return invalid_argument(
        fmt::format("\"{}\" is no coating; write none, quarter-wave:550:1.38, hullin:550:1.38, "
                    "stack:1.38@99.6,ZrO2@0.5w, measured:FILE or a design ({})",
                    text, fmt::join(coating_design_names(), ", ")));
  }
  return coating;
}

Result<SurfaceCoating> parse_coating_at(std::string_view text) {
  const std::size_t colon = text.find(':');
  const auto surface = parse_integer(text.substr(0, colon));
  if (colon == std::string_view::npos || !surface || *surface < 1)
    return invalid_argument(fmt::format("\"{}\" is not a surface and its coating; write 12:v-coat:550", text));
  auto coating = parse_coating(text.substr(colon + 1));
  if (!coating) return tl::unexpected(coating.error());
  return SurfaceCoating{*surface, std::move(*coating)};
}

Result<SensorPlate> parse_cover_glass(std::string_view text) {
  const auto parts = split(text, ':');
  SensorPlate plate;
  const auto thickness_mm = parse_real(parts[0]);
  const std::string glass(parts.size() > 1 ? parts[1] : "N-BK7");
  const auto gap_mm = parts.size() > 2 ? parse_real(parts[2]) : Result<double>(plate.gap_mm);
  if (!thickness_mm || !gap_mm || parts.size() > 3) {
    return invalid_argument(
        fmt::format("\"{}\" is no plate; write its thickness in mm, and if you like its glass or index and "
                    "the gap behind it, as in 2, 2:N-BK7 or 2:1.52:0.8",
                    text));
  }
  plate.thickness_mm = *thickness_mm;
  plate.gap_mm = *gap_mm;
  if (const auto n = parse_real(glass)) {
    plate.glass = {glass, ConstantIndex{*n}};
    return plate;
  }
  auto entry = bundled_glasses().find(glass);
  if (!entry) return tl::unexpected(entry.error());
  plate.glass = std::move(entry->glass);
  return plate;
}

}  // namespace contrejour::params
