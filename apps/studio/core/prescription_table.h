// SPDX-License-Identifier: Apache-2.0
// A lens as a table that one can type in: a row for each surface, cells as texts. Rows count from 0. Errors:
// InvalidArgument with the reason, for the cell; those of validate(), for the lens. Thread-safety: pure functions.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/lens.h"

namespace contrejour::studio {

enum class LensColumn { Radius, Thickness, Glass, SemiDiameter, Conic, Coating };
inline constexpr std::array<LensColumn, 6> kLensColumns = {LensColumn::Radius, LensColumn::Thickness,
                                                           LensColumn::Glass,  LensColumn::SemiDiameter,
                                                           LensColumn::Conic,  LensColumn::Coating};
[[nodiscard]] std::string_view heading_of(LensColumn column);  // with its unit

// Empty where the surface has no such value: the glass of air, the radius of the stop.
[[nodiscard]] std::string cell_text(const Prescription& lens, std::size_t row, LensColumn column);
[[nodiscard]] bool is_editable(const Prescription& lens, std::size_t row, LensColumn column);

[[nodiscard]] Result<Prescription> with_cell(const Prescription& lens, std::size_t row, LensColumn column,
                                             std::string_view text);

// A surface in the middle of the gap behind the row, in its medium, with the mean of its neighbours' curvatures.
[[nodiscard]] Result<Prescription> with_inserted_surface(const Prescription& lens, std::size_t row);
// Its gap is added to that of the surface in front. Errors: also the stop.
[[nodiscard]] Result<Prescription> without_surface(const Prescription& lens, std::size_t row);
// All lengths times the factor, the sensor's size excepted. Errors: also a factor that is not above 0.
[[nodiscard]] Result<Prescription> scaled_lens(const Prescription& lens, double factor);
// Light passes it from the other end. Errors: Unsupported for zooms, and for surfaces that are tilted or decentred.
[[nodiscard]] Result<Prescription> reversed_lens(const Prescription& lens);

// Names of bundled glasses that begin with this text, in any case, without repetition.
[[nodiscard]] std::vector<std::string> glasses_like(std::string_view text, std::size_t count);
// The same, or those that begin with the longest beginning of the text that any name has.
[[nodiscard]] std::vector<std::string> glasses_near(std::string_view text, std::size_t count);

}  // namespace contrejour::studio
