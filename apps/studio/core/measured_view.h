// SPDX-License-Identifier: Apache-2.0
// A measured flare (.flare.toml) as its panel shows it: a kymograph, which is the row of pixels through the optical
// centre for each angle of the light; the picture at one angle; its ghosts' parameters over the angle; and, where the
// folder of the sweep is known, the photographs beside it. Read and rendered in the background. Thread-safety: as
// LatestJob; the rest is pure.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contrejour/expert/measured_flare.h"
#include "studio/core/latest_job.h"

namespace contrejour::studio {

inline constexpr int kKymographWidth = 240, kKymographHeight = 121;
inline constexpr int kMeasuredWidth = 240, kMeasuredHeight = 160;

enum class GhostCurve { Speed, HalfWidth, HalfHeight, Level };
inline constexpr std::array<GhostCurve, 4> kGhostCurves = {GhostCurve::Speed, GhostCurve::HalfWidth,
                                                           GhostCurve::HalfHeight, GhostCurve::Level};
[[nodiscard]] const char* name_of(GhostCurve curve);

struct MeasuredCurve {
  std::string ghost;
  std::vector<Vec2> points;  // angle of the light in degrees, value
};
// A figure of each ghost over the angles at which it exists: its speed (its centre over the light's position), its size
// as a tangent, or its level inside in the green channel.
[[nodiscard]] std::vector<MeasuredCurve> curves_of(const MeasuredFlare& flare, GhostCurve curve);

[[nodiscard]] double largest_angle_deg(const MeasuredFlare& flare);
[[nodiscard]] double angle_of_row_deg(const MeasuredFlare& flare, int row);  // of the kymograph
// half_width: of the picture, as a tangent.
[[nodiscard]] TangentFrame measured_frame(double half_width, int width, int height);

struct MeasuredOrder {
  std::string file;
  double angle_deg = 0;
  std::string sweep = {};  // the folder of the merged photographs; empty: not known
};

// The photograph of the station next to the angle, and the fit in its light. All pictures have the fit's exposure.
struct MeasuredPhotograph {
  std::size_t station = 0, count = 0;  // from 0; of the sweep
  std::vector<std::uint32_t> captured = {}, fitted = {}, residual = {};
  // The kymograph of all stations that have been read; black where there is none.
  std::shared_ptr<const std::vector<std::uint32_t>> kymograph = nullptr;
  std::size_t read = 0;  // stations
};

// Published several times while the photographs of a sweep are read.
struct MeasuredAnswer {
  std::string file;
  std::shared_ptr<const MeasuredFlare> flare;  // null where there is an error
  double angle_deg = 0;
  double half_width = 0;  // of both pictures, as a tangent
  std::shared_ptr<const std::vector<std::uint32_t>> kymograph;  // rows from the largest negative angle on
  std::vector<std::uint32_t> picture;
  std::string sweep;
  std::optional<MeasuredPhotograph> photograph;  // none: the sweep is not known, or `error` says why
  std::string error;
};

using MeasuredJob = LatestJob<MeasuredOrder, MeasuredAnswer>;
[[nodiscard]] MeasuredJob::Work measured_work();

}  // namespace contrejour::studio
