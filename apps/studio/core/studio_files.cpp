// SPDX-License-Identifier: Apache-2.0
// The files of a studio: sessions, lenses, plates, exports.
#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/frame_range.h"
#include "contrejour/expert/output_file.h"
#include "studio/core/lights.h"
#include "studio/core/plate_frames.h"
#include "studio/core/studio.h"

namespace contrejour::studio {

bool Studio::open_lens(const std::string& name_or_file) {
  const bool had_coating = document().texts.contains("coating") || document().texts.contains("coating-at");
  auto opened = document_with_lens(document(), name_or_file);
  const std::string name = opened && !opened->lens->name.empty() ? opened->lens->name : name_or_file;
  if (!adopt(std::move(opened), fmt::format("open lens {}", name), "")) return false;
  say(fmt::format("{} at f/{:.3g}{}", document().lens->name, lens_->f_number,
                  had_coating ? ", with its own coatings in place of those that were set" : ""));
  return true;
}

void Studio::take_view(const Document& document) {
  for (const SessionMember& member : document.others)
    if (member.key == kViewKey) view = view_of_json(member.json);
}

bool Studio::open_session(const std::string& file) {
  const auto session = read_session(std::filesystem::path(file));
  auto document = session ? document_of(*session, file) : Result<Document>(tl::unexpected(session.error()));
  if (document) take_view(*document);
  if (!adopt_whole(std::move(document), fmt::format("open {}", file), "open")) return false;
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
  say(fmt::format("recovered the unsaved work {}",
                  work.of_file.empty() ? "that had no file yet" : "of " + work.of_file));
  return true;
}

bool Studio::save_session(const std::string& file) {
  Session session = session_of(document(), file);
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
  std::error_code code;
  if (!std::filesystem::is_regular_file(file, code) && !is_plate_sequence(file))
    return refuse({ErrorCode::Io, "there is no such file", {file}}, "plate");
  message_ = fmt::format("reading {} ...", file);
  problem_.clear();
  plates_.open({std::filesystem::absolute(file).lexically_normal().string(), "", "", "", ""});
  return true;
}

void Studio::close_plate() {
  edit("close plate", "", [](const Document& d) { return Result<Document>(without_plate(d)); });
}

void Studio::take_plate(PlateAnswer answer) {
  if (!answer.plate) take_problem(answer.error);
  if (!answer.order.is_new) return post_picture();  // a document's, which waits for it
  if (answer.plate) take_new_plate(answer);
}

void Studio::take_new_plate(const PlateAnswer& answer) {
  const Image& rgb = answer.plate->picture.rgb;
  const std::string name = std::filesystem::path(answer.order.reference.file).filename().string();
  std::string frames;
  if (answer.order.frame) {
    view.first_frame = std::max(0, answer.frames.front());
    view.last_frame = std::max(view.first_frame, answer.frames.back());
    go_to_frame(*answer.order.frame);
    frames = fmt::format(", frames {}", frame_range_text(answer.frames));
  }
  if (edit(fmt::format("open plate {}", name), "", [&](const Document& d) {
        return Result<Document>(with_plate(d, answer.order.reference, rgb.width, rgb.height));
      }))
    say(fmt::format("{}: {} \u00d7 {}{}. Shift+L puts lights where it is bright.", name, rgb.width, rgb.height,
                    frames));
}

bool Studio::detect_lights() {
  const auto plate = this->plate();
  if (!plate) return refuse({ErrorCode::InvalidArgument, "open a plate first: its bright areas become lights", {}}, "");
  message_ = "looking for lights ...";
  detection_job_.post({plate, document().values(), lens_});
  return true;
}

void Studio::take_detection(const DetectionAnswer& answer) {
  if (!answer.error.empty()) return take_problem(answer.error);
  if (answer.lights.empty())
    return take_problem("the plate has no bright areas; --threshold (Parameters, Light detection) sets how bright");
  const std::size_t count = answer.lights.size();
  const std::string name = fmt::format("detect {} {}", count, count == 1 ? "light" : "lights");
  if (edit(name, "", [&](Document d) {
        d.animation.lights.clear();  // they are other lights
        auto lit = with_lights(std::move(d), answer.lights);
        return lit ? with_value(std::move(*lit), "detect", "off") : lit;
      }))
    say(fmt::format("{} bright {} of the plate {} now {}", count, count == 1 ? "area" : "areas",
                    count == 1 ? "is" : "are", count == 1 ? "a light" : "lights"));
}

void Studio::open_measured(const std::string& file) {
  measured_sweep_.clear();
  measured_job_.post({file, 0, ""});
}

void Studio::open_measured_sweep(const std::string& folder) {
  problem_.clear();
  measured_sweep_ = folder;
  choose_measured_angle(measured_.angle_deg);
}

bool Studio::save_look(const std::string& name) {
  if (auto ok = save_own_look(look_folders_.own, name, document()); !ok) return refuse(ok.error(), "look");
  looks_ = all_looks(look_folders_.own);
  want_thumbnails();
  say(fmt::format("saved the look {}", name));
  problem_.clear();
  return true;
}

bool Studio::export_frames(const std::string& pattern) {
  if (auto ok = check_pattern(pattern, document().has_plate()); !ok) return refuse(ok.error(), "export");
  exported_frames_ = {0, view.last_frame - view.first_frame + 1, {}, {}, false};
  frames_job_.post({document(), plate(), pattern, view.first_frame, view.last_frame});
  say(fmt::format("writing {} frames in the background ...", exported_frames_.count));
  return true;
}

void Studio::stop_exporting_frames() { frames_job_.post({}); }

void Studio::take_exported_frames(const FramesAnswer& answer) {
  exported_frames_ = answer;
  if (!answer.error.empty()) return take_problem(answer.error);
  const std::string missing =
      answer.missing.empty() ? "" : fmt::format("; the plate has no frames {}", frame_range_text(answer.missing));
  say(answer.is_over ? fmt::format("wrote {} of {} frames{}", answer.done, answer.count, missing)
                     : fmt::format("writing frame {} of {} ...", answer.done + 1, answer.count));
}

bool Studio::export_as(ExportKind kind, const std::string& file, LayersBy layers_by) {
  problem_.clear();
  if (kind == ExportKind::Frames) return export_frames(file);
  ExportOrder order{kind, file, document(), lens_, plate(), layers_by, figures_};
  if (auto ok = check_export(order); !ok) return refuse(ok.error(), "export");
  message_ = fmt::format("writing {} ...", file);
  order.document.plate = plate_at(document().plate, view.frame);
  export_job_.post({file, [order = std::move(order)] {
                      const auto done = export_file(order);
                      return done ? std::string() : done.error().to_string();
                    }});
  return true;
}

}  // namespace contrejour::studio
