// SPDX-License-Identifier: Apache-2.0
// contrejour lens convert: converts a lens of any known format to TOML, Zemax or CODE V, by the file's extension.
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/lens_choice.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "contrejour/expert/write_lens.h"
#include "contrejour/lens.h"

namespace contrejour::cli {
namespace {

struct ConvertOptions {
  std::string input, output;
};

Result<WrittenLens> written_lens(const Prescription& lens, const std::string& file) {
  const std::string ending = lower_extension(file);
  if (ending == ".zmx") return write_lens_zmx(lens);
  if (ending == ".seq") return write_lens_seq(lens);
  return WrittenLens{write_lens_toml(lens), {}};
}

Result<int> run_convert(const ConvertOptions& options) {
  Outputs outputs;
  const auto file = outputs.add(options.output);
  if (!file) return tl::unexpected(file.error());
  const auto lens = prescription_of(options.input);
  if (!lens) return tl::unexpected(lens.error());
  const auto out = written_lens(*lens, options.output);
  if (!out) return tl::unexpected(out.error());
  if (const auto ok = (*file)->write(out->text); !ok) return tl::unexpected(ok.error());
  if (const auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  print_warnings(out->losses);
  print_summary(fmt::format("{}: {}, {} surfaces\n", options.output, lens->name, lens->surfaces.size()));
  return kDone;
}

}  // namespace

void add_lens_convert(CLI::App& lens, Action& action) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = lens.add_subcommand("convert", "convert a lens to TOML, Zemax or CODE V");
  command->add_option("IN", options->input, "a lens file in any known format, or a bundled lens")
      ->required()
      ->option_text(" ");
  add_output(*command, "OUT,-o,--output", options->output, {".toml", ".zmx", ".seq"},
             "the file to write; the extension determines the format")
      ->required();
  command->footer(
      "Examples:\n"
      "  contrejour lens convert heliar my-heliar.toml\n"
      "  contrejour lens convert other.zmx tidy.toml\n"
      "  contrejour lens convert canon-70-200 -o canon.zmx");
  command->callback([options, &action] { action = [options] { return run_convert(*options); }; });
}

}  // namespace contrejour::cli
