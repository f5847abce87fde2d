// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/json/json_lens.h"

#include <algorithm>
#include <cctype>
#include <string>

#include <fmt/format.h>

#include "base/near_name.h"
#include "optics/lens/validate.h"

namespace contrejour::inline internal {
namespace {

constexpr JsonLensFormat kJsonFormats[] = {
    {"ray-optics", is_roa, read_roa},
    {"Optiland", is_optiland, read_optiland},
    {"Realflare", is_realflare, read_realflare},
    {"DeepLens", is_deeplens, read_deeplens},
    {"Lentil", is_lentil, read_lentil, true},
};

std::string first_keys(const JsonField& root) {
  constexpr std::size_t kMaxShown = 8;
  std::string keys;
  for (std::size_t k = 0; root.is_map() && k < std::min(root.size(), kMaxShown); ++k)
    keys += fmt::format("{}'{}'", k == 0 ? "" : ", ", shortened(root.key(k)));
  return keys.empty() ? "none" : keys;
}

}  // namespace

void refuse_many_surfaces(const JsonField& surfaces) {
  if (surfaces.size() > static_cast<std::size_t>(kMaxSurfaces))
    surfaces.fail(fmt::format("{} surfaces; at most {} are computed", surfaces.size(), kMaxSurfaces));
}

void add_powers(const JsonField& list, std::size_t first, std::size_t step, SurfaceShape& shape) {
  for (std::size_t k = 0; k < list.size(); ++k) {
    const double value = list[k].required_number();
    const std::size_t power = first + step * k;
    if (value == 0.0) continue;
    if (power == 0 || power > static_cast<std::size_t>(SurfaceShape::kHighestPower))
      return list[k].fail(
          fmt::format("a coefficient of the power {}; 1 to {} are computed", power, SurfaceShape::kHighestPower));
    if (shape.powers.size() < power) shape.powers.resize(power, 0.0);
    shape.powers[power - 1] += value;
  }
}

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool looks_like_json(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '{';
}

Result<Prescription> read_json_lens(const LensText& in) {
  const auto tree = parse_json(in.text, in.file);
  if (!tree) return tl::unexpected(tree.error());
  JsonErrors errors{in.file, {}};
  const JsonField root(*tree, errors);
  for (const JsonLensFormat& format : kJsonFormats) {
    if (!format.is(root)) continue;
    if (!in.key.empty() && !format.many)
      return failure(ErrorCode::InvalidArgument,
                     fmt::format("the file holds one lens; leave '#{}' out", shortened(in.key)), {in.file, 0, 0});
    return format.read(root, in);
  }
  std::string names;
  for (const JsonLensFormat& format : kJsonFormats) names += (names.empty() ? "" : ", ") + std::string(format.name);
  return failure(ErrorCode::Parse,
                 fmt::format("JSON, but no lens of a program that is known; its keys are {}; lenses of {} are read "
                             "(docs/formats)",
                             first_keys(root), names),
                 {in.file, root.line(), 0});
}

}  // namespace contrejour::inline internal
