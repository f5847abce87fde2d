// SPDX-License-Identifier: Apache-2.0
// Selects the reader for a lens file.
#include "optics/lens_files/read_lens.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "base/decode_text.h"
#include "base/lower_extension.h"
#include "base/near_name.h"
#include "base/text_file.h"
#include "contrejour/lens.h"

namespace contrejour {

namespace {

// TOML begins with `key =` or `[table]`, after comments and empty lines.
bool looks_like_toml(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos || line[begin] == '#') continue;
    line.remove_prefix(begin);
    return line.front() == '[' || (line.find('=') != std::string_view::npos && line.front() != '<');
  }
  return false;
}

// The first format that recognises a text reads it, so the formats with the most specific tests come first.
struct LensFormat {
  std::string_view name;
  bool (*looks_like)(std::string_view text);
  Result<Prescription> (*read)(const LensText& in);
};

Result<Prescription> read_ours(const LensText& in) { return read_lens_toml(in.text, in.file, in.glasses); }

constexpr LensFormat kFormats[] = {
    {"Optical Bench", looks_like_optical_bench, read_optical_bench},
    {"Zemax", looks_like_zmx, read_zmx},
    {"CODE V", looks_like_seq, read_seq},
    {"ray-optics, Optiland, Realflare, Lentil or DeepLens in JSON", looks_like_json, read_json_lens},
    {"OpenLensFlare", looks_like_lens_xml, read_lens_xml},
    {"FlareSim", looks_like_flaresim, read_flaresim},
    {"our TOML", looks_like_toml, read_ours},
    {"PBRT", looks_like_pbrt, read_pbrt},
};

std::string format_names() {
  std::string names;
  for (const LensFormat& format : kFormats) names += (names.empty() ? "" : ", ") + std::string(format.name);
  return names;
}

// "lenses.json#0001" is the lens 0001 of that file, unless there is a file of that name.
struct FileAndKey {
  std::filesystem::path file;
  std::string key;
};

FileAndKey split_key(const std::filesystem::path& named) {
  const std::string whole = named.string();
  const std::size_t hash = whole.rfind('#');
  std::error_code code;
  if (hash == std::string::npos || std::filesystem::exists(named, code)) return {named, ""};
  return {whole.substr(0, hash), whole.substr(hash + 1)};
}

}  // namespace

Result<Prescription> read_lens(const std::filesystem::path& named, const GlassCatalogue* glasses) {
  const auto [file, key] = split_key(named);
  const auto bytes = read_text_file(file, kMaxLensFileBytes, "see the bundled lenses by `contrejour lens list`");
  if (!bytes) return tl::unexpected(bytes.error());
  const std::string name = file.string();
  if (bytes->empty()) return failure(ErrorCode::Parse, "the file is empty; give a lens file", {name, 0, 0});
  const bool is_toml = lower_extension(file) == ".toml";
  const std::string text = is_toml ? *bytes : decode_text(*bytes);
  if (text.find('\0') != std::string::npos) {
    return failure(ErrorCode::Parse,
                   "not a lens file that is known: it is binary; give a TOML lens file "
                   "(docs/formats/lens-toml.md)",
                   {name, 0, 0});
  }
  if (!key.empty() && (is_toml || !looks_like_json(text)))
    return failure(ErrorCode::InvalidArgument, fmt::format("the file holds one lens; leave '#{}' out", shortened(key)),
                   {name, 0, 0});
  const LensText in{text, name, glasses, key};
  if (is_toml) return read_ours(in);
  for (const LensFormat& format : kFormats)
    if (format.looks_like(text)) return format.read(in);
  return failure(ErrorCode::Parse,
                 fmt::format("not a lens file that is known: it begins with '{}'; formats that are read are {} "
                             "(docs/formats)",
                             shortened(text.substr(0, text.find('\n'))), format_names()),
                 {name, 1, 0});
}

Result<Prescription> find_lens(const std::string& name_or_file, const GlassCatalogue* glasses) {
  const std::vector<BundledLens> bundled = bundled_lenses();
  for (const BundledLens& lens : bundled) {
    if (lens.name == name_or_file) return read_lens_toml(lens.toml, std::string(lens.name) + ".toml");
  }
  std::error_code code;
  const std::filesystem::path path(name_or_file);
  const bool is_path = path.has_parent_path() || path.has_extension();
  if (is_path || std::filesystem::exists(split_key(path).file, code)) return read_lens(path, glasses);
  std::vector<std::string_view> names;
  for (const BundledLens& lens : bundled) names.push_back(lens.name);
  const std::string near = nearest_name(name_or_file, names);
  const std::string remedy = near.empty() ? fmt::format("bundled are {}; or name a file", fmt::join(names, ", "))
                                          : fmt::format("did you mean '{}'? `contrejour lens list` shows all", near);
  return failure(ErrorCode::InvalidArgument,
                 fmt::format("no lens and no file is called '{}'; {}", shortened(name_or_file), remedy));
}

}  // namespace contrejour
