// SPDX-License-Identifier: Apache-2.0
// A tilt, an air space and a focus shift that were planted in a lens, from simulated photographs of its ghosts.
#include <algorithm>
#include <cmath>
#include <string>

#include <doctest/doctest.h>

#include "base/units.h"
#include "lens_capture.h"
#include "measure/prescription/lens_numbers.h"
#include "measure/prescription/traced_figures.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::testing;

namespace {

Eigen::Index index_of(const std::vector<LearntNumber>& numbers, LearntKind kind, int first = 0) {
  const auto at = std::ranges::find_if(
      numbers, [&](const LearntNumber& n) { return n.kind == kind && (first == 0 || n.first == first); });
  return at - numbers.begin();
}

}  // namespace

TEST_CASE("lens numbers: a body is tilted as a file's group is, and gaps move what is behind them") {
  const Prescription lens = *find_lens("tessar");
  const AdjustableLens adjustable = *adjustable_lens(lens, kStopped, {});
  Eigen::VectorXd values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(adjustable.numbers.size()));
  values[index_of(adjustable.numbers, LearntKind::TiltX, 3)] = rad_from_deg(0.3);
  values[index_of(adjustable.numbers, LearntKind::TiltY, 3)] = rad_from_deg(-0.2);
  values[index_of(adjustable.numbers, LearntKind::DecentreX, 3)] = 0.1;
  std::string toml = write_lens_toml(lens);
  toml.insert(toml.find("\nsurfaces"),
              "\ngroups = [{ surfaces = [3, 4], decentre_mm = [0.1, 0], tilt_deg = [0.3, -0.2] }]");
  const auto grouped = read_lens_toml(toml, "grouped.toml");
  REQUIRE_MESSAGE(grouped.has_value(), grouped.error().to_string());
  const Prescription moved = adjustable.prescription(values);
  for (std::size_t k = 0; k < lens.surfaces.size(); ++k) {
    CHECK(length(moved.surfaces[k].pose.axis - grouped->surfaces[k].pose.axis) < 1e-9);
    CHECK(length(moved.surfaces[k].pose.shift_mm - grouped->surfaces[k].pose.shift_mm) < 1e-9);
  }
  values.setZero();
  values[index_of(adjustable.numbers, LearntKind::Gap)] = 0.25;
  values[index_of(adjustable.numbers, LearntKind::Focus)] = -0.1;
  values[index_of(adjustable.numbers, LearntKind::StopRadius)] = 0.02;
  const LensState state = *adjustable.state(values);
  CHECK(state.surfaces.back().z_mm == test::approx(adjustable.nominal.surfaces.back().z_mm + 0.25));
  CHECK(state.sensor_z_mm == test::approx(adjustable.nominal.sensor_z_mm + 0.15));
  CHECK(state.stop_radius_mm == test::approx(1.02 * adjustable.nominal.stop_radius_mm));
}

TEST_CASE("adjust lens: a tilt of 0.1 degrees and an air space and a focus shift are found [slow]") {
  const Prescription believed = *find_lens("tessar");
  const AdjustableLens planted = *adjustable_lens(believed, kStopped, {});
  Eigen::VectorXd values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(planted.numbers.size()));
  values[index_of(planted.numbers, LearntKind::TiltY, 3)] = rad_from_deg(0.1);
  values[index_of(planted.numbers, LearntKind::Gap)] = 0.1;
  values[index_of(planted.numbers, LearntKind::Focus)] = 0.2;
  LensState truth = *planted.state(values);
  for (SurfaceState& s : truth.surfaces)
    if (is_air(s.before) != is_air(s.after)) s.coating = {"", QuarterWave{1.38, 480.0}};
  const LensCapture capture = capture_lens(truth, 320, 5);
  AdjustOptions options;
  options.max_ghosts = 10;
  options.max_iterations = 5;
  // Coatings first: with wrong ones, ghosts have wrong mean wavelengths in each channel, and so wrong sizes.
  CoatingFitOptions coating_options;
  coating_options.max_rounds = 2;
  const auto coated = learn_coatings(capture.photographs(believed, kStopped), coating_options);
  REQUIRE_MESSAGE(coated.has_value(), coated.error().to_string());
  const auto adjusted = adjust_lens(capture.photographs(coated->lens, kStopped), options);
  REQUIRE_MESSAGE(adjusted.has_value(), adjusted.error().to_string());
  for (const LearntNumber& n : adjusted->numbers) MESSAGE(learnt_name(n), ": ", n.value, " +- ", n.error, n.determined);
  // Five stations hardly tell a tilt of all elements together from a shift of the axis: each tilt is within its
  // standard error, and their differences from the mean, of which one element was planted, within 0.02 degrees.
  double mean = 0.0, planted_mean = 0.0;
  for (std::size_t k = 0; k < adjusted->numbers.size(); ++k) {
    if (adjusted->numbers[k].kind != LearntKind::TiltY) continue;
    mean += adjusted->numbers[k].value / 3.0;
    planted_mean += values[static_cast<Eigen::Index>(k)] / 3.0;
  }
  for (std::size_t k = 0; k < adjusted->numbers.size(); ++k) {
    const LearntNumber& number = adjusted->numbers[k];
    CHECK(std::abs(number.value - values[static_cast<Eigen::Index>(k)]) < 2.5 * number.error);
    if (number.kind != LearntKind::TiltY) continue;
    const double off = (number.value - mean) - (values[static_cast<Eigen::Index>(k)] - planted_mean);
    CHECK(std::abs(deg_from_rad(off)) < 0.02);
  }
  CHECK(std::ranges::any_of(adjusted->warnings, [](const std::string& w) {
    return w.find("tilts about y are") != std::string::npos && w.find("surfaces 3-4 +0.") != std::string::npos;
  }));
  const auto& gap = adjusted->numbers[static_cast<std::size_t>(index_of(adjusted->numbers, LearntKind::Gap))];
  CHECK(std::abs(gap.value - 0.1) < 0.03);
  const auto& focus = adjusted->numbers[static_cast<std::size_t>(index_of(adjusted->numbers, LearntKind::Focus))];
  CHECK(std::abs(focus.value - 0.2) < 0.1);
  CHECK(adjusted->rms_after_px < 0.5 * adjusted->rms_before_px);
  CHECK(configure_lens(adjusted->lens, kStopped).has_value());
}
