// Options of a sub-command, made from the table of parameters; and the checks files' names need.
#pragma once

#include <array>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

#include "contrejour/image_io.h"
#include "contrejour/parameter_values.h"

namespace contrejour::cli {

// One option each; `values` must live as long as the command. A wrong value is a usage error.
void add_parameters(CLI::App& command, params::Values& values, std::initializer_list<std::string_view> names);
void add_parameters(CLI::App& command, params::Values& values, std::span<const std::string_view> names);

// Every parameter that sets the lens: focal, fnumber, focus, coating, and those below.
void add_lens_parameters(CLI::App& command, params::Values& values);

inline constexpr std::array<std::string_view, 7> kIris = {
    "blades", "blade-rotation", "blade-curvature", "blade-asymmetry", "blade-seed", "blade-spread", "iris-image"};
inline constexpr std::array<std::string_view, 3> kGrating = {"sensor-orders", "sensor-pitch", "sensor-fill"};
inline constexpr std::array<std::string_view, 11> kDirt = {
    "dust",           "dust-size",  "scratches", "scratch-length", "scratch-width", "scratch-angle",
    "scratch-spread", "dirt-image", "dirt-on",   "dirt-seed",      "dirt-time"};

// Options that are taken, so that one line of options will do for every command, but change nothing of what this one
// shows: they are not in its help.
void hide_parameters(CLI::App& command, std::span<const std::string_view> names);

// How to render: the method and its settings.
void add_rendering_parameters(CLI::App& command, params::Values& values);

// -o FILE or another file that is written; its name must end so (".exr"), in any case.
CLI::Option* add_output(CLI::App& command, const std::string& flags, std::string& file,
                        std::initializer_list<std::string_view> endings, const std::string& help);

// --layer and --part: which of the pictures of an EXR file is read.
void add_picture_choice(CLI::App& command, ReadOptions& read);

[[nodiscard]] std::string lower_extension(const std::string& file);

}  // namespace contrejour::cli
