// SPDX-License-Identifier: Apache-2.0
#include "studio/core/file_choice.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <string_view>

#include "contrejour/expert/plate.h"
#include "contrejour/expert/session.h"

namespace contrejour::studio {
namespace {

constexpr std::size_t kMostEntries = 400;
constexpr std::array<std::string_view, 9> kLensEndings = {".toml", ".zmx", ".seq", ".txt", ".lens",
                                                          ".json", ".xml", ".dat", ".pbrt"};

std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

}  // namespace

bool is_of_kind(const std::filesystem::path& file, FileKind kind) {
  switch (kind) {
    case FileKind::Any: return true;
    case FileKind::Lens:
      return std::find(kLensEndings.begin(), kLensEndings.end(), ending_of(file)) != kLensEndings.end();
    case FileKind::Plate: return is_plate_name(file);
    case FileKind::Session: return is_session(file.string());
  }
  return true;
}

namespace {

FolderListing listing_where(const std::filesystem::path& folder,
                            const std::function<bool(const std::filesystem::path&)>& is_listed) {
  FolderListing listing;
  std::error_code code;
  for (auto at = std::filesystem::directory_iterator(folder, code);
       !code && at != std::filesystem::directory_iterator(); at.increment(code)) {
    const std::string name = at->path().filename().string();
    std::error_code unknown;
    const bool is_folder = at->is_directory(unknown);
    if (name.starts_with(".")) continue;
    if (!is_folder && !is_listed(at->path()))
      ++listing.others;
    else if (listing.entries.size() < kMostEntries)
      listing.entries.push_back({name, is_folder});
  }
  std::sort(listing.entries.begin(), listing.entries.end(), [](const FolderEntry& a, const FolderEntry& b) {
    return a.is_folder != b.is_folder ? a.is_folder : a.name < b.name;
  });
  return listing;
}

}  // namespace

FolderListing listing_of(const std::filesystem::path& folder, FileKind kind) {
  return listing_where(folder, [&](const std::filesystem::path& file) { return is_of_kind(file, kind); });
}

FolderListing listing_of(const std::filesystem::path& folder, std::span<const std::string_view> endings) {
  return listing_where(folder, [&](const std::filesystem::path& file) {
    return std::ranges::find(endings, ending_of(file)) != endings.end();
  });
}

std::filesystem::path folder_of(const std::string& path) {
  std::error_code code;
  if (!path.empty() && std::filesystem::is_directory(path, code)) return path;
  const auto parent = std::filesystem::path(path).parent_path();
  return parent.empty() ? std::filesystem::current_path(code) : parent;
}

std::string typed_path(const std::string& text) {
  const std::size_t at = text.rfind("//");
  return at == std::string::npos ? text : text.substr(at + 1);
}

std::string usual_session(const std::string& lens_name) {
  const std::string stem = std::filesystem::path(lens_name).stem().string();
  return (stem.empty() ? "untitled" : stem) + ".session.json";
}

}  // namespace contrejour::studio
