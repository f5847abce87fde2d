// SPDX-License-Identifier: Apache-2.0
// The states of a lens in a range of zoom or focus, by their coordinate, each made at its first use.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "contrejour/expert/polynomial_range.h"
#include "optics/trace/by_wavelength.h"

namespace contrejour::inline internal::polynomial {

// The position of a lens's surfaces between those of two states, 0 to 1: the best fit to all of them.
[[nodiscard]] double between_positions(std::span<const double> low_mm, std::span<const double> high_mm,
                                       std::span<const double> z_mm);

// All vertices' positions, and last the sensor's.
[[nodiscard]] std::vector<double> positions_of(const LensState& lens);

// A state, wide open, with what rays are traced by.
struct RangeState {
  RangeState(const LensState& state, const TablesByWavelength& tables, double field);

  LensState lens;
  StepsByWavelength steps;
  double largest_field = 0.0;  // tangent
};

// Thread-safe.
class RangeStates {
 public:
  // Errors: those of configure_lens at the ends of the range; a range that is empty.
  [[nodiscard]] static Result<std::unique_ptr<RangeStates>> create(const Prescription& lens,
                                                                   const LensSettings& settings,
                                                                   const PolynomialRangeOptions& options);

  // Rising coordinates between which positions vary smoothly: the ends of the range, and the zoom's own positions.
  [[nodiscard]] const std::vector<double>& breaks() const { return breaks_; }
  // Focal lengths or object distances at the first and the last of them.
  [[nodiscard]] std::array<double, 2> ends_mm() const { return ends_mm_; }
  // coordinate: within the range. Null if the lens has no such state.
  [[nodiscard]] const RangeState* at(double coordinate);

 private:
  RangeStates(const Prescription& lens, const LensSettings& settings, const PolynomialRangeOptions& options)
      : lens_(lens), settings_(settings), options_(options) {}

  [[nodiscard]] Result<LensState> configured(double setting_mm) const;
  [[nodiscard]] Result<LensState> zoomed(double coordinate) const;
  Result<void> find_breaks();
  void keep(double coordinate, const LensState& lens);

  const Prescription& lens_;
  LensSettings settings_;
  const PolynomialRangeOptions& options_;
  std::vector<double> breaks_;
  std::array<double, 2> ends_mm_{};
  std::vector<std::vector<double>> break_positions_;  // of zooms
  std::unique_ptr<LensState> first_;  // its reflectances are those of all states
  TablesByWavelength tables_;
  std::mutex mutex_;
  std::map<double, std::unique_ptr<RangeState>> states_;
};

}  // namespace contrejour::inline internal::polynomial
