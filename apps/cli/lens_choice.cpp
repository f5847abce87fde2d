// SPDX-License-Identifier: Apache-2.0
#include "cli/lens_choice.h"

#include <utility>

#include <fmt/format.h>

#include "cli/console.h"
#include "cli/glass_choice.h"
#include "contrejour/expert/flare_source.h"
#include "contrejour/expert/session.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {

CLI::Option* add_lens_argument(CLI::App& command, std::string& lens) {
  return command
      .add_option("LENS", lens, "a bundled lens (`contrejour lens list`), a lens file or a session of the studio")
      ->required()
      ->option_text(" ");
}

Result<Prescription> prescription_of(const std::string& lens) {
  if (is_measured_flare(lens)) {
    return failure(
        ErrorCode::Unsupported,
        "this is a measured flare, which has no surfaces; render, apply and measure predict take it, but this "
        "command needs a lens",
        {lens, 0, 0});
  }
  const auto glasses = own_glasses();
  if (!glasses) return tl::unexpected(glasses.error());
  if (!is_session(lens)) return find_lens(lens, &*glasses);
  const auto session = read_session(std::filesystem::path(lens));
  if (!session) return tl::unexpected(session.error());
  return lens_of_session(*session, &*glasses);
}

Result<LensState> open_lens(const std::string& lens, const params::Values& values) {
  auto prescription = prescription_of(lens);
  if (!prescription) return tl::unexpected(prescription.error());
  auto state = params::lens_of(std::move(*prescription), values);
  if (state) print_warnings(state->warnings);
  return state;
}

namespace {

// Checks while the command line is parsed that the text names a ghost.
template <auto parse>
CLI::Option* checked(CLI::Option* option) {
  const auto problem = [](const std::string& text) {
    const auto parsed = parse(text);
    return parsed ? std::string() : parsed.error().message;
  };
  return option->check(CLI::Validator(problem, "", "ghost"))->option_text("I-J");
}

Result<Ghost> of_lens(const LensState& lens, const Ghost& ghost) {
  if (has_ghost(lens, ghost)) return ghost;
  return failure(ErrorCode::InvalidArgument,
                 fmt::format("the lens has no ghost {}; give two of its {} surfaces other than {}, which is the stop",
                             ghost_name(ghost), lens.surfaces.size(), lens.stop_index + 1));
}

}  // namespace

CLI::Option* add_ghost_option(CLI::App& command, const std::string& flag, std::string& ghost, const std::string& help) {
  return checked<params::parse_ghost>(command.add_option(flag, ghost, help));
}

CLI::Option* add_ghosts_option(CLI::App& command, std::vector<std::string>& ghosts, const std::string& help) {
  CLI::Option* option = command.add_option("--ghost", ghosts, help)->type_size(1)->expected(1);
  return checked<params::parse_ghosts>(option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll));
}

Result<Ghost> choose_ghost(const LensState& lens, const std::string& text) {
  return of_lens(lens, *params::parse_ghost(text));
}

Result<std::vector<Ghost>> choose_ghosts(const LensState& lens, const std::string& text) {
  std::vector<Ghost> ghosts = *params::parse_ghosts(text);
  for (const Ghost& ghost : ghosts)
    if (const auto good = of_lens(lens, ghost); !good) return tl::unexpected(good.error());
  return ghosts;
}

double wavelength_nm(const params::Values& values, const LensState& lens) {
  return values.real("wavelength").value_or(lens.design_wavelength_nm);
}

}  // namespace contrejour::cli
