// SPDX-License-Identifier: Apache-2.0
// The files that a file dialog offers, and the path that it begins with. Thread-safety: pure functions, but for the
// files.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace contrejour::studio {

enum class FileKind { Any, Lens, Plate, Session };

struct FolderEntry {
  std::string name;
  bool is_folder = false;
};

struct FolderListing {
  std::vector<FolderEntry> entries;  // folders first, then files, by name; hidden ones are left out
  std::size_t others = 0;  // files of other kinds
};

// By the name alone. Lens: of lens files in every format that is read, sessions and measured flares.
[[nodiscard]] bool is_of_kind(const std::filesystem::path& file, FileKind kind);
// At most 400 entries; none for a folder that cannot be read.
[[nodiscard]] FolderListing listing_of(const std::filesystem::path& folder, FileKind kind);
// The same of files whose names have one of these endings, in small letters with their full stop.
[[nodiscard]] FolderListing listing_of(const std::filesystem::path& folder, std::span<const std::string_view> endings);

// The folder to list for a path that is being typed: itself, or the one that the file would be in.
[[nodiscard]] std::filesystem::path folder_of(const std::string& path);

// "/lenses//plates/a.exr" -> "/plates/a.exr": a path from the root that was typed behind the folder offered.
[[nodiscard]] std::string typed_path(const std::string& text);

// The name of a session that has none yet: "planar-50.session.json", from the lens's name or file.
[[nodiscard]] std::string usual_session(const std::string& lens_name);

}  // namespace contrejour::studio
