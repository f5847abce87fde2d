// SPDX-License-Identifier: Apache-2.0
// The source of rays: they are traced through the lens, or evaluated from a fit of the ghost. Those who search pupils
// and draw ghosts ask for rays here, and do not depend on which it is.
// Thread-safety: a source serves one thread at a time; fits are shared by all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "ghosts/ray_grid.h"
#include "optics/trace/clearance.h"

namespace contrejour::inline internal::pupils {

// The rays of one ghost and light at one wavelength, through points of the entrance plane in the light's frame.
class RaySource {
 public:
  RaySource() = default;
  RaySource(const RaySource&) = delete;
  RaySource& operator=(const RaySource&) = delete;
  virtual ~RaySource() = default;

  // Points are relative to origin_mm. rim_squared has rims() rows.
  virtual void rays(Vec2 origin_mm, PacketPrecision precision, const float* x_mm, const float* y_mm, std::size_t count,
                    const TracedArrays& out) = 0;
  // The transmissions of the same rays alone.
  virtual void transmissions(Vec2 origin_mm, PacketPrecision precision, const float* x_mm, const float* y_mm,
                             std::size_t count, float* out) = 0;
  // The arrays extend to clearance_padded(count).
  virtual void clearances(Vec2 origin_mm, PacketPrecision precision, const float* x_mm, const float* y_mm,
                          std::size_t count, const ClearanceArrays& out) = 0;

  [[nodiscard]] virtual int stop_crossings() const = 0;
  [[nodiscard]] virtual std::size_t rims() const = 0;  // that relative heights are given for
  [[nodiscard]] virtual bool blocks_within(std::size_t rim) const = 0;  // an obscuration
  // The relative height below which values hold: beyond it, those of a fit have any size.
  [[nodiscard]] virtual float reach() const = 0;
  // Surfaces that a ray is traced to; 0: rays are not traced.
  [[nodiscard]] virtual std::size_t surfaces() const = 0;
};

// Rays that are traced along a path, whose steps are the rims.
class TracedRays final : public RaySource {
 public:
  // path: of the light, from any point of the entrance plane.
  explicit TracedRays(PacketPath path) : path_(std::move(path)) {}

  void rays(Vec2 origin_mm, PacketPrecision precision, const float* x_mm, const float* y_mm, std::size_t count,
            const TracedArrays& out) override;
  void transmissions(Vec2 origin_mm, PacketPrecision precision, const float* x_mm, const float* y_mm, std::size_t count,
                     float* out) override;
  void clearances(Vec2 origin_mm, PacketPrecision precision, const float* x_mm, const float* y_mm, std::size_t count,
                  const ClearanceArrays& out) override;
  [[nodiscard]] int stop_crossings() const override { return path_.stop_crossings(); }
  [[nodiscard]] std::size_t rims() const override { return path_.steps().size(); }
  [[nodiscard]] bool blocks_within(std::size_t rim) const override { return path_.steps()[rim].blocks_within; }
  [[nodiscard]] float reach() const override { return kFailed; }
  [[nodiscard]] std::size_t surfaces() const override { return path_.steps().size(); }

 private:
  PacketPath path_;
  std::vector<float> unused_;  // by the caller: scratch memory
};

// A ghost of a light whose rays are evaluated at any wavelength of the fit.
class FittedGhost {
 public:
  FittedGhost() = default;
  FittedGhost(const FittedGhost&) = delete;
  FittedGhost& operator=(const FittedGhost&) = delete;
  virtual ~FittedGhost() = default;

  [[nodiscard]] virtual std::unique_ptr<RaySource> at(double lambda_nm) const = 0;
  // A box that contains all light that enters, whatever the stop's opening; where it is symmetric about the light's
  // meridian, its upper half.
  [[nodiscard]] virtual Rectangle region() const = 0;
  [[nodiscard]] virtual bool is_symmetric() const = 0;
};

// The light of one ghost for which rays are needed.
struct RayRequest {
  Ghost ghost;
  const LightFrame& light;
  double plane_z_mm = 0.0;  // of the light's entrance window
  double stop_radius_mm = 1.0;  // that stop coordinates are divided by
  double shortest_nm = 0.0, longest_nm = 0.0;
};

// The fit of a lens's ghosts.
class FittedGhosts {
 public:
  FittedGhosts() = default;
  FittedGhosts(const FittedGhosts&) = delete;
  FittedGhosts& operator=(const FittedGhosts&) = delete;
  virtual ~FittedGhosts() = default;

  // Null where rays must be traced. A dark ghost has no light: its upper half is empty.
  [[nodiscard]] virtual std::unique_ptr<FittedGhost> find(const RayRequest& request) const = 0;
};

}  // namespace contrejour::inline internal::pupils
