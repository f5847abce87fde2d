// SPDX-License-Identifier: Apache-2.0
// The report of exports.h.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "contrejour/expert/coating.h"
#include "contrejour/expert/lens_section.h"
#include "contrejour/expert/preview_exposure.h"
#include "contrejour/expert/source_renderer.h"
#include "contrejour/expert/svg.h"
#include "studio/core/coating_curves.h"
#include "studio/core/exports.h"
#include "studio/core/picture_files.h"
#include "studio/core/prescription_table.h"

namespace contrejour::studio {
namespace {

constexpr std::size_t kReportedGhosts = 30;

constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{0}</title><style>
body {{ font: 15px/1.5 system-ui, sans-serif; color: #1c2128; max-width: 1180px; margin: 32px auto; padding: 0 24px; }}
h1 {{ font-size: 26px; margin: 0; }} h2 {{ font-size: 18px; margin: 36px 0 8px; }} p {{ color: #57606a; margin: 4px 0; }}
img {{ width: 100%; border-radius: 4px; background: #fff; }} img.picture {{ background: #000; }}
table {{ border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }}
th {{ text-align: left; font-weight: 600; border-bottom: 2px solid #d0d7de; }}
td, th {{ padding: 3px 14px 3px 0; }} td {{ border-bottom: 1px solid #eaeef2; }}
i {{ display: inline-block; width: 22px; height: 12px; border-radius: 3px; }}
</style></head><body>
<h1>{0}</h1>
)";

std::string row(const std::vector<std::string>& cells, const char* tag = "td") {
  std::string html = "<tr>";
  for (const std::string& cell : cells) html += fmt::format("<{0}>{1}</{0}>", tag, cell);
  return html + "</tr>\n";
}

std::string colour_html(const Rgb& rgb) {
  const double brightest = std::fmax(1e-30, std::fmax(rgb[0], std::fmax(rgb[1], rgb[2])));
  const auto code = [&](double v) {
    return static_cast<int>(255 * std::pow(std::clamp(v / brightest, 0.0, 1.0), 1 / 2.2));
  };
  return fmt::format("<i style=\"background:rgb({},{},{})\"></i>", code(rgb[0]), code(rgb[1]), code(rgb[2]));
}

Result<std::string> picture_html(const ExportOrder& order, const Context& context) {
  const params::Values values = order.document.values();
  auto renderer = renderer_of(values, FlareSource(*order.lens));
  if (!renderer) return tl::unexpected(renderer.error());
  const auto drawn =
      draw_picture({values, order.lens, order.plate, order.document.plate}, std::get<Renderer>(*renderer), context);
  if (!drawn) return tl::unexpected(drawn.error());
  const Image picture = picture_of(*drawn);
  const auto otherwise = order.plate ? params::DefaultExposure::None : params::DefaultExposure::Automatic;
  const auto png = preview_png(picture, params::preview_settings(values, picture, otherwise), context);
  if (!png) return tl::unexpected(png.error());
  return "<img class=\"picture\" alt=\"The picture\" src=\"" + data_uri("image/png", *png) + "\">\n";
}

std::string section_html(const ExportOrder& order) {
  const std::string svg = section_svg(lens_section(*order.lens));
  return "<h2>Section</h2>\n<img alt=\"Section of the lens\" src=\"" +
         data_uri("image/svg+xml", std::as_bytes(std::span(svg))) + "\">\n";
}

std::string ghosts_html(const ExportOrder& order) {
  double all = 0;
  for (const GhostFigures& f : order.figures) all += f.relative_flux;
  std::string html =
      fmt::format("<h2>Ghosts</h2>\n<p>{} ghosts carry {:.2f} per cent of the light; the brightest:</p>\n<table>\n",
                  order.figures.size(), 100 * all);
  html += row({"", "Ghost", "Colour", "Flux, per cent", "Peak", "Size, pixels", "In focus"}, "th");
  for (std::size_t k = 0; k < std::min(kReportedGhosts, order.figures.size()); ++k) {
    const GhostFigures& f = order.figures[k];
    html += row({fmt::format("{}", k + 1), ghost_name(f.ghost), colour_html(f.rgb),
                 fmt::format("{:.3g}", 100 * f.relative_flux), fmt::format("{:.3g}", f.peak_irradiance),
                 fmt::format("{:.0f} x {:.0f}", f.size_px.x, f.size_px.y), f.in_focus ? "yes" : ""});
  }
  return html + "</table>\n";
}

std::string prescription_html(const ExportOrder& order) {
  const Prescription& lens = *order.document.lens;
  std::vector<std::string> heads = {"Surface"};
  for (const LensColumn column : kLensColumns) heads.push_back(markup_text(heading_of(column)));
  heads.emplace_back("Reflectance");
  std::string html = "<h2>Prescription</h2>\n<table>\n" + row(heads, "th");
  for (std::size_t k = 0; k < lens.surfaces.size(); ++k) {
    std::vector<std::string> cells = {fmt::format("{}", k + 1)};
    for (const LensColumn column : kLensColumns) cells.push_back(markup_text(cell_text(lens, k, column)));
    const bool reflects =
        k < order.lens->surfaces.size() && !(order.lens->surfaces[k].before == order.lens->surfaces[k].after);
    cells.push_back(reflects ? fmt::format("{} {:.2f} %", colour_html(reflected_rgb(order.lens->surfaces[k])),
                                           100 * luminous_reflectance(order.lens->surfaces[k]))
                             : "");
    html += row(cells);
  }
  return html + "</table>\n";
}

std::string settings_html(const Document& document) {
  std::string html = "<h2>Settings</h2>\n<p>What is not listed has its default.</p>\n<table>\n";
  html += row({"Parameter", "Value", "Unit"}, "th");
  for (const auto& [name, texts] : document.texts)
    html +=
        row({name, markup_text(fmt::format("{}", fmt::join(texts, " "))), markup_text(params::parameter(name).unit)});
  return html + "</table>\n";
}

}  // namespace

Result<std::string> report_html(const ExportOrder& order, const Context& context) {
  const auto picture = picture_html(order, context);
  if (!picture) return tl::unexpected(picture.error());
  const Document& document = order.document;
  const std::string name = document.lens->name.empty() ? document.lens_name : document.lens->name;
  std::string html = fmt::format(fmt::runtime(kHead), markup_text(name));
  html += fmt::format("<p>{:.4g} mm, f/{:.3g}, {} surfaces{}</p>\n", order.lens->focal_length_mm, order.lens->f_number,
                      document.lens->surfaces.size(), document.lens_was_edited ? ", edited" : "");
  html += *picture + section_html(order) + ghosts_html(order) + prescription_html(order) + settings_html(document);
  return html + "</body></html>\n";
}

}  // namespace contrejour::studio
