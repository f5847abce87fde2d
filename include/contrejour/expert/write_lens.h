// SPDX-License-Identifier: Apache-2.0
// Writes lenses as files of design programs: sequential Zemax (.zmx) and CODE V (.seq). Read again, they give the same
// lens: surfaces, shapes, stop, gaps of a zoom and f-number to the last bit, tilts and rotations to 1e-12, glasses'
// indices as `losses` says. What a format cannot hold is either left out, which `losses` says for people, or an error.
// Errors: InvalidArgument for an invalid lens (validate()); Unsupported for a shape that the format cannot express.
// docs/formats/zemax.md, docs/formats/codev.md. Thread-safety: pure functions.
#pragma once

#include <string>
#include <vector>

#include "contrejour/expert/ghost_id.h"
#include "contrejour/export.h"
#include "contrejour/lens.h"
#include "contrejour/result.h"

namespace contrejour {

struct WrittenLens {
  std::string text;
  std::vector<std::string> losses;  // "the coatings of 12 surfaces are not written"
};

[[nodiscard]] CONTREJOUR_API Result<WrittenLens> write_lens_zmx(const Prescription& lens);
[[nodiscard]] CONTREJOUR_API Result<WrittenLens> write_lens_seq(const Prescription& lens);

// Writes the path of a ghost through a configured lens: every surface in the order and as often as the light meets it,
// mirrors where it reflects, negative gaps where it travels back. This is for other programs: read_lens() refuses
// mirrors. Errors: InvalidArgument for a ghost that the lens does not have; Unsupported for a diffraction order.
[[nodiscard]] CONTREJOUR_API Result<WrittenLens> write_ghost_zmx(const LensState& lens, const Ghost& ghost);
[[nodiscard]] CONTREJOUR_API Result<WrittenLens> write_ghost_seq(const LensState& lens, const Ghost& ghost);

}  // namespace contrejour
