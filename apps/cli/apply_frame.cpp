// SPDX-License-Identifier: Apache-2.0
#include "cli/apply_frame.h"

#include <utility>

#include <fmt/format.h>

#include "cli/apply_report.h"
#include "cli/flare_report.h"
#include "cli/options.h"
#include "contrejour/expert/apply_files.h"
#include "contrejour/expert/preview_exposure.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

Result<ApplyFiles> open_apply_files(const ApplyOptions& options, Outputs& outputs) {
  ApplyFiles files;
  const std::pair<const std::string&, OutputFile*&> all[] = {{options.output, files.output},
                                                             {options.flare_only, files.flare_only},
                                                             {options.detected, files.detected},
                                                             {options.preset.save, files.preset},
                                                             {options.preview, files.preview}};
  if (auto ok = outputs.add_all(all); !ok) return tl::unexpected(ok.error());
  return files;
}

Result<void> write_preview(const ApplyOptions& options, OutputFile& file, const Image& rgb, const Context& context) {
  const PreviewSettings preview = params::preview_settings(options.values, rgb, params::DefaultExposure::None);
  return write_preview_png(file, rgb, preview, context);
}

Result<void> write_result(const PlannedPhotograph& planned, const Context& context) {
  const auto& [options, lens, outputs, files, picture, plan, source, exposure] = planned;
  const std::string ending = lower_extension(options.output);
  const bool is_usual =
      source == nullptr && options.colour.output_space.empty() && (ending == ".exr" || ending == ".png");
  if (!is_usual) return write_plate(*files.output, picture, source, options.colour, context);
  return plan.lights.empty() ? copy_photograph(*files.output, options.input, picture, options.values, context)
                             : contrejour::write_photograph(*files.output, picture, options.values, context);
}

// The flare of a plan, with layers where the options ask for them.
Result<PictureLayers> draw_plan(FlarePlan& plan, const PlannedPhotograph& planned, const params::Values& values,
                                SourceRenderer& renderer, const Context& context) {
  const Image& rgb = planned.picture.rgb;
  if (planned.options.layers.on()) {
    const auto options = layer_options(planned.options.layers, plan.lights.size() - plan.given_light_count);
    if (!options) return tl::unexpected(options.error());
    return render_flare_layers(plan, rgb, values, renderer, *options, context);
  }
  auto flare = render_flare(plan, rgb, values, renderer, context);
  if (!flare) return tl::unexpected(flare.error());
  return PictureLayers{std::move(*flare), {}};
}

// The mean over the time for which the shutter is open. Lights are found anew at each time, because the same place of
// the picture is another direction when the focal length changes.
Result<FlaredPhotograph> render_exposure(PlannedPhotograph&& planned, SourceRenderer& renderer,
                                         const Context& context) {
  const double error =
      params::frame_settings(planned.options.values, planned.plan.grid.frame, planned.plan.space).area_error;
  auto exposed = planned.exposure->expose(
      [&](const FrameMoment& moment, const Context& within) -> Result<LayeredFlare> {
        auto plan = plan_flare(planned.picture, *moment.lens, moment.values);
        if (!plan) return tl::unexpected(plan.error());
        auto drawn = draw_plan(*plan, planned, moment.values, renderer, within);
        if (!drawn) return tl::unexpected(drawn.error());
        return LayeredFlare{std::move(drawn->flare.image), std::move(drawn->layers),
                            std::move(drawn->flare.statistics)};
      },
      renderer, error, context);
  if (!exposed) return tl::unexpected(exposed.error());
  LayeredFlare& flare = exposed->flare;
  PictureFlare whole{std::move(flare.image), std::move(flare.statistics), {}};
  whole.visibility = visibility_of(planned.picture.rgb, whole.image, planned.plan.found, planned.plan.space);
  return FlaredPhotograph{std::move(planned), std::move(whole), std::move(flare.layers), exposed->drawn};
}

Result<void> write_flare(const FlaredPhotograph& flared, const Context& context) {
  const PlannedPhotograph& planned = flared.planned;
  Picture alone = aligned_picture(flared.flare.image, planned.picture, planned.plan);
  alone.exr_compression = planned.options.compression;
  if (planned.options.layers.on()) add_layers(alone, flared.layers, planned.options.layers);
  return write_picture(*planned.files.flare_only, alone, context);
}

}  // namespace

Result<PlannedPhotograph> read_photograph(const ApplyOptions& options, std::shared_ptr<const LensState> lens) {
  auto plate = read_plate(options.input, options.read, options.colour);
  if (!plate) return tl::unexpected(plate.error());
  return plan_photograph(options, std::move(lens), std::move(*plate));
}

Result<PlannedPhotograph> plan_photograph(const ApplyOptions& options, std::shared_ptr<const LensState> lens,
                                          Plate plate) {
  PlannedPhotograph planned{options, std::move(lens), {}, {}, std::move(plate.picture), {}, std::move(plate.source)};
  planned.picture.exr_compression = options.compression;
  auto files = open_apply_files(options, planned.outputs);
  if (!files) return tl::unexpected(files.error());
  planned.files = *files;
  auto plan = plan_flare(planned.picture, *planned.lens, options.values);
  if (!plan) {
    if (plan.error().position.file.empty()) plan.error().position.file = options.input;
    return tl::unexpected(plan.error());
  }
  planned.plan = std::move(*plan);
  return planned;
}

Result<FlaredPhotograph> render_photograph(PlannedPhotograph&& planned, SourceRenderer& renderer,
                                           const Context& context) {
  if (planned.exposure) return render_exposure(std::move(planned), renderer, context);
  auto drawn = draw_plan(planned.plan, planned, planned.options.values, renderer, context);
  if (!drawn) return tl::unexpected(drawn.error());
  return FlaredPhotograph{std::move(planned), std::move(drawn->flare), std::move(drawn->layers)};
}

// The detected lights are drawn over the photograph without flare, so they are written before the flare is added.
Result<void> write_photograph(FlaredPhotograph& flared, const Context& context) {
  auto& [options, lens, outputs, files, picture, plan, source, exposure] = flared.planned;
  const Image& flare = flared.flare.image;
  Result<void> ok;
  if (files.detected) ok = write_detected(*files.detected, picture, plan, context);
  if (!ok) return ok;
  add_flare(picture.rgb, flare);
  ok = write_result(flared.planned, context);
  if (ok && files.flare_only) ok = write_flare(flared, context);
  if (ok && files.preset) ok = files.preset->write(params::write_preset({{}, {}, options.lens, options.values}));
  if (ok && files.preview) ok = write_preview(options, *files.preview, picture.rgb, context);
  return ok ? outputs.commit() : ok;
}

Json frame_json(const FlaredPhotograph& flared) {
  const auto& [options, lens, outputs, files, picture, plan, source, exposure] = flared.planned;
  Json json = {{"lens", lens->name}, {"input", options.input}, {"output", options.output}};
  json.update(report_json(plan));
  json["drawn"] = flared.drawn;
  json["flare"] = visibility_json(flared.flare.visibility);
  json["statistics"] = plan.lights.empty() ? Json() : stats_json(flared.flare.statistics);
  return json;
}

std::string frame_text(const FlaredPhotograph& flared) {
  const RenderStatistics& statistics = flared.flare.statistics;
  return fmt::format("{}: {} ghosts, {:.2f} s\n", flared.planned.options.output, statistics.ghosts_rendered,
                     total_ms(statistics) / 1000.0);
}

}  // namespace contrejour::cli
