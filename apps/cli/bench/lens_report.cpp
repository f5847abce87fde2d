// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/lens_report.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "cli/machine.h"
#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

// frame_cases() by aperture: a small frame and a large one each.
struct Aperture {
  const char* name;
  const char* key;
  std::size_t small, large;
};
constexpr Aperture kApertures[] = {{"f/8", "f8", 0, 1}, {"wide open", "wide_open", 2, 3}};

// A property of a lens, with statistics over all lenses.
struct Figure {
  const char* name;
  const char* key;
  std::optional<double> must_median, must_90th;  // at f/8
  std::function<double(const BenchedFrames&, const LensBench&, const Aperture&)> value;
};

double first_of(const FrameCost& frame) { return frame.first_ms > 0.0 ? frame.first_ms : frame.warm_ms; }

double ghost_ratio(const BenchedFrames& lens, const LensBench& bench, std::size_t k) {
  return lens.frames[k].ghost_ms() / bench.baseline.frames[k].ghost_ms();
}

const std::vector<Figure>& figures() {
  using Lens = const BenchedFrames&;
  using Bench = const LensBench&;
  using At = const Aperture&;
  static const std::vector<Figure> list{
      {"first frame ms, large",
       "first_ms_large",
       {},
       {},
       [](Lens lens, Bench, At at) { return first_of(lens.frames[at.large]); }},
      {"warm frame ms, large",
       "warm_ms_large",
       {},
       {},
       [](Lens lens, Bench, At at) { return lens.frames[at.large].warm_ms; }},
      {"first frame ms, small",
       "first_ms_small",
       {},
       {},
       [](Lens lens, Bench, At at) { return first_of(lens.frames[at.small]); }},
      {"warm frame ms, small",
       "warm_ms_small",
       {},
       {},
       [](Lens lens, Bench, At at) { return lens.frames[at.small].warm_ms; }},
      {"a ghost / Canon's, large", "ghost_ratio_large", 1.5, 3.0,
       [](Lens lens, Bench bench, At at) { return ghost_ratio(lens, bench, at.large); }},
      {"a ghost / Canon's, small",
       "ghost_ratio_small",
       {},
       {},
       [](Lens lens, Bench bench, At at) { return ghost_ratio(lens, bench, at.small); }},
      {"small / large",
       "small_over_large",
       1.0 / 3.0,
       {},
       [](Lens lens, Bench, At at) { return first_of(lens.frames[at.small]) / first_of(lens.frames[at.large]); }},
      {"first / warm, large",
       "first_over_warm",
       1.6,
       {},
       [](Lens lens, Bench, At at) { return first_of(lens.frames[at.large]) / lens.frames[at.large].warm_ms; }},
  };
  return list;
}

// The value that this fraction of all values does not exceed, interpolated linearly in the sorted list.
double quantile(const std::vector<double>& sorted, double fraction) {
  const double position = fraction * static_cast<double>(sorted.size() - 1);
  const auto k = static_cast<std::size_t>(position);
  const std::size_t next = std::min(k + 1, sorted.size() - 1);
  return std::lerp(sorted[k], sorted[next], position - static_cast<double>(k));
}

struct Spread {
  double median, ninetieth, worst;
  std::string worst_lens;
};

Spread spread_of(const Figure& figure, const LensBench& bench, const Aperture& aperture) {
  std::vector<std::pair<double, std::string>> all;
  for (const BenchedFrames& lens : bench.lenses) all.emplace_back(figure.value(lens, bench, aperture), lens.name);
  std::sort(all.begin(), all.end());
  std::vector<double> values;
  for (const auto& [value, name] : all) values.push_back(value);
  return {quantile(values, 0.5), quantile(values, 0.9), values.back(), all.back().second};
}

