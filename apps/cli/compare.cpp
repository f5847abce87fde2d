// contrejour compare: how far picture B is from picture A.
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "contrejour/image_io.h"
#include "contrejour/metrics.h"

namespace contrejour::cli {
namespace {

constexpr const char* kExamples =
    "PSNR is 10 log10(P^2 / mean square error) over the RGB samples, both pictures clipped at P and -P, P being the\n"
    "99.9th percentile of A. The flux ratio is the sum of B over the sum of A, per channel.\n\n"
    "Examples:\n"
    "  contrejour compare reference.exr bundle.exr\n"
    "  contrejour compare reference.exr bundle.exr --json";

struct CompareOptions {
  std::string a, b;
  bool json = false;
};

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
  if (c.non_finite_mismatches > 0) text += fmt::format("\nnot finite in one only: {} samples", c.non_finite_mismatches);
  return text + "\n";
}

Result<int> run_compare(const CompareOptions& options) {
  const auto a = read_picture(options.a);
  if (!a) return tl::unexpected(a.error());
  const auto b = read_picture(options.b);
  if (!b) return tl::unexpected(b.error());
  const auto comparison = compare(a->rgb, b->rgb);
  if (!comparison) {
    Error error = comparison.error();
    error.place.file = options.b;
    return tl::unexpected(error);
  }
  if (a->data_window.x != b->data_window.x || a->data_window.y != b->data_window.y) {
    print_warnings({"the data windows lie at different places; pixels are compared by their order in the files"});
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
  CLI::App* command = app.add_subcommand("compare", "PSNR, largest error and flux ratio of two pictures");
  command->add_option("A", options->a, "the picture taken as true")->required()->option_text(" ");
  command->add_option("B", options->b, "the other")->required()->option_text(" ");
  command->add_flag("--json", options->json, "as JSON");
  command->footer(kExamples);
  command->callback([options, &action] { action = [options] { return run_compare(*options); }; });
}

}  // namespace contrejour::cli
