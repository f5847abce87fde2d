// SPDX-License-Identifier: Apache-2.0
#include "studio/core/document.h"

#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/settings.h"
#include "contrejour/preset.h"

namespace contrejour::studio {
namespace {

constexpr const char* kFirstPreset = "amber-wide";

std::shared_ptr<const Prescription> shared(Prescription lens) {
  return std::make_shared<const Prescription>(std::move(lens));
}

void take_values(const params::Values& values, ValueTexts& texts) {
  for (const params::Parameter& p : params::all_parameters())
    if (values.given(p.name)) texts[std::string(p.name)] = values.list(p.name);
}

// Whether the media on both sides of the surface (from 1) differ.
bool bounds_glass(const Prescription& lens, int surface) {
  if (surface < 1 || static_cast<std::size_t>(surface) > lens.surfaces.size()) return false;
  const auto row = static_cast<std::size_t>(surface) - 1;
  const Glass before = row > 0 ? lens.surfaces[row - 1].glass_after : air();
  return lens.surfaces[row].kind != SurfaceKind::Stop && !(before == lens.surfaces[row].glass_after);
}

SessionPlate plate_in_folder(SessionPlate plate, const std::filesystem::path& session_file) {
  if (plate.file.empty() || session_file.empty()) return plate;
  const auto folder = std::filesystem::absolute(session_file).parent_path();
  const auto relative = std::filesystem::path(plate.file).lexically_relative(folder);
  if (!relative.empty() && *relative.begin() != "..") plate.file = relative.string();
  return plate;
}

}  // namespace

params::Values Document::values() const {
  params::Values values;
  for (const auto& [name, list] : texts)
    for (const std::string& one : list) static_cast<void>(values.set(name, one));  // checked when it was entered
  return values;
}

std::string Document::text(std::string_view name) const {
  const auto found = texts.find(name);
  if (found != texts.end() && !found->second.empty()) return found->second.back();
  return std::string(params::parameter(name).fallback);
}

std::vector<std::string> Document::list(std::string_view name) const {
  const auto found = texts.find(name);
  return found != texts.end() ? found->second : std::vector<std::string>{};
}

// A wide angle whose films differ from surface to surface: a blue veil, amber polygons, and a row of bright dots.
Document first_document() {
  Document document;
  document.lens_name = "distagon-25";
  document.lens = shared(*find_lens(document.lens_name));
  document.texts = {{"size", {"1280x720"}}, {"light-at", {"0.22,0.25:60000:5200K"}}};
  if (auto preset = document_with_preset(document, kFirstPreset)) document = std::move(*preset);
  document.texts["coating-at"] = {"6:quarter-wave:640:1.38", "11:quarter-wave:700:1.38", "13:quarter-wave:660:1.38",
                                  "14:quarter-wave:480:1.38", "16:quarter-wave:560:1.38"};
  document.texts["blades"] = {"7"};
  document.texts["blade-curvature"] = {"0.3"};
  document.texts["blade-rotation"] = {"12"};
  document.texts["starburst-gain"] = {"0.6"};
  document.texts["exposure"] = {"6.2"};
  return document;
}

Result<Document> document_with_lens(const Document& scene, const std::string& lens_name) {
  auto lens = find_lens(lens_name);
  if (!lens) return tl::unexpected(lens.error());
  Document document = scene;
  document.lens_name = lens_name;
  document.lens = shared(std::move(*lens));
  document.lens_was_edited = false;
  // These belong to the lens before.
  for (const char* name : {"focal", "ghost", "coating", "coating-at", "select"}) document.texts.erase(name);
  if (!params::lens_of(*document.lens, document.values())) document.texts.erase("fnumber");
  return document;
}

Result<Document> document_with_preset(const Document& scene, const std::string& preset_name) {
  const auto preset = params::find_preset(preset_name);
  if (!preset) return tl::unexpected(preset.error());
  auto document = preset->lens.empty() ? Result<Document>(scene) : document_with_lens(scene, preset->lens);
  if (!document) return document;
  std::erase_if(document->texts,
                [](const auto& value) { return params::belongs_to_preset(params::parameter(value.first)); });
  take_values(preset->values, document->texts);
  return document;
}

Result<Document> document_of(const Session& session, const std::filesystem::path& file) {
  auto lens = lens_of_session(session);
  if (!lens) return tl::unexpected(lens.error());
  Document document;
  document.lens_name = session.lens;
  const auto original = find_lens(session.lens);
  document.lens_was_edited = !original || write_lens_toml(*original) != write_lens_toml(*lens);
  document.lens = shared(std::move(*lens));
  take_values(session.values, document.texts);
  document.plate = session.plate;
  document.plate.file = plate_file(session.plate, file.empty() ? file : std::filesystem::absolute(file)).string();
  if (!session.animation.empty()) {
    auto animation = read_animation(session.animation, file.string());
    if (!animation) return tl::unexpected(animation.error());
    document.animation = std::move(*animation);
  }
  document.others = session.others;
  return document;
}

Session session_of(const Document& document, const std::filesystem::path& file) {
  const bool has_keys = document.animation != Animation{};
  return {document.lens_name,
          write_lens_toml(*document.lens),
          document.values(),
          plate_in_folder(document.plate, file),
          has_keys ? write_animation(document.animation) : std::string(),
          document.others};
}

Document with_plate(Document document, const SessionPlate& plate, int width, int height) {
  document.plate = plate;
  document.texts["size"] = {fmt::format("{}x{}", width, height)};
  if (!document.list("light-at").empty()) document.texts["detect"] = {"off"};
  return document;
}

Document without_plate(Document document) {
  document.plate = {};
  return without_value(std::move(document), "detect");
}

Result<Document> with_value(Document document, std::string_view name, const std::string& text) {
  return with_values(std::move(document), name, {text});
}

Result<Document> with_values(Document document, std::string_view name, const std::vector<std::string>& texts) {
  for (const std::string& text : texts)
    if (auto ok = params::check_value(params::parameter(name), text); !ok) return tl::unexpected(ok.error());
  if (texts.empty()) return without_value(std::move(document), name);
  document.texts[std::string(name)] = texts;
  return document;
}

Document without_value(Document document, std::string_view name) {
  if (const auto found = document.texts.find(name); found != document.texts.end()) document.texts.erase(found);
  return document;
}

Document with_edited_lens(Document document, Prescription lens) {
  document.lens = shared(std::move(lens));
  document.lens_was_edited = true;
  if (const auto coatings = document.texts.find("coating-at"); coatings != document.texts.end()) {
    std::erase_if(coatings->second, [&](const std::string& text) {
      const auto coating = params::parse_coating_at(text);
      return !coating || !bounds_glass(*document.lens, coating->surface);
    });
    if (coatings->second.empty()) document.texts.erase(coatings);
  }
  return document;
}

}  // namespace contrejour::studio
