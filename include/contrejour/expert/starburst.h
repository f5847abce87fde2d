// SPDX-License-Identifier: Apache-2.0
// The starburst: a light's own image, spread by diffraction at the pupil, in colour.
// Units: pixels; flux per pixel relative to the light's, so that the whole plane sums to the light's RGB.
// Accuracy: flux within 1e-3; pixels are integrals of the pattern, so any window of them holds its flux within 1 per
// cent; the tail far beyond the spectrum's samples within 10 per cent of the fringes' mean
// (docs/physics/diffraction.md). Errors: InvalidArgument for invalid settings, bands or masks, Cancelled.
// Thread-safety: a Starburst is a value to share; results do not depend on the threads. Source:
// hullin2011 3.3 and eq. 2; Differs: in absolute scale, which hullin2011 leaves to the user (eq. 3 and 4).
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/colour.h"
#include "contrejour/expert/dirt.h"
#include "contrejour/expert/iris.h"
#include "contrejour/expert/pupil_mask.h"
#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/image.h"
#include "contrejour/result.h"

namespace contrejour {

struct StarburstSettings {
  double distance_mm = 50.0;     // exit pupil to sensor
  double pupil_radius_mm = 5.0;  // the stop's radius as imaged into the exit pupil
  double pixel_pitch_mm = 0.01;
  double radius_px = 1200.0;     // drawn up to this distance from its centre: to the frame's farthest corner
  int samples_across = 510;      // of the pupil, where the mask is made from an opening
};

// The dirt within a mask, for the diffraction beyond the mask's samples.
struct PupilDirt {
  std::vector<DirtStroke> strokes;  // those within the opening, in part at least
  Vec2 x_mm, y_mm;  // the dirt's own unit vectors in the mask's plane
  double power_mm2 =
      0;  // integral of the mask's power transmittance, which amplitudes of partly covered samples do not give
};

// A mask's outline: an opening, and its unit vectors in the mask's plane. A pupil seen at an angle is foreshortened:
// its circle becomes an ellipse.
struct PupilOutline {
  IrisOpening opening{Iris{}};
  Vec2 x_mm, y_mm;
  std::shared_ptr<const PupilDirt> dirt = nullptr;  // null: none, or none that has shapes
  std::vector<double> obscured_mm2 = {};  // areas in the mask's plane of opaque discs within the opening
  double slope_spread_rad = 0.0;  // RMS of the edges' slopes about the opening's (iris_slope_spread_rad)

  // The area that is open.
  [[nodiscard]] double area_mm2() const {
    return std::accumulate(obscured_mm2.begin(), obscured_mm2.end(), opening.area() * std::abs(cross(x_mm, y_mm)),
                           std::minus<>());
  }
};

inline namespace internal {
struct StarburstRings;
}

// A starburst for one pupil, pitch and spectrum, which can be drawn for any number of lights.
class Starburst {
 public:
  explicit Starburst(std::shared_ptr<const StarburstRings> rings = nullptr) : rings_(std::move(rings)) {}
  [[nodiscard]] const StarburstRings* rings() const { return rings_.get(); }  // null: nothing is open

 private:
  std::shared_ptr<const StarburstRings> rings_;
};

// bands: spectral_bands of the light, 100 and more (5 nm and finer), their weights times the lens's transmittance.
[[nodiscard]] CONTREJOUR_API Result<Starburst> make_starburst(const IrisOpening& opening,
                                                              std::span<const SpectralBand> bands,
                                                              const StarburstSettings& settings,
                                                              const Context& context = {});

// Makes a starburst from any mask without phase, in mm of the exit pupil: vignetted, with dirt, a picture. outline:
// determines the tail beyond the mask's own samples; null: the outermost samples are continued as r^-3.
[[nodiscard]] CONTREJOUR_API Result<Starburst> make_starburst(const PupilMask& mask, const PupilOutline* outline,
                                                              std::span<const SpectralBand> bands,
                                                              const StarburstSettings& settings,
                                                              const Context& context = {});

// Adds a light's starburst to an RGB image; centre in pixels, (0, 0) the top left corner; it may lie outside.
CONTREJOUR_API void add_starburst(Image& image, const Starburst& starburst, Vec2 centre_px, const Rgb& flux,
                                  const Context& context = {});

inline namespace internal {
struct StarburstSamples;
}

// A starburst precomputed at pixels, which can be drawn in a few milliseconds a frame as the light moves. It is a value
// to share, valid while lens, light direction and pixel pitch stay (nearly) the same. Accuracy: within 16 pixels of the
// centre placed to an eighth of a pixel; from 20 pixels on, linear interpolation between samples a pixel apart: smooth
// parts to 1 per cent (5 where the pattern's own fringes are finer than pixels), spikes narrower than pixels up to half
// a pixel wider. The flux is the same to 1e-4.
class StarburstImage {
 public:
  explicit StarburstImage(std::shared_ptr<const StarburstSamples> samples = nullptr) : samples_(std::move(samples)) {}
  [[nodiscard]] const StarburstSamples* samples() const { return samples_.get(); }  // null: it draws nothing

 private:
  std::shared_ptr<const StarburstSamples> samples_;
};

// For frames of up to width x height pixels that contain the light: 24 bytes * width * height. Beyond that distance it
// is drawn from the starburst itself, at the starburst's speed. Errors: InvalidArgument (no pixels, more than 2^26 of
// them), Cancelled.
[[nodiscard]] CONTREJOUR_API Result<StarburstImage> lay_out(const Starburst& starburst, int width, int height,
                                                            const Context& context = {});

CONTREJOUR_API void add_starburst(Image& image, const StarburstImage& sheet, Vec2 centre_px, const Rgb& flux,
                                  const Context& context = {});

}  // namespace contrejour
