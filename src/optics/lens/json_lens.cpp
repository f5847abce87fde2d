#include "optics/lens/json_lens.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "base/near_name.h"
#include "optics/lens/validate.h"

namespace contrejour {
namespace {

constexpr JsonLensFormat kFormats[] = {
    {"Realflare", is_realflare, read_realflare},
    {"Lentil", is_lentil, read_lentil, true},
};

std::string first_keys(const JsonField& root) {
  constexpr std::size_t kMost = 8;
  std::string keys;
  for (std::size_t k = 0; root.is_map() && k < std::min(root.size(), kMost); ++k)
    keys += fmt::format("{}'{}'", k == 0 ? "" : ", ", shortened(root.key(k)));
  return keys.empty() ? "none" : keys;
}

}  // namespace

void refuse_many_surfaces(const JsonField& surfaces) {
  if (surfaces.size() > static_cast<std::size_t>(kMaxSurfaces))
    surfaces.fail(fmt::format("{} surfaces; at most {} are computed", surfaces.size(), kMaxSurfaces));
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
  for (const JsonLensFormat& format : kFormats) {
    if (!format.is(root)) continue;
    if (!in.key.empty() && !format.many)
      return failure(ErrorCode::InvalidArgument,
                     fmt::format("the file holds one lens; leave '#{}' out", shortened(in.key)), {in.file, 0, 0});
    return format.read(root, in);
  }
  std::string names;
  for (const JsonLensFormat& format : kFormats) names += (names.empty() ? "" : ", ") + std::string(format.name);
  return failure(ErrorCode::Parse,
                 fmt::format("JSON, but no lens of a program that is known; its keys are {}; lenses of {} are read "
                             "(docs/formats)",
                             first_keys(root), names),
                 {in.file, root.line(), 0});
}

}  // namespace contrejour
