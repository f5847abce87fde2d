// From a ghost, a light and a wavelength to a traced grid: where its rays enter, how many, in which frame.
// Here hullin2011's accelerations of 4.2 are heeded that concern rays: bounds, grid levels, symmetries.
#pragma once

#include <optional>

#include "contrejour/lens.h"
#include "contrejour/method_options.h"
#include "ghosts/meridian.h"
#include "ghosts/pupil_bounds.h"
#include "optics/trace/by_wavelength.h"
#include "render/bundle/map_figures.h"
#include "render/screens/screens.h"

namespace contrejour::bundle {

struct Counts {
  std::uint64_t rays = 0, surface_hits = 0, primitives = 0;
  double search_ms = 0, trace_ms = 0, raster_ms = 0;

  void add(const Counts& other);
};

// A ghost's pupil and what a look at it told.
struct GhostPupil {
  double lambda_nm = 0;
  OpticalPath path;
  Meridian meridian;     // of the light; or as it comes, with no turn
  Iris iris;             // as it stands there
  double plane_z_mm = 0;
  PupilRegion region;
  std::shared_ptr<const StopScreen> screen;  // null: the iris is sharp; else it is a circle, and the path a widened one
  std::shared_ptr<const DirtScreen> dirt;  // null: its shadows are sharp
  std::optional<MapFigures> figures;  // in the frame of the sensor, where a look was asked for
};

// What all grids of a frame are traced from; all must outlive the grids.
struct GridSource {
  const LensState& lens;
  const BundleOptions& options;
  const TablesByWavelength& tables;
  const Screens& screens;
  const PupilBounds* bounds;  // in place of a search, for distant lights where there is no screen; may be null
};

class GhostGrid {
 public:
  GhostGrid(const GridSource& source, double pixel_pitch_mm) : from_(source), pixel_pitch_mm_(pixel_pitch_mm) {}

  // None when nothing gets through. look: figures are wanted whatever the options are.
  [[nodiscard]] std::optional<GhostPupil> find(Ghost ghost, const LightSource& light, double lambda_nm, bool look);

  // Traces the pupil; rays() is valid until the next find() or trace().
  void trace(const GhostPupil& pupil);
  [[nodiscard]] const RayGrid& rays() const { return rays_; }

  [[nodiscard]] Counts& counts() { return counts_; }

 private:
  // A lens without axial symmetry has no mirror image.
  [[nodiscard]] bool mirrors() const { return from_.options.mirror_symmetry && from_.lens.has_axial_symmetry(); }
  [[nodiscard]] const ReflectanceTables& tables_of(const GhostPupil& pupil) const;
  [[nodiscard]] PupilEffort search_effort() const;
  [[nodiscard]] MapFigures figures_of(const GhostPupil& pupil);
  [[nodiscard]] int side_of(const GhostPupil& pupil) const;
  void count_rays(std::uint64_t rays, const OpticalPath& path);

  GridSource from_;
  double pixel_pitch_mm_;
  RayGrid rays_;
  Counts counts_;
};

}  // namespace contrejour::bundle
