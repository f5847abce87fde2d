// SPDX-License-Identifier: Apache-2.0
#include "studio/core/studio.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "contrejour/expert/output_file.h"
#include "contrejour/expert/settings.h"
#include "contrejour/image_io.h"
#include "studio/core/export_picture.h"
#include "studio/core/lights.h"

namespace contrejour::studio {
namespace {

constexpr const char* kViewKey = "studio-view";

std::string json_of_view(const View& view) {
  return nlohmann::json{{"zoom", view.zoom},
                        {"pan", {view.pan.x, view.pan.y}},
                        {"transform", static_cast<int>(view.transform)},
                        {"handles", view.shows_handles},
                        {"ghosts", view.shows_ghosts}}
      .dump();
}

View view_of_json(const std::string& text) {
  View view;
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return view;
  const auto number = [&](const char* key, double otherwise) {
    const auto found = json.find(key);
    return found != json.end() && found->is_number() ? found->get<double>() : otherwise;
  };
  const auto flag = [&](const char* key) {
    const auto found = json.find(key);
    return found == json.end() || !found->is_boolean() || found->get<bool>();
  };
  view.zoom = std::clamp(number("zoom", 1.0), 0.1, 32.0);
  if (const auto pan = json.find("pan"); pan != json.end() && pan->is_array() && pan->size() == 2)
    if ((*pan)[0].is_number() && (*pan)[1].is_number()) view.pan = {(*pan)[0].get<double>(), (*pan)[1].get<double>()};
  view.transform = static_cast<ViewTransform>(std::clamp(static_cast<int>(number("transform", 0)), 0, 2));
  view.shows_handles = flag("handles");
  view.shows_ghosts = flag("ghosts");
  return view;
}

// Settings that do not change the image of a light while it moves: other ghosts, and how the picture is shown.
bool leaves_stars_alone(std::string_view name) {
  return name == "light-at" || name == "select" || name == "ghost" || name == "exposure" || name == "error";
}

// Lights by their directions have no handle that could move them, and no star layers.
std::vector<StarLight> stars_of(const Document& document) {
  if (document.texts.contains("light")) return {};
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
    : history_(std::move(how_opened), std::move(first)), autosave_(settings.autosave_folder),
      picture_job_(picture_work(), settings.wake), display_job_(display_work(), settings.wake),
      figures_job_(figures_work(), settings.wake), section_job_(section_work(), settings.wake),
      export_job_([](const std::function<std::string()>& work, auto& control) { control.publish(work()); },
                  settings.wake) {
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

bool Studio::adopt(Result<Document> document, const std::string& name, const std::string& merge_key) {
  if (!document) return refuse(document.error(), merge_key);
  auto lens = params::lens_of(*document->lens, document->values());
  if (!lens) return refuse(lens.error(), merge_key);
  problem_.clear();
  problem_key_.clear();
  history_.push(name, merge_key, std::move(*document));
  lens_ = std::make_shared<const LensState>(std::move(*lens));
  document_changed();
  return true;
}

void Studio::undo() { go_to_step(history_.can_undo() ? history_.position() - 1 : history_.position()); }
void Studio::redo() { go_to_step(history_.position() + 1); }

void Studio::go_to_step(std::size_t step) {
  history_.go_to(step);
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
  const params::Values values = document().values();
  std::vector<Ghost> brightest;
  for (const GhostFigures& f : figures_)
    if (has_ghost(*lens_, f.ghost)) brightest.push_back(f.ghost);
  picture_job_.post({revision_, values, lens_, stars_of(document()), std::move(brightest)});
  figures_job_.post({revision_, values, lens_, selection.light});
  refresh_section();
}

void Studio::refresh_section() {
  SectionOrder order{lens_, selection.ghost, 0};
  if (const auto light = light_of(document().values(), *lens_, selection.light))
    order.light_rad = angle_from_axis_rad(*light);
  section_job_.post(std::move(order));
}

void Studio::select_ghost(std::optional<Ghost> ghost) {
  selection.ghost = ghost;
  refresh_section();
}

void Studio::select_light(std::size_t light) {
  if (selection.light == light) return;
  selection.light = light;
  figures_job_.post({revision_, document().values(), lens_, light});
  refresh_section();
}

void Studio::refresh_display() {
  if (!picture_.image) return;
  const std::string exposure = document().text("exposure");
  const auto stops = params::parse_real(exposure);
  display_job_.post({picture_, plate_, view.transform, !stops.has_value(), stops.value_or(0.0)});
}

void Studio::take_display() {
  auto shown = display_job_.take();
  if (!shown) return;
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
    }
  }
  take_display();
  if (auto figures = figures_job_.take(); figures && figures->error.empty()) {
    figures_ = std::move(figures->figures);
    figures_revision_ = figures->revision;
    ++changes_;
  }
  if (auto section = section_job_.take()) take_section(std::move(*section));
  if (auto exported = export_job_.take()) say(std::move(*exported));
  if (!is_saved()) static_cast<void>(autosave_.save(document(), file_));
}

bool Studio::is_idle() const {
  return picture_job_.is_idle() && display_job_.is_idle() && figures_job_.is_idle() && section_job_.is_idle() &&
         export_job_.is_idle();
}

bool Studio::open_lens(const std::string& name_or_file) {
  return adopt(document_with_lens(document(), name_or_file), fmt::format("open lens {}", name_or_file), "");
}

void Studio::take_view(const Document& document) {
  for (const SessionMember& member : document.others)
    if (member.key == kViewKey) view = view_of_json(member.json);
}

bool Studio::open_session(const std::string& file) {
  const auto session = read_session(std::filesystem::path(file));
  auto document = session ? document_of(*session) : Result<Document>(tl::unexpected(session.error()));
  if (!adopt(std::move(document), fmt::format("open {}", file), "open")) return false;
  take_view(this->document());
  file_ = file;
  history_.mark_saved();
  return true;
}

bool Studio::recover(const LostWork& work) {
  if (!open_session(work.copy.string())) return false;
  file_ = work.of_file;
  Autosave::remove(work);
  edit("recover unsaved work", "", [](Document d) {
    std::erase_if(d.others, [](const SessionMember& m) { return m.key == "autosave-of"; });
    return Result<Document>(std::move(d));
  });
  static_cast<void>(autosave_.save(document(), file_, true));
  return true;
}

bool Studio::save_session(const std::string& file) {
  Session session = session_of(document());
  std::erase_if(session.others, [](const SessionMember& m) { return m.key == kViewKey; });
  session.others.push_back({kViewKey, json_of_view(view)});
  auto out = OutputFile::create(file);
  if (!out) return refuse(out.error(), "save");
  if (auto ok = out->write(write_session(session)); !ok) return refuse(ok.error(), "save");
  if (auto ok = out->commit(); !ok) return refuse(ok.error(), "save");
  file_ = file;
  history_.mark_saved();
  autosave_.forget();
  message_ = fmt::format("saved {}", file);
  problem_.clear();
  return true;
}

bool Studio::open_plate(const std::string& file) {
  auto picture = read_picture(std::filesystem::path(file));
  if (!picture) return refuse(picture.error(), "plate");
  plate_ = std::make_shared<const Image>(std::move(picture->rgb));
  const std::string size = fmt::format("{}x{}", plate_->width, plate_->height);
  return edit(fmt::format("open plate {}", file), "", [&](const Document& d) { return with_value(d, "size", size); });
}

bool Studio::export_picture(const std::string& file) {
  message_ = fmt::format("writing {} ...", file);
  export_job_.post([values = document().values(), lens = lens_, file] {
    const auto done = studio::export_picture(values, *lens, file);
    return done ? fmt::format("wrote {}", file) : done.error().to_string();
  });
  return true;
}

}  // namespace contrejour::studio
