// SPDX-License-Identifier: Apache-2.0
// The list of a sweep's photographs: written before the sweep as a plan, read afterwards to merge them.
// A list is CSV with the header `station,angle_deg,kind,time_s,file`; kind is `exposure`, `background` (light blocked)
// or `direct` (so short that the light's own image is not saturated). Lines that begin with # are comments.
// Errors: Parse with file and line; InvalidArgument. Thread-safety: plain values, pure functions.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/expert/capture.h"
#include "contrejour/expert/colour.h"
#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

enum class CaptureKind { Exposure, Background, Direct };
inline constexpr std::array<std::string_view, 3> kCaptureKindNames{"exposure", "background", "direct"};

struct PlannedCapture {
  int station = 1;  // from 1
  double angle_deg = 0;  // of the head; 0: the light is on the axis
  CaptureKind kind = CaptureKind::Exposure;
  double time_s = 0;  // > 0
  std::string file;
};

struct CapturePlan {
  double to_deg = 60.0;   // from -to_deg to to_deg, both sides: a test of the set-up's symmetry
  int stations = 601;     // every 0.2 degrees, walch2018 3.1
  std::vector<double> times_s{0.25, 1.0, 4.0};  // walch2018 3.1
  double direct_s = 0.00025;
  int background_every = 20;  // stations between exposures with the light blocked
  std::string ending = "cr2";
};

// Errors: fewer than one station, times or angles out of range.
[[nodiscard]] CONTREJOUR_API Result<std::vector<PlannedCapture>> plan_captures(const CapturePlan& plan);

[[nodiscard]] CONTREJOUR_API std::string write_captures(std::span<const PlannedCapture> captures);
// At most a million photographs.
[[nodiscard]] CONTREJOUR_API Result<std::vector<PlannedCapture>> read_captures(std::string_view csv,
                                                                               const std::string& file);

// The photographs of one station; the background is its own, else that of the nearest station with one.
struct StationFiles {
  int station = 0;
  double angle_deg = 0;
  std::vector<PlannedCapture> exposures, background, direct;
};
// In order of stations. Errors: a station without exposures, or with several angles.
[[nodiscard]] CONTREJOUR_API Result<std::vector<StationFiles>> stations_of(std::span<const PlannedCapture> captures);

// The light's own image in a short exposure: where it is, and how much light it has, as a sum over merged pixels.
struct DirectFlux {
  Vec2 position_px;   // in pixels of half the raw size
  Rgb rate{};         // DN per second
};
// Errors: no light in the picture, or a saturated one.
[[nodiscard]] CONTREJOUR_API Result<DirectFlux> direct_flux(const RawFrame& direct);

// Stations whose direct image is more than `most` (relative) off the middle of it and its two neighbours on either
// side: a cloud, a lamp that flickered. Slow drift cancels where flare is taken relative to the direct image.
[[nodiscard]] CONTREJOUR_API std::vector<std::size_t> unsteady_stations(std::span<const double> flux, double most);

}  // namespace contrejour
