// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/merge_stations.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/tasks.h"

namespace contrejour {
namespace {

Result<std::vector<RawFrame>> frames_of(std::span<const PlannedCapture> captures, const ReadRawFrame& read) {
  std::vector<RawFrame> frames;
  for (const PlannedCapture& capture : captures) {
    auto frame = read(capture);
    if (!frame) return tl::unexpected(frame.error());
    frames.push_back(std::move(*frame));
  }
  return frames;
}

// The light's flux in the first short exposure that shows it. Errors: a file that cannot be read.
Result<std::optional<DirectFlux>> direct_of(const StationFiles& files, const ReadRawFrame& read,
                                            std::vector<std::string>& warnings) {
  for (const PlannedCapture& capture : files.direct) {
    const auto frame = read(capture);
    if (!frame) return tl::unexpected(frame.error());
    const auto flux = direct_flux(*frame);
    if (flux) return std::optional(*flux);
    warnings.push_back(fmt::format("{}: {}", capture.file, flux.error().message));
  }
  return std::optional<DirectFlux>();
}

Result<void> merge_one(const StationFiles& files, const ReadRawFrame& read, const WriteStation& write,
                       const MergeSettings& settings, const Context& context, std::vector<std::string>& warnings) {
  MergedStation merged{files.station, files.angle_deg, {}, {}};
  auto direct = direct_of(files, read, warnings);
  if (!direct) return tl::unexpected(direct.error());
  merged.direct = *direct;
  const auto exposures = frames_of(files.exposures, read);
  if (!exposures) return tl::unexpected(exposures.error());
  const auto background = frames_of(files.background, read);
  if (!background) return tl::unexpected(background.error());
  auto image = merge_exposures(*exposures, *background, settings, context);
  if (!image) return tl::unexpected(image.error());
  merged.image = std::move(*image);
  warnings.insert(warnings.end(), merged.image.warnings.begin(), merged.image.warnings.end());
  return write(merged);
}

}  // namespace

Result<std::vector<StationOutcome>> merge_stations(std::span<const StationFiles> stations, const ReadRawFrame& read,
                                                   const WriteStation& write, const MergeSettings& settings,
                                                   int at_once, const Context& context) {
  std::vector<StationOutcome> outcomes(stations.size());
  Context several = context;
  several.threads = std::max(at_once, 1);
  const Context one{.threads = 1, .cancel = context.cancel};
  const bool done = parallel_for(stations.size(), several, [&](std::size_t k) {
    const auto ok = merge_one(stations[k], read, write, settings, one, outcomes[k].warnings);
    if (!ok) outcomes[k].error = ok.error();
  });
  if (!done) return interrupted();
  return outcomes;
}

}  // namespace contrejour
