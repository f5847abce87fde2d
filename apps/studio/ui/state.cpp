// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "studio/core/coating_curves.h"
#include "studio/core/command_line.h"
#include "studio/core/lights.h"
#include "studio/ui/interface.h"

namespace contrejour::studio {
namespace {

using Json = nlohmann::ordered_json;

Json json_of_widgets(const WidgetRegistry& registry) {
  Json all = Json::array();
  for (const WidgetRecord& w : registry.all())
    all.push_back({{"id", w.id},
                   {"rect", {w.min.x, w.min.y, w.max.x, w.max.y}},
                   {"value", w.value},
                   {"clipped", w.is_clipped},
                   {"cut", w.is_cut}});
  return all;
}

Json json_of_lights(const Document& document) {
  Json all = Json::array();
  for (const LightEntry& light : lights_of(document))
    all.push_back({{"at", {light.at.x, light.at.y}}, {"value", light.value}, {"colour", light.colour}});
  return all;
}

Json json_of_ghosts(const std::vector<GhostFigures>& figures) {
  Json all = Json::array();
  for (const GhostFigures& f : figures)
    all.push_back({{"ghost", ghost_name(f.ghost)},
                   {"flux", f.relative_flux},
                   {"centre", {f.centroid_px.x, f.centroid_px.y}},
                   {"size", {f.size_px.x, f.size_px.y}},
                   {"rgb", f.rgb}});
  return all;
}

Json json_of_shown(const DisplayAnswer& shown) {
  return {{"kind", shown.picture.kind == PictureKind::Draft ? "draft" : "refined"},
          {"revision", shown.picture.revision},
          {"width", shown.width},
          {"height", shown.height},
          {"ms", shown.picture.time_ms},
          {"ghosts", shown.picture.ghosts},
          {"stops", shown.stops}};
}

Json json_of_pace(const Pace::Summary& s) {
  return {{"frames", s.frames},
          {"frame_p50_ms", s.frame_p50_ms},
          {"frame_p99_ms", s.frame_p99_ms},
          {"frame_max_ms", s.frame_max_ms},
          {"processor_p50_ms", s.processor_p50_ms},
          {"processor_p99_ms", s.processor_p99_ms},
          {"drawn_part", s.drawn_part},
          {"pictures", s.pictures},
          {"pictures_per_s", s.pictures_per_s},
          {"latency_p50_ms", s.latency_p50_ms},
          {"latency_p99_ms", s.latency_p99_ms}};
}

Json json_of_history(const History& history) {
  Json names = Json::array();
  for (const History::Step& step : history.steps()) names.push_back(step.name);
  return {{"steps", names}, {"position", history.position()}, {"saved", history.is_saved()}};
}

Json json_of_selection(const Selection& selection) {
  return {{"light", selection.light},
          {"ghost", selection.ghost ? ghost_name(*selection.ghost) : ""},
          {"surface", selection.surface}};
}

Json json_of_tracks(const Document& document) {
  Json all = Json::object();
  for (const Track& track : tracks_of(document)) {
    Json keys = Json::array();
    for (const Key& key : track.value.keys) keys.push_back({key.frame, text_at(track.value, key.frame)});
    all[track.label] = keys;
  }
  return all;
}

Json json_of_compare(const Studio& studio) {
  const auto& figures = studio.comparison();
  return {{"mode", static_cast<int>(studio.compare_view().mode)},
          {"edge", studio.compare_view().edge},
          {"snapshots", studio.snapshots().size()},
          {"psnr_db", figures && figures->psnr_db ? Json(*figures->psnr_db) : Json()},
          {"equal", figures && !figures->psnr_db}};
}

}  // namespace

std::string Interface::state_json() const {
  const Document& document = studio_.document();
  Json values = Json::object();
  for (const auto& [name, texts] : document.texts) values[name] = texts;
  Json surfaces = Json::array();
  for (const Surface& s : document.lens->surfaces)
    surfaces.push_back(s.curvature_per_mm == 0 ? 0 : 1 / s.curvature_per_mm);
  const Json state = {{"lens", document.lens_name},
                      {"edited", document.lens_was_edited},
                      {"f_number", studio_.lens().f_number},
                      {"radii", surfaces},
                      {"values", values},
                      {"lights", json_of_lights(document)},
                      {"history", json_of_history(studio_.history())},
                      {"selection", json_of_selection(studio_.selection)},
                      {"revision", studio_.revision()},
                      {"shown", json_of_shown(studio_.shown())},
                      {"ghosts", json_of_ghosts(studio_.figures())},
                      {"zoom", studio_.view.zoom},
                      {"scale", scale()},
                      {"frame_of_shot", studio_.view.frame},
                      {"plays", studio_.is_playing()},
                      {"cached_frames", studio_.frame_cache().count()},
                      {"tracks", json_of_tracks(document)},
                      {"compare", json_of_compare(studio_)},
                      {"plate", document.plate.file},
                      {"plate_frames", studio_.plate_frames()},
                      {"thumbnails", studio_.thumbnails().size()},
                      {"clipboard", ImGui::GetClipboardText() != nullptr ? ImGui::GetClipboardText() : ""},
                      {"file", studio_.file()},
                      {"problem", studio_.problem()},
                      {"message", studio_.message()},
                      {"dialog", static_cast<int>(state_.dialog)},
                      {"help", state_.shows_help},
                      {"panels", state_.shows_panels},
                      {"idle", studio_.is_idle()},
                      {"frame", frames_},
                      {"command", command_of_values(document, {})},
                      {"pace", json_of_pace(pace_.summary())},
                      {"widgets", json_of_widgets(registry_)}};
  return state.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace contrejour::studio
