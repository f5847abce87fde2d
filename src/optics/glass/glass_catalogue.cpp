// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/glass_catalogue.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/near_name.h"
#include "optics/glass/catalogue_row.h"
#include "optics/glass/glass_line.h"

namespace contrejour {
namespace {

// The unit of closest()'s distance: about the variation between melts of one glass (n_d +-0.0005, V_d +-0.8 %).
constexpr double kIndexStep = 0.001;
constexpr double kAbbeStep = 0.8;

// Prefixes of the lead-free or present-day successor of an old name: Schott N-, Ohara S-, Hikari J-, CDGM H-.
constexpr std::string_view kSuccessors[] = {"N", "S", "J", "H"};

// Letters and digits, in capitals.
std::string key_of(std::string_view name) {
  std::string key;
  key.reserve(name.size());
  for (const char c : name) {
    if (c == ' ' || c == '-' || c == '_' || c == '\t') continue;
    key.push_back(c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c);
  }
  return key;
}

// Maps the several names of one firm to one key.
std::string maker_key(std::string_view maker) {
  const std::string key = key_of(maker);
  return key == "NIKON" || key == "NIKONHIKARI" ? "HIKARI" : key;
}

constexpr std::size_t kLongestName = 200;

}  // namespace

std::string_view status_name(GlassStatus status) {
  constexpr std::string_view kNames[] = {"standard", "preferred", "obsolete", "special", "melt"};
  return kNames[static_cast<std::size_t>(status)];
}

GlassCatalogue::GlassCatalogue() = default;
GlassCatalogue::~GlassCatalogue() = default;
GlassCatalogue::GlassCatalogue(const GlassCatalogue&) = default;
GlassCatalogue::GlassCatalogue(GlassCatalogue&&) noexcept = default;
GlassCatalogue& GlassCatalogue::operator=(const GlassCatalogue&) = default;
GlassCatalogue& GlassCatalogue::operator=(GlassCatalogue&&) noexcept = default;

void GlassCatalogue::add(std::vector<CatalogueEntry> glasses) {
  for (CatalogueEntry& entry : glasses) {
    Row row{entry.summary, key_of(entry.summary.name), maker_key(entry.summary.maker), {}, nullptr};
    row.entry = std::make_shared<const CatalogueEntry>(std::move(entry));
    rows_.push_back(std::move(row));
  }
}

void GlassCatalogue::add(const GlassCatalogue& other) {
  rows_.insert(rows_.end(), other.rows_.begin(), other.rows_.end());
}

GlassCatalogue GlassCatalogue::read_bundled() {
  GlassCatalogue catalogue;
  for (const BundledGlassFile& file : bundled_glass_files()) {
    const std::string maker = maker_of_bundled(file.name);
    const std::string key = maker_key(maker);
    for_each_glass_line(file.text, [&](std::string_view line) {
      GlassSummary summary = summary_of_line(line, maker);
      std::string name_key = key_of(summary.name);
      catalogue.rows_.push_back({std::move(summary), std::move(name_key), key, line, nullptr});
    });
  }
  return catalogue;
}

const GlassCatalogue& bundled_glasses() {
  static const GlassCatalogue kBundled = GlassCatalogue::read_bundled();
  return kBundled;
}

std::size_t GlassCatalogue::size() const { return rows_.size(); }
GlassSummary GlassCatalogue::summary(std::size_t k) const {
  return k < rows_.size() ? rows_[k].summary : GlassSummary{};
}
CatalogueEntry GlassCatalogue::entry(std::size_t k) const {
  if (k >= rows_.size()) return {};
  const Row& row = rows_[k];
  return row.entry ? *row.entry : entry_of_line(row.line, row.summary.maker);
}

std::vector<std::string> GlassCatalogue::makers() const {
  std::vector<std::string> all;
  for (const Row& row : rows_)
    if (std::find(all.begin(), all.end(), row.summary.maker) == all.end()) all.push_back(row.summary.maker);
  return all;
}

bool GlassCatalogue::is_of(std::size_t k, std::span<const std::string> makers) const {
  if (k >= rows_.size()) return false;
  return makers.empty() || std::any_of(makers.begin(), makers.end(), [&](const std::string& maker) {
           return rows_[k].maker_key == maker_key(maker);
         });
}

Result<CatalogueEntry> GlassCatalogue::find(std::string_view name, std::span<const std::string> makers) const {
  const std::string key = key_of(name.substr(0, kLongestName));
  const auto row_of = [&](std::string_view wanted, const std::string* maker) {
    const std::string only = maker == nullptr ? "" : maker_key(*maker);
    const auto found = std::find_if(rows_.begin(), rows_.end(), [&](const Row& row) {
      if (maker != nullptr && row.maker_key != only) return false;
      if (row.key == wanted) return true;
      if (wanted.size() != row.key.size() + row.maker_key.size()) return false;
      return (wanted.starts_with(row.maker_key) && wanted.ends_with(row.key)) ||
             (wanted.starts_with(row.key) && wanted.ends_with(row.maker_key));
    });
    return static_cast<std::size_t>(found - rows_.begin());
  };
  const auto anywhere = [&](std::string_view wanted) {
    std::size_t k = makers.empty() ? row_of(wanted, nullptr) : size();
    for (std::size_t m = 0; m < makers.size() && k == size(); ++m) k = row_of(wanted, &makers[m]);
    return k;
  };
  std::size_t k = key.empty() || name.size() > kLongestName ? size() : anywhere(key);
  for (const std::string_view prefix : kSuccessors) {
    if (key.size() < 2 || k < size()) break;
    k = anywhere(std::string(prefix) + key);
  }
  if (k < size()) return entry(k);
  std::vector<std::string_view> names;
  for (const Row& row : rows_) names.push_back(row.summary.name);
  const std::string near = nearest_name(name, names);
  const std::string where = makers.empty() ? "" : fmt::format(" among {}", fmt::join(makers, ", "));
  return failure(ErrorCode::InvalidArgument, fmt::format("no glass is called '{}'{}; {}", shortened(name), where,
                                                         near.empty() ? "`contrejour glass list` shows all"
                                                                      : fmt::format("did you mean '{}'?", near)));
}

std::vector<CloseGlass> GlassCatalogue::closest(double n_d, double v_d, std::size_t count,
                                                std::span<const std::string> makers, bool obsolete) const {
  std::vector<CloseGlass> all;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const GlassSummary& glass = rows_[k].summary;
    if (glass.n_d == 0.0 || glass.v_d == 0.0 || (glass.status == GlassStatus::Obsolete && !obsolete)) continue;
    if (!is_of(k, makers)) continue;
    const double distance = std::hypot((glass.n_d - n_d) / kIndexStep, (glass.v_d - v_d) / kAbbeStep);
    if (std::isfinite(distance)) all.push_back({glass, distance});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const CloseGlass& a, const CloseGlass& b) { return a.distance < b.distance; });
  if (all.size() > count) all.resize(count);
  return all;
}

}  // namespace contrejour
