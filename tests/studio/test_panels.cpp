// SPDX-License-Identifier: Apache-2.0
// The contents of the panels of exports, looks, iris, comparison and frames, without a window.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <doctest/doctest.h>

#include "contrejour/image_io.h"
#include "contrejour/preset.h"
#include "studio/core/command_line.h"
#include "studio/core/lights.h"
#include "studio/core/section_edits.h"
#include "studio/core/studio.h"
#include "studio/studio_scene.h"
#include "support/approx.h"
#include "support/scratch_folder.h"

namespace contrejour::studio {
namespace {

using test::ScratchFolder;

std::string text_of(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST_CASE("layers, lens, look and report are exported; wrong names are refused") {
  const ScratchFolder folder;
  Studio studio("first", small_scene(), {});
  run_until_idle(studio);
  const auto exported = [&](ExportKind kind, const char* name) {
    if (!studio.export_as(kind, (folder / name).string())) return studio.problem();
    run_until_idle(studio);
    return studio.message();
  };
  CHECK(exported(ExportKind::Layers, "layers.exr").starts_with("wrote "));
  const auto layers = read_picture(folder / "layers.exr");
  REQUIRE(layers);
  CHECK(layers->channels.size() == 6);
  CHECK(exported(ExportKind::Lens, "lens.toml").starts_with("wrote "));
  CHECK(write_lens_toml(*find_lens((folder / "lens.toml").string())) == write_lens_toml(*studio.document().lens));
  CHECK(exported(ExportKind::Lens, "lens.zmx").starts_with("wrote "));
  CHECK(exported(ExportKind::Look, "mine.toml").starts_with("wrote "));
  const auto look = params::find_preset((folder / "mine.toml").string());
  REQUIRE(look);
  CHECK(look->name == "mine");
  CHECK(look->lens == "distagon-25");
  CHECK(exported(ExportKind::Report, "report.html").starts_with("wrote "));
  const std::string report = text_of(folder / "report.html");
  for (const char* part : {"<!DOCTYPE html>", "data:image/png;base64,", "data:image/svg+xml;base64,", "105 ghosts",
                           "blade-curvature", "</html>"})
    CHECK_MESSAGE(report.find(part) != std::string::npos, part);
  CHECK(exported(ExportKind::Layers, "layers.png").find(".exr") != std::string::npos);
  CHECK(exported(ExportKind::Report, "report.pdf").find(".html") != std::string::npos);
  CHECK(exported(ExportKind::Lens, "lens.txt").find(".zmx") != std::string::npos);
}

TEST_CASE("each kind of export has its command") {
  const Document d = small_scene();
  CHECK(command_of_values(d, {ExportKind::Layers, "a.exr", LayersBy::Ghost}).ends_with("--layers ghost -o a.exr"));
  CHECK(command_of_values(d, {ExportKind::Lens, "a.zmx"}) == "contrejour lens convert distagon-25 a.zmx");
  CHECK(command_of_values(d, {ExportKind::Report, "a.html"}).empty());
  CHECK(command_of_session(d, "s.session.json", {ExportKind::Frames, "f.####.exr", LayersBy::Part, 1, 12}) ==
        "contrejour render --session s.session.json --frames 1-12 -o 'f.####.exr'");
}

TEST_CASE("looks have thumbnails, which are kept, and the user's own are among them") {
  const ScratchFolder folder;
  const LookFolders folders{folder / "own", {}};
  const auto kept = folder / "kept";
  Studio studio("first", small_scene(), {{}, {}, folders});
  CHECK_FALSE(studio.save_look("a/b"));
  REQUIRE(studio.save_look("Mine"));
  REQUIRE(studio.looks().back().is_own);
  CHECK(studio.looks().back().name == "Mine");

  const std::vector<Look> two = {studio.looks().front(), studio.looks().back()};
  const auto thumbnails_of = [&](const std::vector<Look>& looks) {
    ThumbnailJob job(thumbnail_work(), {});
    job.post({looks, kept});
    Thumbnails all;
    while (!job.is_idle())
      if (auto answer = job.take()) all = std::move(*answer);
    return all;
  };
  const Thumbnails first = thumbnails_of(two);
  REQUIRE(first.size() == 2);
  const Thumbnail& one = *first.at(two[0].source);
  CHECK(one.rgba.size() == static_cast<std::size_t>(kThumbnailWidth * kThumbnailHeight));
  CHECK(std::distance(std::filesystem::directory_iterator(kept), {}) == 2);
  CHECK(first.at(two[0].source)->rgba != first.at(two[1].source)->rgba);
  const Thumbnails again = thumbnails_of(two);
  int worst = 0;  // the kept one went through a file of 8 bits
  for (std::size_t k = 0; k < one.rgba.size(); ++k)
    worst = std::max(worst, std::abs(static_cast<int>(one.rgba[k] & 255U) -
                                     static_cast<int>(again.at(two[0].source)->rgba[k] & 255U)));
  CHECK(worst <= 1);
}

TEST_CASE("a snapshot is compared with what comes after it") {
  Studio studio("first", small_scene(), {});
  run_until_idle(studio);
  REQUIRE(studio.take_snapshot());
  run_until_idle(studio);
  REQUIRE(studio.comparison());
  CHECK_FALSE(studio.comparison()->psnr_db);  // equal
  const auto before = studio.shown().rgba;
  studio.edit("exposure", "", [&](const Document& d) { return with_value(d, "exposure", "9"); });
  studio.edit("move", "", [](const Document& d) { return with_light_at(d, 0, {0.7, 0.6}); });
  run_until_idle(studio);
  REQUIRE(studio.comparison());
  REQUIRE(studio.comparison()->psnr_db);
  CHECK(*studio.comparison()->psnr_db < 40);

  const Image snapshot = *studio.snapshots()[0].image, picture = *studio.shown().picture.image;
  CompareView compare{CompareMode::Wipe, 0, 0.25, 0};
  const Image wiped = compared_image(picture, 1, snapshot, compare);
  for (const int x : {0, 23}) CHECK(wiped.at(x, 30) == snapshot.at(x, 30));
  for (const int x : {24, 95}) CHECK(wiped.at(x, 30) == picture.at(x, 30));
  compare.mode = CompareMode::Difference;
  compare.gain_stops = 2;
  const Image difference = compared_image(picture, 1, snapshot, compare);
  CHECK(difference.at(50, 20) == 4 * std::fabs(picture.at(50, 20) - snapshot.at(50, 20)));

  compare.mode = CompareMode::Wipe;
  compare.edge = 1;
  studio.set_compare(compare);
  run_until_idle(studio);
  CHECK(studio.shown().rgba == displayed(snapshot, 9, ViewTransform::Preview));
  CHECK(studio.restore_snapshot(0));
  run_until_idle(studio);
  CHECK(lights_of(studio.document())[0].at.x == test::approx(0.22));
  CHECK_FALSE(studio.comparison()->psnr_db);
  studio.remove_snapshot(0);
  run_until_idle(studio);
  CHECK(studio.compare_view().mode == CompareMode::Off);
  CHECK(studio.shown().rgba == before);
}

TEST_CASE("the point spread has the arms of the iris, and dirt dims the pupil") {
  Document d = *with_value(*with_value(small_scene(), "blades", "6"), "fnumber", "16");
  d = *with_value(*with_value(d, "blade-curvature", "0"), "blade-rotation", "0");
  d = *with_light_at(d, 0, {0.5, 0.5});
  const auto answer_of = [](const Document& document) {
    PointSpreadJob job(point_spread_work(), {});
    job.post(
        {document.values(), std::make_shared<const LensState>(*params::lens_of(*document.lens, document.values())), 0});
    PointSpreadAnswer answer;
    while (!job.is_idle())
      if (auto next = job.take()) answer = std::move(*next);
    return answer;
  };
  const PointSpreadAnswer clean = answer_of(d);
  REQUIRE(clean.error.empty());
  REQUIRE(clean.pupil.size() == static_cast<std::size_t>(kPupilSide * kPupilSide));
  CHECK(clean.open_fraction == 1);
  CHECK(clean.radius == test::approx(1.0 / 32).epsilon(0.03));
  // Six blades: the levels on a circle about the middle repeat every sixth of a turn, and not every fifth.
  const auto at = [&](double turn) {
    const double angle = 6.283185307179586 * turn;
    const int x = static_cast<int>(kSpreadSide / 2 + 60 * std::cos(angle)),
              y = static_cast<int>(kSpreadSide / 2 - 60 * std::sin(angle));
    return static_cast<double>(clean.spread[static_cast<std::size_t>(y * kSpreadSide + x)] & 255U);
  };
  const auto strength = [&](int times) {
    double c = 0, s = 0;
    for (int k = 0; k < 720; ++k) {
      c += at(k / 720.0) * std::cos(6.283185307179586 * times * k / 720.0);
      s += at(k / 720.0) * std::sin(6.283185307179586 * times * k / 720.0);
    }
    return std::hypot(c, s);
  };
  CHECK(strength(6) > 3 * strength(5));
  // Its middle follows the light over the field.
  const PointSpreadAnswer aside = answer_of(*with_light_at(d, 0, {0.22, 0.25}));
  const auto middle = aside.spread[static_cast<std::size_t>(kSpreadSide / 2 * kSpreadSide + kSpreadSide / 2)];
  CHECK((middle & 255U) > 200);
  d = *with_value(*with_value(d, "dust", "100"), "dust-size", "0.3");
  CHECK(answer_of(d).open_fraction < 0.98);
}

TEST_CASE("frames are cached for playing, and a scrub is no step of the history") {
  Studio studio("first", small_scene(), {});
  studio.view.last_frame = 4;
  const TrackId position{"", 0, LightPart::Position};
  studio.edit("key", "", [&](const Document& d) { return with_key(d, position, 1); });
  studio.go_to_frame(4);
  studio.edit("move", "", [](const Document& d) { return with_light_at(d, 0, {0.62, 0.25}); });
  const std::size_t steps = studio.history().steps().size();
  studio.go_to_frame(2);
  CHECK(studio.history().steps().size() == steps);
  const double x = lights_of(studio.document())[0].at.x;
  CHECK(x > 0.22);
  CHECK(x < 0.62);
  run_until_idle(studio);
  studio.play(true);
  run_until_idle(studio);
  CHECK(studio.frame_cache().count() == 4);
  CHECK(studio.is_playing());
  studio.undo();
  CHECK_FALSE(studio.is_playing());
  run_until_idle(studio);
  CHECK(studio.shown().picture.kind == PictureKind::Refined);
}

TEST_CASE("exported frames are the pictures of their values") {
  const ScratchFolder folder;
  Studio studio("first", *with_value(small_scene(), "size", "48x32"), {});
  studio.view.last_frame = 3;
  const TrackId position{"", 0, LightPart::Position};
  studio.edit("key", "", [&](const Document& d) { return with_key(d, position, 1); });
  studio.go_to_frame(3);
  studio.edit("move", "", [](const Document& d) { return with_light_at(d, 0, {0.6, 0.5}); });
  CHECK_FALSE(studio.export_as(ExportKind::Frames, (folder / "flare.exr").string()));
  CHECK(studio.problem().find("####") != std::string::npos);
  REQUIRE(studio.export_as(ExportKind::Frames, (folder / "f.##.exr").string()));
  run_until_idle(studio);
  CHECK(studio.message() == "wrote 3 of 3 frames");
  for (const int frame : {1, 2, 3}) {
    studio.go_to_frame(frame);
    run_until_idle(studio);
    const auto written = read_picture(folder / fmt::format("f.{:02d}.exr", frame));
    REQUIRE(written);
    CHECK(written->rgb.pixels == studio.shown().picture.image->pixels);
  }
}

TEST_CASE("a surface is moved and bent along the axis") {
  const Prescription lens = *find_lens("tessar");
  const double before = lens.surfaces[1].thickness_mm, behind = lens.surfaces[2].thickness_mm;
  const auto moved = with_surface_dragged(lens, 2, SurfaceGrip::Vertex, 0.2);
  REQUIRE(moved);
  CHECK(moved->surfaces[1].thickness_mm == test::approx(before + 0.2));
  CHECK(moved->surfaces[2].thickness_mm == test::approx(behind - 0.2));
  const Surface& first = lens.surfaces[0];
  CHECK(grip_at(first, 0.1) == SurfaceGrip::Vertex);
  CHECK(grip_at(first, 0.9 * first.semi_diameter_mm) == SurfaceGrip::Rim);
  const auto bent = with_surface_dragged(lens, 0, SurfaceGrip::Rim, 0.1);
  REQUIRE(bent);
  // The sphere meets its rim a tenth of a millimetre farther on.
  const double h = first.semi_diameter_mm;
  const auto sag = [h](double c) { return 1 / c - std::copysign(std::sqrt(1 / (c * c) - h * h), c); };
  CHECK(sag(bent->surfaces[0].curvature_per_mm) - sag(first.curvature_per_mm) == test::approx(0.1).epsilon(0.001));
  CHECK_FALSE(with_surface_dragged(lens, 0, SurfaceGrip::Vertex, 1));
  CHECK_FALSE(with_surface_dragged(lens, 2, SurfaceGrip::Vertex, -1000));
}

}  // namespace
}  // namespace contrejour::studio
