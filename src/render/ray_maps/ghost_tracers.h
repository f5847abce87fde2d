// SPDX-License-Identifier: Apache-2.0
// The rays of a light's ghost at each of its wavelengths: their sources are made when first used.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "optics/trace/by_wavelength.h"
#include "optics/trace/lens_steps.h"
#include "render/planning/planned_light.h"
#include "render/pupils/clearance_grid.h"
#include "render/ray_maps/lobatto_rays.h"

namespace contrejour::inline internal::ray_maps {

class GhostTracers {
 public:
  // All arguments must outlive this object. plane_z_mm: of the light's entrance window. stop_times: the factor by which
  // the stop's radius is enlarged (stop_transmittance.h). fitted: evaluates the rays; null: they are traced.
  GhostTracers(const StepsByWavelength& steps, Ghost ghost, const LightFrame& light, double plane_z_mm,
               std::span<const PlannedPass> passes, double stop_times, const FittedGhost* fitted = nullptr)
      : steps_(steps), ghost_(ghost), light_(light), passes_(passes), stop_times_(stop_times), plane_z_mm_(plane_z_mm),
        fitted_(fitted), tracers_(passes.size()) {}

  [[nodiscard]] LobattoTracer& at(std::size_t pass) {
    std::optional<LobattoTracer>& tracer = tracers_[pass];
    if (!tracer) tracer.emplace(source(pass), light_);
    tracer->curve(curve_);
    return *tracer;
  }
  // Sets the curve of the sides of the boxes that are traced from here on.
  void curve(const SideCurve& curve) { curve_ = curve; }
  [[nodiscard]] bool is_curved() const { return curve_.is_curved(); }
  // Finds where the rays of a pass are blocked.
  [[nodiscard]] ClearanceGrid clearance(std::size_t pass) const { return ClearanceGrid(path(pass)); }

  [[nodiscard]] const LightFrame& light() const { return light_; }
  [[nodiscard]] std::span<const PlannedPass> passes() const { return passes_; }
  [[nodiscard]] double plane_z_mm() const { return plane_z_mm_; }
  [[nodiscard]] double stop_times() const { return stop_times_; }

  // Adds to the counts the rays that a clearance grid traced.
  void count(const ClearanceGrid& grid) {
    clearance_rays_ += grid.rays();
    clearance_hits_ += grid.rays() * grid.steps();
  }
  [[nodiscard]] std::uint64_t rays() const { return clearance_rays_ + sum(&LobattoTracer::rays); }
  [[nodiscard]] std::uint64_t traced_rays() const { return clearance_rays_ + sum(&LobattoTracer::traced_rays); }
  [[nodiscard]] std::uint64_t surface_hits() const { return clearance_hits_ + sum(&LobattoTracer::surface_hits); }

 private:
  [[nodiscard]] std::unique_ptr<RaySource> source(std::size_t pass) const {
    if (fitted_ != nullptr) return fitted_->at(passes_[pass].lambda_nm);
    return std::make_unique<TracedRays>(path(pass));
  }
  [[nodiscard]] PacketPath path(std::size_t pass) const {
    return {steps_.at(passes_[pass].lambda_nm), ghost_, {{0.0, 0.0, plane_z_mm_}, light_.source}, stop_times_};
  }
  [[nodiscard]] std::uint64_t sum(std::uint64_t (LobattoTracer::*of)() const) const {
    std::uint64_t total = 0;
    for (const auto& tracer : tracers_) total += tracer ? ((*tracer).*of)() : 0;
    return total;
  }

  const StepsByWavelength& steps_;
  Ghost ghost_;
  const LightFrame& light_;
  std::span<const PlannedPass> passes_;
  double stop_times_;
  double plane_z_mm_;
  const FittedGhost* fitted_;
  SideCurve curve_;
  std::uint64_t clearance_rays_ = 0, clearance_hits_ = 0;
  std::vector<std::optional<LobattoTracer>> tracers_;  // one a pass
};

}  // namespace contrejour::inline internal::ray_maps
