// Options of a sub-command, made from the table of parameters; and the checks files' names need.
#pragma once

#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

#include "params/values.h"

namespace contrejour::cli {

// One option each; `values` must live as long as the command. A wrong value is a usage error.
void add_parameters(CLI::App& command, params::Values& values, std::initializer_list<std::string_view> names);

// Every parameter that sets the lens: focal, fnumber, focus, coating, those of the blades, iris-image, those of dirt.
void add_lens_parameters(CLI::App& command, params::Values& values);

// How to render: the method and its settings.
void add_rendering_parameters(CLI::App& command, params::Values& values);

// -o FILE or another file that is written; its name must end so (".exr"), in any case.
CLI::Option* add_output(CLI::App& command, const std::string& flags, std::string& file,
                        std::initializer_list<std::string_view> endings, const std::string& help);

[[nodiscard]] std::string lower_extension(const std::string& file);

}  // namespace contrejour::cli
