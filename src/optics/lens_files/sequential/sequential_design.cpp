#include "optics/lens_files/sequential/sequential_design.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "optics/lens_files/complete.h"
#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/sequential/design_light.h"
#include "optics/lens_files/sequential/design_opening.h"

namespace contrejour {
namespace {

constexpr double kNearFocus = 0.05;  // of the focal length: an image surface within is this lens's own, out of focus
constexpr double kInFocus = 1e-6;          // of the focal length: as near as files print it
constexpr double kSameFocalLength = 1e-6;  // relative: two positions of one zoom that are one
constexpr double kNearNominal = 0.2;       // relative: an engraved focal length and the real one
constexpr double kDefaultDiagonal_mm = 43.2666;  // 36 x 24

// A row of the prescription, and which of the design's surfaces' thicknesses add up to the gap behind it.
struct Row {
  Surface surface;
  std::vector<std::size_t> gap;
  Placement own;
  std::size_t of = 0;  // the design's surface
};

// One of a zoom, and its place in the file.
struct Position {
  double focal_mm = 0;
  std::size_t index = 0;
};

class Builder {
 public:
  explicit Builder(const SequentialDesign& design) : design_(design) {}

  Result<Prescription> build() {
    lens_.name = design_.name;
    lens_.source = design_.source;
    lens_.file = {design_.file, 0, 0};
    lens_.warnings = design_.warnings;
    set_wavelength();
    if (design_.surfaces.size() < 3) fail(0, "no lens: it has an object, an image and nothing between");
    make_rows();
    choose_positions();
    place_all();
    if (error_) return tl::unexpected(*error_);
    for (const Row& row : rows_) lens_.surfaces.push_back(row.surface);
    set_gaps();
    return finish();
  }

 private:
  void fail(int line, std::string message, ErrorCode code = ErrorCode::Parse) {
    if (!error_) error_ = Error{code, std::move(message), {design_.file, line, 0}};
  }
  void warn(std::string message) { lens_.warnings.push_back(std::move(message)); }

  [[nodiscard]] const DesignSurface& image() const { return design_.surfaces.back(); }

  void set_wavelength() {
    if (!design_.wavelength_nm) return;
    if (*design_.wavelength_nm >= 300.0 && *design_.wavelength_nm <= 1100.0) {
      lens_.stated.wavelength_nm = *design_.wavelength_nm;
    } else {
      warn(fmt::format("designed for {:g} nm; focal length and focus are those of {:g} nm", *design_.wavelength_nm,
                       lens_.stated.wavelength_nm));
    }
  }

  [[nodiscard]] SurfaceShape shape_in_mm(const DesignSurface& from) const {
    SurfaceShape shape = from.shape;
    if (design_.unit_mm == 1.0) return shape;
    shape.curvature_x_per_mm /= design_.unit_mm;
    for (std::size_t k = 0; k < shape.powers.size(); ++k)
      shape.powers[k] *= std::pow(design_.unit_mm, -static_cast<double>(k));
    return shape;
  }

  [[nodiscard]] Surface surface_of(const DesignSurface& from) {
    Surface surface;
    surface.source_line = from.line;
    surface.curvature_per_mm = tidy_curvature(from.curvature / design_.unit_mm);
    surface.shape = shape_in_mm(from);
    surface.glass_after = from.glass_after;
    set_opening(from, design_.unit_mm, surface, lens_.warnings);
    return surface;
  }

  // The stop's row: flat, in the medium in front. A semi-diameter that the program worked out for its own rays gives
  // way to that of the f-number.
  [[nodiscard]] Surface stop_of(const DesignSurface& from, const Surface& at, const Glass& medium, bool refracts) {
    Surface stop;
    stop.kind = SurfaceKind::Stop;
    stop.source_line = from.line;
    stop.glass_after = medium;
    const bool own = design_.is_by_stop() || from.is_semi_fixed || from.opening;
    if (own) stop.semi_diameter_mm = at.semi_diameter_mm;
    if (at.aperture.kind != ApertureKind::Disc)
      warn(
          fmt::format("the stop (line {}) is not round; the circle around it is used, --blades and --iris-image give "
                      "it a shape",
                      from.line));
    if (!refracts && (at.curvature_per_mm != 0.0 || !at.shape.is_sphere()))
      warn(fmt::format("the stop (line {}) is curved; it is taken as flat", from.line));
    return stop;
  }

