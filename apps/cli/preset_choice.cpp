// SPDX-License-Identifier: Apache-2.0
#include "cli/preset_choice.h"

#include "cli/options.h"
#include "cli/outputs.h"
#include "contrejour/expert/session.h"

namespace contrejour::cli {
namespace {

// The session's own lens stands for its file's name, wherever a lens may.
Result<void> fill_from_session(const std::string& file, std::string& lens, params::Values& values) {
  const auto session = read_session(std::filesystem::path(file));
  if (!session) return tl::unexpected(session.error());
  values = values.over(session->values);
  if (lens.empty()) lens = file;
  return {};
}

}  // namespace

void add_preset_options(CLI::App& command, PresetOptions& options) {
  command
      .add_option(
          "--preset", options.name,
          "the preset to start from: a bundled one (`contrejour preset list`) or a file; other options override "
          "its settings")
      ->option_text("PRESET");
  const auto problem = [](const std::string& file) {
    return is_session(file) ? std::string() : std::string("a session's name ends in .session.json");
  };
  command
      .add_option("--session", options.session,
                  "the session of the studio to start from, a file NAME.session.json, with its lens and lights; other "
                  "options override its settings")
      ->check(CLI::Validator(problem, "", "session"))
      ->option_text("FILE");
  add_output(command, "--save-preset", options.save, {".toml"}, "save all settings of this flare as a preset");
  // The earlier names, which the help does not show.
  command.add_option("--look", options.name)->group("");
  add_output(command, "--save-look", options.save, {".toml"}, "")->group("");
}

Result<void> fill_from_preset(const PresetOptions& options, std::string& lens, params::Values& values) {
  if (!options.session.empty())
    if (auto ok = fill_from_session(options.session, lens, values); !ok) return ok;
  if (options.name.empty()) return {};
  const auto preset = params::find_preset(options.name);
  if (!preset) return tl::unexpected(preset.error());
  values = values.over(preset->values);
  if (lens.empty()) lens = preset->lens;
  if (!lens.empty()) return {};
  return failure(ErrorCode::InvalidArgument, "the preset names no lens; give a LENS (`contrejour lens list`)");
}

Result<void> save_preset(const PresetOptions& options, const std::string& lens, const params::Values& values) {
  Outputs outputs;
  const auto file = outputs.add(options.save);
  if (!file) return tl::unexpected(file.error());
  if (*file == nullptr) return {};
  if (auto ok = (*file)->write(params::write_preset({{}, {}, lens, values})); !ok) return ok;
  return outputs.commit();
}

}  // namespace contrejour::cli
