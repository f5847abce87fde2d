// SPDX-License-Identifier: Apache-2.0
#include "studio/core/measured_photographs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "studio/core/view_codes.h"

namespace contrejour::studio {
namespace {

Image difference_of(const Image& a, const Image& b) {
  Image difference = a;
  for (std::size_t k = 0; k < difference.pixels.size(); ++k) difference.pixels[k] = a.pixels[k] - b.pixels[k];
  return difference;
}

Image size_of(Image difference) {
  for (float& value : difference.pixels) value = std::fabs(value);
  return difference;
}

std::vector<std::uint32_t> codes_of(const Image& image, double stops) {
  return displayed(image, stops, ViewTransform::Preview);
}

}  // namespace

Result<void> MeasuredPhotographs::open(const MeasuredOrder& order, const MeasuredAnswer& answer) {
  const bool is_open = are_of(order.sweep);
  if (is_open && flare_file_ == order.file) return {};
  if (!is_open) {
    sweep_.reset();
    auto sweep = MeasuredSweep::open(order.sweep);
    if (!sweep) return tl::unexpected(sweep.error());
    sweep_ = std::move(*sweep);
  }
  flare_file_ = order.file;
  half_width_ = answer.half_width;
  stations_.assign(sweep_->count(), {});
  return {};
}

Result<Image> MeasuredPhotographs::read(std::size_t k) {
  Station& station = stations_[k];
  if (station.picture) return *station.picture;
  station.is_read = true;
  auto row = sweep_->photograph(k, measured_frame(half_width_, kKymographWidth, 1));
  if (!row) return row;
  station.row = std::move(*row);
  auto picture = sweep_->photograph(k, measured_frame(half_width_, kMeasuredWidth, kMeasuredHeight));
  if (picture && stations_.size() <= kMostPictures) station.picture = *picture;
  return picture;
}

Result<Image> MeasuredPhotographs::fit(std::size_t k, const MeasuredFlare& flare, const Context& context) const {
  const FlareLight light = sweep_->light(k);
  return render_measured(flare, {&light, 1}, measured_frame(half_width_, kMeasuredWidth, kMeasuredHeight), context);
}

Vec2 MeasuredPhotographs::light_px(std::size_t k) const {
  const TangentFrame frame = measured_frame(half_width_, kMeasuredWidth, kMeasuredHeight);
  const Vec2 at = sweep_->light(k).position;
  return {frame.centre_px.x + frame.focal_length_px * at.x, frame.centre_px.y - frame.focal_length_px * at.y};
}

void MeasuredPhotographs::compare(std::size_t k, const Image& captured, const Image& fitted) {
  Station& station = stations_[k];
  station.residual = difference_of(captured, fitted);
  station.rings = ring_levels(*station.residual, captured, light_px(k));
}

Result<void> MeasuredPhotographs::show(const MeasuredOrder& order, double stops, MeasuredAnswer& answer,
                                       const Context& context) {
  if (auto ok = open(order, answer); !ok) return ok;
  stops_ = stops;
  const std::size_t k = sweep_->nearest(order.angle_deg);
  const auto captured = read(k);
  if (!captured) return tl::unexpected(captured.error());
  const auto fitted = fit(k, *answer.flare, context);
  if (!fitted) return tl::unexpected(fitted.error());
  compare(k, *captured, *fitted);
  shown_ = *captured;
  answer.sweep = order.sweep;
  answer.angle_deg = sweep_->angle_deg(k);
  answer.photograph = MeasuredPhotograph{.station = k,
                                         .count = sweep_->count(),
                                         .captured = codes_of(*captured, stops),
                                         .fitted = codes_of(*fitted, stops)};
  draw_residual(answer);
  draw_kymograph(answer);
  return {};
}

bool MeasuredPhotographs::read_next(MeasuredAnswer& answer, const Context& context) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < stations_.size() && count < kReadAtOnce; ++k) {
    if (stations_[k].is_read) continue;
    const auto captured = read(k);  // one that cannot be read leaves its rows black
    ++count;
    if (!captured || !stations_[k].picture) continue;
    if (const auto fitted = fit(k, *answer.flare, context)) compare(k, *captured, *fitted);
  }
  if (count == 0) return false;
  draw_residual(answer);
  draw_kymograph(answer);
  return true;
}

// The halo is better known with each station that is read.
void MeasuredPhotographs::draw_residual(MeasuredAnswer& answer) const {
  std::vector<RingLevels> rings;
  for (const Station& station : stations_)
    if (station.residual) rings.push_back(station.rings);
  const std::size_t k = answer.photograph->station;
  const Image rest = without_halo(*stations_[k].residual, shown_, stations_[k].rings, halo_of(rings), light_px(k));
  answer.photograph->residual = codes_of(size_of(rest), stops_);
}

// Each row is that of the station nearest to its angle, as far as the sweep reaches.
void MeasuredPhotographs::draw_kymograph(MeasuredAnswer& answer) {
  double first = sweep_->angle_deg(0), last = first;
  for (std::size_t k = 1; k < sweep_->count(); ++k) {
    first = std::min(first, sweep_->angle_deg(k));
    last = std::max(last, sweep_->angle_deg(k));
  }
  const double step = angle_of_row_deg(*answer.flare, 1) - angle_of_row_deg(*answer.flare, 0);
  Image rows(kKymographWidth, kKymographHeight);
  for (int y = 0; y < kKymographHeight; ++y) {
    const double angle = angle_of_row_deg(*answer.flare, y);
    const Station& station = stations_[sweep_->nearest(angle)];
    if (!station.row || angle < first - step || angle > last + step) continue;
    std::copy(station.row->pixels.begin(), station.row->pixels.end(), rows.row(y).begin());
  }
  answer.photograph->kymograph = std::make_shared<const std::vector<std::uint32_t>>(codes_of(rows, stops_));
  answer.photograph->read = static_cast<std::size_t>(std::ranges::count_if(stations_, &Station::is_read));
}

}  // namespace contrejour::studio
