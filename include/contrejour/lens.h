// SPDX-License-Identifier: Apache-2.0
// A lens as its patent lists it (Prescription), and the same lens configured for a picture (LensState).
// Lengths mm, z = 0 at the first vertex, light travels to +z. Surfaces count from 1 in prescription order
// wherever a user sees a number; vectors count from 0. Thread-safety: plain values.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contrejour/expert/clear_aperture.h"
#include "contrejour/expert/coating.h"
#include "contrejour/expert/dirt.h"
#include "contrejour/expert/glass.h"
#include "contrejour/expert/iris.h"
#include "contrejour/expert/surface_shape.h"
#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

class GlassCatalogue;  // glass_catalogue.h

enum class SurfaceKind {
  Refracting,
  Stop,
  Sensor,  // in a LensState only: light ends there, unless reflected
};

// Decentre and tilt of a surface.
struct SurfacePose {
  Vec3 shift_mm{};     // displacement of its vertex
  Vec3 axis{0, 0, 1};  // unit, z > 0; the smallest rotation takes +z there
  friend bool operator==(const SurfacePose&, const SurfacePose&) = default;
};

struct Surface {
  SurfaceKind kind = SurfaceKind::Refracting;
  double curvature_per_mm = 0.0;  // 1 / radius, 0 for a plane, > 0 when the centre lies to +z
  double thickness_mm = 0.0;      // to the next vertex; unused on the last surface
  double semi_diameter_mm = 0.0;  // clear radius; for the stop, its widest opening
  Glass glass_after = {};         // the medium behind; for the stop, the same as in front
  Coating coating = {};
  int source_line = 0;            // in the file it was read from, 0 unknown
  SurfaceShape shape = {};
  SurfacePose pose = {};          // decentred and tilted elements; those around stay where they are
  ClearAperture aperture = {};    // within semi_diameter_mm; the stop's opening is the iris
  Obscuration obscuration = {};   // the stop may have one, too
};

// One position of a zoom: thicknesses (mm) that replace those of the surfaces, by vector index.
struct ZoomPosition {
  double focal_length_mm = 0.0;  // nominal: the number a photographer asks for
  std::vector<std::pair<int, double>> thickness_mm;
  int source_line = 0;
};

// First-order values that the source states; readers report a lens whose computed values differ.
struct StatedFigures {
  double wavelength_nm = kLineD_nm;
  std::optional<double> focal_length_mm;
  std::optional<double> back_focal_distance_mm;
  double tolerance = 0.01;  // relative
};

struct Prescription {
  std::string name;    // "Canon 70-200mm f/2.8"
  std::string source;  // patent or book, with its number
  std::vector<Surface> surfaces;
  std::vector<ZoomPosition> zoom;  // empty: a prime; else in rising focal length
  double f_number = 0.0;           // widest
  double sensor_width_mm = 36.0;
  double sensor_height_mm = 24.0;
  std::optional<double> sensor_distance_mm;  // last vertex -> sensor at infinity focus; default: paraxial focus
  StatedFigures stated;
  SourcePosition file;
  // What a reader interpreted differently from its file, or could not read: for people, with the line.
  std::vector<std::string> warnings;
};

// How the f-number changes the blades (docs/physics/diffraction.md).
enum class IrisClosing {
  Scaled,     // one shape at every f-number, scaled to the radius of the round stop
  Mechanism,  // blades close over the round hole of the widest f-number until the opening has the area of the round
              // stop: round wide open, then rim and blades alternating, then the blades' polygon
};

// Manufacturing errors: each body of glass between air gaps, cemented parts together, is tilted about its middle and
// decentred by its own random amounts; the stop stays. Normally distributed in both directions.
struct BuildErrors {
  double tilt_rms_rad = 0.0;  // of the angle between the body's axis and the lens's; up to kMaxTilt_rad
  double decentre_rms_mm = 0.0;  // of the distance between the body's middle and the lens's axis
  std::uint32_t seed = 0;  // selects one of the lenses with such errors

  static constexpr double kMaxTilt_rad = 0.2;
};

// A plane plate in air in front of the sensor: its cover glass or a filter.
struct SensorPlate {
  double thickness_mm = 1.0;
  double gap_mm = 1.0;  // behind it, to the next plate or the sensor
  Glass glass;
  Coating coating;  // of both its sides
};

// The plates behind the lens and the sensor's own reflection. The plates move the focus back, and the sensor with it.
struct SensorStack {
  std::vector<SensorPlate> plates;  // from the lens to the sensor
  double reflectance = 0.0;  // of the sensor's whole area, at all angles and wavelengths
  // The sensor's pixels act as a grating of reflecting squares: orders up to this number in x and in y, each a ghost of
  // its own.
  int orders = 0;
  double pitch_mm = 0.005;  // of the grating
  double fill = 0.8;  // side of a square over the pitch

  static constexpr int kMaxOrders = 20;
  static constexpr std::size_t kMaxPlates = 10;
};

