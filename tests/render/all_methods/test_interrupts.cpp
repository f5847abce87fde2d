// SPDX-License-Identifier: Apache-2.0
// A render that is cancelled at any moment returns an error; it neither fails in another way nor returns an incomplete
// picture.
#include <atomic>
#include <chrono>
#include <thread>

#include "render/all_methods/methods.h"
#include "support/sanitized.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

using Clock = std::chrono::steady_clock;

struct Case {
  std::string name;
  bool is_of_the_driver;  // common to all methods: tested with one of them
  LensState lens;
  test::Settings settings;
  std::vector<Light> lights;
};

// Every stage, each in its own case and once all together.
std::vector<Case> cases() {
  const LensState clean = bundled("heliar", {.f_number = 16.0, .iris = {6}});
  LensSettings dusty{.f_number = 16.0, .iris = {6}};
  dusty.dirt.dust_per_cm2 = 30.0;
  const LensState dirty = bundled("heliar", dusty);
  test::Settings plain = small_frame(clean, 64, 36);
  plain.reference.density = 0.3;
  test::Settings ringing = plain, hullin = plain, starburst = plain;
  ringing.ringing.mode = RingingMode::Fresnel;
  hullin.ringing.mode = RingingMode::Hullin;
  starburst.starburst.on = true;
  starburst.glare.fraction = 0.1;
  test::Settings all = ringing;
  all.starburst = starburst.starburst;
  all.glare = starburst.glare;
  const Light point = light_at(clean, plain.frame, {0.7, 0.33});
  Light disc = point;
  disc.radius_rad = 0.01;
  return {{"plain", false, clean, plain, {point, point}}, {"dirt", false, dirty, plain, {point}},
          {"ringing", false, clean, ringing, {point}},    {"hullin", true, clean, hullin, {point}},
          {"disc", true, clean, plain, {disc}},           {"starburst", true, clean, starburst, {point}},
          {"all", true, dirty, all, {point, disc}}};
}

}  // namespace

TEST_CASE("interrupted at any moment, a render refuses or has the whole flare") {
  constexpr int kMoments = kSanitized ? 3 : 6;
  for (const Case& c : cases()) {
    for_each_method([&](const Bounds& bounds) {
      if (bounds.method != render_methods().front() && c.is_of_the_driver) return;
      CAPTURE(c.name);
      const auto began = Clock::now();
      const Image whole = image_of(bounds, c.lens, c.lights, c.settings);
      const auto took = Clock::now() - began;
      int refused = 0;
      for (int k = 0; k < kMoments; ++k) {
        std::atomic<bool> cancel = k == 0;  // on a busy machine all other cancellations may come too late
        std::thread stopper([&, until = Clock::now() + took * k / kMoments] {
          std::this_thread::sleep_until(until);
          cancel = true;
        });
        const auto flare =
            render(bounds.method, c.lens, c.lights, c.settings, {.threads = 1 + k % 2, .cancel = &cancel});
        stopper.join();
        if (flare) {
          CHECK(flare->image.pixels == whole.pixels);
          continue;
        }
        CHECK(flare.error().code == ErrorCode::Cancelled);
        ++refused;
      }
      CHECK(refused > 0);
    });
  }
}
