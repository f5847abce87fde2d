// SPDX-License-Identifier: Apache-2.0
// Lines in a host's viewer, by its draw suite (OpenFX 1.5) or by OpenGL, as older hosts have it: their context is
// current while an overlay is drawn. Thread-safety: the host's main thread only.
#pragma once

#include <span>

#include "openfx/host.h"

namespace contrejour::openfx {

class OverlayLines {
 public:
  // context: of the draw suite; null: OpenGL. Draws nothing where neither is there.
  OverlayLines(const Host& host, DrawContext context);

  void set_colour(const ColourF& colour) const;
  void draw(DrawPrimitive primitive, std::span<const PointD> points) const;

 private:
  const DrawSuite* suite_;
  DrawContext context_;
};

}  // namespace contrejour::openfx
