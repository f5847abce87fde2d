#include "render/adaptive/ray_sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/adaptive/lobatto.h"
#include "render/interface/stop_screen.h"

namespace contrejour::adaptive {
namespace {

constexpr float kFailed = std::numeric_limits<float>::infinity();

// Rows below the middle from those above.
void complete(float* values, int nodes, float sign) {
  const auto n = static_cast<std::size_t>(nodes);
  for (std::size_t row = 0; row < n / 2; ++row) {
    for (std::size_t k = 0; k < n; ++k) values[row * n + k] = sign * values[(n - 1 - row) * n + k];
  }
}

// Rows above this one are mirror images of those below, where the box is its own.
int first_traced_row(const RaySheet& sheet, const LightFrame& light) {
  return light.symmetric && sheet.box.low.y == -sheet.box.high.y ? sheet.nodes / 2 : 0;
}

}  // namespace

bool is_open(const RaySheet& sheet, std::size_t node) {
  if (sheet.r_rel[node] > 1.0F) return false;
  return std::all_of(sheet.stop.begin(), sheet.stop.end(),
                     [node](const auto& s) { return s[0][node] * s[0][node] + s[1][node] * s[1][node] <= 1.0F; });
}

SheetTracer::SheetTracer(const LensState& lens, Ghost ghost, const LightFrame& light, double plane_z_mm,
                         const Band& band, const TablesByWavelength& tables, double stop_times)
    : light_(light), plane_z_mm_(plane_z_mm), band_(band) {
  const auto add = [&](double lambda_nm) {
    paths_.push_back(widened(ghost_path(lens, ghost, lambda_nm), stop_times));
    tables_.push_back(tables.at(lambda_nm).get());
  };
  add(band.lambda_nm);
  for (const PlannedPass& pass : band.passes) {
    if (pass.lambda_nm != band.lambda_nm) add(pass.lambda_nm);
  }
}

RaySheet SheetTracer::trace(const Rectangle& box, int nodes, PacketPrecision precision) {
  RaySheet sheet;
  sheet.box = box;
  sheet.nodes = nodes;
  const std::size_t count = sheet.count();
  for (auto* v :
       {&sheet.sensor_x_mm, &sheet.sensor_y_mm, &sheet.r_rel, &sheet.weight[0], &sheet.weight[1], &sheet.weight[2]}) {
    v->resize(count);
  }
  sheet.stop.resize(static_cast<std::size_t>(paths_.front().stop_crossings));
  for (auto& s : sheet.stop) {
    s[0].resize(count);
    s[1].resize(count);
  }
  sheet.rim_squared.resize(steps() * count);
  const int first_row = first_traced_row(sheet, light_);
  lay_out(sheet, first_row);
  trace_path(0, first_row, precision, sheet);
  if (first_row > 0) {
    complete(sheet.sensor_x_mm.data(), nodes, 1.0F);
    complete(sheet.sensor_y_mm.data(), nodes, -1.0F);
    for (auto& w : sheet.weight) complete(w.data(), nodes, 1.0F);
    complete(sheet.r_rel.data(), nodes, 1.0F);
    for (auto& s : sheet.stop) {
      complete(s[0].data(), nodes, 1.0F);
      complete(s[1].data(), nodes, -1.0F);
    }
    for (std::size_t step = 0; step < steps(); ++step) complete(sheet.rim_squared.data() + step * count, nodes, 1.0F);
  }
  if (paths_.front().obscured) leave_obscurations_out(sheet);
  sheet.failed = static_cast<int>(std::count(sheet.r_rel.begin(), sheet.r_rel.end(), kFailed));
  return sheet;
}

// Of relative heights, which searches take to be those of convex openings.
void SheetTracer::leave_obscurations_out(RaySheet& sheet) const {
  const std::vector<PathStep>& steps = paths_.front().steps;
  for (const PathStep& step : steps) sheet.blocks_within.push_back(step.blocks_within);
  for (std::size_t node = 0; node < sheet.count(); ++node) {
    if (sheet.r_rel[node] == kFailed) continue;
    float squared = 0.0F;
    for (std::size_t k = 0; k < steps.size(); ++k)
      if (!steps[k].blocks_within) squared = std::max(squared, sheet.rim_squared[k * sheet.count() + node]);
    sheet.r_rel[node] = std::sqrt(squared);
  }
}

void SheetTracer::add_wavelengths(RaySheet& sheet, PacketPrecision precision) {
  const int first_row = first_traced_row(sheet, light_);
  lay_out(sheet, first_row);
  for (std::size_t k = 1; k < paths_.size(); ++k) trace_path(k, first_row, precision, sheet);
  if (first_row == 0) return;
  for (auto& w : sheet.weight) complete(w.data(), sheet.nodes, 1.0F);
}

// The entrance points of the rows to trace.
void SheetTracer::lay_out(const RaySheet& sheet, int first_row) {
  const auto points = lobatto_points(sheet.nodes);
  const Vec2 half = (sheet.box.high - sheet.box.low) * 0.5;
  x_mm_.clear();
  y_mm_.clear();
  for (int row = first_row; row < sheet.nodes; ++row) {
    for (int column = 0; column < sheet.nodes; ++column) {
      x_mm_.push_back(static_cast<float>((1.0 + points[static_cast<std::size_t>(column)]) * half.x));
      y_mm_.push_back(static_cast<float>((1.0 + points[static_cast<std::size_t>(row)]) * half.y));
    }
  }
}

// One of the paths through the points laid out; what the sheet keeps of it starts at first_row.
void SheetTracer::trace_path(std::size_t k, int first_row, PacketPrecision precision, RaySheet& sheet) {
  const std::size_t count = x_mm_.size();
  const auto at = static_cast<std::size_t>(first_row) * static_cast<std::size_t>(sheet.nodes);
  constexpr std::size_t kDiscarded = 4 + 2 * kMaxStopCrossings;
  scratch_.resize(kDiscarded * count);
  const auto discarded = [&](std::size_t f) { return scratch_.data() + f * count; };
  const bool geometry = k == 0;
  TracedArrays out{discarded(0), discarded(1), discarded(2), discarded(3), {}, {}, nullptr, 0};
  for (std::size_t c = 0; c < sheet.stop.size(); ++c) {
    out.stop_x[c] = geometry ? sheet.stop[c][0].data() + at : discarded(4 + 2 * c);
    out.stop_y[c] = geometry ? sheet.stop[c][1].data() + at : discarded(5 + 2 * c);
  }
  if (geometry) {
    out.sensor_x_mm = sheet.sensor_x_mm.data() + at;
    out.sensor_y_mm = sheet.sensor_y_mm.data() + at;
    out.r_rel = sheet.r_rel.data() + at;
    out.rim_squared = sheet.rim_squared.data() + at;
    out.rim_stride = sheet.count();
  }
  const PacketPath packets(paths_[k], *tables_[k], {{sheet.box.low.x, sheet.box.low.y, plane_z_mm_}, light_.source});
  trace_packets(packets, precision, x_mm_.data(), y_mm_.data(), count, out);
  rays_ += count;
  for (const PlannedPass& pass : band_.passes) {
    if (pass.lambda_nm != paths_[k].lambda_nm) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto gain = static_cast<float>(pass.gain[c]);
      float* weight = sheet.weight[c].data() + at;
      for (std::size_t node = 0; node < count; ++node) weight[node] += gain * out.transmission[node];
    }
  }
}

}  // namespace contrejour::adaptive
