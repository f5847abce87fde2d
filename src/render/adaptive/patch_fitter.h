// SPDX-License-Identifier: Apache-2.0
// Fits patches to a box of the pupil: polynomials through exact rays at few points, whose error is tested. Where the
// test fails, more rays or smaller boxes follow.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/adaptive/budget/fit_budget.h"
#include "render/adaptive/cells/box_cells.h"
#include "render/ray_maps/band_set.h"
#include "render/stop_patterns/band_stop_pattern.h"

namespace contrejour::inline internal::adaptive {

// A part of a box, with the patches from which BandSet::band_patch() computes each band's patch, or with the patch of
// one band alone.
struct FittedPart {
  MeshPosition position;
  std::vector<Patch> patches;
  std::optional<std::size_t> only_band = std::nullopt;
};

struct FittedBox {
  std::vector<FittedPart> parts;
  std::vector<FittedPart> mirror_image;  // of the box, if requested
};

using BandPatterns =
    std::vector<std::shared_ptr<const stop_patterns::BandStopPattern>>;  // one a band; null: the iris is sharp

class PatchFitter {
 public:
  // max_depth: how often a box may be quartered before straight lines between rays must do. negligible_level: the
  // negligible level of pixel values behind stop patterns.
  PatchFitter(GhostTracers& tracers, const Frame& frame, int max_depth, double negligible_level)
      : tracers_(tracers), frame_(frame), max_depth_(max_depth), negligible_level_(negligible_level) {}

  // first: rays of the box at kMinNodes, with weights.
  [[nodiscard]] FittedBox fit(BandSet& bands, std::span<const LobattoRays> first, const Tolerance& tolerance,
                              const BandPatterns& patterns, bool with_mirror_image);

 private:
  // A box, or a quarter of another part.
  struct BoxPart {
    Rectangle box;
    MeshPosition position;
    int depth = 0;
  };
  struct Fitting {
    BandSet& bands;
    const Tolerance& tolerance;
    std::span<const std::shared_ptr<const stop_patterns::BandStopPattern>> patterns;  // those of the bands
    std::vector<FittedPart>& parts;
    std::vector<FittedPart>* mirror_image;  // null: not requested
    std::optional<std::size_t> only_band = std::nullopt;  // if several bands are fitted apart: the band of this set
  };

  [[nodiscard]] BoxPart whole(const Rectangle& box, int depth = 0);
  [[nodiscard]] bool is_symmetric(const Rectangle& box) const;
  void fit(const BoxPart& part, std::optional<double> first_misfit, const Fitting& fitting);
  void fit_quarters(const BoxPart& part, const Fitting& fitting);
  void fit_between_rays(const BoxPart& part, std::span<const LobattoRays> ray_sets, const Fitting& fitting);
  void keep(const MeshPosition& position, std::span<const LobattoRays> ray_sets, std::vector<Patch> patches,
            const Fitting& fitting) const;
  [[nodiscard]] PacketPrecision precision_for(const Rectangle& box, const Tolerance& tolerance) const;
  [[nodiscard]] std::optional<double> level_behind(std::span<const LobattoRays> ray_sets, const Fitting& fitting) const;

  GhostTracers& tracers_;
  const Frame& frame_;
  int max_depth_;
  double negligible_level_;
  int boxes_ = 0;  // indices of boxes in use
};

}  // namespace contrejour::inline internal::adaptive
