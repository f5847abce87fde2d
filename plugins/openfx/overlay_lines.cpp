// SPDX-License-Identifier: Apache-2.0
#include "openfx/overlay_lines.h"

#if !defined(_WIN32)
#include <dlfcn.h>
#endif

namespace contrejour::openfx {
namespace {

// The host's own OpenGL, of the process: hosts without a viewer have none, so nothing is linked.
template <class Function>
Function gl_function([[maybe_unused]] const char* name) {
#if defined(_WIN32)
  return nullptr;
#else
  return reinterpret_cast<Function>(dlsym(RTLD_DEFAULT, name));
#endif
}

void gl_set_colour(const ColourF& colour) {
  if (const auto set = gl_function<void (*)(float, float, float, float)>("glColor4f"))
    set(colour.r, colour.g, colour.b, colour.a);
}

// OpenGL's numbers of lines, line strips and line loops (GL_LINES 1, GL_LINE_STRIP 3, GL_LINE_LOOP 2).
void gl_draw(DrawPrimitive primitive, std::span<const PointD> points) {
  const auto begin = gl_function<void (*)(unsigned int)>("glBegin");
  const auto vertex = gl_function<void (*)(double, double)>("glVertex2d");
  const auto end = gl_function<void (*)()>("glEnd");
  if (begin == nullptr || vertex == nullptr || end == nullptr) return;
  constexpr unsigned int kModes[] = {1, 3, 2};
  begin(kModes[primitive]);
  for (const PointD& point : points) vertex(point.x, point.y);
  end();
}

}  // namespace

OverlayLines::OverlayLines(const Host& host, DrawContext context)
    : suite_(context != nullptr ? host.drawing : nullptr), context_(context) {}

void OverlayLines::set_colour(const ColourF& colour) const {
  if (suite_ != nullptr)
    suite_->set_colour(context_, &colour);
  else
    gl_set_colour(colour);
}

void OverlayLines::draw(DrawPrimitive primitive, std::span<const PointD> points) const {
  if (suite_ != nullptr)
    suite_->draw(context_, primitive, points.data(), static_cast<int>(points.size()));
  else
    gl_draw(primitive, points);
}

}  // namespace contrejour::openfx
