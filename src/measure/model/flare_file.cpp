// SPDX-License-Identifier: Apache-2.0
// docs/formats/measured-flare.md: a TOML file of a flare's ghosts; writing and reading it back gives the same bits.
#include <cmath>

#include <fmt/format.h>

#include "base/text_file.h"
#include "base/toml_fields.h"
#include "measure/model/flare_curves.h"

namespace contrejour {
namespace {

constexpr std::string_view kPage = "docs/formats/measured-flare.md";
constexpr std::size_t kMaxFileBytes = std::size_t{1} << 24U;
constexpr std::size_t kMaxGhosts = 10000;
constexpr std::size_t kMaxCoefficients = 32;
constexpr std::array<std::string_view, 3> kProfileNames{"profile_red", "profile_green", "profile_blue"};
constexpr NumberRange kTangent{0.0, 1000.0};
constexpr NumberRange kAny{-1e30, 1e30};
constexpr NumberRange kPositive{1e-9, 1e9};

void read_coefficients(const toml::array& list, std::string_view name, TomlFields& fields, AngleCurve& curve) {
  if (list.size() > kMaxCoefficients) return fields.fail(list, fmt::format("{}: more than 32 coefficients", name));
  curve.coefficients.clear();
  for (const toml::node& number : list) curve.coefficients.push_back(fields.number_at(number, name, kAny));
}

// A list has the curve's natural parity; { plain = [...] } is a polynomial of all powers.
void read_curve(std::string_view name, TomlFields& fields, TomlErrors& errors, AngleCurve& curve) {
  const toml::node* node = fields.find(name);
  if (node == nullptr) return;
  if (const toml::array* list = node->as_array()) return read_coefficients(*list, name, fields, curve);
  const toml::table* table = node->as_table();
  if (table == nullptr) return fields.fail(*node, fmt::format("{}: give a list of coefficients", name));
  TomlFields inner(*table, std::string(name), {"plain"}, errors);
  const toml::array* list = inner.array("plain");
  if (list == nullptr) return inner.fail_here("give plain = [...], the coefficients of 1, s, s^2, ...");
  curve.parity = Parity::None;
  read_coefficients(*list, name, inner, curve);
}

// A list of kProfileTerms lists.
void read_profile(std::string_view name, TomlFields& fields, std::vector<AngleCurve>& terms) {
  const toml::array* lists = fields.array(name);
  if (lists == nullptr) return;
  if (lists->size() != kProfileTerms) return fields.fail(*lists, fmt::format("{}: give {} lists", name, kProfileTerms));
  for (const toml::node& node : *lists) {
    const toml::array* list = node.as_array();
    if (list == nullptr) return fields.fail(node, fmt::format("{}: give lists of coefficients", name));
    terms.push_back({profile_parity(terms.size()), {}});
    read_coefficients(*list, name, fields, terms.back());
  }
}

MeasuredGhost read_ghost(const toml::table& table, std::size_t index, TomlErrors& errors) {
  TomlFields fields(
      table, fmt::format("ghost {}", index + 1),
      {"name",        "first",       "last",           "transition",   "centre",      "half_width", "skew",
       "half_height", "roundness",   "roundness_skew", "width_in",     "width_out",   "slope_in",   "slope_out",
       "clip_centre", "clip_radius", "border_red",     "border_green", "border_blue", "inside_red", "inside_green",
       "inside_blue", "profile_red", "profile_green",  "profile_blue"},
      errors);
  MeasuredGhost ghost;
  ghost.name = fields.text("name").value_or(fmt::format("{}", index + 1));
  ghost.first = fields.number("first", kTangent).value_or(0.0);
  ghost.last = fields.required_number("last", kTangent, "give the largest tangent at which the ghost is visible");
  ghost.transition = fields.number("transition", kTangent).value_or(0.0);
  const auto curves = curves_of(ghost);
  for (std::size_t k = 0; k < kGhostCurves; ++k) read_curve(kCurveNames[k], fields, errors, *curves[k]);
  for (std::size_t c = 0; c < kProfileNames.size(); ++c) read_profile(kProfileNames[c], fields, ghost.profile[c]);
  return ghost;
}

void read_exposure(TomlFields& fields, TomlErrors& errors, MeasuredFlare& flare) {
  const toml::table* table = fields.table("exposure");
  if (table == nullptr) return;
  TomlFields inner(*table, "exposure", {"f_number", "iso", "time_s"}, errors);
  CaptureExposure exposure;
  exposure.f_number = inner.required_number("f_number", kPositive, "give the f-number of the photographs");
  exposure.iso = inner.required_number("iso", kPositive, "give the sensitivity of the photographs");
  exposure.time_s = inner.required_number("time_s", kPositive, "give the exposure time of the photographs");
  flare.exposure = exposure;
}

void read_half_field(TomlFields& fields, MeasuredFlare& flare) {
  const toml::array* list = fields.array("half_field");
  if (list == nullptr) return;
  if (list->size() != 2) return fields.fail(*list, "half_field: give two tangents, across and down");
  flare.half_field = Vec2{fields.number_at(*list->get(0), "half_field", kTangent),
                          fields.number_at(*list->get(1), "half_field", kTangent)};
}

void read_ghosts(TomlFields& fields, TomlErrors& errors, MeasuredFlare& flare) {
  const toml::array* rows = fields.array("ghosts");
  if (rows == nullptr) return;
  if (rows->size() > kMaxGhosts) return fields.fail(*rows, fmt::format("more than {} ghosts", kMaxGhosts));
  for (const toml::node& row : *rows) {
    if (!row.is_table()) return fields.fail(row, "each ghost is a table: [[ghosts]]");
    flare.ghosts.push_back(read_ghost(*row.as_table(), flare.ghosts.size(), errors));
    if (errors.failed()) return;
  }
}

std::string curve_text(const AngleCurve& curve) {
  std::string list;
  for (const double c : curve.coefficients) list += (list.empty() ? "" : ", ") + toml_number(c);
  return curve.parity == Parity::None ? fmt::format("{{ plain = [{}] }}", list) : fmt::format("[{}]", list);
}

std::string ghost_text(const MeasuredGhost& ghost) {
  std::string text =
      fmt::format("\n[[ghosts]]\nname = {}\nfirst = {}\nlast = {}\ntransition = {}\n", toml_string(ghost.name),
                  toml_number(ghost.first), toml_number(ghost.last), toml_number(ghost.transition));
  const auto curves = curves_of(ghost);
  for (std::size_t k = 0; k < kGhostCurves; ++k) {
    if (is_clip_curve(k) && ghost.clip_radius.coefficients.empty()) continue;
    text += fmt::format("{} = {}\n", kCurveNames[k], curve_text(*curves[k]));
  }
  for (std::size_t c = 0; c < kProfileNames.size(); ++c) {
    std::string lists;
    for (const AngleCurve& term : ghost.profile[c]) lists += (lists.empty() ? "" : ", ") + curve_text(term);
    if (!lists.empty()) text += fmt::format("{} = [{}]\n", kProfileNames[c], lists);
  }
  return text;
}

}  // namespace

Result<MeasuredFlare> read_flare(std::string_view toml, const std::string& file) {
  const Result<toml::table> root = parse_toml(toml, file, kPage);
  if (!root) return tl::unexpected(root.error());
  TomlErrors errors(file);
  TomlFields fields(*root, "flare", {"name", "source", "s_max", "half_field", "exposure", "ghosts"}, errors);
  MeasuredFlare flare;
  flare.name = fields.required_text("name", "give the flare a name");
  flare.source = fields.text("source").value_or("");
  flare.s_max =
      fields.required_number("s_max", {1e-6, kTangent.high}, "give the tangent of the largest angle measured");
  read_half_field(fields, flare);
  read_exposure(fields, errors, flare);
  read_ghosts(fields, errors, flare);
  if (errors.failed()) return tl::unexpected(errors.error());
  if (const Result<void> ok = check_flare(flare); !ok)
    return failure(ErrorCode::Parse, ok.error().message, {file, 0, 0});
  return flare;
}

Result<MeasuredFlare> read_flare(const std::filesystem::path& file) {
  const Result<std::string> text =
      read_text_file(file, kMaxFileBytes, "name a file that `contrejour measure fit` wrote");
  if (!text) return tl::unexpected(text.error());
  return read_flare(*text, file.string());
}

std::string write_flare(const MeasuredFlare& flare) {
  std::string text = fmt::format("name = {}\nsource = {}\ns_max = {}\n", toml_string(flare.name),
                                 toml_string(flare.source), toml_number(flare.s_max));
  if (flare.half_field) {
    text += fmt::format("half_field = [{}, {}]\n", toml_number(flare.half_field->x), toml_number(flare.half_field->y));
  }
  if (flare.exposure) {
    text +=
        fmt::format("exposure = {{ f_number = {}, iso = {}, time_s = {} }}\n", toml_number(flare.exposure->f_number),
                    toml_number(flare.exposure->iso), toml_number(flare.exposure->time_s));
  }
  for (const MeasuredGhost& ghost : flare.ghosts) text += ghost_text(ghost);
  return text;
}

}  // namespace contrejour
