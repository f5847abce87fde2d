// SPDX-License-Identifier: Apache-2.0
// Glasses by name and maker: those that come with the library, and users' own catalogues (AGF files,
// refractiveindex.info YAML; docs/formats/glass.md). Reading files is bounded in memory and time. Errors: Parse with
// file and line, Io; InvalidArgument for an unknown name, with the nearest known one. Thread-safety: plain values.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/expert/glass.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

enum class GlassStatus { Standard, Preferred, Obsolete, Special, Melt };  // as AGF files number them

[[nodiscard]] CONTREJOUR_API std::string_view status_name(GlassStatus status);  // "standard", "obsolete", ...

// A glass in a list. n_d and v_d are the catalogue's, or else computed; 0 if the formula's range does not include the
// lines.
struct GlassSummary {
  std::string name;  // "N-BK7"
  std::string maker;  // "SCHOTT"
  std::string code;  // six digits, may be empty
  GlassStatus status = GlassStatus::Standard;
  double n_d = 0.0;
  double v_d = 0.0;
};

struct CatalogueEntry {
  GlassSummary summary;
  Glass glass;  // named as the catalogue names it
  std::string source;  // the file it comes from
};

// What a file holds. warnings: glasses left out, or figures that disagree, each "file:line: ...".
struct GlassFile {
  std::vector<CatalogueEntry> glasses;
  std::vector<std::string> warnings;
};

// Reads an AGF file in UTF-8, UTF-16 or Latin-1, with any line ends. An impossible glass is left out with a warning.
// Errors: Parse if it is no AGF file, or holds no glass that can be read.
[[nodiscard]] CONTREJOUR_API Result<GlassFile> read_agf(std::string_view bytes, const std::string& file,
                                                        const std::string& maker);

// Reads one glass in the format of refractiveindex.info's database. Errors: Parse; Unsupported for a page without
// n(lambda).
[[nodiscard]] CONTREJOUR_API Result<GlassFile> read_glass_yaml(std::string_view bytes, const std::string& file,
                                                               const std::string& maker, const std::string& name);

// Reads a file by its ending: .agf, .yml, .yaml. The maker is an AGF file's name in capitals, as in the GCAT lists of
// lens files; for YAML it is the folder's name (the one above `optical`, as in the database). The glass of a YAML file
// has the file's name.
[[nodiscard]] CONTREJOUR_API Result<GlassFile> read_glass_file(const std::filesystem::path& file);

struct CloseGlass {
  GlassSummary glass;
  double distance = 0.0;  // see closest()
};

class CONTREJOUR_API GlassCatalogue {
 public:
  GlassCatalogue();
  ~GlassCatalogue();
  GlassCatalogue(const GlassCatalogue&);
  GlassCatalogue(GlassCatalogue&&) noexcept;
  GlassCatalogue& operator=(const GlassCatalogue&);
  GlassCatalogue& operator=(GlassCatalogue&&) noexcept;

  // Appends glasses. Where a name occurs several times, the first is found.
  void add(std::vector<CatalogueEntry> glasses);
  void add(const GlassCatalogue& other);
  // A file, or all .agf, .yml and .yaml files of a folder and the folders in it. A folder's files that cannot be read
  // are warnings. Returns warnings.
  [[nodiscard]] Result<std::vector<std::string>> add_path(const std::filesystem::path& path);

  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] GlassSummary summary(std::size_t k) const;
  [[nodiscard]] CatalogueEntry entry(std::size_t k) const;
  [[nodiscard]] std::vector<std::string> makers() const;  // each once, in order
  // True if the glass is of one of these makers, with names compared as in find(); also true if no maker is given.
  [[nodiscard]] bool is_of(std::size_t k, std::span<const std::string> makers) const;

  // Finds "N-BK7", "nbk7", "SCHOTT N-BK7" or "NBK7_SCHOTT": letter case, spaces, dashes and underscores are ignored. An
  // unknown name is tried as its lead-free successor ("BK7" finds "N-BK7": see the entry's own name). makers: which to
  // search, in that order; empty: all. Errors: InvalidArgument, naming the nearest.
  [[nodiscard]] Result<CatalogueEntry> find(std::string_view name, std::span<const std::string> makers = {}) const;

  // The nearest `count` to (n_d, v_d), nearest first: distance^2 = ((n - n_d) / 0.001)^2 + ((v - v_d) / 0.8)^2, so that
  // 1 is about the variation between melts of one glass. Obsolete glasses only on request.
  [[nodiscard]] std::vector<CloseGlass> closest(double n_d, double v_d, std::size_t count = 1,
                                                std::span<const std::string> makers = {}, bool obsolete = false) const;

 private:
  friend const GlassCatalogue& bundled_glasses();
  static GlassCatalogue read_bundled();
  struct Row;
  std::vector<Row> rows_;
};

// The catalogue that comes with the library. It is read from its text at the first call, in a few milliseconds, and
// shared by all callers.
[[nodiscard]] CONTREJOUR_API const GlassCatalogue& bundled_glasses();

}  // namespace contrejour