// A coating for one surface, in place of the one that the lens has there.
struct SurfaceCoating {
  int surface = 0;  // 1-based; one that bounds glass, cemented or not
  Coating coating = {};
};

inline constexpr double kLargestFNumber = 1e5;

struct LensSettings {
  std::optional<double> focal_length_mm = std::nullopt;  // zoom; default: the first position
  std::optional<double> f_number = std::nullopt;  // default: the widest; at most kLargestFNumber
  double object_distance_mm = std::numeric_limits<double>::infinity();  // from surface 1; focus
  std::optional<Coating> coating = std::nullopt;  // in place of every glass-to-air coating
  std::vector<SurfaceCoating> coating_at = {};  // then for single surfaces; the last one for a surface counts
  Iris iris = {};
  IrisClosing iris_closing = IrisClosing::Scaled;  // Mechanism sets the iris's blade_radius
  BuildErrors build = {};
  Dirt dirt = {};
  SensorStack sensor = {};
  bool absorption = false;  // glass absorbs light, where its catalogue has data
};

struct SurfaceState {
  SurfaceKind kind = SurfaceKind::Refracting;
  double z_mm = 0.0;
  double curvature_per_mm = 0.0;
  double semi_diameter_mm = 0.0;
  Glass before = {}, after = {};
  Coating coating = {};
  SurfacePose pose = {};
  SurfaceShape shape = {};
  ClearAperture aperture = {};
  Obscuration obscuration = {};
  friend bool operator==(const SurfaceState&, const SurfaceState&) = default;

  [[nodiscard]] bool is_centred() const { return pose == SurfacePose{}; }
  [[nodiscard]] bool has_axial_symmetry() const {
    return is_centred() && shape.has_axial_symmetry() && aperture.kind == ApertureKind::Disc &&
           obscuration.has_axial_symmetry();
  }
};

// The grating that the sensor's pixels form for reflected light (SensorStack).
struct SensorGrating {
  int orders = 0;
  double pitch_mm = 0.005;
  double fill = 0.8;
};

// Everything a renderer needs to know of the lens: fixed positions, stop radius, sensor in focus.
struct LensState {
  std::string name;
  std::vector<SurfaceState> surfaces;
  int stop_index = 0;  // into surfaces
  double stop_radius_mm = 0.0;  // the largest distance of the opening from the axis
  Iris iris;
  Dirt dirt;
  double sensor_z_mm = 0.0;
  double sensor_width_mm = 36.0;
  double sensor_height_mm = 24.0;
  double focal_length_mm = 0.0;
  double f_number = 0.0;
  double object_distance_mm = std::numeric_limits<double>::infinity();
  double design_wavelength_nm = kLineD_nm;
  bool absorption = false;
  SensorGrating sensor_grating;
  std::vector<std::string> warnings;

  // Surfaces of revolution about one axis, so that one meridian determines the lens.
  [[nodiscard]] bool has_axial_symmetry() const {
    return std::all_of(surfaces.begin(), surfaces.end(), [](const SurfaceState& s) { return s.has_axial_symmetry(); });
  }
};

// Checks a prescription: stop, semi-diameters, finite values, surfaces that cross inside their clear
// aperture (at every zoom position). Errors name file, line and remedy.
[[nodiscard]] CONTREJOUR_API Result<void> validate(const Prescription& lens);

// Sets zoom (any focal length within the range), stop and focus. Errors: a focal length or f-number out of range, a
// coating for a surface that does not bound glass, an object inside the front focal point, a sensor stack that does not
// fit behind the lens, an iris that lets nothing through, numbers of the iris or the dirt out of range.
[[nodiscard]] CONTREJOUR_API Result<LensState> configure_lens(const Prescription& lens,
                                                              const LensSettings& settings = {});

// Reads a lens in any supported format, recognised by content and extension. Bounded in memory and time. Glasses that
// the file names are looked for in `glasses`, if given, and then in the bundled catalogue.
[[nodiscard]] CONTREJOUR_API Result<Prescription> read_lens(const std::filesystem::path& file,
                                                            const GlassCatalogue* glasses = nullptr);

// Our own format (docs/formats/lens-toml.md) from memory; `file` names it in errors.
[[nodiscard]] CONTREJOUR_API Result<Prescription> read_lens_toml(std::string_view text, const std::string& file,
                                                                 const GlassCatalogue* glasses = nullptr);
[[nodiscard]] CONTREJOUR_API std::string write_lens_toml(const Prescription& lens);

// Lenses that come with the library.
struct BundledLens {
  std::string_view name;  // "canon-70-200"
  std::string_view toml;
};
[[nodiscard]] CONTREJOUR_API std::vector<BundledLens> bundled_lenses();

// A bundled name, or else a file.
[[nodiscard]] CONTREJOUR_API Result<Prescription> find_lens(const std::string& name_or_file,
                                                            const GlassCatalogue* glasses = nullptr);

}  // namespace contrejour
