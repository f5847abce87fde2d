// SPDX-License-Identifier: Apache-2.0
#include "studio/core/file_choice.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include <doctest/doctest.h>

using namespace contrejour::studio;

TEST_CASE("a file dialog offers folders and the files of its kind") {
  const auto folder = std::filesystem::temp_directory_path() / "contrejour-test-file-choice";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder / "zoo");
  for (const char* name : {"b.zmx", "a.TXT", "shot.session.json", "plate.exr", "notes.md", ".hidden.toml"})
    std::ofstream(folder / name) << "x";
  const auto names = [&](FileKind kind) {
    std::string all;
    for (const FolderEntry& entry : listing_of(folder, kind).entries)
      all += entry.name + (entry.is_folder ? "/ " : " ");
    return all;
  };
  CHECK(names(FileKind::Lens) == "zoo/ a.TXT b.zmx shot.session.json ");
  CHECK(listing_of(folder, FileKind::Lens).others == 2);
  CHECK(names(FileKind::Plate) == "zoo/ plate.exr ");
  CHECK(names(FileKind::Session) == "zoo/ shot.session.json ");
  CHECK(names(FileKind::Any) == "zoo/ a.TXT b.zmx notes.md plate.exr shot.session.json ");
  constexpr std::array<std::string_view, 2> kPictures = {".exr", ".png"};
  REQUIRE(listing_of(folder, kPictures).entries.size() == 2);
  CHECK(listing_of(folder, kPictures).entries[1].name == "plate.exr");
  CHECK(listing_of(folder / "missing", FileKind::Any).entries.empty());
  CHECK(folder_of(folder.string()) == folder);
  CHECK(folder_of((folder / "new.toml").string()) == folder);
  CHECK(folder_of("tessar") == std::filesystem::current_path());
  std::filesystem::remove_all(folder);
}

TEST_CASE("a path from the root may be typed behind the folder offered, and a session gets its lens's name") {
  CHECK(typed_path("/lenses//plates/a.exr") == "/plates/a.exr");
  CHECK(typed_path("/lenses/a.toml") == "/lenses/a.toml");
  CHECK(usual_session("planar-50") == "planar-50.session.json");
  CHECK(usual_session("/lenses/Sigma-40mmf1.4.txt") == "Sigma-40mmf1.4.session.json");
  CHECK(usual_session("") == "untitled.session.json");
}
