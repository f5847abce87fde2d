// SPDX-License-Identifier: Apache-2.0
// Looks: bundled presets and those of the user's own folder, and their thumbnails, which are rendered in the background
// and kept in the user's cache. Errors: Io. Thread-safety: pure functions, but for the files; the job as LatestJob.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/image.h"
#include "studio/core/document.h"
#include "studio/core/latest_job.h"
#include "studio/core/thumbnail.h"

namespace contrejour::studio {

struct Look {
  std::string name;  // for display
  std::string source;  // what find_preset() takes: a bundled preset's name, or a file
  std::string lens, description;
  bool is_own = false;
};

struct LookFolders {
  std::filesystem::path own;  // presets of the user; empty: none
  std::filesystem::path thumbnails;  // empty: none are kept
};

// $XDG_DATA_HOME/contrejour/looks and $XDG_CACHE_HOME/contrejour/looks, else below ~/.local/share and ~/.cache.
[[nodiscard]] LookFolders usual_look_folders();

// Bundled ones, then the user's own by name. Files that are no presets are left out.
[[nodiscard]] std::vector<Look> all_looks(const std::filesystem::path& own_folder);
// Writes the document's settings into the folder, which is created. Errors: also a name that is no file's.
[[nodiscard]] Result<void> save_own_look(const std::filesystem::path& own_folder, const std::string& name,
                                         const Document& document);

// By the looks' sources. Published after each one; all so far.
using Thumbnails = std::map<std::string, std::shared_ptr<const Thumbnail>>;
struct ThumbnailOrder {
  std::vector<Look> looks;
  std::filesystem::path folder;
};
using ThumbnailJob = LatestJob<ThumbnailOrder, Thumbnails>;
[[nodiscard]] ThumbnailJob::Work thumbnail_work();

// The look in the first scene with the light in the frame: the same scene for all looks.
[[nodiscard]] Result<Image> thumbnail_image(const Look& look, const Context& context);

}  // namespace contrejour::studio
