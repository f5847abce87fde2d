// SPDX-License-Identifier: Apache-2.0
// The handles in a host's viewer.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "scenes.h"
#include "support/approx.h"

using namespace contrejour::openfx;

namespace {

// A viewer of an instance, by one of the two kinds of overlay.
class Viewer {
 public:
  Viewer(const TestHost& host, EffectStruct& effect, const char* kind) {
    const auto described = host.describe(context::kFilter);
    entry_ = reinterpret_cast<EntryPoint>(described->properties.get<void*>(kind));
    REQUIRE((entry_ != nullptr));
    interact_.properties.put<void*>(name::kEffectInstance, {&effect});
    CHECK(entry_(action::kCreateInstance, &interact_, nullptr, nullptr) == status::kOk);
  }
  ~Viewer() { CHECK(entry_(action::kDestroyInstance, &interact_, nullptr, nullptr) == status::kOk); }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  Status act(const char* action, double x, double y, DrawContextStruct* drawing = nullptr) {
    PropertySetStruct in;
    in.put<double>(name::kTime, {1.0});
    in.put<double>(name::kPixelScale, {0.5, 0.5});
    in.put<double>(name::kPenPosition, {x, y});
    if (drawing != nullptr) in.put<void*>(name::kDrawContext, {drawing});
    return entry_(action, &interact_, &in, nullptr);
  }

 private:
  EntryPoint entry_ = nullptr;
  InteractStruct interact_;
};

}  // namespace

TEST_CASE("openfx: a light is dragged in the viewer, others stay, and a click beside it is not taken") {
  const TestHost host;
  for (const char* kind : {name::kOverlayV1, name::kOverlayV2}) {
    const Scene scene(host, context::kFilter, kBounds, 640, 480);
    scene.effect().set("light2On", {1.0});
    scene.effect().set("light2Position", {0.25, 0.5});  // at 160, 240
    Viewer viewer(host, scene.effect(), kind);
    CHECK(viewer.act(action::kPenMotion, 160, 240) == status::kReplyDefault);
    CHECK(viewer.act(action::kPenDown, 166, 240) == status::kReplyDefault);  // 12 pixels of the screen
    CHECK(viewer.act(action::kPenDown, 480, 300) == status::kReplyDefault);  // light 1, which is off
    CHECK(viewer.act(action::kPenDown, 162, 240) == status::kOk);
    CHECK(viewer.act(action::kPenMotion, 322, 120) == status::kOk);
    CHECK(viewer.act(action::kPenUp, 482, 120) == status::kOk);
    CHECK(viewer.act(action::kPenMotion, 0, 0) == status::kReplyDefault);
    CHECK(scene.effect().param("light2Position").numbers[0] == test::approx(0.75));
    CHECK(scene.effect().param("light2Position").numbers[1] == test::approx(0.25));
    CHECK(scene.effect().param("light1Position").numbers[0] == kLightX);
    CHECK(viewer.act("OfxInteractActionKeyDown", 0, 0) == status::kReplyDefault);
  }
}

TEST_CASE("openfx: a handle is drawn at each light that is on") {
  const TestHost host;
  const Scene scene(host, context::kFilter, kBounds, 640, 480);
  Viewer viewer(host, scene.effect(), name::kOverlayV2);
  DrawContextStruct drawing;
  CHECK(viewer.act(action::kDraw, 0, 0, &drawing) == status::kOk);
  CHECK(drawing.points.empty());
  scene.effect().set("light1On", {1.0});
  CHECK(viewer.act(action::kDraw, 0, 0, &drawing) == status::kOk);
  REQUIRE_FALSE(drawing.points.empty());
  for (const PointD& point : drawing.points) {
    CHECK(std::abs(point.x - kLightX * 640) < 10.0);
    CHECK(std::abs(point.y - kLightY * 480) < 10.0);
  }
  Viewer by_opengl(host, scene.effect(), name::kOverlayV1);
  CHECK(by_opengl.act(action::kDraw, 0, 0) == status::kOk);  // no OpenGL in this process: nothing is drawn
}

TEST_CASE("openfx: a viewer that outlives its instance takes nothing") {
  const TestHost host;
  const auto effect = host.create(context::kFilter, 640, 480);
  effect->set("light1On", {1.0});
  Viewer viewer(host, *effect, name::kOverlayV2);
  host.destroy(*effect);
  DrawContextStruct drawing;
  CHECK(viewer.act(action::kDraw, 0, 0, &drawing) == status::kReplyDefault);
  CHECK(viewer.act(action::kPenDown, 480, 300) == status::kReplyDefault);
}
