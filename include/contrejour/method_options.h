// SPDX-License-Identifier: Apache-2.0
// Options of the rendering methods, each of a type of its own, and the one type that holds those of any method.
// Ranges are stated at the members; render() refuses values outside of them. Thread-safety: plain values.
#pragma once

#include "contrejour/export.h"

#include <any>
#include <concepts>
#include <string_view>
#include <utility>

namespace contrejour {

// The grid of rays that is traced for each ghost.
struct GridOptions {
  int rays = 256;  // along each side, 4 to 512
  // Fewer rays for small ghosts, bodonyi2023 eq. 13: by the factor (sigma times the fraction of the
  // sensor that the ghost covers) to the power of phi. Sigma from 0 to 1e6, phi from 0 to 4.
  bool scale = false;
  double sigma = 1.0;
  double phi = 0.5;
};

struct CONTREJOUR_API AdaptiveOptions {
  static constexpr std::string_view kMethod = "adaptive";
  double error = 0.003;  // limit of the RMS error, relative to the frame's peak; 1e-4 to 0.1
};

// The grid, and the accelerations and improvements of hullin2011 4.2 and 4.3.
struct CONTREJOUR_API BundleOptions {
  static constexpr std::string_view kMethod = "bundle";
  GridOptions grid;
  bool smooth_shading = true;  // irradiance averaged to the vertices, linear over a cell; off: constant in a cell
  bool grid_levels = false;  // replaces `grid`: one of six, 16 to 512, by the variance of cell areas
  bool mirror_symmetry = false;  // half the grid is traced, the other half mirrored at the light's meridian
  bool precomputed_bounds = false;  // pupil bounds from a table over field angles, made first, instead of a search
  bool spectral_filter = false;  // few bands, each blurred towards its neighbours to bridge the gaps
  enum class Anisotropic { Exact, HighResolution, Points } anisotropic = Anisotropic::Exact;
};

// The options of bodonyi2023.
struct CONTREJOUR_API TiledOptions {
  static constexpr std::string_view kMethod = "tiled";
  GridOptions grid;
  int merge_steps = 4;  // 0 to 9
  double merge_threshold = 0.001;  // gamma of eq. 12; light 0.001, heavy 0.1
  int dense_tile = 8;  // pixels a side; must divide coarse_tile
  int coarse_tile = 128;  // 0: none
  enum class Interpolation {
    Triangle,
    HomogeneousTriangle,
    MeanValue,
    Wachspress,
    LoopDeRose
  } interpolation = Interpolation::LoopDeRose;
};

struct CONTREJOUR_API ReferenceOptions {
  static constexpr std::string_view kMethod = "reference";
  double density = 1.0;  // above 0 to 64; 2 halves the cells
};

// A type that holds a method's options names the method.
template <class Options>
concept OptionsOfMethod = requires {
  { Options::kMethod } -> std::convertible_to<std::string_view>;
} && std::copy_constructible<Options>;

// A method and its options. Any type of options converts to it, so that render() takes `BundleOptions{...}` as it is.
class MethodOptions {
 public:
  template <OptionsOfMethod Options>
  MethodOptions(Options options) : name_(Options::kMethod), options_(std::move(options)) {}  // NOLINT: converts

  [[nodiscard]] std::string_view name() const { return name_; }

  // Null where the options are of another type.
  template <OptionsOfMethod Options>
  [[nodiscard]] const Options* get_if() const {
    return std::any_cast<Options>(&options_);
  }
  template <OptionsOfMethod Options>
  [[nodiscard]] Options* get_if() {
    return std::any_cast<Options>(&options_);
  }

 private:
  std::string_view name_;
  std::any options_;
};

}  // namespace contrejour
