// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/zmx_zoom.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "optics/lens/validate.h"
#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/sequential/design_text.h"

namespace contrejour::inline internal {
namespace {

// Operands without influence on rays: names, weights, vignetting factors, coatings.
bool operand_changes_nothing(std::string_view name) {
  static const std::set<std::string_view> kNames = {"MOFF", "LTTL", "CWGT", "FVDX", "FVDY", "FVCX", "FVCY", "FVAN",
                                                    "FLWT", "WLWT", "COTN", "SATP", "TELE", "RAIM", "NOTE", "BLNK"};
  return kNames.contains(name);
}

// Operands whose values our zoom shares between all positions.
bool operand_is_said_once(std::string_view name) {
  static const std::set<std::string_view> kNames = {"APER", "XFIE", "YFIE", "FLTP", "WAVE", "PRWV",
                                                    "SDIA", "CSP1", "CSP2", "TEMP", "PRES"};
  return kNames.contains(name);
}

// Operands whose value differs between configurations, grouped, with rising configurations.
std::vector<const ZmxOperand*> changing(const std::vector<ZmxOperand>& operands) {
  std::vector<const ZmxOperand*> out;
  const ZmxOperand* first = nullptr;
  for (const ZmxOperand& operand : operands) {
    const bool same = first != nullptr && first->name == operand.name && first->subject == operand.subject &&
                      operand.configuration > first->configuration;
    if (!same) {
      first = &operand;
    } else if (operand.value != first->value) {
      out.push_back(&operand);
    }
  }
  return out;
}

}  // namespace

void ZmxConfigurations::begin(const ZmxRow& row) {
  is_there = true;
  count = row.size() > 1 ? row.whole(1) : 1;
  current = row.size() > 2 ? row.whole(2) : 1;
  if (count > kMaxZoomPositions)
    row.fail(fmt::format("{} configurations; at most {} are read", count, kMaxZoomPositions));
}

void ZmxConfigurations::add(const ZmxRow& row) {
  constexpr std::size_t kMaxOperands = 20'000;
  if (row.size() < 4 || operands.size() >= kMaxOperands) return;
  const auto subject = plain_number(row.word(1)), configuration = plain_number(row.word(2));
  if (!subject || !configuration || std::abs(*subject) > 1e6 || std::abs(*configuration) > 1e6) return;
  // A title may have spaces.
  std::string value(row.word(3));
  for (std::size_t k = 4; value.starts_with('"') && (value.size() == 1 || value.back() != '"') && k < row.size(); ++k)
    value += " " + std::string(row.word(k));
  operands.push_back(
      {row.line(), std::string(row.word(0)), static_cast<int>(*subject), static_cast<int>(*configuration), value});
}

std::vector<DesignPosition> zmx_positions(const ZmxConfigurations& configurations,
                                          const std::vector<ZmxSurface>& surfaces, std::vector<std::string>& warnings) {
  const auto moving = changing(configurations.operands);
  if (configurations.count < 2 || moving.empty()) return {};
  std::set<std::string_view> once;
  for (const ZmxOperand* operand : moving) {
    if (operand->name == "THIC" || operand_changes_nothing(operand->name)) continue;
    if (!operand_is_said_once(operand->name)) {
      warnings.push_back(
          fmt::format("the {} configurations differ in {} (line {}), not in thicknesses alone; "
                      "configuration {} is read",
                      configurations.count, operand->name, operand->line, configurations.current));
      return {};
    }
    if (once.insert(operand->name).second)
      warnings.push_back(
          fmt::format("{} changes with the configuration (line {}); that of configuration {} is used at "
                      "all of them",
                      operand->name, operand->line, configurations.current));
  }
  if (std::none_of(moving.begin(), moving.end(), [](const ZmxOperand* o) { return o->name == "THIC"; })) return {};
  std::vector<double> own;
  for (const ZmxSurface& surface : surfaces) own.push_back(surface.thickness);
  std::vector<DesignPosition> positions(static_cast<std::size_t>(configurations.count), {own});
  const int gaps = static_cast<int>(own.size()) - 1;
  for (const ZmxOperand& operand : configurations.operands) {
    const int in = operand.configuration - 1, gap = operand.subject;
    if (in < 0 || in >= configurations.count) continue;
    DesignPosition& position = positions[static_cast<std::size_t>(in)];
    if (operand.name == "LTTL") position.nominal_focal_mm = nominal_focal_mm(operand.value);
    const auto value = number_or_infinity(operand.value);
    if (operand.name == "THIC" && value && gap >= 0 && gap < gaps)
      position.thickness[static_cast<std::size_t>(gap)] = *value;
  }
  return positions;
}

}  // namespace contrejour::inline internal
