// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/svg.h"

#include <fmt/format.h>

namespace contrejour {
Svg::Svg(double width, double height) : width_(width), height_(height) {}

void Svg::rectangle(Vec2 corner, Vec2 size, const std::string& style) {
  body_ += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" {}/>\n", corner.x, corner.y,
                       size.x, size.y, style);
}

void Svg::line(Vec2 from, Vec2 to, const std::string& style) {
  body_ += fmt::format("<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" {}/>\n", from.x, from.y, to.x,
                       to.y, style);
}

void Svg::polyline(const std::vector<Vec2>& points, const std::string& style) {
  body_ += "<polyline points=\"";
  for (const Vec2 p : points) body_ += fmt::format("{:.2f},{:.2f} ", p.x, p.y);
  body_ += fmt::format("\" fill=\"none\" {}/>\n", style);
}

void Svg::path(const std::string& data, const std::string& style) {
  body_ += fmt::format("<path d=\"{}\" {}/>\n", data, style);
}

void Svg::circle(Vec2 centre, double radius, const std::string& style) {
  body_ += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" {}/>\n", centre.x, centre.y, radius, style);
}

void Svg::text(Vec2 position, const std::string& words, const std::string& style) {
  body_ +=
      fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" {}>{}</text>\n", position.x, position.y, style, markup_text(words));
}

void Svg::begin_clip(Vec2 corner, Vec2 size) {
  ++clips_;
  body_ += fmt::format(
      "<clipPath id=\"clip{}\"><rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"/>"
      "</clipPath>\n<g clip-path=\"url(#clip{})\">\n",
      clips_, corner.x, corner.y, size.x, size.y, clips_);
}

void Svg::end_clip() { body_ += "</g>\n"; }

std::string Svg::finish() const {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"Helvetica, Arial, sans-serif\">\n{2}</svg>\n",
      width_, height_, body_);
}

}  // namespace contrejour