  void make_rows() {
    Glass medium = air();
    int stops = 0, refracting = 0;
    for (std::size_t k = 1; k + 1 < design_.surfaces.size() && !error_; ++k) {
      const DesignSurface& from = design_.surfaces[k];
      if (!std::isfinite(from.thickness)) return fail(from.line, "an infinite thickness behind a surface of the lens");
      const bool refracts = !from.is_break && !(from.glass_after == medium);
      refracting += refracts ? 1 : 0;
      const bool kept = refracts || from.is_stop || from.opening;
      if (kept) {
        const Surface surface = surface_of(from);
        if (from.is_stop) {
          ++stops;
          rows_.push_back({stop_of(from, surface, medium, refracts), {}, from.own, k});
        }
        if (refracts || !from.is_stop) rows_.push_back({surface, {}, from.own, k});
      }
      if (!rows_.empty()) rows_.back().gap.push_back(k);
      if (!from.is_break) medium = from.glass_after;
    }
    if (image().curvature != 0.0 || !image().shape.is_sphere())
      warn(fmt::format("the image surface (line {}) is curved; the sensor is flat", image().line));
    if (refracting == 0) return fail(image().line, "no lens: no surface refracts");
    rows_.back().gap.push_back(design_.surfaces.size() - 1);
    if (stops != 1) fail(image().line, stops == 0 ? "no surface is the stop; say which one is" : "more than one stop");
  }

  [[nodiscard]] std::vector<double> own_thicknesses() const {
    std::vector<double> out;
    for (const DesignSurface& surface : design_.surfaces) out.push_back(surface.thickness);
    return out;
  }

  // What follows from thicknesses that a position changes.
  void solve(std::vector<double>& thickness) const {
    for (std::size_t k = 0; k < thickness.size(); ++k) {
      if (!design_.surfaces[k].solve) continue;
      const ThicknessSolve& by = *design_.surfaces[k].solve;
      if (by.from < 0 || static_cast<std::size_t>(by.from) >= k) continue;
      const auto from = static_cast<std::size_t>(by.from);
      double sum = 0.0;
      for (std::size_t j = from; j < k; ++j) sum += thickness[j];
      switch (by.kind) {
        case ThicknessSolve::Kind::Pickup: thickness[k] = by.scale * thickness[from] + by.offset; break;
        case ThicknessSolve::Kind::Sum: thickness[k] = by.offset - sum; break;
        case ThicknessSolve::Kind::Pair: thickness[k] = by.offset - thickness[from]; break;
      }
    }
  }

  // Those for distant objects, or else all; the rest is focusing.
  void choose_positions() {
    if (error_) return;
    positions_ = design_.positions;
    for (auto& position : positions_) solve(position.thickness);
    if (positions_.empty()) positions_.push_back({own_thicknesses()});
    const auto distant = [](const DesignPosition& p) { return std::isinf(p.thickness.front()); };
    const std::size_t near = static_cast<std::size_t>(
        std::count_if(positions_.begin(), positions_.end(), [&](const auto& position) { return !distant(position); }));
    if (near == positions_.size()) {
      warn(fmt::format("designed for an object {:.6g} mm in front of it (line {}); focus is set by --focus",
                       positions_.front().thickness.front() * design_.unit_mm, design_.surfaces.front().line));
    } else if (near > 0) {
      std::erase_if(positions_, [&](const auto& position) { return !distant(position); });
      warn(fmt::format("{} of {} positions are for near objects and left out: focusing moves the sensor", near,
                       design_.positions.size()));
    }
  }

  // The gap behind a row, mm.
  [[nodiscard]] double gap_mm(const Row& row, const std::vector<double>& thickness) const {
    double sum = 0.0;
    for (const std::size_t k : row.gap) sum += thickness[k];
    return sum * design_.unit_mm + 0.0;
  }

  // Of all rows. A stop or an opening that stands behind the vertex of the next surface, as a negative gap has it, is
  // moved to that vertex.
  [[nodiscard]] std::vector<double> gaps_mm(const std::vector<double>& thickness) const {
    std::vector<double> gaps;
    for (const Row& row : rows_) gaps.push_back(gap_mm(row, thickness));
    for (std::size_t k = gaps.size(); k-- > 1;) {
      const bool bends = rows_[k].surface.kind == SurfaceKind::Refracting &&
                         !(rows_[k].surface.glass_after == rows_[k - 1].surface.glass_after);
      if (bends || k + 1 == gaps.size() || gaps[k] >= 0.0 || gaps[k - 1] + gaps[k] < 0.0) continue;
      gaps[k - 1] += gaps[k];
      gaps[k] = 0.0;
    }
    return gaps;
  }

