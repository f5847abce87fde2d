// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/seq_zoom.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "base/near_name.h"
#include "optics/lens/validate.h"
#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/sequential/design_text.h"

namespace contrejour::inline internal {
namespace {

// Names, variables, weights, vignetting factors.
bool command_changes_nothing(std::string_view name) {
  static const std::set<std::string_view> kNames = {"TIT", "THC", "CCY", "WTF", "WTW", "WTX", "WTY", "VUX", "VLX",
                                                    "VUY", "VLY", "OFF", "CUM", "THM", "WTA", "CWT", "KC",  "AC",
                                                    "BC",  "CC",  "DC",  "PIM", "POS", "LAB", "INI"};
  return kNames.contains(name);
}

// Commands whose values our zoom shares between all positions.
bool command_is_said_once(std::string_view name) {
  static const std::set<std::string_view> kNames = {"EPD", "FNO", "NA",  "NAO", "WL",  "REF", "XAN",
                                                    "YAN", "XOB", "YOB", "XIM", "YIM", "XRI", "YRI",
                                                    "CIR", "TEM", "PRE", "REX", "REY", "ELX", "ELY"};
  return kNames.contains(name);
}

bool differs(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [&](double v) { return v != values.front(); });
}

}  // namespace

std::size_t seq_zoom_word(const SeqCommand& command) {
  const bool described =
      command.name == "PIK" || command.name == "PRV" || command.name == "ZOO" || command.name == "DER";
  for (std::size_t k = 0; k < 2 && k < command.words.size() && !described; ++k) {
    const std::string_view word = command.words[k];
    if (word.size() > 1 && (word[0] == 'Z' || word[0] == 'z') && plain_number(word.substr(1))) return k;
  }
  return command.words.size();
}

std::optional<std::string> SeqZoom::add(const SeqCommand& command) {
  if (const auto count = plain_number(command.word(0))) {
    if (!(*count >= 1.0 && *count <= kMaxZoomPositions))
      return fmt::format("ZOO {}: 1 to {} positions are read", command.word(0), kMaxZoomPositions);
    count_ = static_cast<std::size_t>(*count);
    return std::nullopt;
  }
  Row row{command.line, capitals(command.word(0)).substr(0, 3), {}};
  if (command_changes_nothing(row.name)) return std::nullopt;
  const SeqSurfaceName at = seq_surface_name(command.word(1));
  const std::string_view second = command.word(1);
  const bool about =
      at.is || (second.size() > 1 && (second[0] == 'F' || second[0] == 'f' || second[0] == 'W' || second[0] == 'w'));
  bool numbers = true;
  for (std::size_t k = about ? 2 : 1; k < command.words.size(); ++k) {
    const auto value = number_or_infinity(command.words[k]);
    numbers = numbers && value;
    row.values.push_back(value.value_or(static_cast<double>(k)));  // different names count as different values
  }
  if (row.name == "THI") {
    if (!at.is || !numbers) return "ZOO THI: give the surface and its thickness at each position";
    if (!row.values.empty()) thicknesses_[at.index] = std::move(row);
  } else if (row.values.size() > 1 && others_.size() < 1000) {
    others_.push_back(std::move(row));
  }
  return std::nullopt;
}

void SeqZoom::add_one(const SeqCommand& command, std::size_t word) {
  const double position = plain_number(std::string_view(command.words[word]).substr(1)).value_or(0.0);
  if (!(position >= 1.0 && position <= kMaxZoomPositions)) return;
  const SeqSurfaceName at = seq_surface_name(command.word(0));
  const auto value = number_or_infinity(command.words.back());
  if (command.name == "TIT") nominal_mm_[static_cast<std::size_t>(position)] = nominal_focal_mm(command.words.back());
  if (command.name == "THI" && at.is && value) {
    Row& row = thicknesses_[at.index];
    const auto k = static_cast<std::size_t>(position);
    if (row.values.size() < k) row.values.resize(k, std::nan(""));
    row.values[k - 1] = *value;
  } else if (position > 1.0 && !command_changes_nothing(command.name) && others_.size() < 1000) {
    others_.push_back({command.line, command.name, {0.0, 1.0}});
  }
}

std::vector<DesignPosition> SeqZoom::positions(const SequentialDesign& design,
                                               std::vector<std::string>& warnings) const {
  if (count_ < 2) return {};
  std::set<std::string> once;
  for (const Row& row : others_) {
    if (!differs(row.values)) continue;
    if (!command_is_said_once(row.name)) {
      warnings.push_back(
          fmt::format("the {} positions differ in {} (line {}), not in thicknesses alone; position 1 is "
                      "read",
                      count_, shortened(row.name), row.line));
      return {};
    }
    if (once.insert(row.name).second)
      warnings.push_back(fmt::format(
          "{} changes with the position (line {}); that of position 1 is used at all of them", row.name, row.line));
  }
  std::vector<double> own;
  for (const DesignSurface& surface : design.surfaces) own.push_back(surface.thickness);
  std::vector<DesignPosition> out(count_, {own});
  for (const auto& [position, focal_mm] : nominal_mm_)
    if (position <= count_) out[position - 1].nominal_focal_mm = focal_mm;
  for (const auto& [index, row] : thicknesses_) {
    const std::size_t at = index == kSeqImage ? own.size() - 1 : static_cast<std::size_t>(index);
    if (at >= own.size()) continue;
    for (std::size_t p = 0; p < count_ && p < row.values.size(); ++p)
      if (!std::isnan(row.values[p])) out[p].thickness[at] = row.values[p];
  }
  return out;
}

}  // namespace contrejour::inline internal
