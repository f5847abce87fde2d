#include "cli/lens_choice.h"

#include <fmt/format.h>

#include "cli/console.h"
#include "cli/glass_choice.h"
#include "params/settings.h"

namespace contrejour::cli {

CLI::Option* add_lens_argument(CLI::App& command, std::string& lens) {
  return command.add_option("LENS", lens, "a bundled lens (see `contrejour lens list`) or a file")
      ->required()
      ->option_text(" ");
}

Result<Prescription> prescription_of(const std::string& lens) {
  const auto glasses = own_glasses();
  if (!glasses) return tl::unexpected(glasses.error());
  return find_lens(lens, &*glasses);
}

Result<LensState> open_lens(const std::string& lens, const params::Values& values) {
  const auto prescription = prescription_of(lens);
  if (!prescription) return tl::unexpected(prescription.error());
  const auto settings = params::lens_settings(values);
  if (!settings) return tl::unexpected(settings.error());
  auto state = lens_at(*prescription, *settings);
  if (state) print_warnings(state->warnings);
  return state;
}

CLI::Option* add_ghost_option(CLI::App& command, std::string& ghost, const std::string& help) {
  const auto problem = [](const std::string& text) {
    const auto parsed = params::parse_ghost(text);
    return parsed ? std::string() : parsed.error().message;
  };
  return command.add_option("--ghost", ghost, help)->check(CLI::Validator(problem, "", "ghost"))->option_text("I,J");
}

Result<Ghost> choose_ghost(const LensState& lens, const std::string& text) {
  const Ghost ghost = *params::parse_ghost(text);
  if (has_ghost(lens, ghost)) return ghost;
  return failure(ErrorCode::InvalidArgument,
                 fmt::format("there is no ghost {}: the lens has {} surfaces and number {}, the stop, does not reflect",
                             ghost_name(ghost), lens.surfaces.size(), lens.stop_index + 1));
}

double wavelength_nm(const params::Values& values, const LensState& lens) {
  return values.real("wavelength").value_or(lens.design_wavelength_nm);
}

}  // namespace contrejour::cli