  // Where each row stands beside its place on the axis, in one position; the last one is the image.
  [[nodiscard]] std::vector<PoseAndTurn> poses(const std::vector<double>& thickness) const {
    std::vector<PoseAndTurn> out;
    Placement frame;
    std::size_t next = 0;
    for (std::size_t k = 1; k < design_.surfaces.size(); ++k) {
      const DesignSurface& at = design_.surfaces[k];
      if (!(at.move == Placement{})) frame = frame.then(in_mm(at.move));
      for (; next < rows_.size() && rows_[next].of == k; ++next) out.push_back(pose_of(frame.then(in_mm(at.own))));
      if (k + 1 == design_.surfaces.size()) break;
      const Vec3 along{0, 0, thickness[k] * design_.unit_mm};
      if (!(frame.axes == Placement{}.axes)) frame.shift = frame.shift + frame.turned(along) - along;
    }
    out.push_back(pose_of(frame.then(in_mm(image().own))));
    return out;
  }

  [[nodiscard]] Placement in_mm(const Placement& placement) const {
    Placement out = placement;
    out.shift = out.shift * design_.unit_mm;
    return out;
  }

  void place_all() {
    if (error_) return;
    const auto placed = poses(positions_.front().thickness);
    for (const auto& position : positions_) {
      const auto other = poses(position.thickness);
      for (std::size_t k = 0; k < placed.size(); ++k)
        if (!(other[k].pose == placed[k].pose))
          return fail(design_.surfaces.front().line,
                      "the coordinates are tilted where a zoom's gap changes, which moves elements aside",
                      ErrorCode::Unsupported);
    }
    for (std::size_t k = 0; k < rows_.size(); ++k) place(rows_[k].surface, placed[k]);
    if (!(placed.back().pose == SurfacePose{})) {
      const SurfacePose& pose = placed.back().pose;
      fail(image().line,
           fmt::format("the image surface stands {:.4g} mm beside the lens's axis with its own along ({:.4g}, {:.4g}, "
                       "{:.4g}); the sensor is computed centred and upright: bring the coordinates back before it",
                       std::hypot(pose.shift_mm.x, pose.shift_mm.y), pose.axis.x, pose.axis.y, pose.axis.z),
           ErrorCode::Unsupported);
    }
  }

  void place(Surface& surface, const PoseAndTurn& at) {
    if (surface.kind == SurfaceKind::Stop) {
      if (at.pose == SurfacePose{}) return;
      return fail(surface.source_line,
                  "the stop is decentred or tilted; it is computed centred on the axis: move the coordinate break "
                  "behind it",
                  ErrorCode::Unsupported);
    }
    surface.pose = at.pose;
    if (!surface.shape.has_axial_symmetry()) surface.shape.turn_rad += at.turn_rad;
    turn_opening(at.turn_rad, surface.aperture);
  }

  void set_gaps(std::size_t position = 0) {
    const auto gaps = gaps_mm(positions_[position].thickness);
    for (std::size_t k = 0; k + 1 < gaps.size(); ++k) lens_.surfaces[k].thickness_mm = gaps[k];
    if (position > 0) return;
    for (std::size_t k = 1; k + 1 < gaps.size(); ++k)
      if (gap_mm(rows_[k], positions_[0].thickness) < gaps[k])
        warn(fmt::format("the opening (line {}) stands behind the next surface's vertex; it is moved there",
                         rows_[k].surface.source_line));
  }

  Result<Prescription> finish() {
    // To the first row: what stands in front of it adds to the distance.
    const std::vector<double>& thickness = positions_.front().thickness;
    double object_mm = thickness.front();
    for (std::size_t k = 1; k < rows_.front().of; ++k) object_mm += thickness[k];
    const auto light = light_of(design_, lens_, object_mm * design_.unit_mm);
    if (!light) return tl::unexpected(light.error());
    if (light->stop_is_open)
      warn("nothing tells the stop's size; it lets through what the other surfaces do of a beam along the axis");
    lens_.f_number = light->f_number;
    set_sensor(*light, std::isinf(object_mm));
    if (const auto zoomed = set_zoom(); !zoomed) return tl::unexpected(zoomed.error());
    return completed(std::move(lens_), light->beam);
  }

