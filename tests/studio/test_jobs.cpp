// SPDX-License-Identifier: Apache-2.0
// Work on other threads: the latest request is answered, drafts come first, pictures are the command line's.
#include <atomic>
#include <chrono>
#include <numeric>
#include <thread>

#include <doctest/doctest.h>

#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/source_renderer.h"
#include "contrejour/image_io.h"
#include "studio/core/display_job.h"
#include "studio/core/document.h"
#include "studio/core/figures_job.h"
#include "studio/core/ghosts_under.h"
#include "studio/core/lights.h"
#include "studio/core/picture_job.h"
#include "support/approx.h"

namespace contrejour::studio {
namespace {

using namespace std::chrono_literals;

template <class Answer, class Job>
std::vector<Answer> answers_until_idle(Job& job) {
  std::vector<Answer> answers;
  const auto start = std::chrono::steady_clock::now();
  while (!job.is_idle() && std::chrono::steady_clock::now() - start < 60s) {
    if (auto answer = job.take()) answers.push_back(std::move(*answer));
    std::this_thread::sleep_for(1ms);
  }
  return answers;
}

PictureOrder small_order(std::uint64_t revision, double u = 0.3) {
  Document d = first_document();
  d = *with_light_at(*with_value(d, "size", "160x96"), 0, {u, 0.3});
  const params::Values values = d.values();
  return {revision, values, std::make_shared<const LensState>(*params::lens_of(*d.lens, values)), {}, {}};
}

TEST_CASE("a request that waits is replaced, and the one in work is asked to stop") {
  std::atomic<int> started = 0;
  std::atomic<bool> was_stopped = false;
  LatestJob<int, int> job(
      [&](int request, auto& control) {
        ++started;
        if (request == 1) was_stopped = !control.rests_for(10s);
        control.publish(request);
      },
      {});
  job.post(1);
  while (started == 0) std::this_thread::sleep_for(1ms);
  for (int k = 2; k <= 50; ++k) job.post(k);
  std::vector<int> answers = answers_until_idle<int>(job);
  REQUIRE_FALSE(answers.empty());
  CHECK(answers.back() == 50);
  CHECK(was_stopped);
  CHECK(started <= 50);
  CHECK(job.is_idle());
}

TEST_CASE("a job that ends does not wait for its work to rest") {
  const auto start = std::chrono::steady_clock::now();
  {
    LatestJob<int, int> job([](int, auto& control) { static_cast<void>(control.rests_for(60s)); }, {});
    job.post(1);
    std::this_thread::sleep_for(20ms);
  }
  CHECK(std::chrono::steady_clock::now() - start < 30s);
}

TEST_CASE("a draft comes first, then the command line's picture, bit for bit") {
  const PictureOrder order = small_order(7);
  PictureJob job(picture_work(), {});
  job.post(order);
  const auto answers = answers_until_idle<PictureAnswer>(job);
  REQUIRE(answers.size() == 2);
  CHECK(answers[0].kind == PictureKind::Draft);
  CHECK(answers[0].pixel_area >= 1);
  CHECK(answers[1].kind == PictureKind::Refined);
  CHECK(answers[1].revision == 7);
  const auto request = picture_request(order.values, *order.lens);
  REQUIRE(request);
  auto renderer = renderer_of(order.values, FlareSource(*order.lens));
  REQUIRE(renderer);
  const auto flare = render_picture(*request, *renderer);
  REQUIRE(flare);
  REQUIRE(answers[1].image);
  CHECK(answers[1].image->pixels == flare->image.pixels);
}

TEST_CASE("a draft has the picture's light, in pixels of another size") {
  PictureOrder order = small_order(1);
  const auto sum_of = [&](const params::Values& values) {
    auto renderer = renderer_of(values, FlareSource(*order.lens));
    const auto flare = render_picture(*picture_request(values, *order.lens), *renderer);
    double sum = 0;
    for (const float value : flare->image.pixels) sum += static_cast<double>(value);
    return sum;
  };
  static_cast<void>(order.values.set("starburst", "off"));
  static_cast<void>(order.values.set("size", "512x288"));
  const double whole = sum_of(order.values);
  CHECK(sum_of(draft_values(order, draft_levels()[1])) == test::approx(whole).epsilon(0.05));
}

TEST_CASE("while a light is dragged there are drafts, and the last picture is that of its last place") {
  PictureJob job(picture_work(), {});
  std::vector<PictureAnswer> answers;
  for (int k = 1; k <= 40; ++k) {
    job.post(small_order(static_cast<std::uint64_t>(k), 0.2 + 0.01 * k));
    std::this_thread::sleep_for(10ms);
    if (auto answer = job.take()) answers.push_back(std::move(*answer));
  }
  for (PictureAnswer& answer : answers_until_idle<PictureAnswer>(job)) answers.push_back(std::move(answer));
  REQUIRE(answers.size() >= 3);
  CHECK(answers.front().revision < 40);
  CHECK(answers.back().kind == PictureKind::Refined);
  CHECK(answers.back().revision == 40);
  for (std::size_t k = 1; k < answers.size(); ++k) CHECK(answers[k].revision >= answers[k - 1].revision);
}

TEST_CASE("a starburst that was shifted to another light is near the one rendered there") {
  const PictureOrder here = small_order(1, 0.4), there = small_order(1, 0.5);
  const auto image_of = [&](const params::Values& values) {
    auto renderer = renderer_of(values, FlareSource(*here.lens));
    return render_picture(*picture_request(values, *here.lens), *renderer)->image;
  };
  const auto with = [](params::Values values, const char* starburst, const char* size) {
    static_cast<void>(values.set("starburst", starburst));
    static_cast<void>(values.set("size", size));
    return values;
  };
  StarLayers layers;
  CHECK_FALSE(layers.have({{{0.4, 0.3}, "a"}}));
  auto renderer = Renderer::create();
  REQUIRE(renderer->set_lens(*here.lens));
  REQUIRE(layers.prepare({{{0.4, 0.3}, "a"}}, with(here.values, "on", "480x270"), *here.lens, *renderer, {}));
  REQUIRE(layers.have({{{0.5, 0.3}, "a"}}));
  CHECK_FALSE(layers.have({{{0.5, 0.3}, "b"}}));

  Image star = image_of(with(there.values, "on", "160x90"));
  const Image ghosts = image_of(with(there.values, "off", "160x90"));
  for (std::size_t k = 0; k < star.pixels.size(); ++k) star.pixels[k] -= ghosts.pixels[k];
  Image shifted(160, 90);
  layers.add({{{0.5, 0.3}, "a"}}, {480, 270}, 3, shifted);
  double sum = 0, moved = 0, difference = 0;
  for (std::size_t k = 0; k < star.pixels.size(); ++k) {
    sum += static_cast<double>(star.pixels[k]);
    moved += static_cast<double>(shifted.pixels[k]);
    difference += std::abs(static_cast<double>(star.pixels[k] - shifted.pixels[k]));
  }
  CHECK(moved == test::approx(sum).epsilon(0.05));
  CHECK(difference < 0.3 * sum);
}

TEST_CASE("late drafts draw the brightest ghosts, unless the user has chosen some") {
  PictureOrder order = small_order(1);
  for (int k = 0; k < 100; ++k) order.brightest.push_back({1, k + 2});
  const DraftLevel coarse{4, "0.1", 3};
  CHECK(draft_values(order, coarse).text("select") == "list:1-2,1-3,1-4");
  CHECK(draft_values(order, draft_levels()[0]).text("select") == "all");
  static_cast<void>(order.values.set("select", "list:2-5"));
  CHECK(draft_values(order, coarse).text("select") == "list:2-5");
  CHECK(draft_values(order, coarse).text("size") == "64x64");
}

TEST_CASE("a picture that cannot be made says why") {
  PictureOrder order = small_order(1);
  static_cast<void>(order.values.set("light", "0,0:1,1,1:1,0.5,0.2"));
  PictureJob job(picture_work(), {});
  job.post(order);
  const auto answers = answers_until_idle<PictureAnswer>(job);
  REQUIRE_FALSE(answers.empty());
  CHECK_FALSE(answers.back().image);
  CHECK(answers.back().error.find("R,G,B") != std::string::npos);
}

TEST_CASE("the view is that of the command line's preview, to one code") {
  Image image(64, 4);
  for (std::size_t k = 0; k < image.pixels.size(); ++k) image.pixels[k] = 0.00002F * static_cast<float>(k * k) - 0.01F;
  for (const bool rolls_off : {true, false}) {
    const auto png = preview_png(image, {.exposure_stops = 1.5, .roll_off_highlights = rolls_off});
    REQUIRE(png);
    const auto picture = read_picture(*png, "preview.png");
    REQUIRE(picture);
    const auto codes = displayed(image, 1.5, rolls_off ? ViewTransform::Preview : ViewTransform::Clipped);
    const auto& samples = picture->channels;
    REQUIRE(samples.size() >= 3);
    int worst = 0;
    for (std::size_t k = 0; k < codes.size(); ++k)
      for (std::size_t c = 0; c < 3; ++c) {
        const auto& channel = samples[static_cast<std::size_t>(picture->rgb_source[c])];
        worst = std::max(
            worst, std::abs(static_cast<int>(channel.samples[k]) - static_cast<int>(codes[k] >> (8 * c) & 0xFFU)));
      }
    CHECK(worst <= 1);
  }
}

TEST_CASE("a picture in ACEScg is shown in the window's primaries") {
  // ACEScg of Rec.709 red, by the matrices that the ACES project publishes.
  auto image = std::make_shared<Image>(1, 1);
  image->pixels = {0.61309F, 0.07020F, 0.02062F};
  DisplayOrder order;
  order.picture.kind = PictureKind::Refined;
  order.picture.image = image;
  order.picture.space = ColourSpace::AcesCg;
  order.transform = ViewTransform::Clipped;
  order.automatic = false;
  DisplayJob job(display_work(), {});
  job.post(order);
  const auto answers = answers_until_idle<DisplayAnswer>(job);
  REQUIRE(answers.size() == 1);
  CHECK((answers[0].rgba[0] & 255U) >= 254);
  CHECK((answers[0].rgba[0] >> 8U & 255U) <= 2);
  CHECK((answers[0].rgba[0] >> 16U & 255U) <= 2);
}

TEST_CASE("false colours tell stops apart") {
  Image image(3, 1);
  for (std::size_t c = 0; c < 3; ++c) {
    image.pixels[c] = 0.18F;
    image.pixels[3 + c] = 0.36F;
    image.pixels[6 + c] = 0;
  }
  const auto codes = displayed(image, 0, ViewTransform::FalseColour);
  CHECK(codes[0] == 0xFF808080U);
  CHECK(codes[1] != codes[0]);
  CHECK(codes[2] == 0xFF000000U);
}

TEST_CASE("figures are those of the light that is asked for, and the section has the ghost's rays") {
  const PictureOrder order = small_order(3);
  FiguresJob figures_job(figures_work(), {});
  figures_job.post({3, order.values, order.lens, 0});
  const auto answers = answers_until_idle<FiguresAnswer>(figures_job);
  REQUIRE(answers.size() == 1);
  const auto& figures = answers[0].figures;
  REQUIRE(figures.size() > 50);
  CHECK(figures[0].relative_flux >= figures[1].relative_flux);
  const auto under = ghosts_under(figures, figures[0].centroid_px);
  CHECK(std::find(under.begin(), under.end(), std::size_t{0}) != under.end());
  CHECK(ghosts_under(figures, {1e9, 0}).empty());

  // Footprints have their figures' middle and size.
  REQUIRE(answers[0].footprints.size() == figures.size());
  CHECK(std::ranges::count_if(answers[0].footprints, [](const auto& f) { return !f.cells_px.empty(); }) <=
        static_cast<std::ptrdiff_t>(kFootprintsByFlux + kFootprintsByPeak));
  int traced = 0;
  for (std::size_t k = 0; k < kFootprintsByFlux; ++k) {
    const GhostFootprint& footprint = answers[0].footprints[k];
    if (footprint.cells_px.size() < 60 || figures[k].in_focus) continue;
    Vec2 low{1e9, 1e9}, high{-1e9, -1e9};
    for (const auto& cell : footprint.cells_px)
      for (const Vec2 p : cell) {
        low = {std::fmin(low.x, p.x), std::fmin(low.y, p.y)};
        high = {std::fmax(high.x, p.x), std::fmax(high.y, p.y)};
      }
    const double tolerance = 2 + 0.2 * std::fmax(figures[k].size_px.x, figures[k].size_px.y);
    CHECK(std::fabs(high.x - low.x - figures[k].size_px.x) < tolerance);
    CHECK(std::fabs(high.y - low.y - figures[k].size_px.y) < tolerance);
    CHECK_FALSE(footprint.contains({high.x + 10, high.y + 10}, 3));
    CHECK(std::accumulate(footprint.cell_light.begin(), footprint.cell_light.end(), 0.0) == test::approx(1.0));
    ++traced;
  }
  CHECK(traced > 5);

  SectionJob section_job(section_work(), {});
  const auto light = light_of(order.values, *order.lens, 0);
  REQUIRE(light);
  CHECK(angle_from_axis_rad(*light) > 0);
  section_job.post({order.lens, figures[0].ghost, angle_from_axis_rad(*light)});
  const auto sections = answers_until_idle<SectionAnswer>(section_job);
  REQUIRE(sections.size() == 1);
  CHECK(std::any_of(sections[0].section->rays.begin(), sections[0].section->rays.end(),
                    [](const SectionRay& ray) { return ray.reflections_mm.size() == 2; }));
  CHECK_FALSE(light_of(order.values, *order.lens, 1));
}

}  // namespace
}  // namespace contrejour::studio
