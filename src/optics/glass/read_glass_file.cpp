// SPDX-License-Identifier: Apache-2.0
// Catalogues on disk: one file, or all of a folder.
#include <algorithm>
#include <cmath>
#include <system_error>

#include <fmt/format.h>

#include "base/lower_extension.h"
#include "base/text_file.h"
#include "contrejour/expert/glass_catalogue.h"
#include "optics/glass/catalogue_row.h"
#include "optics/glass/glass_limits.h"

namespace contrejour::inline internal {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFiles = 20000;  // of a folder; refractiveindex.info's whole database has some 4000
constexpr int kMaxDepth = 8;

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

std::string upper_case(std::string text) {
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

bool is_agf(const fs::path& file) { return lower_extension(file) == ".agf"; }
bool is_yaml(const fs::path& file) {
  const std::string extension = lower_extension(file);
  return extension == ".yml" || extension == ".yaml";
}

// The maker of specs/schott/optical/N-BK7.yml is schott; that of main/CaF2/nk/Malitson.yml is CaF2.
std::string maker_of_yaml(const fs::path& file) {
  fs::path folder = file.parent_path();
  const std::string last = lower_case(folder.filename().string());
  if (last == "optical" || last == "nk" || last == "misc" || last == "obsolete") folder = folder.parent_path();
  return upper_case(folder.filename().string());
}

// Recognises a database's other pages: descriptions of folders, and nonlinear indices.
bool is_other_page(const fs::path& file) {
  return file.filename() == "about.yml" || file.parent_path().filename() == "n2";
}

struct FoundFiles {
  std::vector<fs::path> files;
  std::error_code code;
};

FoundFiles files_of(const fs::path& folder) {
  FoundFiles found;
  fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, found.code);
  const fs::recursive_directory_iterator end;
  while (!found.code && at != end && found.files.size() < kMaxFiles) {
    if (at.depth() >= kMaxDepth) at.disable_recursion_pending();
    const fs::path& file = at->path();
    if ((is_agf(file) || is_yaml(file)) && !is_other_page(file)) found.files.push_back(file);
    at.increment(found.code);
  }
  std::sort(found.files.begin(), found.files.end());  // the same order everywhere
  return found;
}

}  // namespace

void fill_stated(CatalogueEntry& entry) {
  const auto range = wavelength_range_nm(entry.glass);
  const bool visible = !range || (range->first_nm <= kLineF_nm && range->last_nm >= kLineC_nm);
  if (!visible || (entry.summary.n_d != 0.0 && entry.summary.v_d != 0.0)) return;
  const GlassFigures figures = glass_figures(entry.glass);
  if (!std::isfinite(figures.n_d) || !std::isfinite(figures.v_d)) return;
  if (entry.summary.n_d == 0.0) entry.summary.n_d = figures.n_d;
  if (entry.summary.v_d == 0.0) entry.summary.v_d = figures.v_d;
}

}  // namespace contrejour::inline internal

namespace contrejour {

Result<GlassFile> read_glass_file(const std::filesystem::path& file) {
  if (!is_agf(file) && !is_yaml(file)) {
    return failure(ErrorCode::Parse,
                   "not a catalogue that is known by its ending; give an .agf file, or a .yml of "
                   "refractiveindex.info",
                   {file.string(), 0, 0});
  }
  const auto bytes = read_text_file(file, kMaxGlassFileBytes, "give an .agf or .yml file, or a folder of them");
  if (!bytes) return tl::unexpected(bytes.error());
  const std::string stem = file.stem().string();
  if (is_agf(file)) return read_agf(*bytes, file.string(), upper_case(stem));
  return read_glass_yaml(*bytes, file.string(), maker_of_yaml(file), stem);
}

Result<std::vector<std::string>> GlassCatalogue::add_path(const std::filesystem::path& path) {
  std::error_code code;
  if (!fs::is_directory(path, code)) {
    auto read = read_glass_file(path);
    if (!read) return tl::unexpected(read.error());
    add(std::move(read->glasses));
    return std::move(read->warnings);
  }
  const FoundFiles found = files_of(path);
  if (found.code)
    return failure(ErrorCode::Io, fmt::format("cannot be read: {}; check the folder", found.code.message()),
                   {path.string(), 0, 0});
  if (found.files.empty()) {
    return failure(ErrorCode::Io, "the folder has no .agf and no .yml files; give another", {path.string(), 0, 0});
  }
  std::vector<std::string> warnings;
  for (const fs::path& file : found.files) {
    auto read = read_glass_file(file);
    if (!read) {
      warnings.push_back(read.error().to_string());
      continue;
    }
    add(std::move(read->glasses));
    warnings.insert(warnings.end(), read->warnings.begin(), read->warnings.end());
  }
  return warnings;
}

}  // namespace contrejour