  void set_sensor(const DesignLight& light, bool distant) {
    double radius_mm = light.image_radius_mm;
    if (radius_mm == 0.0) {
      radius_mm = 0.5 * std::min(kDefaultDiagonal_mm, std::abs(light.focal_length_mm));
      warn(fmt::format("no field off the axis is told; the sensor's diagonal is taken as {:.6g} mm", 2.0 * radius_mm));
    }
    lens_.sensor_width_mm = 2.0 * radius_mm * 3.0 / std::sqrt(13.0);
    lens_.sensor_height_mm = 2.0 * radius_mm * 2.0 / std::sqrt(13.0);
    if (design_.field == FieldKind::ImageHeight && design_.largest_x > 0.0 && design_.largest_y > 0.0) {
      lens_.sensor_width_mm = 2.0 * design_.largest_x * design_.unit_mm;
      lens_.sensor_height_mm = 2.0 * design_.largest_y * design_.unit_mm;
    }
    if (!distant || design_.is_focused) return;
    const double at_mm = gap_mm(rows_.back(), positions_.front().thickness);
    for (const auto& position : positions_)
      if (gap_mm(rows_.back(), position.thickness) != at_mm) return;  // it follows the focus
    const double defocus_mm = std::abs(at_mm - light.focus_mm);
    if (defocus_mm <= kInFocus * std::abs(light.focal_length_mm)) return;
    if (defocus_mm <= kNearFocus * std::abs(light.focal_length_mm) && at_mm > 0.0) {
      lens_.sensor_distance_mm = at_mm;
    } else {
      warn(
          fmt::format("the image surface (line {}) stands {:.6g} mm behind the lens, distant objects are in focus at "
                      "{:.6g} mm; the sensor is put there",
                      image().line, at_mm, light.focus_mm));
    }
  }

  // Positions in rising focal length; those of one focal length are one.
  Result<void> set_zoom() {
    if (positions_.size() < 2) return {};
    std::vector<Position> sorted;
    for (std::size_t p = 0; p < positions_.size(); ++p) {
      set_gaps(p);
      const auto light = light_of(design_, lens_, std::numeric_limits<double>::infinity());
      if (!light) return tl::unexpected(light.error());
      sorted.push_back({light->focal_length_mm, p});
      lens_.f_number = std::min(lens_.f_number, light->f_number);  // 0 where the stop's opening says it
    }
    std::stable_sort(sorted.begin(), sorted.end(), [](auto& a, auto& b) { return a.focal_mm < b.focal_mm; });
    const auto same = [](auto& a, auto& b) { return std::abs(b.focal_mm / a.focal_mm - 1.0) < kSameFocalLength; };
    sorted.erase(std::unique(sorted.begin(), sorted.end(), same), sorted.end());
    set_gaps(sorted.front().index);
    if (sorted.size() < 2) return {};
    const auto first = gaps_mm(positions_[sorted.front().index].thickness);
    for (const Position& position : sorted) lens_.zoom.push_back({position.focal_mm, {}, 0});
    name_positions(sorted);
    for (std::size_t k = 0; k + 1 < first.size(); ++k) {
      std::vector<double> gaps;
      for (const Position& position : sorted) gaps.push_back(gaps_mm(positions_[position.index].thickness)[k]);
      if (std::all_of(gaps.begin(), gaps.end(), [&](double gap) { return gap == gaps.front(); })) continue;
      for (std::size_t p = 0; p < sorted.size(); ++p)
        lens_.zoom[p].thickness_mm.emplace_back(static_cast<int>(k), gaps[p]);
    }
    return {};
  }

  // By the focal lengths that the file calls them, where these are what they nearly have.
  void name_positions(const std::vector<Position>& sorted) {
    std::vector<double> names;
    for (const Position& position : sorted) {
      const double nominal_mm = positions_[position.index].nominal_focal_mm;
      if (std::abs(nominal_mm / position.focal_mm - 1.0) > kNearNominal) return;
      if (!names.empty() && nominal_mm <= names.back()) return;
      names.push_back(nominal_mm);
    }
    for (std::size_t p = 0; p < names.size(); ++p) lens_.zoom[p].focal_length_mm = names[p];
  }

  const SequentialDesign& design_;
  Prescription lens_;
  std::vector<Row> rows_;
  std::vector<DesignPosition> positions_;
  std::optional<Error> error_;
};

}  // namespace

Result<Prescription> prescription_of(const SequentialDesign& design) { return Builder(design).build(); }

}  // namespace contrejour
