// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/capture_list.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "base/trimmed.h"

namespace contrejour {
namespace {

constexpr std::string_view kHeader = "station,angle_deg,kind,time_s,file";
constexpr std::size_t kMaxCaptures = 1000000;
constexpr int kMaxStations = 100000;
constexpr double kMinTime_s = 1e-9, kMaxTime_s = 86400.0;

template <class T>
bool parse_whole(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

bool is_time(double time_s) { return time_s >= kMinTime_s && time_s <= kMaxTime_s; }

// Five fields; the last, a file's name, may contain commas.
std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (int k = 0; k < 4; ++k) {
    const std::size_t comma = line.find(',');
    if (comma == std::string_view::npos) break;
    fields.push_back(trimmed(line.substr(0, comma)));
    line.remove_prefix(comma + 1);
  }
  fields.push_back(trimmed(line));
  return fields;
}

Result<PlannedCapture> capture_of(std::string_view line, const SourcePosition& position) {
  const auto fields = fields_of(line);
  const auto wrong = [&](std::string_view what) { return failure(ErrorCode::Parse, std::string(what), position); };
  if (fields.size() != 5 || fields[4].empty()) return wrong(fmt::format("give five values: {}", kHeader));
  PlannedCapture capture;
  if (!parse_whole(fields[0], capture.station) || capture.station < 1 || capture.station > kMaxStations)
    return wrong("the station is not a whole number from 1 to 100000");
  if (!parse_whole(fields[1], capture.angle_deg) || !(std::abs(capture.angle_deg) <= 180.0))
    return wrong("the angle is not a number from -180 to 180");
  const auto kind = std::ranges::find(kCaptureKindNames, fields[2]);
  if (kind == kCaptureKindNames.end()) return wrong("the kind is not exposure, background or direct");
  capture.kind = static_cast<CaptureKind>(kind - kCaptureKindNames.begin());
  if (!parse_whole(fields[3], capture.time_s) || !is_time(capture.time_s))
    return wrong("the time is not a number of seconds above 0");
  capture.file = std::string(fields[4]);
  return capture;
}

void add_planned(std::vector<PlannedCapture>& captures, PlannedCapture capture, const CapturePlan& plan) {
  const std::string_view kind = kCaptureKindNames[static_cast<std::size_t>(capture.kind)];
  capture.file = fmt::format("station-{:04}-{}-{:g}s.{}", capture.station, kind, capture.time_s, plan.ending);
  captures.push_back(std::move(capture));
}

}  // namespace

Result<std::vector<PlannedCapture>> plan_captures(const CapturePlan& plan) {
  const bool good = plan.stations >= 1 && plan.stations <= kMaxStations && plan.to_deg >= 0.0 && plan.to_deg <= 90.0 &&
                    plan.background_every >= 1 && !plan.times_s.empty() && std::ranges::all_of(plan.times_s, is_time) &&
                    is_time(plan.direct_s);
  if (!good) {
    return invalid_argument(
        "a sweep needs 1 to 100000 stations, angles up to 90 degrees, times above 0 seconds, and a background every "
        "so many stations");
  }
  std::vector<PlannedCapture> captures;
  for (int k = 0; k < plan.stations; ++k) {
    PlannedCapture at{k + 1, 0.0, CaptureKind::Exposure, 0.0, ""};
    if (plan.stations > 1) at.angle_deg = plan.to_deg * (2.0 * k / (plan.stations - 1) - 1.0);
    const auto add = [&](CaptureKind kind, double time_s) {
      at.kind = kind;
      at.time_s = time_s;
      add_planned(captures, at, plan);
    };
    for (const double time_s : plan.times_s) add(CaptureKind::Exposure, time_s);
    add(CaptureKind::Direct, plan.direct_s);
    if (k % plan.background_every != 0 && k != plan.stations - 1) continue;
    for (const double time_s : plan.times_s) add(CaptureKind::Background, time_s);
  }
  return captures;
}

std::string write_captures(std::span<const PlannedCapture> captures) {
  std::string csv = std::string(kHeader) + "\n";
  for (const PlannedCapture& c : captures) {
    csv += fmt::format("{},{:.6g},{},{:g},{}\n", c.station, c.angle_deg,
                       kCaptureKindNames[static_cast<std::size_t>(c.kind)], c.time_s, c.file);
  }
  return csv;
}

Result<std::vector<PlannedCapture>> read_captures(std::string_view csv, const std::string& file) {
  std::vector<PlannedCapture> captures;
  bool has_header = false;
  for (int line_number = 1; !csv.empty(); ++line_number) {
    const std::size_t end = std::min(csv.find('\n'), csv.size());
    const std::string_view line = trimmed(csv.substr(0, end));
    csv.remove_prefix(std::min(end + 1, csv.size()));
    const SourcePosition position{file, line_number, 0};
    if (line.empty() || line.front() == '#') continue;
    if (!has_header) {
      if (line != kHeader) return failure(ErrorCode::Parse, fmt::format("the first line is not {}", kHeader), position);
      has_header = true;
      continue;
    }
    if (captures.size() == kMaxCaptures) return failure(ErrorCode::Parse, "more than a million photographs", position);
    auto capture = capture_of(line, position);
    if (!capture) return tl::unexpected(capture.error());
    captures.push_back(std::move(*capture));
  }
  if (captures.empty()) return failure(ErrorCode::Parse, "the list has no photographs", {file, 0, 0});
  return captures;
}

Result<std::vector<StationFiles>> stations_of(std::span<const PlannedCapture> captures) {
  std::map<int, StationFiles> stations;
  for (const PlannedCapture& capture : captures) {
    const auto [at, is_new] = stations.try_emplace(capture.station);
    StationFiles& files = at->second;
    if (is_new) files = {capture.station, capture.angle_deg, {}, {}, {}};
    if (files.angle_deg != capture.angle_deg)
      return invalid_argument(fmt::format("station {} has two angles: {:g} and {:g} degrees", capture.station,
                                          files.angle_deg, capture.angle_deg));
    auto& list = capture.kind == CaptureKind::Exposure     ? files.exposures
                 : capture.kind == CaptureKind::Background ? files.background
                                                           : files.direct;
    list.push_back(capture);
  }
  std::vector<StationFiles> all;
  for (const auto& [number, files] : stations) {
    if (files.exposures.empty()) return invalid_argument(fmt::format("station {} has no exposure", number));
    all.push_back(files);
  }
  for (StationFiles& files : all) {
    if (!files.background.empty()) continue;
    int nearest = kMaxStations + 1;
    for (const auto& [number, other] : stations) {
      if (other.background.empty() || std::abs(number - files.station) >= nearest) continue;
      nearest = std::abs(number - files.station);
      files.background = other.background;
    }
  }
  return all;
}

}  // namespace contrejour
