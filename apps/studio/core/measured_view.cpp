// SPDX-License-Identifier: Apache-2.0
#include "studio/core/measured_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contrejour/expert/preview_exposure.h"
#include "contrejour/expert/settings.h"
#include "studio/core/measured_photographs.h"
#include "studio/core/view_codes.h"

namespace contrejour::studio {
namespace {

constexpr int kPointsOfCurve = 64;
constexpr double kBeyondRange = 1.1;  // of the pictures, where the file does not state the photographs' field

double half_width_of(const MeasuredFlare& flare) {
  return flare.half_field ? flare.half_field->x : kBeyondRange * flare.s_max;
}

double value_of(const MeasuredGhost& ghost, GhostCurve curve, double s) {
  switch (curve) {
    case GhostCurve::Speed: return s > 1e-6 ? ghost.centre(s) / s : ghost.centre.derivative(0.0);
    case GhostCurve::HalfWidth: return ghost.half_width(s);
    case GhostCurve::HalfHeight: return ghost.half_height(s);
    case GhostCurve::Level: return std::fmax(0.0, ghost.inside[1](s));
  }
  return 0;
}

Result<Image> kymograph_of(const MeasuredFlare& flare, double half_width, const Context& context) {
  Image rows(kKymographWidth, kKymographHeight);
  for (int y = 0; y < kKymographHeight; ++y) {
    const double angle_deg = angle_of_row_deg(flare, y);
    const FlareLight light{{std::tan(angle_deg * params::kDegree_rad), 0}, {1, 1, 1}};
    const auto row = render_measured(flare, {&light, 1}, measured_frame(half_width, kKymographWidth, 1), context);
    if (!row) return tl::unexpected(row.error());
    std::copy(row->pixels.begin(), row->pixels.end(), rows.row(y).begin());
  }
  return rows;
}

class MeasuredWorker {
 public:
  void work(const MeasuredOrder& order, MeasuredJob::Control& control) {
    const Context context = control.context(1);
    auto ok = open(order, context);
    MeasuredAnswer answer = opened_;
    answer.angle_deg = order.angle_deg;
    if (ok) ok = draw(answer, context);
    if (control.is_outdated()) return;
    if (!ok) {
      answer = {};
      answer.file = order.file;
      answer.error = ok.error().to_string();
      opened_ = {};
    }
    // Photographs that are there already come with it.
    if (!ok || !photographs_.are_of(order.sweep)) control.publish(answer);
    if (ok && !order.sweep.empty()) show_photographs(order, std::move(answer), control);
  }

 private:
  void show_photographs(const MeasuredOrder& order, MeasuredAnswer answer, MeasuredJob::Control& control) {
    const Context context = control.context(1);
    auto ok = photographs_.show(order, stops_, answer, context);
    if (control.is_outdated()) return;
    if (!ok) answer.error = ok.error().to_string();
    control.publish(answer);
    while (ok && !control.is_outdated() && photographs_.read_next(answer, context)) control.publish(answer);
  }

  // The kymograph is that of the file, whatever the angle.
  Result<void> open(const MeasuredOrder& order, const Context& context) {
    if (opened_.file == order.file && opened_.kymograph) return {};
    auto flare = read_flare(std::filesystem::path(order.file));
    if (!flare) return tl::unexpected(flare.error());
    opened_ = {};
    opened_.flare = std::make_shared<const MeasuredFlare>(std::move(*flare));
    opened_.half_width = half_width_of(*opened_.flare);
    const auto rows = kymograph_of(*opened_.flare, opened_.half_width, context);
    if (!rows) return tl::unexpected(rows.error());
    stops_ = params::automatic_exposure(*rows);
    opened_.kymograph =
        std::make_shared<const std::vector<std::uint32_t>>(displayed(*rows, stops_, ViewTransform::Preview));
    opened_.file = order.file;
    return {};
  }

  Result<void> draw(MeasuredAnswer& answer, const Context& context) const {
    const FlareLight light{{std::tan(answer.angle_deg * params::kDegree_rad), 0}, {1, 1, 1}};
    const auto picture = render_measured(*answer.flare, {&light, 1},
                                         measured_frame(answer.half_width, kMeasuredWidth, kMeasuredHeight), context);
    if (!picture) return tl::unexpected(picture.error());
    answer.picture = displayed(*picture, stops_, ViewTransform::Preview);
    return {};
  }

  MeasuredAnswer opened_;
  double stops_ = 0;
  MeasuredPhotographs photographs_;
};

}  // namespace

const char* name_of(GhostCurve curve) {
  static constexpr const char* names[] = {"Speed", "Half width", "Half height", "Level"};
  return names[static_cast<std::size_t>(curve)];
}

double largest_angle_deg(const MeasuredFlare& flare) { return std::atan(flare.s_max) / params::kDegree_rad; }

double angle_of_row_deg(const MeasuredFlare& flare, int row) {
  return largest_angle_deg(flare) * (2.0 * row / (kKymographHeight - 1) - 1);
}

TangentFrame measured_frame(double half_width, int width, int height) {
  const double focal_px = 0.5 * width / std::fmax(half_width, 1e-6);
  return {width, height, focal_px, {0.5 * width, 0.5 * height}};
}

std::vector<MeasuredCurve> curves_of(const MeasuredFlare& flare, GhostCurve curve) {
  std::vector<MeasuredCurve> all;
  for (const MeasuredGhost& ghost : flare.ghosts) {
    if (ghost.name == "veil") continue;  // it is everywhere
    MeasuredCurve one{ghost.name, {}};
    for (int k = 0; k <= kPointsOfCurve; ++k) {
      const double s = ghost.first + (ghost.last - ghost.first) * k / kPointsOfCurve;
      one.points.push_back({std::atan(s) / params::kDegree_rad, value_of(ghost, curve, s)});
    }
    all.push_back(std::move(one));
  }
  return all;
}

MeasuredJob::Work measured_work() {
  return [worker = std::make_shared<MeasuredWorker>()](const MeasuredOrder& order, MeasuredJob::Control& control) {
    worker->work(order, control);
  };
}

}  // namespace contrejour::studio
