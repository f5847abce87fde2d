// SPDX-License-Identifier: Apache-2.0
#include "studio/core/studio.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/settings.h"
#include "studio/core/keys.h"
#include "studio/core/lights.h"

namespace contrejour::studio {
namespace {

// Settings that do not change the image of a light while it moves: other ghosts, and how the picture is shown.
bool leaves_stars_alone(std::string_view name) {
  return name == "light-at" || name == "select" || name == "ghost" || name == "exposure" || name == "error";
}

// Lights by their directions have no handle that could move them, and no star layers.
std::vector<StarLight> stars_of(const Document& document) {
  if (document.texts.contains("light")) return {};
  // Lights of the plate have no handles, and its gain is not that of the values.
  if (document.has_plate() &&
      (document.text("detect") == "on" || document.texts.contains("gain") || document.texts.contains("stops")))
    return {};
  std::string common = fmt::format("{}", static_cast<const void*>(document.lens.get()));
  for (const auto& [name, texts] : document.texts)
    if (!leaves_stars_alone(name)) common += fmt::format(" {}={}", name, fmt::join(texts, ","));
  std::vector<StarLight> stars;
  for (const LightEntry& light : lights_of(document))
    stars.push_back(
        {light.at, fmt::format("{} {}:{}:{}:{}", common, light.value, light.colour, light.size, light.distance)});
  return stars;
}

}  // namespace

Studio::Studio(std::string how_opened, Document first, StudioSettings settings)
    : history_(std::move(how_opened), std::move(first)), look_folders_(settings.looks),
      looks_(all_looks(settings.looks.own)), autosave_(settings.autosave_folder),
      picture_job_(picture_work(), settings.jobs), display_job_(display_work(), settings.jobs, JobPriority::Interface),
      figures_job_(figures_work(), settings.jobs), section_job_(section_work(), settings.jobs, JobPriority::Interface),
      export_job_([](const ExportTask& task, auto& control) { control.publish({task.file, task.write()}); },
                  settings.jobs),
      plates_(settings.jobs), detection_job_(detection_work(), settings.jobs), views_job_(views_work(), settings.jobs),
      compare_job_(compare_work(), settings.jobs), thumbnail_job_(thumbnail_work(), settings.jobs),
      point_spread_job_(point_spread_work(), settings.jobs), frames_job_(frames_work(), settings.jobs),
      cache_job_(cache_work(frame_cache_), settings.jobs), measured_job_(measured_work(), settings.jobs) {
  auto lens = params::lens_of(*document().lens, document().values());
  if (!lens) {
    refuse(lens.error(), "");
    history_ = History("first scene", first_document());
    lens = params::lens_of(*document().lens, document().values());
  }
  lens_ = std::make_shared<const LensState>(std::move(*lens));
  take_view(document());
  post_work();
}

bool Studio::refuse(const Error& error, const std::string& key) {
  problem_ = error.to_string();
  problem_key_ = key;
  return false;
}

bool Studio::edit(const std::string& name, const std::string& merge_key, const Edit& edit) {
  return adopt(edit(document()), name, merge_key);
}

bool Studio::adopt_whole(Result<Document> document, const std::string& name, const std::string& merge_key) {
  if (document && document->animation != Animation{}) document = at_frame(std::move(*document), view.frame);
  return push(std::move(document), name, merge_key);
}

bool Studio::adopt(Result<Document> document, const std::string& name, const std::string& merge_key) {
  if (document) document = with_keys_of_edit(this->document(), std::move(*document), view.frame);
  return push(std::move(document), name, merge_key);
}

bool Studio::push(Result<Document> document, const std::string& name, const std::string& merge_key) {
  if (!document) return refuse(document.error(), merge_key);
  auto lens = params::lens_of(*document->lens, document->values());
  if (!lens) return refuse(lens.error(), merge_key);
  problem_.clear();
  problem_key_.clear();
  message_ = name;
  history_.push(name, merge_key, std::move(*document));
  lens_ = std::make_shared<const LensState>(std::move(*lens));
  document_changed();
  return true;
}

Vec2 Studio::frame_px() const {
  const auto size = params::parse_size(document().text("size"));
  return size ? Vec2{static_cast<double>(size->width), static_cast<double>(size->height)} : Vec2{1920, 1080};
}

void Studio::undo() { go_to_step(history_.can_undo() ? history_.position() - 1 : history_.position()); }
void Studio::redo() { go_to_step(history_.position() + 1); }

bool Studio::add_light(Vec2 at) {
  const auto lights = lights_of(document());
  LightEntry light = lights.empty() ? LightEntry{} : lights[std::min(selection.light, lights.size() - 1)];
  light.at = at;
  if (!edit("add light", "", [&](const Document& d) { return with_new_light(d, light); })) return false;
  select_light(lights.size());
  say(fmt::format("light {} added; Ctrl+Z takes it away", lights.size() + 1));
  return true;
}

void Studio::go_to_step(std::size_t step) {
  const std::size_t before = history_.position();
  history_.go_to(step);
  const std::size_t now = history_.position();
  problem_.clear();
  problem_key_.clear();
  if (now + 1 == before)
    say("undone: " + history_.steps()[before].name);
  else if (now == before + 1)
    say("redone: " + history_.steps()[now].name);
  else if (now != before)
    say("back to: " + history_.steps()[now].name);
  if (document().animation != Animation{}) history_.replace_now(at_frame(document(), view.frame));
  auto lens = params::lens_of(*document().lens, document().values());  // it was configured before
  if (lens) lens_ = std::make_shared<const LensState>(std::move(*lens));
  document_changed();
}

void Studio::document_changed() {
  ++revision_;
  const std::size_t lights = lights_of(document()).size();
  if (selection.light >= lights) selection.light = lights > 0 ? lights - 1 : 0;
  if (selection.surface > static_cast<int>(document().lens->surfaces.size())) selection.surface = 0;
  if (selection.ghost && !has_ghost(*lens_, *selection.ghost)) selection.ghost.reset();
  post_work();
}

void Studio::post_work() {
  if (is_playing()) play(false);
  post_picture();
  post_point_spread();
  figures_job_.post({revision_, document().values(), lens_, selection.light});
  refresh_section();
}

// While its plate is read the picture before stays: the answer of the reading calls this again.
void Studio::post_picture() {
  frame_of_picture_ = view.frame;
  auto plate = this->plate();
  if (!plate && plates_.is_reading(document().plate, view.frame)) return;
  picture_job_.post(
      {revision_, document().values(), lens_, stars_of(document()), std::move(plate), brightest_ghosts()});
}

std::vector<Ghost> Studio::brightest_ghosts() const {
  std::vector<double> radii;
  for (const LightEntry& light : lights_of(document())) radii.push_back(radius_of(light.at, frame_px()));
  std::vector<Ghost> brightest;
  if (ranks_ && !radii.empty() && !document().texts.contains("light")) {
    brightest = brightest_at(*ranks_, radii);
  } else {
    for (const GhostFigures& f : figures_) brightest.push_back(f.ghost);
  }
  std::erase_if(brightest, [&](const Ghost& ghost) { return !has_ghost(*lens_, ghost); });
  return brightest;
}

void Studio::refresh_section() {
  SectionOrder order{lens_, selection.ghost, 0};
  if (const auto light = light_of(document().values(), *lens_, selection.light))
    order.light_rad = angle_from_axis_rad(*light);
  section_job_.post(std::move(order));
}

void Studio::select_ghost(std::optional<Ghost> ghost) {
  selection.ghost = ghost;
  if (ghost && !ghost->reflects_at(selection.surface)) selection.surface = ghost->j;  // whose coating one changes
  refresh_section();
}

void Studio::select_light(std::size_t light) {
  if (selection.light == light) return;
  selection.light = light;
  figures_job_.post({revision_, document().values(), lens_, light});
  refresh_section();
  post_point_spread();
}

void Studio::refresh_display() {
  if (!picture_.image) return;
  const std::string exposure = document().text("exposure");
  const auto stops = params::parse_real(exposure);
  DisplayOrder order{picture_};
  order.transform = view.transform;
  order.colour = view.colour;
  order.automatic = !stops.has_value();
  order.stops = stops.value_or(0.0);
  order.compare = compare_;
  if (compare_.snapshot < snapshots_.size()) order.snapshot = snapshots_[compare_.snapshot].image;
  display_job_.post(std::move(order));
}

void Studio::take_display() {
  auto shown = display_job_.take();
  if (!shown) return;
  if (is_playing()) return;
  if (!shown->error.empty() && shown->error != shown_.error) take_problem(shown->error);
  shown_ = std::move(*shown);
  ++shown_count_;
  ++changes_;
}

void Studio::take_section(SectionAnswer section) {
  section_ = std::move(section);
  ++changes_;
}

void Studio::take_problem(const std::string& problem) {
  refuse({ErrorCode::InvalidArgument, problem, {}}, "");
  ++changes_;
}

void Studio::say(std::string message) {
  message_ = std::move(message);
  ++changes_;
}

void Studio::update() {
  if (auto picture = picture_job_.take()) {
    if (!picture->error.empty()) take_problem(picture->error);
    if (picture->image) {
      picture_ = std::move(*picture);
      refresh_display();
      post_comparison();
    }
  }
  take_display();
  if (auto figures = figures_job_.take(); figures && figures->error.empty()) {
    figures_ = std::move(figures->figures);
    footprints_ = std::move(figures->footprints);
    ranks_ = std::move(figures->ranks);
    figures_revision_ = figures->revision;
    ++changes_;
  }
  if (auto section = section_job_.take()) take_section(std::move(*section));
  take_background_work();
  if (is_playing()) show_playing_frame();
  if (!is_saved()) static_cast<void>(autosave_.save(document(), file_));
}

bool Studio::is_idle() const {
  return picture_job_.is_idle() && display_job_.is_idle() && figures_job_.is_idle() && section_job_.is_idle() &&
         export_job_.is_idle() && plates_.is_idle() && detection_job_.is_idle() && views_job_.is_idle() &&
         compare_job_.is_idle() && thumbnail_job_.is_idle() && point_spread_job_.is_idle() && frames_job_.is_idle() &&
         cache_job_.is_idle() && measured_job_.is_idle();
}

}  // namespace contrejour::studio
