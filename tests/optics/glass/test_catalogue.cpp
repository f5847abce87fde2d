// SPDX-License-Identifier: Apache-2.0
// Glasses by name, maker and closeness; users' own catalogues.
#include "contrejour/expert/glass_catalogue.h"
#include "support/approx.h"

#include <cmath>
#include <fstream>

#include <doctest/doctest.h>

namespace contrejour::test::catalogue {
namespace {

CatalogueEntry entry(const std::string& maker, const std::string& name, double n_d, double v_d,
                     GlassStatus status = GlassStatus::Standard) {
  return {{name, maker, "", status, n_d, v_d}, {name, ModelGlass{n_d, v_d, 0.0}}, "test"};
}

std::string found(const GlassCatalogue& catalogue, std::string_view name, std::vector<std::string> makers = {}) {
  const auto glass = catalogue.find(name, makers);
  return glass ? glass->summary.maker + " " + glass->summary.name : "";
}

TEST_CASE("names as people write them") {
  const GlassCatalogue all = bundled_glasses();
  for (const char* name :
       {"N-BK7", "n-bk7", "NBK7", "N BK7", "N_BK7", "SCHOTT N-BK7", "schott_nbk7", "NBK7_SCHOTT", "N-BK7 (SCHOTT"})
    CHECK(found(all, name) == (std::string(name).find('(') == std::string::npos ? "SCHOTT N-BK7" : ""));
  CHECK(found(all, "S-BSL7") == "OHARA S-BSL7");
  CHECK(found(all, "E-FDS1-W") == "HOYA E-FDS1-W");
  CHECK(found(all, "H-K9L") == "CDGM H-K9L");
  CHECK(found(all, "K-PSK11") == "SUMITA K-PSK11");
  CHECK(found(all, "J-LASF015") == "HIKARI J-LASF015");
  CHECK(found(all, "caf2") == "MISC CaF2");
  CHECK(found(all, "pmma") == "MISC PMMA");
}

TEST_CASE("makers in the order of a lens file's list") {
  const GlassCatalogue all = bundled_glasses();
  CHECK(found(all, "SF4", {"HIKARI", "SCHOTT"}) == "HIKARI SF4");
  CHECK(found(all, "SF4", {"schott", "HIKARI"}) == "SCHOTT SF4");
  CHECK(found(all, "SF4", {"NIKON"}) == "HIKARI SF4");  // one firm
  CHECK(found(all, "N-BK7", {"OHARA", "HOYA"}).empty());
  CHECK(found(all, "N-BK7", {"OHARA", "SCHOTT"}) == "SCHOTT N-BK7");
}

TEST_CASE("old names find today's glass, and say which") {
  GlassCatalogue own;
  own.add({entry("A", "N-BK7", 1.5168, 64.17), entry("B", "S-LAH66", 1.7725, 49.6), entry("B", "LAH66", 1.7, 49.0)});
  CHECK(found(own, "BK7") == "A N-BK7");
  CHECK(found(own, "lah66") == "B LAH66");  // the exact name first
  CHECK(found(own, "BK7", {"B"}).empty());
}

TEST_CASE("a name that none has") {
  const GlassCatalogue all = bundled_glasses();
  const auto wrong = all.find("N-BK77X");
  REQUIRE_FALSE(wrong.has_value());
  CHECK(wrong.error().message.find("did you mean 'N-BK7") != std::string::npos);
  const auto among = all.find("qqqqqqqqqq", std::vector<std::string>{"SCHOTT", "OHARA"});
  CHECK(among.error().message.find("among SCHOTT, OHARA") != std::string::npos);
  for (const std::string& name :
       {std::string(), std::string(" -"), std::string(1'000'000, 'N'), std::string("\0\xFF", 2)}) {
    const auto none = all.find(name);
    REQUIRE_FALSE(none.has_value());
    CHECK(none.error().message.size() < 300);
  }
}

TEST_CASE("the first of a name is found: a user's before the bundled") {
  GlassCatalogue all;
  all.add({entry("MINE", "N-BK7", 1.6, 50.0)});
  all.add(bundled_glasses());
  CHECK(found(all, "N-BK7") == "MINE N-BK7");
  CHECK(found(all, "SCHOTT N-BK7") == "SCHOTT N-BK7");
  CHECK(all.makers().front() == "MINE");
  CHECK(all.makers().size() == 8);
}

TEST_CASE("the closest glass") {
  const GlassCatalogue all = bundled_glasses();
  const auto close = all.closest(1.5168, 64.17, 3, std::vector<std::string>{"SCHOTT"});
  REQUIRE(close.size() == 3);
  CHECK(close[0].glass.name.find("BK7") != std::string::npos);
  CHECK(close[0].distance < 0.01);
  CHECK(close[0].distance <= close[1].distance);
  GlassCatalogue own;
  own.add({entry("A", "one", 1.500, 60.0), entry("B", "two", 1.502, 60.0),
           entry("A", "old", 1.501, 60.0, GlassStatus::Obsolete)});
  const auto two = own.closest(1.5014, 60.8, 9);
  REQUIRE(two.size() == 2);
  CHECK(two[0].glass.name == "two");
  CHECK(two[0].distance == test::approx(std::sqrt(0.36 + 1.0)));
  CHECK(own.closest(1.5014, 60.0, 1, {}, true).at(0).glass.name == "old");
  CHECK(own.closest(1.5014, 60.0, 1, std::vector<std::string>{"A"}).at(0).glass.name == "one");
  CHECK(own.closest(1.5, 60.0, 0).empty());
  CHECK(own.closest(std::nan(""), 60.0, 5).empty());
  CHECK(GlassCatalogue().closest(1.5, 60.0, 5).empty());
}

// A temporary folder, removed at the end.
struct Folder {
  std::filesystem::path path = std::filesystem::temp_directory_path() / "contrejour-glass-test";
  Folder() { std::filesystem::create_directories(path / "maker" / "optical"); }
  ~Folder() { std::filesystem::remove_all(path); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name, std::ios::binary) << text;
  }
};

constexpr const char* kAgf = "NM MINE-1 1 1 1.5 0\nCD 2.25\nLD 0.4 0.7\n";
constexpr const char* kYaml = "DATA:\n  - type: formula 5\n    wavelength_range: 0.4 0.7\n    coefficients: 1.7\n";

TEST_CASE("catalogues on disk: files and folders") {
  const Folder folder;
  folder.write("own.agf", kAgf);
  folder.write("maker/optical/GLASS-2.yml", kYaml);
  folder.write("maker/about.yml", "ABOUT: x\n");
  folder.write("broken.agf", "nothing\n");
  folder.write("notes.txt", "NM\n");
  GlassCatalogue all;
  const auto warnings = all.add_path(folder.path);
  REQUIRE(warnings.has_value());
  CHECK(warnings->size() == 1);
  CHECK(warnings->front().find("broken.agf") != std::string::npos);
  CHECK(all.size() == 2);
  CHECK(found(all, "mine1") == "OWN MINE-1");
  CHECK(found(all, "MAKER GLASS-2") == "MAKER GLASS-2");
  GlassCatalogue one;
  CHECK(one.add_path(folder.path / "own.agf").has_value());
  CHECK(one.size() == 1);
}

TEST_CASE("paths that are no catalogues") {
  const Folder folder;
  folder.write("notes.txt", "x");
  folder.write("large.agf", std::string(std::size_t{9} << 20U, 'x'));
  GlassCatalogue all;
  const auto refused = [&](const std::filesystem::path& path, const std::string& words) {
    const auto read = all.add_path(path);
    REQUIRE_FALSE(read.has_value());
    CAPTURE(read.error().to_string());
    CHECK(read.error().to_string().find(words) != std::string::npos);
  };
  refused(folder.path / "absent.agf", "no such file");
  refused(folder.path / "notes.txt", "by its ending");
  refused(folder.path / "large.agf", "larger than");
  CHECK(all.add_path(folder.path)->size() == 1);  // the large one, a warning
  CHECK(all.size() == 0);
}

}  // namespace
}  // namespace contrejour::test::catalogue
