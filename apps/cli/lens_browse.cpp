// SPDX-License-Identifier: Apache-2.0
// contrejour lens browse: writes a page of many lenses, each with its section and its flare.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/lens_choice.h"
#include "cli/lens_page.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/expert/lens_section.h"
#include "contrejour/expert/preview_exposure.h"
#include "contrejour/expert/settings.h"
#include "contrejour/image_io.h"
#include "contrejour/render.h"

namespace contrejour::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLensBrowseExamples =
    "The page needs no network. Each picture is exposed for its own brightest parts; its card states the exposure.\n\n"
    "Examples:\n"
    "  contrejour lens browse -o lenses.html\n"
    "  contrejour lens browse my-lenses/ heliar -f 8 --blades 7 -o lenses.html\n"
    "  contrejour lens browse *.zmx --light 12,8 --wavelengths 8 --size 640x360 -o sharp.html";

constexpr const char* kPictureSize = "320x180";

struct BrowseOptions {
  std::vector<std::string> lenses;
  std::string output;
  params::Values values;
};

// The given files, and all files in given folders and below, in the order of their names.
Result<std::vector<std::string>> expanded_files(const std::vector<std::string>& given) {
  std::vector<std::string> files;
  for (const std::string& name : given) {
    std::error_code error;
    if (!fs::is_directory(name, error)) {
      files.push_back(name);
      continue;
    }
    std::vector<std::string> within;
    for (auto at = fs::recursive_directory_iterator(name, error); !error && at != fs::end(at); at.increment(error))
      if (at->is_regular_file(error)) within.push_back(at->path().string());
    if (error) return failure(ErrorCode::Io, "the folder cannot be listed: " + error.message(), {name});
    std::sort(within.begin(), within.end());
    files.insert(files.end(), within.begin(), within.end());
  }
  if (given.empty())
    for (const BundledLens& bundled : bundled_lenses()) files.emplace_back(bundled.name);
  return files;
}

// The requested f-number, or that of the lens's maximum aperture if it is larger.
Result<LensState> state_of(const Prescription& lens, const params::Values& values) {
  auto settings = params::lens_settings(values);
  if (!settings) return tl::unexpected(settings.error());
  if (settings->f_number) settings->f_number = std::max(*settings->f_number, lens.f_number);
  return configure_lens(lens, *settings);
}

std::string focal_lengths_text(const Prescription& lens, const LensState& state) {
  if (lens.zoom.size() < 2) return fmt::format("{:.4g}", state.focal_length_mm);
  return fmt::format("{:.4g}-{:.4g} at {:.4g}", lens.zoom.front().focal_length_mm, lens.zoom.back().focal_length_mm,
                     state.focal_length_mm);
}

// The luminance of the flare within the frame, relative to that of the light.
double relative_flare(const Image& flare, const Light& light, ColourSpace space) {
  Rgb sum{};
  for (std::size_t k = 0; k < flare.pixels.size(); ++k) sum[k % 3] += flare.pixels[k];
  const double whole = luminance(light.value, space);
  return whole > 0.0 ? luminance(sum, space) / whole : 0.0;
}

Result<LensCard> card_of(const std::string& id, const params::Values& values, const Context& context) {
  const auto lens = prescription_of(id);
  if (!lens) return tl::unexpected(lens.error());
  const auto state = state_of(*lens, values);
  if (!state) return tl::unexpected(state.error());
  const Frame frame = params::whole_frame(values, *state, *params::parse_size(*values.text("size")));
  const ColourSpace space = ColourSpace::Rec709;
  const auto lights = params::lights(values, *state, frame, space);
  if (!lights) return tl::unexpected(lights.error());
  const FrameSettings settings = params::frame_settings(values, frame, space);
  const auto flare = render(params::method_options(values), *state, *lights, settings, context);
  if (!flare) return tl::unexpected(flare.error());
  const PreviewSettings preview = params::preview_settings(values, flare->image, params::DefaultExposure::Automatic);
  auto picture = preview_png(flare->image, preview, context);
  if (!picture) return tl::unexpected(picture.error());
  SectionRequest section;
  section.lambda_nm = state->design_wavelength_nm;
  return LensCard{id,
                  lens->name,
                  lens->source,
                  state->focal_length_mm,
                  state->f_number,
                  focal_lengths_text(*lens, *state),
                  lens->surfaces.size(),
                  enumerate_ghosts(*state, settings.scope).size(),
                  relative_flare(flare->image, lights->front(), space),
                  preview.exposure_stops,
                  section_svg(lens_section(*state, section)),
                  std::move(*picture)};
}

Result<int> run_browse(const BrowseOptions& options) {
  Outputs outputs;
  const auto file = outputs.add(options.output);
  if (!file) return tl::unexpected(file.error());
  const auto files = expanded_files(options.lenses);
  if (!files) return tl::unexpected(files.error());
  std::vector<LensCard> cards;
  std::vector<RefusedLens> refused;
  for (const std::string& id : *files) {
    const LongTask task(fmt::format("lens {} of {}", cards.size() + refused.size() + 1, files->size()),
                        options.values.integer("threads"));
    auto card = card_of(id, options.values, task.context());
    if (card) {
      cards.push_back(std::move(*card));
    } else if (card.error().code == ErrorCode::Cancelled) {
      return tl::unexpected(card.error());
    } else {
      refused.push_back({id, card.error().to_string()});
    }
  }
  if (cards.empty() && !refused.empty())
    return failure(ErrorCode::InvalidArgument, "no lens could be drawn; the first error is: " + refused.front().reason);
  if (const auto ok = (*file)->write(lens_page(cards, refused)); !ok) return tl::unexpected(ok.error());
  if (const auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  print_summary(fmt::format("{}: {} lenses, {} refused\n", options.output, cards.size(), refused.size()));
  return kDone;
}

}  // namespace

void add_lens_browse(CLI::App& lens, Action& action) {
  const auto options = std::make_shared<BrowseOptions>();
  CLI::App* command = lens.add_subcommand("browse", "write a page of many lenses, each with its section and its flare");
  command->add_option("LENS", options->lenses, "lens files, folders or names (default: all bundled lenses)")
      ->option_text("...");
  add_output(*command, "-o,--output", options->output, {".html"}, "the page as HTML")->required();
  add_parameters(*command, options->values, {"light", "light-at", "colour", "light-distance"});
  add_lens_parameters(*command, options->values);
  add_parameters(*command, options->values,
                 {"size", "hfov", "exposure", "method", "error", "wavelengths", "ghosts", "threads"});
  static_cast<void>(options->values.set("size", kPictureSize));
  command->get_option("--size")->description(fmt::format("size of the pictures in pixels (default: {})", kPictureSize));
  command->footer(kLensBrowseExamples);
  command->callback([options, &action] { action = [options] { return run_browse(*options); }; });
}

}  // namespace contrejour::cli
