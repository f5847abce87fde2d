// SPDX-License-Identifier: Apache-2.0
// Edits of documents as the values that the command line takes, and their history.
#include <cmath>
#include <random>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "contrejour/expert/ghost.h"
#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/settings.h"
#include "studio/core/coating_curves.h"
#include "studio/core/command_line.h"
#include "studio/core/ghost_edits.h"
#include "studio/core/ghost_summary.h"
#include "studio/core/history.h"
#include "studio/core/lights.h"
#include "studio/core/prescription_table.h"
#include "support/approx.h"

namespace contrejour::studio {
namespace {

std::string text_of(const Document& document) { return write_session(session_of(document)); }

TEST_CASE("lights keep what else is said of them while they move") {
  Document d = first_document();
  d = *with_lights(d, {{{0.25, 0.75}, "100000lx", "3200K", "0.53", "2m"}, {{1.5, -0.25}, "", "led", "", ""}});
  CHECK(d.list("light-at") ==
        std::vector<std::string>{"0.25000,0.75000:100000lx:3200K:0.53:2m", "1.50000,-0.25000::led"});
  d = *with_light_at(d, 0, {0.5, 0.125});
  const auto lights = lights_of(d);
  REQUIRE(lights.size() == 2);
  CHECK(lights[0] == LightEntry{{0.5, 0.125}, "100000lx", "3200K", "0.53", "2m"});
  CHECK(lights[1] == LightEntry{{1.5, -0.25}, "", "led", "", ""});
}

TEST_CASE("a value that the table refuses is an error, and so is a picture without a light") {
  Document d = *with_lights(first_document(), {{}});
  CHECK_FALSE(without_light(d, 0));
  CHECK_FALSE(with_light(d, 0, {{0.5, 0.5}, "bright", "", "", ""}));
  d = *with_new_light(d, {{1e9, 0.5}, "", "", "", ""});
  CHECK(lights_of(d)[1].at.x == 20.0);
  CHECK(without_light(d, 0));
}

TEST_CASE("ghosts that are alone or muted are the values select and ghost") {
  Document d = with_all_ghosts(first_document());
  const Ghost a{2, 5}, b{3, 8};
  d = *with_solo(*with_solo(d, b, true), a, true);
  CHECK(d.text("select") == "list:2-5,3-8");
  CHECK(is_solo(d, a));
  CHECK(has_solo(d));
  d = *with_solo(*with_solo(d, a, false), b, false);
  CHECK(d.text("select") == "all");
  d = *with_tint(*with_mute(d, a, true), b, {1, 0.5, 0.25});
  CHECK(is_muted(d, a));
  CHECK(adjustment_of(d, b).colour == Rgb{1, 0.5, 0.25});
  d = *with_tint(*with_mute(d, a, false), b, {1, 1, 1});
  CHECK(d.list("ghost").empty());
}

TEST_CASE("the ghosts of one surface are the value select, once more all ghosts") {
  Document d = with_all_ghosts(first_document());
  d = *with_ghosts_of_surface(d, 11);
  CHECK(d.text("select") == "surface:11");
  CHECK_FALSE(has_solo(d));
  CHECK(with_ghosts_of_surface(d, 12)->text("select") == "surface:12");
  CHECK(with_ghosts_of_surface(d, 11)->text("select") == "all");
}

TEST_CASE("a ghost is drawn unless it is muted, others are solo, or another surface's are chosen") {
  const Document document = first_document();
  const Ghost a{2, 5}, b{3, 8};
  CHECK(is_drawn(document, a));
  CHECK_FALSE(is_drawn(*with_mute(document, a, true), a));
  CHECK(is_drawn(*with_mute(document, a, true), b));
  CHECK(is_drawn(*with_solo(document, a, true), a));
  CHECK_FALSE(is_drawn(*with_solo(document, a, true), b));
  CHECK(is_drawn(*with_ghosts_of_surface(document, 8), b));
  CHECK_FALSE(is_drawn(*with_ghosts_of_surface(document, 8), a));
}

TEST_CASE("a surface has one coating, that of its last edit") {
  Document d = first_document();
  d.texts.erase("coating-at");
  d.texts.erase("coating");
  const std::string own = coating_of_surface(d, 1);
  CHECK(own == cell_text(*d.lens, 0, LensColumn::Coating));
  d = *with_surface_coating(*with_surface_coating(d, 1, "v-coat"), 1, "quarter-wave:500");
  CHECK(d.list("coating-at") == std::vector<std::string>{"1:quarter-wave:500"});
  CHECK(coating_of_surface(d, 1) == "quarter-wave:500");
  CHECK(*design_wavelength_nm(d, 1) == 500);
  CHECK(with_design_wavelength("quarter-wave:500:1.45", 620) == "quarter-wave:620.0:1.45");
  CHECK_FALSE(with_surface_coating(d, 1, "paint"));
  // The lens's file calls its own films by a name, which is no value.
  CHECK(own == "amber");
  CHECK(with_surface_coating(d, 1, "amber")->list("coating-at").empty());
  d = *with_value(d, "coating", "v-coat");
  CHECK(with_surface_coating(d, 1, "amber")->list("coating-at") == std::vector<std::string>{"1:quarter-wave:480:1.38"});
}

TEST_CASE("the luminous reflectance is that of the curve under the eye's sensitivity") {
  // Bare crown glass, and six films that hardly reflect but at the end of the spectrum.
  Document d = first_document();
  const auto reflectance_with = [&](const char* coating) {
    const Document coated = *with_surface_coating(d, 1, coating);
    const auto lens = params::lens_of(*coated.lens, coated.values());
    return std::pair(luminous_reflectance(lens->surfaces[0]), reflectance_curves(lens->surfaces[0]));
  };
  const double n = refractive_index(d.lens->surfaces[0].glass_after, 555);
  CHECK(reflectance_with("none").first == test::approx((n - 1) * (n - 1) / ((n + 1) * (n + 1))).epsilon(0.01));
  const auto [mean, curves] = reflectance_with("broadband-6");
  // The eye's sensitivity as a normal distribution about 559 nm, 42 nm wide.
  double sum = 0, weights = 0;
  for (std::size_t k = 0; k < kCurvePoints; ++k) {
    const double from = (380 + 360.0 * static_cast<double>(k) / (kCurvePoints - 1) - 559) / 42;
    weights += std::exp(-0.5 * from * from);
    sum += std::exp(-0.5 * from * from) * curves.reflectance[0][k];
  }
  CHECK(mean == test::approx(sum / weights).epsilon(0.15));
  CHECK(curves.reflectance[0][0] > 5 * mean);
}

TEST_CASE("the line over the list of ghosts says whose they are, and which are shown") {
  Document d = first_document();
  std::vector<GhostFigures> figures(20);
  for (int k = 0; k < 20; ++k) {
    figures[static_cast<std::size_t>(k)].ghost = {1, k + 2};
    figures[static_cast<std::size_t>(k)].relative_flux = 0.0001;
  }
  CHECK(summary_of_ghosts(d, figures, 0, 20) == "20 ghosts, 0.20 % of the light; ten carry 50 % of it");
  CHECK(summary_of_ghosts(*with_solo(d, {1, 4}, true), figures, 0, 20) ==
        "1 of 20 ghosts shown (solo), 0.01 % of the light");
  CHECK(summary_of_ghosts(*with_mute(d, {1, 4}, true), figures, 0, 20).starts_with("19 of 20 ghosts shown"));
  d = *with_new_light(d, {{0.6, 0.6}, "", "", "", ""});
  CHECK(summary_of_ghosts(d, figures, 1, 3).starts_with("Light 2: 3 listed of 20 ghosts"));
}

TEST_CASE("the command line quotes what a shell would take apart") {
  Document d = first_document();
  d.lens_name = "it's mine.toml";
  d.texts = {{"light-at", {"-0.2,0.3:900"}}, {"starburst", {"on"}}, {"mirror-symmetry", {"off"}}};
  CHECK(command_of_values(d, {.output = "a b.exr"}) ==
        "contrejour render 'it'\\''s mine.toml' --light-at=-0.2,0.3:900 "
        "--no-mirror-symmetry --starburst -o 'a b.exr'");
  d.lens_was_edited = true;
  CHECK(command_of_values(d, {.output = "a.exr"}).empty());
}

TEST_CASE("commands of one gesture are one step until it ends") {
  History history("open", first_document());
  for (int k = 1; k <= 5; ++k)
    history.push("move light 1", "light/0/at", *with_light_at(history.now(), 0, {0.1 * k, 0.5}));
  CHECK(history.steps().size() == 2);
  history.seal();
  history.push("move light 1", "light/0/at", *with_light_at(history.now(), 0, {0.9, 0.5}));
  CHECK(history.steps().size() == 3);
  history.undo();
  CHECK(lights_of(history.now())[0].at.x == test::approx(0.5));
  history.push("set fnumber", "parameter/fnumber", *with_value(history.now(), "fnumber", "11"));
  CHECK(history.steps().size() == 3);
  CHECK_FALSE(history.can_redo());
  CHECK_FALSE(history.is_saved());
  history.go_to(0);
  CHECK(history.is_saved());
}

// Any command at all, the same for the same numbers; as the panels make them.
Result<Document> random_edit(const Document& d, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  const auto part = [&] { return static_cast<double>(random() % 1000) / 1000.0; };
  const Ghost ghost{static_cast<int>(1 + below(3)), static_cast<int>(5 + below(4))};
  switch (below(9)) {
    case 0: return with_light_at(d, below(lights_of(d).size()), {2 * part() - 0.5, part()});
    case 1: return with_new_light(d, {{part(), part()}, "500", "", "", ""});
    case 2: return without_light(d, below(lights_of(d).size()));
    case 3: return with_value(d, "fnumber", fmt::format("{:.2f}", 4 + 12 * part()));
    case 4: return with_mute(d, ghost, below(2) == 0);
    case 5: return with_solo(d, ghost, below(2) == 0);
    case 6: return with_surface_coating(d, static_cast<int>(1 + below(8)), below(2) == 0 ? "v-coat" : "none");
    case 7: return Result<Document>(without_value(d, "fnumber"));
    default: {
      const std::size_t row = below(d.lens->surfaces.size());
      auto lens = with_cell(*d.lens, row, LensColumn::SemiDiameter, fmt::format("{:.3f}", 5 + 3 * part()));
      if (!lens) return tl::unexpected(lens.error());
      return with_edited_lens(d, std::move(*lens));
    }
  }
}

TEST_CASE("2000 random commands are undone and redone to the same documents") {
  std::mt19937 random(7);
  History history("open", first_document());
  std::vector<std::size_t> hashes = {std::hash<std::string>{}(text_of(history.now()))};
  int refused = 0;
  for (int k = 0; k < 2000; ++k) {
    auto next = random_edit(history.now(), random);
    refused += next ? 0 : 1;
    if (!next) continue;
    history.push("edit", "", std::move(*next));
    hashes.push_back(std::hash<std::string>{}(text_of(history.now())));
  }
  CHECK(refused < 400);
  REQUIRE(history.steps().size() == hashes.size());
  std::size_t wrong = 0;
  for (std::size_t k = hashes.size(); k-- > 0; history.undo())
    wrong += std::hash<std::string>{}(text_of(history.now())) == hashes[k] ? 0 : 1;
  CHECK_FALSE(history.can_undo());
  for (const std::size_t hash : hashes) {
    wrong += std::hash<std::string>{}(text_of(history.now())) == hash ? 0 : 1;
    history.redo();
  }
  CHECK(wrong == 0);
}

}  // namespace
}  // namespace contrejour::studio
