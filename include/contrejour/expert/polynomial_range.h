// SPDX-License-Identifier: Apache-2.0
// One fit of a lens's ghosts for a range of zoom or focus: polynomials at nodes of the range, between which their
// coefficients are interpolated, checked by rays of states between the nodes. docs/physics/polynomial.md, "Zoom and
// focus"; docs/formats/poly.md describes the file. Units: mm. Accuracy: that which each zone states, at states between
// the nodes; parts of a ghost that do not reach it are marked Traced. Thread-safety: plain values, pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "contrejour/expert/polynomial.h"

namespace contrejour {

enum class PolynomialVariable : std::uint8_t {
  // The coordinate is 0 at the range's shortest focal length, rises by 1 to each next position of the zoom and to the
  // longest focal length, and varies between them in proportion to the spaces between the surfaces.
  Zoom,
  Focus,  // the coordinate is the inverse of the object's distance in mm; 0: infinity
};

struct PolynomialRangeOptions {
  PolynomialVariable variable = PolynomialVariable::Zoom;
  // Focal lengths as LensSettings::focal_length_mm has them, or object distances, in any order.
  double from_mm = 0.0, to_mm = 0.0;
  int max_divisions = 3;  // of the range, where a ghost does not reach the accuracy; 0 to 4
  PolynomialOptions fit = {};  // its accuracy holds between the nodes
};

// A ghost over a part of the range: zones of the field by rising field, adjoining, each at all nodes of the part
// (Chebyshev-Lobatto points from `high` to `low`).
struct PolynomialSpan {
  double low = 0.0, high = 0.0;  // coordinates
  std::vector<std::vector<PolynomialZone>> zones;
};

struct GhostRange {
  Ghost ghost;
  std::vector<PolynomialSpan> spans;  // by rising coordinate, adjoining
};

// The vertices' and last the sensor's positions at nodes of a part of the range, which show whether a lens is the one
// that was fitted, at a state of the range.
struct RangePositions {
  double low = 0.0, high = 0.0;
  std::vector<std::vector<double>> z_mm;  // by node
};

struct LensPolynomialRange {
  LensPolynomials common;  // without ghosts; the fingerprint is that of the lens without its positions
  PolynomialVariable variable = PolynomialVariable::Zoom;
  std::array<double, 2> ends_mm{};  // focal lengths or object distances, by rising coordinate
  std::vector<RangePositions> positions;  // by rising coordinate, adjoining
  std::vector<GhostRange> ghosts;
};

// Fits the ghosts of a lens over the range; `settings` has all that does not vary. In parallel; the result does not
// depend on the number of threads. Errors: those of configure_lens and fit_polynomials; a range that is empty.
[[nodiscard]] CONTREJOUR_API Result<LensPolynomialRange> fit_polynomial_range(const Prescription& lens,
                                                                              const LensSettings& settings,
                                                                              const PolynomialRangeOptions& options,
                                                                              const Context& context = {});

// The fit of one state. Errors: InvalidArgument for another lens, and for a state that is not of the range.
[[nodiscard]] CONTREJOUR_API Result<LensPolynomials> polynomials_at(const LensPolynomialRange& range,
                                                                    const LensState& lens);

// As traced_flux_fraction(const LensPolynomials&), over the whole range.
[[nodiscard]] CONTREJOUR_API double traced_flux_fraction(const LensPolynomialRange& range);

// Files. Errors: Io; Parse for anything that is not a whole and consistent file.
[[nodiscard]] CONTREJOUR_API std::string write_polynomial_range(const LensPolynomialRange& range);

// A file of one state or of a range.
using AnyPolynomials = std::variant<LensPolynomials, LensPolynomialRange>;
[[nodiscard]] CONTREJOUR_API Result<AnyPolynomials> read_any_polynomials(std::string_view bytes,
                                                                         const std::string& file);
[[nodiscard]] CONTREJOUR_API Result<AnyPolynomials> read_any_polynomial_file(const std::filesystem::path& file);

}  // namespace contrejour
