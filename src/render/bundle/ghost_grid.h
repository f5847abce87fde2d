// SPDX-License-Identifier: Apache-2.0
// From a ghost, a light and a wavelength to a traced grid: where its rays enter, their number, and the frame of
// reference. The accelerations of hullin2011 4.2 that concern rays are applied here: bounds, grid levels, symmetries.
#pragma once

#include <optional>

#include "contrejour/lens.h"
#include "contrejour/method_options.h"
#include "ghosts/meridian.h"
#include "optics/trace/by_wavelength.h"
#include "render/bundle/map_figures.h"
#include "render/pupils/kept_pupils.h"
#include "render/pupils/pupil_bounds.h"
#include "render/stop_patterns/stop_transmittances.h"

namespace contrejour::inline internal::bundle {

struct Counts {
  std::uint64_t rays = 0, surface_hits = 0, primitives = 0;
  double search_ms = 0, trace_ms = 0, raster_ms = 0;

  void add(const Counts& other);
};

// A ghost's pupil, and what a coarse grid found about its map.
struct GhostPupil {
  double lambda_nm = 0;
  OpticalPath path;
  Meridian meridian;     // that of the light; or no rotation
  Iris iris;             // rotated to that meridian
  double plane_z_mm = 0;
  pupils::PupilRegion region;
  StopTransmittance stop;  // path and iris: as it requires
  std::optional<MapFigures> figures;  // in the sensor's frame; only if a coarse grid was requested
};

// What all grids of a frame are traced from; all must outlive the grids.
struct GridSource {
  const LensState& lens;
  const BundleOptions& options;
  const TablesByWavelength& tables;
  const StopTransmittances& stops;
  pupils::KeptPupils& kept;
  const pupils::PupilBounds* bounds;  // replace a search, for distant lights without a stop pattern; may be null
  const Context& context;
};

class GhostGrid {
 public:
  GhostGrid(const GridSource& source, double pixel_pitch_mm) : from_(source), pixel_pitch_mm_(pixel_pitch_mm) {}

  // nullopt when nothing gets through. with_figures: the figures are computed whatever the options are.
  [[nodiscard]] std::optional<GhostPupil> find(Ghost ghost, const LightSource& light, double lambda_nm,
                                               bool with_figures);

  // The rays a side and the precision with which trace() traces a pupil.
  struct Sampling {
    int side = 0;
    PacketPrecision precision = PacketPrecision::Float;
  };
  [[nodiscard]] Sampling sampling_of(const GhostPupil& pupil) const;

  // Traces the pupil; rays() is valid until the next find() or trace().
  void trace(const GhostPupil& pupil);
  [[nodiscard]] const RayGrid& rays() const { return rays_; }

  [[nodiscard]] Counts& counts() { return counts_; }

 private:
  // The mirror image may be used only for a lens with axial symmetry.
  [[nodiscard]] bool mirrors() const { return from_.options.mirror_symmetry && from_.lens.has_axial_symmetry(); }
  [[nodiscard]] const ReflectanceTables& tables_of(const GhostPupil& pupil) const;
  [[nodiscard]] std::optional<pupils::PupilRegion> search(Ghost ghost, const GhostPupil& pupil,
                                                          const EntranceWindow& window);
  [[nodiscard]] MapFigures figures_of(const GhostPupil& pupil);
  [[nodiscard]] int side_of(const GhostPupil& pupil) const;
  void count_rays(std::uint64_t rays, const OpticalPath& path);

  GridSource from_;
  double pixel_pitch_mm_;
  RayGrid rays_;
  Counts counts_;
};

}  // namespace contrejour::inline internal::bundle
