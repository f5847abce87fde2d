// SPDX-License-Identifier: Apache-2.0
#include "studio/core/looks.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/output_file.h"
#include "contrejour/expert/preview_exposure.h"
#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/source_renderer.h"
#include "contrejour/image_io.h"
#include "contrejour/preset.h"
#include "studio/core/display_job.h"

namespace contrejour::studio {
namespace {

namespace fs = std::filesystem;

constexpr int kThumbnailThreads = 1;  // the picture comes first
constexpr const char* kThumbnailLight = "0.24,0.28:60000:5200K";
constexpr const char* kThumbnailError = "0.05";

fs::path xdg_folder(const char* variable, const char* otherwise) {
  const char* folder = std::getenv(variable);
  const char* home = std::getenv("HOME");
  if (folder != nullptr && *folder != '\0') return fs::path(folder) / "contrejour" / "looks";
  if (home != nullptr && *home != '\0') return fs::path(home) / otherwise / "contrejour" / "looks";
  return {};
}

Look look_of(const params::Preset& preset, std::string source, bool is_own) {
  std::string name = preset.name.empty() ? fs::path(source).stem().string() : preset.name;
  return {std::move(name), std::move(source), preset.lens, preset.description, is_own};
}

// FNV-1a: the name of a thumbnail changes with all that decides how it looks.
std::uint64_t hash_of(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

fs::path kept_file(const Look& look, const fs::path& folder) {
  const auto preset = params::find_preset(look.source);
  if (!preset || folder.empty()) return {};
  const std::string all = fmt::format("{}x{} {} {} {}", kThumbnailWidth, kThumbnailHeight, kThumbnailLight,
                                      kThumbnailError, params::write_preset(*preset));
  return folder / fmt::format("{:016x}.png", hash_of(all));
}

std::shared_ptr<const Thumbnail> thumbnail_of(const Image& image, double stops, ViewTransform transform) {
  return std::make_shared<const Thumbnail>(Thumbnail{image.width, image.height, displayed(image, stops, transform)});
}

std::shared_ptr<const Thumbnail> read_kept(const fs::path& file) {
  std::error_code code;
  if (file.empty() || !fs::exists(file, code)) return nullptr;
  const auto picture = read_picture(file);
  if (!picture) return nullptr;
  return thumbnail_of(picture->rgb, 0, ViewTransform::Clipped);
}

std::shared_ptr<const Thumbnail> rendered(const Look& look, const fs::path& kept, const Context& context) {
  const auto image = thumbnail_image(look, context);
  if (!image) return context.cancelled() ? nullptr : std::make_shared<const Thumbnail>();
  const double stops = params::automatic_exposure(*image);
  if (!kept.empty()) {
    std::error_code code;
    fs::create_directories(kept.parent_path(), code);
    static_cast<void>(write_preview_png(kept, *image, {stops, true}));  // it is rendered again where this fails
  }
  return thumbnail_of(*image, stops, ViewTransform::Preview);
}

}  // namespace

LookFolders usual_look_folders() {
  return {xdg_folder("XDG_DATA_HOME", ".local/share"), xdg_folder("XDG_CACHE_HOME", ".cache")};
}

std::vector<Look> all_looks(const fs::path& own_folder) {
  std::vector<Look> looks;
  for (const params::BundledPreset& bundled : params::bundled_presets())
    if (const auto preset = params::find_preset(std::string(bundled.name)))
      looks.push_back(look_of(*preset, std::string(bundled.name), false));
  std::vector<Look> own;
  std::error_code code;
  if (!own_folder.empty())
    for (auto at = fs::directory_iterator(own_folder, code); !code && at != fs::directory_iterator();
         at.increment(code))
      if (at->path().extension() == ".toml")
        if (const auto preset = params::find_preset(at->path().string()))
          own.push_back(look_of(*preset, at->path().string(), true));
  std::sort(own.begin(), own.end(), [](const Look& a, const Look& b) { return a.name < b.name; });
  looks.insert(looks.end(), own.begin(), own.end());
  return looks;
}

Result<void> save_own_look(const fs::path& own_folder, const std::string& name, const Document& document) {
  if (own_folder.empty()) return failure(ErrorCode::Io, "there is no folder for looks: HOME is not set");
  if (name.empty() || name.starts_with(".") || name.find('/') != std::string::npos)
    return invalid_argument(fmt::format("\"{}\" is no name for a look", name));
  std::error_code code;
  fs::create_directories(own_folder, code);
  auto file = OutputFile::create(own_folder / (name + ".toml"));
  if (!file) return tl::unexpected(file.error());
  if (auto ok = file->write(params::write_preset({name, "", document.lens_name, document.values()})); !ok) return ok;
  return file->commit();
}

Result<Image> thumbnail_image(const Look& look, const Context& context) {
  auto document = document_with_preset(first_document(), look.source);
  if (!document) return tl::unexpected(document.error());
  document->texts["size"] = {fmt::format("{}x{}", kThumbnailWidth, kThumbnailHeight)};
  document->texts["light-at"] = {kThumbnailLight};
  document->texts["error"] = {kThumbnailError};
  document->texts["wavelengths"] = {"3"};
  const params::Values values = document->values();
  const auto lens = params::lens_of(*document->lens, values);
  if (!lens) return tl::unexpected(lens.error());
  const auto request = picture_request(values, *lens);
  if (!request) return tl::unexpected(request.error());
  auto renderer = renderer_of(values, FlareSource(*lens));
  if (!renderer) return tl::unexpected(renderer.error());
  auto flare = render_picture(*request, *renderer, context);
  if (!flare) return tl::unexpected(flare.error());
  return std::move(flare->image);
}

ThumbnailJob::Work thumbnail_work() {
  return [](const ThumbnailOrder& order, ThumbnailJob::Control& control) {
    Thumbnails all;
    for (const Look& look : order.looks) {
      if (control.is_outdated()) return;
      const fs::path kept = kept_file(look, order.folder);
      auto thumbnail = read_kept(kept);
      if (!thumbnail) thumbnail = rendered(look, kept, control.context(kThumbnailThreads));
      if (!thumbnail) return;
      all[look.source] = std::move(thumbnail);
      control.publish(all);
    }
  };
}

}  // namespace contrejour::studio
