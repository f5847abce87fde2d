// SPDX-License-Identifier: Apache-2.0
// Options of a sub-command, made from the table of parameters; checks of file names.
#pragma once

#include <array>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

#include "contrejour/expert/parameter_values.h"
#include "contrejour/expert/plate.h"
#include "contrejour/image_io.h"

namespace contrejour::cli {

// Adds one option for each name; `values` must live as long as the command. A wrong value is a usage error.
void add_parameters(CLI::App& command, params::Values& values, std::initializer_list<std::string_view> names);
void add_parameters(CLI::App& command, params::Values& values, std::span<const std::string_view> names);

// Every parameter that configures the lens: focal, fnumber, focus, coating, and those below.
void add_lens_parameters(CLI::App& command, params::Values& values);

inline constexpr std::array<std::string_view, 7> kIris = {
    "blades", "blade-rotation", "blade-curvature", "blade-asymmetry", "blade-seed", "blade-slope-error", "iris-image"};
inline constexpr std::array<std::string_view, 3> kGrating = {"sensor-orders", "sensor-pitch", "sensor-fill"};
inline constexpr std::array<std::string_view, 11> kDirt = {
    "dust",           "dust-size",  "scratches",  "scratch-length", "scratch-width", "scratch-angle",
    "scratch-spread", "dirt-image", "dirt-plane", "dirt-seed",      "dirt-phase"};

// Adds options that are accepted, so that the same options work for every command, but do not affect this command's
// result: its help omits them.
void hide_parameters(CLI::App& command, std::span<const std::string_view> names);

// Adds the parameters of a group of the table that the command does not have yet, but for one: those that are new in
// the table appear without a change here.
void add_others_of_group(CLI::App& command, params::Values& values, std::string_view group,
                         std::string_view except = {});

// Adds the options of rendering: the method and its settings.
void add_rendering_parameters(CLI::App& command, params::Values& values);

// Adds -o FILE or another file to write; its name must have one of these endings (".exr"), in any case.
CLI::Option* add_output(CLI::App& command, const std::string& flags, std::string& file,
                        std::initializer_list<std::string_view> endings, const std::string& help);

// Adds an option for a whole number from `min` to `max`; its present value is the default that the help states.
CLI::Option* add_number(CLI::App& command, const std::string& flag, int& number, int min, int max,
                        const std::string& help);

// Adds --layer and --part, which choose the picture to read from an EXR file.
void add_picture_choice(CLI::App& command, ReadOptions& read);

// Adds the options of a command's colour spaces: --ocio-config, --input-space where it reads the picture, and
// --output-space where it writes it.
enum class PlateUse { Read, Write, ReadAndWrite };
void add_plate_colour(CLI::App& command, PlateColour& colour, PlateUse use);

// Adds --compression, for EXR files that the command writes.
void add_exr_compression(CLI::App& command, ExrCompression& compression);
// The compression for a frame's record; empty where the option is not given.
[[nodiscard]] std::string compression_text(ExrCompression compression);

[[nodiscard]] std::string lower_extension(const std::string& file);

}  // namespace contrejour::cli
