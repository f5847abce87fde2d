// SPDX-License-Identifier: Apache-2.0
#include "cli/sequence_options.h"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/console.h"
#include "cli/options.h"
#include "contrejour/expert/frame_pattern.h"
#include "contrejour/expert/frame_range.h"

namespace contrejour::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSequenceGroup = "Sequences";

bool is_file(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error);
}

bool exists(const std::string& name) {
  std::error_code error;
  return fs::exists(name, error);
}

// --frames, or all frames on disk.
Result<std::vector<int>> requested_frames(const SequenceOptions& options, const std::string& input) {
  if (!options.frames.empty()) return parse_frame_range(options.frames);
  const auto pattern = parse_frame_pattern(input);
  if (!pattern) return tl::unexpected(pattern.error());
  auto frames = frames_on_disk(*pattern);
  if (frames && frames->empty()) return failure(ErrorCode::Io, "there are no files of this sequence", {input});
  return frames;
}

}  // namespace

void add_frame_options(CLI::App& command, SequenceOptions& options, SequenceInput input) {
  const bool are_files = input == SequenceInput::Files;
  command
      .add_option("--frames", options.frames,
                  fmt::format("the frames of the sequence, e.g. 1001-1240, 1001-1100x2,1200{}",
                              are_files ? " (default: all that are there)" : ""))
      ->option_text("RANGE")
      ->group(kSequenceGroup);
  if (!are_files) return;
  command
      .add_option("--missing", options.missing,
                  "what to do about frames whose input is missing: stop, leave them out, or take a black picture "
                  "(default: error)")
      ->check(CLI::IsMember({"error", "skip", "black"}))
      ->option_text("error|skip|black")
      ->group(kSequenceGroup);
}

void add_sequence_options(CLI::App& command, SequenceOptions& options, SequenceInput input) {
  add_frame_options(command, options, input);
  command
      .add_flag("--resume", options.resume, "keep frames that were finished with the same settings from the same files")
      ->group(kSequenceGroup);
  command.add_flag("--keep-going", options.keep_going, "render the other frames when one fails")->group(kSequenceGroup);
  command
      .add_flag("--list-frames", options.list_frames,
                "print the frames that would be rendered (with --resume: those that are not done), and render none")
      ->group(kSequenceGroup);
  add_number(command, "--frames-in-flight", options.frames_in_flight, 1, 8,
             "frames that a device (--device) draws at once, each with buffers of its own; the CPU draws one at a time")
      ->group(kSequenceGroup);
}

bool is_sequence(const std::string& name) { return is_frame_pattern(name) && !exists(name); }

Result<std::string> name_of_frame(const std::string& name, int frame) {
  if (!is_sequence(name)) return name;
  const auto pattern = parse_frame_pattern(name);
  if (!pattern) return tl::unexpected(pattern.error());
  return file_of_frame(*pattern, frame).string();
}

Result<void> number_names(int frame, std::initializer_list<std::string*> names) {
  for (std::string* name : names) {
    auto numbered = name_of_frame(*name, frame);
    if (!numbered) return tl::unexpected(numbered.error());
    *name = std::move(*numbered);
  }
  return {};
}

Result<void> check_sequence_outputs(std::span<const std::string> outputs) {
  for (const std::string& output : outputs) {
    if (output.empty()) continue;
    if (const auto pattern = parse_frame_pattern(output); !pattern) return tl::unexpected(pattern.error());
  }
  return {};
}

Result<SequenceFrames> frames_of_sequence(const SequenceOptions& options, const std::string& input) {
  auto frames = requested_frames(options, input);
  if (!frames) return tl::unexpected(frames.error());
  std::vector<int> missing;
  for (const int frame : *frames) {
    const auto name = name_of_frame(input, frame);
    if (!name) return tl::unexpected(name.error());
    if (!exists(*name)) missing.push_back(frame);
  }
  if (missing.size() == frames->size())
    return failure(ErrorCode::Io, fmt::format("none of the frames {} exists", frame_range_text(missing)), {input});
  if (missing.empty()) return SequenceFrames{std::move(*frames), {}};
  if (options.missing == "error")
    return failure(ErrorCode::Io,
                   fmt::format("frames {} are missing; --missing skip leaves them out, --missing black takes black "
                               "pictures in their place",
                               frame_range_text(missing)),
                   {input});
  print_warnings({fmt::format("{}: frames {} are missing", input, frame_range_text(missing))});
  if (options.missing == "black") return SequenceFrames{std::move(*frames), {missing.begin(), missing.end()}};
  std::vector<int> present;
  std::set_difference(frames->begin(), frames->end(), missing.begin(), missing.end(), std::back_inserter(present));
  return SequenceFrames{std::move(present), {}};
}

SettingsRecord settings_record(const std::string& command, const std::string& lens, const params::Values& values) {
  SettingsRecord record{fmt::format("contrejour {} {}\nlens = {}\n", CONTREJOUR_VERSION, command, lens), {}};
  if (is_file(lens)) record.files.emplace_back(lens);
  for (const params::Parameter& parameter : params::all_parameters()) {
    if (parameter.name == "threads") continue;  // changes no pixel
    for (const std::string& text : values.list(parameter.name)) {
      record.text += fmt::format("{} = {}\n", parameter.name, text);
      if (is_file(text)) record.files.emplace_back(text);
    }
  }
  return record;
}

FrameFiles frame_files(SettingsRecord settings, const std::string& input, std::span<const std::string> outputs) {
  FrameFiles files{std::move(settings.text), std::move(settings.files), {}};
  if (!input.empty()) files.inputs.emplace_back(input);
  for (const std::string& output : outputs)
    if (!output.empty()) files.outputs.emplace_back(output);
  return files;
}

// One frame more is read, and one is written.
RunFramesOptions run_options(const SequenceOptions& options, int renderers) {
  return {options.keep_going, renderers + 2, renderers};
}

void leave_out_done(std::vector<int>& frames, const std::function<bool(int frame)>& is_done) {
  const std::size_t before = frames.size();
  frames.erase(std::remove_if(frames.begin(), frames.end(), is_done), frames.end());
  if (frames.size() < before)
    print_warnings({fmt::format("{} of {} frames are done already", before - frames.size(), before)});
}

Result<void> check_is_not_listed(const SequenceOptions& options) {
  if (!options.list_frames) return {};
  return invalid_argument("--list-frames lists those of a sequence; give names with #### for the number of a frame");
}

int print_frames(const std::vector<int>& frames) {
  if (!frames.empty()) print(frame_range_text(frames) + "\n");
  return 0;
}

int report_failures(const std::vector<FrameFailure>& failures, std::size_t frame_count) {
  for (const FrameFailure& failed : failures)
    print_error(fmt::format("frame {}: {}", failed.frame, failed.error.to_string()));
  if (failures.size() > 1) print_error(fmt::format("{} of {} frames failed", failures.size(), frame_count));
  return failures.empty() ? 0 : 1;
}

}  // namespace contrejour::cli
