// SPDX-License-Identifier: Apache-2.0
// contrejour compare: measures how far picture B differs from picture A.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/options.h"
#include "contrejour/expert/metrics.h"
#include "contrejour/expert/plate.h"

namespace contrejour::cli {
namespace {

constexpr const char* kCompareExamples =
    "PSNR is 10 log10(P^2 / mean square error) over the RGB samples, with both pictures clipped at P and -P, where\n"
    "P is the 99.9th percentile of A. The flux ratio is the sum of B over the sum of A, per channel. Pictures are\n"
    "EXR, PNG, DPX, TIFF, JPEG or HDR, and are compared in scene-linear values.\n\n"
    "Examples:\n"
    "  contrejour compare reference.exr bundle.exr\n"
    "  contrejour compare reference.exr bundle.exr --json\n"
    "  contrejour compare comp.exr flare.exr --layer beauty --layer \"\"";

struct CompareOptions {
  std::string a, b;
  std::vector<std::string> layers, parts;  // one for both pictures, or one for A and one for B
  PlateColour colour;
  bool json = false;
};

// The options of picture 0 or 1.
ReadOptions read_options(const CompareOptions& options, std::size_t picture) {
  const auto chosen = [picture](const std::vector<std::string>& names) {
    return names.empty() ? std::string() : names[std::min(picture, names.size() - 1)];
  };
  ReadOptions read;
  read.layer = chosen(options.layers);
  read.part = chosen(options.parts);
  return read;
}

// The option takes one name at a time, so that pictures may follow it.
void add_names(CLI::App& command, const std::string& flag, std::vector<std::string>& names, const std::string& help) {
  command.add_option(flag, names, help)->allow_extra_args(false)->option_text("NAME");
}

void check_names(const std::string& flag, const std::vector<std::string>& names) {
  if (names.size() > 2)
    throw CLI::ValidationError(
        flag, "is given more than twice; give it once for both pictures, or once for A and once for B");
}

Json comparison_json(const Comparison& c) {
  return {{"psnr_db", c.psnr_db ? Json(*c.psnr_db) : Json()},
          {"peak", c.peak},
          {"max_abs_error", c.max_abs_error},
          {"flux_ratio", c.flux_ratio},
          {"non_finite_mismatches", c.non_finite_mismatches}};
}

std::string comparison_text(const Comparison& c) {
  std::string text = c.psnr_db ? fmt::format("PSNR           {:.3f} dB\n", *c.psnr_db) : "PSNR           equal\n";
  text += fmt::format("peak           {:.9g}\nlargest error  {:.9g}\nflux ratio    ", c.peak, c.max_abs_error);
  for (const double ratio : c.flux_ratio) text += fmt::format(" {:.9g}", ratio);
  if (c.non_finite_mismatches > 0)
    text += fmt::format("\nnot finite in one picture only: {} samples", c.non_finite_mismatches);
  return text + "\n";
}

Result<int> run_compare(const CompareOptions& options) {
  const auto plate_a = read_plate(options.a, read_options(options, 0), options.colour);
  if (!plate_a) return tl::unexpected(plate_a.error());
  const auto plate_b = read_plate(options.b, read_options(options, 1), options.colour);
  if (!plate_b) return tl::unexpected(plate_b.error());
  const Picture &a = plate_a->picture, &b = plate_b->picture;
  const auto comparison = compare(a.rgb, b.rgb);
  if (!comparison) {
    Error error = comparison.error();
    error.position.file = options.b;
    return tl::unexpected(error);
  }
  if (a.data_window.x != b.data_window.x || a.data_window.y != b.data_window.y) {
    print_warnings({"the data windows have different positions; pixels are compared by their order in the files"});
  }
  if (options.json) {
    print_json(comparison_json(*comparison));
  } else {
    print(comparison_text(*comparison));
  }
  return kDone;
}

}  // namespace

void add_compare(CLI::App& app, Action& action) {
  const auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand("compare", "compare two pictures: PSNR, largest error, flux ratio");
  command->add_option("A", options->a, "the reference picture")->required()->option_text(" ");
  command->add_option("B", options->b, "the picture to compare with it")->required()->option_text(" ");
  add_names(*command, "--layer", options->layers,
            "the layer of EXR files to read; give it twice for different layers of A and B (\"\": the default)");
  add_names(*command, "--part", options->parts,
            "the part of EXR files to read, by name or by number from 0; give it twice for different parts of A and B");
  command->add_flag("--json", options->json, "print JSON");
  add_plate_colour(*command, options->colour, PlateUse::Read);
  command->footer(kCompareExamples);
  command->callback([options, &action] {
    check_names("--layer", options->layers);
    check_names("--part", options->parts);
    action = [options] { return run_compare(*options); };
  });
}

}  // namespace contrejour::cli
