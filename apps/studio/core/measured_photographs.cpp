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
  for (std::size_t k = 0; k < difference.pixels.size(); ++k)
    difference.pixels[k] = std::fabs(a.pixels[k] - b.pixels[k]);
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

Result<void> MeasuredPhotographs::show(const MeasuredOrder& order, double stops, MeasuredAnswer& answer,
                                       const Context& context) {
  if (auto ok = open(order, answer); !ok) return ok;
  stops_ = stops;
  const std::size_t k = sweep_->nearest(order.angle_deg);
  const auto captured = read(k);
  if (!captured) return tl::unexpected(captured.error());
  const FlareLight light = sweep_->light(k);
  const auto fitted = render_measured(*answer.flare, {&light, 1},
                                      measured_frame(half_width_, kMeasuredWidth, kMeasuredHeight), context);
  if (!fitted) return tl::unexpected(fitted.error());
  answer.sweep = order.sweep;
  answer.angle_deg = sweep_->angle_deg(k);
  answer.photograph = MeasuredPhotograph{.station = k,
                                         .count = sweep_->count(),
                                         .captured = codes_of(*captured, stops),
                                         .fitted = codes_of(*fitted, stops),
                                         .residual = codes_of(difference_of(*captured, *fitted), stops)};
  draw_kymograph(answer);
  return {};
}

bool MeasuredPhotographs::read_next(MeasuredAnswer& answer) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < stations_.size() && count < kReadAtOnce; ++k) {
    if (stations_[k].is_read) continue;
    static_cast<void>(read(k));  // one that cannot be read leaves its rows black
    ++count;
  }
  if (count > 0) draw_kymograph(answer);
  return count > 0;
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
