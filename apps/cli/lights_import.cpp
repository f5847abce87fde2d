// SPDX-License-Identifier: Apache-2.0
// contrejour lights import: tracks of other programs as a file of lights.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/track_files.h"

namespace contrejour::cli {
namespace {

constexpr const char* kImportExamples =
    "The conventions of each format are in docs/formats/tracks.md. A camera (.chan) needs points, a CSV of\n"
    "name,x,y,z, whose directions and distances become those of lights.\n\n"
    "Examples:\n"
    "  contrejour lights import tracks.txt --size 1920x1080 --value 50000 -o lights.toml\n"
    "  contrejour lights import ae.txt --size 1920x1080 --frame-offset 1001 -o lights.toml\n"
    "  contrejour lights import camera.chan --points lamps.csv --unit 1m --size 1920x1080 -o lights.toml";

struct ImportOptions {
  std::string input, output, format = "auto", size, value, points, unit, rotation_order = "ZXY";
  int frame_offset = 0;
  bool json = false;
};

struct Imported {
  Animation animation;
  TrackFormat format = TrackFormat::Csv;
  std::vector<std::string> never_seen;
};

Result<TrackFormat> format_of(const ImportOptions& options, const std::string& text) {
  if (options.format == "auto") return track_format(text, options.input);
  const auto at = std::find(kTrackFormatNames.begin(), kTrackFormatNames.end(), options.format);
  return static_cast<TrackFormat>(at - kTrackFormatNames.begin());
}

Result<Imported> import_world(const ImportOptions& options, const std::string& text, params::PixelSize size) {
  if (options.points.empty())
    return failure(ErrorCode::InvalidArgument,
                   "the file has a camera; --points gives the lights that it sees, a CSV of name,x,y,z",
                   {options.input});
  const auto camera = read_chan(text, options.input, options.frame_offset);
  if (!camera) return tl::unexpected(camera.error());
  const auto points_text = read_track_text(options.points);
  if (!points_text) return tl::unexpected(points_text.error());
  const auto points = read_world_points(*points_text, options.points, options.frame_offset);
  if (!points) return tl::unexpected(points.error());
  WorldSettings settings{size.width, size.height, options.rotation_order, std::nullopt, options.value};
  if (!options.unit.empty()) {
    const auto unit = params::parse_distance_mm(options.unit);
    if (!unit) return tl::unexpected(unit.error());
    settings.unit_mm = *unit;
  }
  auto lights = lights_of_world(*camera, *points, settings);
  if (!lights) return tl::unexpected(lights.error());
  return Imported{std::move(lights->animation), TrackFormat::Chan, std::move(lights->never_seen)};
}

Result<Imported> import_file(const ImportOptions& options) {
  const auto size = params::parse_size(options.size);
  if (!size) return tl::unexpected(size.error());
  const auto text = read_track_text(options.input);
  if (!text) return tl::unexpected(text.error());
  const auto format = format_of(options, *text);
  if (!format) return tl::unexpected(format.error());
  if (*format == TrackFormat::Chan) return import_world(options, *text, *size);
  if (!options.points.empty())
    return failure(ErrorCode::InvalidArgument, "--points belongs to a camera, and this file has tracks",
                   {options.input});
  const auto tracks = read_tracks(*text, options.input, *format, {size->width, size->height, options.frame_offset});
  if (!tracks) return tl::unexpected(tracks.error());
  auto animation = animation_of_points(*tracks, options.value);
  if (!animation) return tl::unexpected(animation.error());
  return Imported{std::move(*animation), *format, {}};
}

void report_import(const ImportOptions& options, const Imported& imported) {
  const std::string_view format = kTrackFormatNames[static_cast<std::size_t>(imported.format)];
  if (!imported.never_seen.empty())
    print_warnings(
        {fmt::format("points that are never in front of the camera: {}", fmt::join(imported.never_seen, ", "))});
  if (options.json) {
    print_json({{"output", options.output},
                {"format", format},
                {"lights", imported.animation.lights.size()},
                {"first_frame", first_key(imported.animation)}});
    return;
  }
  print_summary(fmt::format("{}: {} lights from a file of the format {}\n", options.output,
                            imported.animation.lights.size(), format));
}

Result<int> run_import(const ImportOptions& options) {
  const auto imported = import_file(options);
  if (!imported) return tl::unexpected(imported.error());
  if (imported->animation.lights.empty())
    return failure(ErrorCode::InvalidArgument, "no point is ever in front of the camera; check --rotation-order",
                   {options.points});
  Outputs outputs;
  const auto file = outputs.add(options.output);
  if (!file) return tl::unexpected(file.error());
  if (auto ok = (*file)->write(write_animation(imported->animation)); !ok) return tl::unexpected(ok.error());
  if (auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  report_import(options, *imported);
  return kDone;
}

void add_camera_options(CLI::App& command, ImportOptions& options) {
  constexpr const char* kGroup = "Cameras";
  command
      .add_option("--points", options.points,
                  "the lights in the world of a camera: a CSV of name,x,y,z, or name,frame,x,y,z")
      ->option_text("FILE")
      ->group(kGroup);
  command
      .add_option("--unit", options.unit,
                  "length of the world's unit, e.g. 1m, for the lights' distances (default: they are at infinity)")
      ->option_text("LENGTH")
      ->group(kGroup);
  command
      .add_option("--rotation-order", options.rotation_order,
                  "the camera's order of rotations, the first one first (default: ZXY, as Nuke's cameras have)")
      ->check(CLI::IsMember({"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"}))
      ->option_text("ORDER")
      ->group(kGroup);
}

}  // namespace

void add_lights_import(CLI::App& lights, Action& action) {
  const auto options = std::make_shared<ImportOptions>();
  CLI::App* command = lights.add_subcommand("import", "tracks of other programs as lights");
  command->add_option("FILE", options->input, "tracks, or a camera")->required()->option_text(" ");
  add_output(*command, "-o,--output", options->output, {".toml"}, "the lights, with keys by frame")->required();
  command->add_option("--size", options->size, "size of the picture that was tracked, in pixels")
      ->required()
      ->option_text("WxH");
  std::vector<std::string> formats{"auto"};
  formats.insert(formats.end(), kTrackFormatNames.begin(), kTrackFormatNames.end());
  command->add_option("--format", options->format, "the file's format (default: auto)")
      ->check(CLI::IsMember(formats))
      ->option_text(fmt::format("{}", fmt::join(formats, "|")));
  command
      ->add_option("--value", options->value,
                   "value of all lights, as for `apply --value` (default: that of the option when it is applied)")
      ->option_text("VALUE");
  add_number(*command, "--frame-offset", options->frame_offset, -100000000, 100000000,
             "added to the file's numbers of frames");
  command->add_flag("--json", options->json, "print the report as JSON");
  add_camera_options(*command, *options);
  command->footer(kImportExamples);
  command->callback([options, &action] { action = [options] { return run_import(*options); }; });
}

}  // namespace contrejour::cli
