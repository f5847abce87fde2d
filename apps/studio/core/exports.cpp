// SPDX-License-Identifier: Apache-2.0
#include "studio/core/exports.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/apply_files.h"
#include "contrejour/expert/frame_pattern.h"
#include "contrejour/expert/picture_layers.h"
#include "contrejour/expert/source_renderer.h"
#include "contrejour/expert/write_lens.h"
#include "contrejour/preset.h"
#include "studio/core/picture_files.h"

namespace contrejour::studio {
namespace {

PictureInput input_of(const ExportOrder& order) {
  return {order.document.values(), order.lens, order.plate, order.document.plate};
}

Result<SourceRenderer> renderer_for(const ExportOrder& order) {
  return renderer_of(order.document.values(), FlareSource(*order.lens));
}

Result<void> write_drawn_picture(const ExportOrder& order, OutputFile& file, const Context& context) {
  auto renderer = renderer_for(order);
  if (!renderer) return tl::unexpected(renderer.error());
  const auto drawn = draw_picture(input_of(order), std::get<Renderer>(*renderer), context);
  if (!drawn) return tl::unexpected(drawn.error());
  return write_drawn(file, *drawn, context);
}

// The flare alone, as `apply --flare-only --layers` writes it.
Result<void> write_plate_layers(const ExportOrder& order, OutputFile& file, Renderer& renderer,
                                const Context& context) {
  const Picture& picture = order.plate->picture;
  const params::Values values = order.document.values();
  const auto plan = plan_flare(picture, *order.lens, values);
  if (!plan) return tl::unexpected(plan.error());
  LayerOptions options;
  options.by = order.layers_by;
  options.light_names.resize(plan->lights.size() - plan->given_light_count);
  const auto drawn = render_flare_layers(*plan, picture.rgb, values, renderer, options, context);
  if (!drawn) return tl::unexpected(drawn.error());
  Picture alone = aligned_picture(drawn->flare.image, picture, *plan);
  add_layer_channels(alone, drawn->layers);
  return write_picture(file, alone, context);
}

Result<void> write_layers(const ExportOrder& order, OutputFile& file, const Context& context) {
  auto renderer = renderer_for(order);
  if (!renderer) return tl::unexpected(renderer.error());
  if (order.plate) return write_plate_layers(order, file, std::get<Renderer>(*renderer), context);
  const auto request = picture_request(order.document.values(), *order.lens);
  if (!request) return tl::unexpected(request.error());
  LayerOptions options;
  options.by = order.layers_by;
  const auto drawn = render_picture_layers(*request, *renderer, options, context);
  if (!drawn) return tl::unexpected(drawn.error());
  Picture picture = contrejour::picture_of(drawn->image);
  set_colour_space(picture, request->settings.colour_space);
  set_pixel_aspect(picture, request->pixel_aspect);
  add_layer_channels(picture, drawn->layers);
  return write_picture(file, picture, context);
}

Result<void> write_lens(const ExportOrder& order, OutputFile& file) {
  const std::string extension = file.destination().extension().string();
  const Prescription& lens = *order.document.lens;
  if (extension == ".toml") return file.write(write_lens_toml(lens));
  const auto written = extension == ".zmx" ? write_lens_zmx(lens) : write_lens_seq(lens);
  return written ? file.write(written->text) : tl::unexpected(written.error());
}

// A look names the lens that it was made for; that of an edited lens is its original's.
Result<void> write_look(const ExportOrder& order, OutputFile& file) {
  const std::string name = file.destination().stem().string();
  return file.write(params::write_preset({name, "", order.document.lens_name, order.document.values()}));
}

Result<void> write_report(const ExportOrder& order, OutputFile& file, const Context& context) {
  const auto html = report_html(order, context);
  return html ? file.write(*html) : tl::unexpected(html.error());
}

Result<void> check_name(const ExportOrder& order) {
  const std::string extension = std::filesystem::path(order.file).extension().string();
  const auto must = [&](bool fits, const char* names) -> Result<void> {
    if (fits) return {};
    return failure(ErrorCode::Unsupported, fmt::format("give a name that ends in {}", names), {order.file});
  };
  switch (order.kind) {
    case ExportKind::Picture: return check_picture_name(order.file, order.plate != nullptr);
    case ExportKind::Layers: return must(extension == ".exr", ".exr");
    case ExportKind::Lens:
      return must(extension == ".toml" || extension == ".zmx" || extension == ".seq", ".toml, .zmx or .seq");
    case ExportKind::Look: return must(extension == ".toml", ".toml");
    case ExportKind::Report: return must(extension == ".html", ".html");
    case ExportKind::Frames: break;
  }
  return invalid_argument("frames are exported one after the other");
}

Result<void> write_kind(const ExportOrder& order, OutputFile& file, const Context& context) {
  switch (order.kind) {
    case ExportKind::Layers: return write_layers(order, file, context);
    case ExportKind::Lens: return write_lens(order, file);
    case ExportKind::Look: return write_look(order, file);
    case ExportKind::Report: return write_report(order, file, context);
    default: return write_drawn_picture(order, file, context);
  }
}

}  // namespace

const char* name_of(ExportKind kind) {
  static constexpr const char* names[] = {"Picture", "Layers", "Frames", "Lens", "Look", "Report"};
  return names[static_cast<std::size_t>(kind)];
}

const char* help_of(ExportKind kind) {
  static constexpr const char* helps[] = {
      "The picture: .exr, scene-linear, or .png, a preview",
      "The flare in layers that sum to it, in one .exr",
      "All frames of the timeline's range: #### stands for the number of a frame",
      "The lens as it is now: .toml, .zmx (Zemax) or .seq (CODE V)",
      "All settings but the scene's, as a preset for other scenes: .toml",
      "One page of pictures and tables, without other files: .html",
  };
  return helps[static_cast<std::size_t>(kind)];
}

std::string usual_file(ExportKind kind) {
  static constexpr const char* files[] = {"flare.exr", "layers.exr", "flare.####.exr",
                                          "lens.toml", "look.toml",  "report.html"};
  return files[static_cast<std::size_t>(kind)];
}

std::vector<std::string_view> endings_of(ExportKind kind) {
  switch (kind) {
    case ExportKind::Picture:
    case ExportKind::Frames: return {".exr", ".png"};
    case ExportKind::Layers: return {".exr"};
    case ExportKind::Lens: return {".toml", ".zmx", ".seq"};
    case ExportKind::Look: return {".toml"};
    case ExportKind::Report: return {".html"};
  }
  return {};
}

Result<void> check_export(const ExportOrder& order) {
  if (auto ok = check_name(order); !ok) return ok;
  const auto file = OutputFile::create(order.file);  // goes away without a commit
  return file ? Result<void>() : tl::unexpected(file.error());
}

bool would_replace(ExportKind kind, const std::string& file, int first_frame, int last_frame) {
  std::error_code code;
  if (kind != ExportKind::Frames) return std::filesystem::is_regular_file(file, code);
  const auto pattern = parse_frame_pattern(file);
  const auto frames = pattern ? frames_on_disk(*pattern) : Result<std::vector<int>>(std::vector<int>());
  return frames && std::ranges::any_of(*frames, [&](int frame) { return frame >= first_frame && frame <= last_frame; });
}

Result<void> export_file(const ExportOrder& order, const Context& context) {
  if (auto ok = check_name(order); !ok) return ok;
  auto file = OutputFile::create(order.file);
  if (!file) return tl::unexpected(file.error());
  if (auto ok = write_kind(order, *file, context); !ok) return ok;
  return file->commit();
}

}  // namespace contrejour::studio