std::string lenses_text(const LensBench& bench, const Aperture& aperture) {
  TextTable table({"<lens", "f/", "ghosts", "small first ms", "warm", "large first ms", "warm", "ghost / Canon's small",
                   "large", "small / large", "first / warm"});
  const auto add = [&](const BenchedFrames& lens) {
    const FrameCost& small = lens.frames[aperture.small];
    const FrameCost& large = lens.frames[aperture.large];
    table.add({lens.name, fmt::format("{:.2f}", large.f_number), fmt::format("{}", large.ghosts),
               fmt::format("{:.1f}", first_of(small)), fmt::format("{:.1f}", small.warm_ms),
               fmt::format("{:.1f}", first_of(large)), fmt::format("{:.1f}", large.warm_ms),
               fmt::format("{:.2f}", ghost_ratio(lens, bench, aperture.small)),
               fmt::format("{:.2f}", ghost_ratio(lens, bench, aperture.large)),
               fmt::format("{:.2f}", first_of(small) / first_of(large)),
               fmt::format("{:.2f}", first_of(large) / large.warm_ms)});
  };
  add(bench.baseline);
  for (const BenchedFrames& lens : bench.lenses) add(lens);
  return table.text();
}

std::string must_text(const std::optional<double>& must) { return must ? fmt::format("{:.2f}", *must) : ""; }

std::string summary_text(const LensBench& bench, const Aperture& aperture) {
  TextTable table({"<figure", "median", "must", "90th percentile", "must", "worst", "<of"});
  const bool has_limits = &aperture == &kApertures[0];
  for (const Figure& figure : figures()) {
    const Spread spread = spread_of(figure, bench, aperture);
    table.add({figure.name, fmt::format("{:.2f}", spread.median), has_limits ? must_text(figure.must_median) : "",
               fmt::format("{:.2f}", spread.ninetieth), has_limits ? must_text(figure.must_90th) : "",
               fmt::format("{:.2f}", spread.worst), spread.worst_lens});
  }
  return table.text();
}

Json frames_json(const BenchedFrames& lens, const LensBench& bench) {
  Json frames = Json::array();
  for (std::size_t k = 0; k < lens.frames.size(); ++k) {
    const FrameCost& frame = lens.frames[k];
    frames.push_back({{"frame", name_of(frame_cases()[k])},
                      {"f_number", frame.f_number},
                      {"ghosts", frame.ghosts},
                      {"first_ms", frame.first_ms > 0.0 ? Json(frame.first_ms) : Json()},
                      {"warm_ms", frame.warm_ms},
                      {"ghost_ratio", ghost_ratio(lens, bench, k)}});
  }
  return {{"lens", lens.name}, {"frames", frames}};
}

}  // namespace

std::string lens_bench_text(const LensBench& bench) {
  std::string text;
  for (const Aperture& aperture : kApertures) {
    text += fmt::format("\n{}: small is {}, large {}\n{}", aperture.name, frame_cases()[aperture.small].size,
                        frame_cases()[aperture.large].size, lenses_text(bench, aperture));
    if (!bench.lenses.empty())
      text += fmt::format("\n{}, {} lenses\n{}", aperture.name, bench.lenses.size(), summary_text(bench, aperture));
  }
  for (const std::string& refused : bench.refused) text += "left out: " + refused + "\n";
  return text;
}

Json lens_bench_json(const LensBench& bench, const FrameRunning& running) {
  Json lenses = Json::array();
  for (const BenchedFrames& lens : bench.lenses) lenses.push_back(frames_json(lens, bench));
  Json summary = Json::object();
  for (const Aperture& aperture : kApertures) {
    if (bench.lenses.empty()) continue;
    Json all = Json::object();
    for (const Figure& figure : figures()) {
      const Spread spread = spread_of(figure, bench, aperture);
      all[figure.key] = {{"median", spread.median},
                         {"ninetieth_percentile", spread.ninetieth},
                         {"worst", spread.worst},
                         {"worst_lens", spread.worst_lens}};
    }
    summary[aperture.key] = all;
  }
  return {{"machine", machine_json(this_machine())},
          {"time", running.processor_time ? "processor" : "clock"},
          {"yardstick", frames_json(bench.baseline, bench)},
          {"lenses", lenses},
          {"left_out", bench.refused},
          {"summary", summary}};
}

}  // namespace contrejour::cli
