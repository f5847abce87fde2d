// SPDX-License-Identifier: Apache-2.0
// Predicts where flare will hurt: figures of a flare by itself and on its scene, as walch2018 3.5 names them, the glare
// transmission of camera testers, and a map of them over all positions of a light, among which one is rated.
// docs/physics/flare-prediction.md has the definitions. Figures are of luminance, in the scene's units (white at 1);
// samples that are not finite are left out. A flare by itself is an image that contains no direct image of a light.
// Errors: InvalidArgument, Cancelled. Thread-safety: pure functions; the same bits for any number of threads.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/colour.h"
#include "contrejour/expert/flare_source.h"
#include "contrejour/export.h"
#include "contrejour/image.h"
#include "contrejour/result.h"

namespace contrejour {

// Added before a logarithm is taken, as a fraction of white.
inline constexpr double kLogOffset = 1e-6;

// walch2018 3.5, on the flare alone.
struct FlareFigures {
  double minimum = 0, maximum = 0;
  double sum = 0, mean = 0;
  double log_average = 0;  // exp(mean of ln(offset + value)) - offset
  double median = 0, percentile_99 = 0;
  double covered = 0;  // fraction of pixels above a level
};

// walch2018 3.5, with the scene. Contrast is Michelson's of the 1st and 99th percentiles, (p99 - p1) / (p99 + p1).
struct SceneFigures {
  double log_average_ratio = 0;  // of the scene over that of the flare: small where the flare dazzles
  double brightening = 1;  // log average of the scene with flare over that without
  double contrast_without = 0, contrast_with = 0;
  double contrast_kept = 1;  // contrast with flare over contrast without; 1 for a scene without contrast
};

// Glare as camera testers state it: transmission is a pixel's level over that of the direct image (point source
// rejection ratio), attenuation its inverse, infinite without flare.
struct GlareFigures {
  double mean_transmission = 0, peak_transmission = 0;  // the peak is the 99.9th percentile
  double mean_attenuation = 0, least_attenuation = 0;
};

struct FigureSettings {
  ColourSpace space = ColourSpace::Rec709;
  double white = 1.0;  // > 0
  double covered_level = 0.01;  // of white: from there on, a pixel counts as covered
};

// Errors: an image without pixels or of other than three channels; settings out of range.
[[nodiscard]] CONTREJOUR_API Result<FlareFigures> figures_of(const Image& flare, const FigureSettings& settings = {});

// Errors: also a scene of another size.
[[nodiscard]] CONTREJOUR_API Result<SceneFigures> figures_on(const Image& scene, const Image& flare,
                                                             const FigureSettings& settings = {});

// The level of the direct image of a disc of this angular radius on the axis, whose image sums to `value`. Errors: a
// radius or focal length that is not above 0.
[[nodiscard]] CONTREJOUR_API Result<double> direct_level(double value, double radius_rad, const Frame& frame,
                                                         double focal_length_mm);
// Errors: as figures_of; a level that is not above 0.
[[nodiscard]] CONTREJOUR_API Result<GlareFigures> glare_of(const Image& flare, double level_of_direct_image,
                                                           ColourSpace space);

// The position of a value among others.
struct Rating {
  double in_range = 0;  // 0 at their smallest, 1 at their largest; beyond these outside 0 to 1
  double rank = 0;  // fraction of them below it, equal ones counted half
};
// Errors: there are no others.
[[nodiscard]] CONTREJOUR_API Result<Rating> rating_of(double value, std::span<const double> others);

// Figures that can be rated and drawn, by name.
enum class Estimator { Maximum, Sum, Mean, LogAverage, Covered, MeanTransmission, PeakTransmission };
inline constexpr std::array<std::string_view, 7> kEstimatorNames{
    "maximum", "sum", "mean", "log_average", "covered", "mean_transmission", "peak_transmission"};

struct LightFigures {
  FlareFigures flare;
  GlareFigures glare;
};
[[nodiscard]] CONTREJOUR_API double value_of(const LightFigures& figures, Estimator estimator);

// Positions of a light: `angles` from the axis, evenly spaced up to the largest, in each of `directions`.
struct LightMapSettings {
  double to_rad = 0;  // 0: what largest_light_angle() says
  int angles = 31;  // the axis included, >= 2
  int directions = 7;  // in a quarter, both ends included, >= 2
  Light light;  // its direction is replaced; its radius is that of the direct image, 0.25 degrees if 0
  MethodOptions method = AdaptiveOptions{};
  FrameSettings frame;  // a whole frame
  FigureSettings figures;
};

struct LightMapPoint {
  double angle_rad = 0;  // from the axis
  double direction_rad = 0;  // 0 to the right, anticlockwise as the photographer sees it
  LightFigures figures;
};

struct LightMap {
  std::vector<LightMapPoint> points;  // the axis, then direction by direction from the axis outwards
  int angles = 0, directions = 0;  // points = 1 + directions * (angles - 1)
  bool is_quarter = false;  // directions from 0 to 90 degrees, the others by symmetry; else all around
  double to_rad = 0;
};

// As far as a measured flare reaches; of a lens twice the angle of the frame's corner, 80 degrees at most.
[[nodiscard]] CONTREJOUR_API double largest_light_angle(const FlareSource& source, const Frame& frame);

// The figures at each position. A source with axial symmetry and a round stop is mapped in a quarter. Lights from which
// no light reaches the sensor have no flare. Errors: those of render() and figures_of(); numbers out of range.
[[nodiscard]] CONTREJOUR_API Result<LightMap> map_lights(const FlareSource& source, const LightMapSettings& settings,
                                                         const Context& context = {});

// All values of an estimator on a map, in the order of its points.
[[nodiscard]] CONTREJOUR_API std::vector<double> values_of(const LightMap& map, Estimator estimator);

}  // namespace contrejour
