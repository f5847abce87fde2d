// SPDX-License-Identifier: Apache-2.0
// contrejour measure merge: the photographs of a sweep -> one picture of each station, with variance and validity.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/raw_file.h"
#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/station_file.h"

namespace contrejour::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMergeExamples =
    "LIST is the CSV of `contrejour measure protocol`; files are relative to its folder. Each station becomes\n"
    "station-NUMBER.exr in the folder: rates in DN per second at half the raw size (R, G, B), their variance and\n"
    "validity as layers. stations.csv lists angles, and the place and flux of the light's own image. Stations that\n"
    "exist are kept, so that an interrupted command continues.\n\n"
    "Examples:\n"
    "  contrejour measure merge sweep.csv -o merged\n"
    "  contrejour measure merge sweep.csv -o merged --gain-e 0.7 --read-e 4 --at-once 4\n"
    "  contrejour measure merge sweep.csv -o merged --pattern rggb --black 512 --white 16383";

constexpr double kUnsteady = 0.1;
constexpr std::uintmax_t kMaxListBytes = std::uintmax_t{1} << 27U;

struct MergeOptions {
  std::string list, folder, pattern = "rggb", monitor;
  double black = -1.0, white = -1.0;  // below 0: not given
  int at_once = 2;
  bool json = false;
  MergeSettings settings;
};

fs::path station_path(const MergeOptions& options, int station) {
  return fs::path(options.folder) / fmt::format("station-{:04}.exr", station);
}

Result<std::vector<StationFiles>> read_list(const std::string& list) {
  std::error_code error;
  const auto bytes = fs::file_size(list, error);
  std::ifstream stream(list, std::ios::binary);
  if (error || !stream || bytes > kMaxListBytes)
    return failure(ErrorCode::Io, "the list cannot be read; write one with `contrejour measure protocol`",
                   {list, 0, 0});
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const auto captures = read_captures(text, list);
  if (!captures) return tl::unexpected(captures.error());
  auto stations = stations_of(*captures);
  if (!stations) stations.error().position.file = list;
  return stations;
}

Result<MosaicFormat> mosaic_format(const MergeOptions& options) {
  MosaicFormat format;
  constexpr std::array<std::string_view, 4> kPatterns{"rggb", "bggr", "grbg", "gbrg"};
  for (std::size_t k = 0; k < kPatterns.size(); ++k)
    if (options.pattern == kPatterns[k]) format.pattern = static_cast<BayerPattern>(k);
  if (options.black >= 0.0) format.black_dn = options.black;
  if (options.white >= 0.0) format.white_dn = options.white;
  return format;
}

Result<void> set_monitor(const std::string& text, MergeSettings& settings) {
  if (text.empty()) return {};
  const auto numbers = params::parse_reals(text, 5);
  if (!numbers)
    return invalid_argument("--monitor needs X,Y,WIDTH,HEIGHT,RATE: raw pixels, and the patch's rate in DN per second");
  const auto whole = [&](std::size_t k) { return static_cast<int>((*numbers)[k]); };
  settings.monitor = MonitorPatch{whole(0), whole(1), whole(2), whole(3), (*numbers)[4]};
  return {};
}

// A row of each station whose file is there, and a warning for lights that were not steady.
Result<std::string> summary_of(const MergeOptions& options, const std::vector<StationFiles>& stations) {
  std::string csv = "station,angle_deg,file,direct_x_px,direct_y_px,direct_red,direct_green,direct_blue\n";
  std::vector<double> flux;
  std::vector<int> with_flux;
  for (const StationFiles& files : stations) {
    const fs::path path = station_path(options, files.station);
    if (!fs::exists(path)) continue;
    const auto facts = read_station_facts(path);
    if (!facts) return tl::unexpected(facts.error());
    csv += fmt::format("{},{:.6g},{}", files.station, facts->angle_deg, path.filename().string());
    if (const auto& d = facts->direct) {
      csv += fmt::format(",{:.3f},{:.3f},{:.6g},{:.6g},{:.6g}\n", d->position_px.x, d->position_px.y, d->rate[0],
                         d->rate[1], d->rate[2]);
      flux.push_back(d->rate[1]);
      with_flux.push_back(files.station);
    } else {
      csv += ",,,,,\n";
    }
  }
  for (const std::size_t k : unsteady_stations(flux, kUnsteady))
    print_warnings({fmt::format("station {}: the light differs by more than 10 per cent from the stations beside it",
                                with_flux[k])});
  return csv;
}

// The stations that are not there yet.
std::vector<StationFiles> missing_stations(const MergeOptions& options, const std::vector<StationFiles>& stations) {
  std::vector<StationFiles> missing;
  for (const StationFiles& files : stations)
    if (!fs::exists(station_path(options, files.station))) missing.push_back(files);
  return missing;
}

