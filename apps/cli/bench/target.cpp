// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/target.h"

#include <fmt/format.h>

#include "cli/flare_report.h"
#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

std::string with_unit(double value, int digits, const std::string& unit) {
  return fmt::format("{:.{}f}{}{}", value, digits, unit.empty() ? "" : " ", unit);
}

}  // namespace

std::string holds_text(const Target& target) {
  const auto reaches = [&](double goal) { return target.more_is_better ? target.value >= goal : target.value <= goal; };
  return reaches(target.aim) && reaches(target.must) ? "aim" : reaches(target.must) ? "yes" : "no";
}

std::string targets_text(const std::vector<Target>& targets) {
  TextTable table({"<target", "<system", "lights", "value", "must", "aim", "<holds", "<computed from"});
  for (const Target& t : targets) {
    table.add({t.name, t.system, fmt::format("{}", t.lights), with_unit(t.value, 2, t.unit),
               with_unit(t.must, 1, t.unit), with_unit(t.aim, 1, t.unit), holds_text(t), t.note});
  }
  return table.text();
}

Target speed_target(const BenchRow& slow, const BenchRow& fast, double must, double aim) {
  const double slow_ms = total_ms(slow.statistics);
  const double fast_ms = total_ms(fast.statistics);
  return {.name = slow.request.method + " / " + fast.request.method,
          .system = std::string(slow.system->name),
          .lights = slow.request.lights,
          .value = slow_ms / fast_ms,
          .must = must,
          .aim = aim,
          .more_is_better = true,
          .note = fmt::format("{:.1f} ms, {:.1f} ms", slow_ms, fast_ms)};
}

}  // namespace contrejour::cli
