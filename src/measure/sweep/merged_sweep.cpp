// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/merged_sweep.h"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

#include "base/units.h"
#include "contrejour/expert/station_file.h"

namespace contrejour {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFewestMerged = 5;

bool is_station_file(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with("station-") && file.extension() == ".exr";
}

Result<std::vector<fs::path>> station_files(const std::string& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (is_station_file(at->path())) files.push_back(at->path());
  if (error)
    return failure(ErrorCode::Io,
                   "the folder of merged stations cannot be read; make one with `contrejour measure merge`",
                   {folder, 0, 0});
  std::ranges::sort(files);
  return files;
}

}  // namespace

FlareSweep MergedSweep::sweep() const {
  FlareSweep all;
  all.angles_rad = angles_rad;
  all.direct = direct;
  all.picture = [paths = files](std::size_t k) { return read_station(paths[k]); };
  return all;
}

Result<MergedSweep> open_merged(const std::string& folder) {
  const auto files = station_files(folder);
  if (!files) return tl::unexpected(files.error());
  MergedSweep merged;
  for (const fs::path& file : *files) {
    const auto facts = read_station_facts(file);
    if (!facts) {
      merged.warnings.push_back(fmt::format("left out: {}", facts.error().to_string()));
      continue;
    }
    merged.files.push_back(file);
    merged.angles_rad.push_back(rad_from_deg(facts->angle_deg));
    merged.direct.push_back(facts->direct);
    merged.expected = expected_centre(facts->width, facts->height);
  }
  if (merged.files.size() < kFewestMerged) {
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("{} merged stations can be read here, and a fit needs at least {}; merge more with "
                               "`contrejour measure merge`",
                               merged.files.size(), kFewestMerged),
                   {folder, 0, 0});
  }
  return merged;
}

Result<SweepGeometry> geometry_of(const MergedSweep& merged, const std::string& folder) {
  std::vector<DirectImage> lights;
  for (std::size_t k = 0; k < merged.direct.size(); ++k)
    if (merged.direct[k]) lights.push_back({merged.angles_rad[k], merged.direct[k]->position_px});
  if (lights.size() < kFewestMerged) {
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("{} stations show the light's own image unsaturated, and {} are needed; add short "
                               "exposures of the kind `direct` to the list and merge again",
                               lights.size(), kFewestMerged),
                   {folder, 0, 0});
  }
  auto geometry = fit_geometry(lights, merged.expected);
  if (!geometry) return failure(geometry.error().code, geometry.error().message, {folder, 0, 0});
  return geometry;
}

}  // namespace contrejour
