// SPDX-License-Identifier: Apache-2.0
// contrejour measure protocol: a page to print for the laboratory, and the list of the photographs to take.
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/protocol_page.h"
#include "contrejour/expert/capture_list.h"
#include "contrejour/expert/parameter_text.h"

namespace contrejour::cli {
namespace {

constexpr const char* kProtocolExamples =
    "The list is CSV: station, angle, kind, time and file of each photograph. Put the names of your files into it, or\n"
    "rename these, and give it to `contrejour measure merge`.\n\n"
    "Examples:\n"
    "  contrejour measure protocol -o protocol.html --list sweep.csv\n"
    "  contrejour measure protocol --stations 61 --to 30 --times 0.25,1,4 --list sweep.csv -o protocol.html";

struct ProtocolOptions {
  std::string output, list, times = "0.25,1,4";
  CapturePlan plan;
  bool json = false;
};

Result<std::vector<double>> times_of(const std::string& text) {
  std::vector<double> times;
  for (const std::string_view word : params::split(text, ',')) {
    const auto time_s = params::parse_real(word);
    if (!time_s) return tl::unexpected(time_s.error());
    times.push_back(*time_s);
  }
  return times;
}

Result<int> run_protocol(ProtocolOptions options) {
  const auto times = times_of(options.times);
  if (!times) return tl::unexpected(times.error());
  options.plan.times_s = *times;
  const auto captures = plan_captures(options.plan);
  if (!captures) return tl::unexpected(captures.error());
  Outputs outputs;
  OutputFile *page = nullptr, *list = nullptr;
  const std::pair<const std::string&, OutputFile*&> all[] = {{options.output, page}, {options.list, list}};
  if (auto ok = outputs.add_all(all); !ok) return tl::unexpected(ok.error());
  Result<void> ok = page->write(protocol_page(options.plan, *captures));
  if (ok && list) ok = list->write(write_captures(*captures));
  if (!ok) return tl::unexpected(ok.error());
  if (auto done = outputs.commit(); !done) return tl::unexpected(done.error());
  print_summary(
      fmt::format("{}: {} stations, {} photographs\n", options.output, options.plan.stations, captures->size()));
  return kDone;
}

}  // namespace

void add_measure_protocol(CLI::App& measure, Action& action) {
  const auto options = std::make_shared<ProtocolOptions>();
  CLI::App* command = measure.add_subcommand("protocol", "write the page and the list for a sweep of photographs");
  add_output(*command, "-o,--output", options->output, {".html"}, "the page, to print")->required();
  add_output(*command, "--list", options->list, {".csv"}, "the list of photographs");
  add_number(*command, "--stations", options->plan.stations, 1, 100000, "number of angles, evenly spaced");
  command->add_option("--to", options->plan.to_deg, "sweep from minus this angle to this angle (default: 60)")
      ->check(CLI::Range(0.0, 90.0))
      ->option_text("DEG");
  command->add_option("--times", options->times, "exposure times of a station (default: 0.25,1,4)")
      ->option_text("SECONDS,...");
  command->add_option("--direct", options->plan.direct_s, "time of the short exposure of the light (default: 0.00025)")
      ->option_text("SECONDS");
  add_number(*command, "--background-every", options->plan.background_every, 1, 100000,
             "stations between exposures with the light blocked");
  command->add_option("--ending", options->plan.ending, "ending of the camera's files in the list (default: cr2)")
      ->option_text("NAME");
  command->footer(kProtocolExamples);
  command->callback([options, &action] { action = [options] { return run_protocol(*options); }; });
}

}  // namespace contrejour::cli