Result<std::vector<StationOutcome>> merge_missing(const MergeOptions& options, const std::vector<StationFiles>& missing,
                                                  const MosaicFormat& format) {
  const fs::path folder = fs::path(options.list).parent_path();
  const LongTask task("merging", 0);
  return merge_stations(
      missing, [&](const PlannedCapture& c) { return read_raw_frame((folder / c.file).string(), format, c.time_s); },
      [&](const MergedStation& s) { return write_station(station_path(options, s.station), s); }, options.settings,
      options.at_once, task.context());
}

int print_outcomes(const std::vector<StationFiles>& missing, const std::vector<StationOutcome>& outcomes) {
  int failed = 0;
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    for (const std::string& warning : outcomes[k].warnings)
      print_warnings({fmt::format("station {}: {}", missing[k].station, warning)});
    if (!outcomes[k].error) continue;
    ++failed;
    print_error(fmt::format("station {} is left out: {}", missing[k].station, outcomes[k].error->to_string()));
  }
  return failed;
}

Result<int> run_merge(MergeOptions options) {
  const auto stations = read_list(options.list);
  if (!stations) return tl::unexpected(stations.error());
  const auto format = mosaic_format(options);
  if (!format) return tl::unexpected(format.error());
  if (auto ok = set_monitor(options.monitor, options.settings); !ok) return tl::unexpected(ok.error());
  std::error_code error;
  fs::create_directories(options.folder, error);
  if (error) return failure(ErrorCode::Io, "the folder cannot be made; name another", {options.folder, 0, 0});
  Outputs outputs;
  const auto summary = outputs.add((fs::path(options.folder) / "stations.csv").string());
  if (!summary) return tl::unexpected(summary.error());
  const auto missing = missing_stations(options, *stations);
  const auto outcomes = merge_missing(options, missing, *format);
  if (!outcomes) return tl::unexpected(outcomes.error());
  const int failed = print_outcomes(missing, *outcomes);
  const auto csv = summary_of(options, *stations);
  if (!csv) return tl::unexpected(csv.error());
  if (auto ok = (*summary)->write(*csv); !ok) return tl::unexpected(ok.error());
  if (auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  const std::size_t merged = missing.size() - static_cast<std::size_t>(failed);
  print_summary(fmt::format("{}: {} stations merged, {} kept, {} left out\n", options.folder, merged,
                            stations->size() - missing.size(), failed));
  return failed == 0 ? kDone : kFailed;
}

}  // namespace

void add_measure_merge(CLI::App& measure, Action& action) {
  const auto options = std::make_shared<MergeOptions>();
  CLI::App* command = measure.add_subcommand("merge", "merge the photographs of each station of a sweep");
  command->add_option("LIST", options->list, "the list of photographs (CSV)")->required()->option_text(" ");
  command->add_option("-o,--output", options->folder, "the folder for the stations")->required()->option_text("FOLDER");
  command->add_option("--pattern", options->pattern, "Bayer pattern of PNG and EXR files: rggb, bggr, grbg, gbrg")
      ->check(CLI::IsMember({"rggb", "bggr", "grbg", "gbrg"}))
      ->option_text("NAME");
  command->add_option("--black", options->black, "black level (default: 0, or the RAW file's)")
      ->check(CLI::Range(0.0, 65535.0))
      ->option_text("DN");
  command->add_option("--white", options->white, "saturation level (default: 65535, or the RAW file's)")
      ->check(CLI::Range(1.0, 65535.0))
      ->option_text("DN");
  command->add_option("--gain-e", options->settings.noise.electrons_per_dn, "electrons per DN (default: 0.5)")
      ->check(CLI::Range(1e-6, 1e6))
      ->option_text("N");
  command->add_option("--read-e", options->settings.noise.read_electrons, "read noise in electrons (default: 3)")
      ->check(CLI::Range(0.0, 1e6))
      ->option_text("N");
  command->add_option("--saturated", options->settings.saturated, "part of the range that is used (default: 0.9)")
      ->check(CLI::Range(0.01, 1.0))
      ->option_text("N");
  command->add_option("--monitor", options->monitor, "a patch that shows the lamp's drift: X,Y,WIDTH,HEIGHT,RATE")
      ->option_text("PATCH");
  add_number(*command, "--at-once", options->at_once, 1, 256, "stations merged at once; memory grows with it");
  command->footer(kMergeExamples);
  command->callback([options, &action] { action = [options] { return run_merge(*options); }; });
}

}  // namespace contrejour::cli
