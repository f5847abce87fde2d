// SPDX-License-Identifier: Apache-2.0
// A few elements of SVG, written as text. Coordinates are in pixels, y downwards. Thread-safety: plain values.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/expert/vec.h"
#include "contrejour/export.h"

namespace contrejour {

// The text with the characters escaped that mean something in HTML and SVG, quotes included, so that it may stand in an
// attribute; control characters, which XML does not allow, become spaces.
[[nodiscard]] CONTREJOUR_API std::string markup_text(std::string_view text);

// A file within a page: a `data:` address (RFC 2397) with its bytes in base64 (RFC 4648). media_type: "image/png".
[[nodiscard]] CONTREJOUR_API std::string data_uri(std::string_view media_type, std::span<const std::byte> bytes);

class CONTREJOUR_API Svg {
 public:
  Svg(double width, double height);

  // style: presentation attributes as written, e.g. `stroke="#000"`.
  void rectangle(Vec2 corner, Vec2 size, const std::string& style);
  void line(Vec2 from, Vec2 to, const std::string& style);
  void polyline(const std::vector<Vec2>& points, const std::string& style);
  void path(const std::string& data, const std::string& style);
  void circle(Vec2 centre, double radius, const std::string& style);
  void text(Vec2 position, const std::string& words, const std::string& style);

  void begin_clip(Vec2 corner, Vec2 size);  // until end_clip, nothing outside is drawn
  void end_clip();

  [[nodiscard]] std::string finish() const;

 private:
  std::string body_;
  double width_, height_;
  int clips_ = 0;
};

}  // namespace contrejour
