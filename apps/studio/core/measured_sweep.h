// SPDX-License-Identifier: Apache-2.0
// The photographs that a measured flare was learned from, as its panel shows them beside the fit: merged stations
// (merged_sweep.h) in the fit's frame, relative to the light. Their halo (measured_halo.h) and starburst are no part of
// the fit. Units: as measured_flare.h. Errors: those of the files; fewer than five direct images of the light.
// Thread-safety: a plain class, one thread at a time; the rest is pure.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contrejour/expert/measured_flare.h"
#include "contrejour/expert/merged_sweep.h"

namespace contrejour::studio {

// The picture turned so that the light's path runs to the right, as a frame sees it: each pixel the sum over its area.
// Black outside the picture.
[[nodiscard]] Image in_frame(const Image& picture, const SweepGeometry& geometry, const TangentFrame& frame);

class MeasuredSweep {
 public:
  [[nodiscard]] static Result<MeasuredSweep> open(const std::string& folder);

  [[nodiscard]] const std::string& folder() const { return folder_; }
  [[nodiscard]] std::size_t count() const { return merged_.files.size(); }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return merged_.warnings; }
  [[nodiscard]] double angle_deg(std::size_t station) const;  // from the axis
  [[nodiscard]] std::size_t nearest(double angle_deg) const;
  // The light of a station, at its direct image; its value is 1, to which the photograph is relative.
  [[nodiscard]] FlareLight light(std::size_t station) const;
  [[nodiscard]] Result<Image> photograph(std::size_t station, const TangentFrame& frame);

 private:
  static constexpr std::size_t kMostKept = 3;  // of large pictures

  struct Kept {
    std::size_t station = 0;
    std::shared_ptr<const Image> picture;  // relative to the light
  };
  [[nodiscard]] Result<std::shared_ptr<const Image>> picture(std::size_t station);

  std::string folder_;
  MergedSweep merged_;
  SweepGeometry geometry_;
  Rgb usual_light_{};  // the mean of the direct images, for stations without one
  std::vector<Kept> kept_;
};

}  // namespace contrejour::studio
