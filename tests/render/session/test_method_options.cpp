// SPDX-License-Identifier: Apache-2.0
// The options of any method in one type, and render()'s errors for those that belong to no method.
#include <span>

#include <doctest/doctest.h>

#include "contrejour/render.h"
#include "support/scenes.h"

using namespace contrejour;

namespace {

struct UnknownOptions {
  static constexpr std::string_view kMethod = "no-such-method";
};

struct OtherOptions {
  static constexpr std::string_view kMethod = "bundle";
};

}  // namespace

TEST_CASE("options know their method and their type") {
  MethodOptions options = BundleOptions{.mirror_symmetry = true};
  CHECK(options.name() == "bundle");
  CHECK(options.get_if<TiledOptions>() == nullptr);
  REQUIRE(options.get_if<BundleOptions>() != nullptr);
  CHECK(options.get_if<BundleOptions>()->mirror_symmetry);
  options.get_if<BundleOptions>()->grid.rays = 7;
  const MethodOptions copy = options;
  CHECK(copy.get_if<BundleOptions>()->grid.rays == 7);
}

TEST_CASE("every method has default options of its own name") {
  for (const std::string_view method : render_methods()) {
    const auto options = method_options(method);
    REQUIRE(options.has_value());
    CHECK(options->name() == method);
  }
  CHECK_FALSE(method_options("no-such-method").has_value());
}

TEST_CASE("options of no method, and of another type than the method's, are refused") {
  const LensState lens = test::bundled("heliar");
  const FrameSettings settings = test::green(frame_on_sensor(lens, 12, 8));
  const Light light = test::light_at(lens, settings.frame, {0.7, 0.3});
  CHECK(render(BundleOptions{}, lens, std::span(&light, 1), settings).has_value());
  for (const MethodOptions& wrong : {MethodOptions(UnknownOptions{}), MethodOptions(OtherOptions{})}) {
    const auto refused = render(wrong, lens, std::span(&light, 1), settings);
    REQUIRE_FALSE(refused.has_value());
    CHECK(refused.error().code == ErrorCode::InvalidArgument);
  }
}
