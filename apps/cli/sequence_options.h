// SPDX-License-Identifier: Apache-2.0
// The options of a sequence, and what they ask for: names with ####, frames, those that are missing, those that are
// done.
#pragma once

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "contrejour/expert/frame_record.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/expert/run_frames.h"
#include "contrejour/result.h"

namespace contrejour::cli {

struct SequenceOptions {
  std::string frames;             // a range; empty: all frames on disk, or a still
  std::string missing = "error";  // or "skip", "black"
  bool resume = false;
  bool keep_going = false;
  bool list_frames = false;  // print the frames that would be rendered, and render none
  int frames_in_flight = 2;  // that a device draws at once
};

// Whether frames are read from files, which may be missing.
enum class SequenceInput { None, Files };

// Adds --frames and, for files, --missing.
void add_frame_options(CLI::App& command, SequenceOptions& options, SequenceInput input);
// The same and --resume, --keep-going, --list-frames and --frames-in-flight, for a sequence that is rendered.
void add_sequence_options(CLI::App& command, SequenceOptions& options, SequenceInput input);

// True for a name with a place for the number of a frame, unless a file has exactly this name.
[[nodiscard]] bool is_sequence(const std::string& name);

// A name without a place for the number is the same for all frames.
[[nodiscard]] Result<std::string> name_of_frame(const std::string& name, int frame);

// Replaces each name by that of the frame.
[[nodiscard]] Result<void> number_names(int frame, std::initializer_list<std::string*> names);

// Errors: InvalidArgument for an output without a place for the number of a frame, which each frame would overwrite.
[[nodiscard]] Result<void> check_sequence_outputs(std::span<const std::string> outputs);

struct SequenceFrames {
  std::vector<int> frames;   // to be rendered, in rising order
  std::set<int> missing;     // those of them whose input does not exist
};

// The frames asked for. Errors: none at all; missing ones, unless --missing allows them.
[[nodiscard]] Result<SequenceFrames> frames_of_sequence(const SequenceOptions& options, const std::string& input);

// Everything that decides how a frame looks, as text: the program, the command, the lens and all values; and the files
// that they name.
struct SettingsRecord {
  std::string text;
  std::vector<std::filesystem::path> files;
};
[[nodiscard]] SettingsRecord settings_record(const std::string& command, const std::string& lens,
                                             const params::Values& values);

// The files of a frame for its record (frame_record.h). input: empty for none; outputs: empty names are left out.
[[nodiscard]] FrameFiles frame_files(SettingsRecord settings, const std::string& input,
                                     std::span<const std::string> outputs);

// The options of run_frames() for a number of renderers, which draw as many frames at once.
[[nodiscard]] RunFramesOptions run_options(const SequenceOptions& options, int renderers);

// Leaves out the frames that are done; says how many.
void leave_out_done(std::vector<int>& frames, const std::function<bool(int frame)>& is_done);

// Errors: InvalidArgument for --list-frames, of which a still has none.
[[nodiscard]] Result<void> check_is_not_listed(const SequenceOptions& options);

// Prints frames as a range, for --list-frames; nothing if there are none. Returns the exit code.
[[nodiscard]] int print_frames(const std::vector<int>& frames);

// Prints the frames that failed and returns the exit code.
[[nodiscard]] int report_failures(const std::vector<FrameFailure>& failures, std::size_t frame_count);

}  // namespace contrejour::cli
