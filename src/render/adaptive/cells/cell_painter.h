// SPDX-License-Identifier: Apache-2.0
// Draws patches as polygons: cells as large as the error allows, small where the map folds and at the edges along which
// the iris and the rims clip them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "render/adaptive/cells/box_cells.h"
#include "render/adaptive/cells/mesh.h"
#include "render/adaptive/cells/outline_cutter.h"
#include "render/adaptive/cells/placed_polygon.h"
#include "render/adaptive/maps/seen_dirt.h"
#include "render/adaptive/maps/tolerance.h"
#include "render/adaptive/tiles/polygon_list.h"
#include "render/stop_patterns/shadow_cutter.h"

namespace contrejour::inline internal::adaptive {

class CellPainter {
 public:
  // budget: of each band. All cells together make no more than its squared error, as long as there are at most
  // kManyCells times few_cells of them. room: scratch memory for cells.
  CellPainter(const IrisShape& iris, const Frame& frame, const ErrorBudget& budget, double few_cells, BoxCells& room,
              PolygonList& out)
      : iris_(iris), width_(frame.width), height_(frame.height), budget_(budget.squared_error), few_cells_(few_cells),
        peak_(budget.peak), out_(out), chosen_(room), cutter_(iris) {}

  // Chooses the cells of a patch at this place in its box; draw() then draws all cells chosen for a band.
  void choose(const Patch& patch, const MeshPlace& place) { choose(patch, place, 0, nullptr); }
  void draw();

  // Sets whether straight lines of the following patches are bent in the entrance plane: their sides would then leave
  // seams next to another box.
  void sides_bend(bool bend) { sides_bend_ = bend; }
  // From here on the light passes a stop pattern: stop coordinates are in units of `unit` stop radii.
  void stand_behind(std::shared_ptr<const screens::BandScreen> screen, double unit) {
    if (screen == screen_) return;
    screen_ = std::move(screen);
    screen_unit_ = unit;
    out_.screens.push_back(screen_);
  }
  // From here on the light passes dirt.
  void stand_behind(const SeenDirt& dirt) {
    if (dirt.band && dirt.band != dirt_.band) out_.band_dirt.push_back(dirt.band);
    dirt_ = dirt;
  }

 private:
  using State = CellState;
  using Flux = std::array<double, 3>;
  // The points, in mm, at which a triangle's light crosses the plane of the dirt.
  struct DirtTriangle {
    std::array<Vec2, 3> pixel;
    std::array<std::array<Vec2, 3>, kMaxStopCrossings> place_mm;
    std::size_t crossings = 0;
  };
  // What the light of a polygon has passed whose transmittance varies over the polygon. If dirt is set, the polygon
  // lies within its triangle.
  struct Behind {
    const StopMap* screen = nullptr;
    const DirtTriangle* dirt = nullptr;
    double most = 1.0;  // largest transmittance of the stop pattern
  };

  // What the stop pattern transmits of a cell's light, in parts of equal size in the cell.
  struct CellParts {
    static constexpr std::size_t kFewestAcross = 3, kMostAcross = 10;
    std::size_t across;
    std::array<Flux, kMostAcross * kMostAcross> room;

    [[nodiscard]] std::size_t count() const { return across * across; }
    [[nodiscard]] std::span<const Flux> passed() const { return {room.data(), count()}; }
    // In coordinates of the cell, each from 0 to 1.
    [[nodiscard]] Vec2 middle(std::size_t part) const { return place(part, {0.5, 0.5}); }
    [[nodiscard]] Vec2 corner(std::size_t part, std::size_t which) const;
    // Interpolates bilinearly between values at the cell's corners.
    [[nodiscard]] static Vec2 between(const std::array<Vec2, 4>& corner, Vec2 uv);
    [[nodiscard]] Flux mean() const;
    [[nodiscard]] bool are_uneven(double room) const;

   private:
    [[nodiscard]] Vec2 place(std::size_t part, Vec2 in_part) const;
  };

  // The quantities from which a cell's error is computed, with straight or with bent sides.
  struct CellMeasure {
    bool on_plane = false;  // its irradiance is that of a plane for several cells
    std::optional<double> whole;  // the squared error whatever its sides are; infinite: do not draw the cell
    double most = 0.0;  // the largest possible squared error
    double mean = 0.0, range = 0.0;  // RMS irradiance of the channels, and its range
    double off_plane = 0.0;  // mean square residual of a plane through it
    double area_px = 0.0;  // by the derivatives in its middle
    double image_px = 0.0, flux = 0.0;  // integrals over the cell
    double longest_px = 0.0;
    double limit = 0.0;  // limit_error()
    std::optional<double> map_error;  // map_error(), computed when needed
  };
  struct Shape {  // a cell's corners, and the middles of its sides if they bend
    std::array<CellCorner, 8> corners;
    std::size_t count = 0;
    void add(const CellCorner& corner) { corners[count++] = corner; }
    [[nodiscard]] std::span<const CellCorner> all() const { return {corners.data(), count}; }
  };

  // The displacement of a cell's sides from the mapped curves.
  struct SidesOff {
    double strips = 0.0;  // visible squared displacements times lengths, summed
    double shared_px = 0.0, alone_px = 0.0;  // the largest displacement of shared sides and of other sides
  };

  static constexpr double kManyCells = 4.0;
  static constexpr double kSoft_px = 0.2;  // minimum thickness of cells in stop maps,
  static constexpr double kSoft = 0.05;  // of their length at most, or maps of small cells would be constant
  // In smaller polygons only the flux counts, whatever irradiance their positions suggest.
  static constexpr double kSmall_px = 2.0;
  // In polygons smaller than this the flux counts too: the edges that clip them are straight in the entrance plane but
  // may curve on the frame.
  static constexpr double kFew_px = 8.0;
  // Light dimmer than this many times the negligible level, thus 0.1 of the error that all pixels may have, is drawn
  // with its mean transmittance over a cell.
  static constexpr double kMeanBelow = 10.0;

  // One of the weights, without gain: its mean, and its rise along the diagonals over the mean.
  struct CellLevel {
    double weight = 0.0, along_d = 0.0, along_f = 0.0;
  };

  static void dim(Shade& shade, Flux& flux, const Flux& share);
  [[nodiscard]] static Shade even_shade(const Shade& of, const Flux& flux, double share_per_px);
  [[nodiscard]] Shade with_flux(std::span<const Corner> polygon, const Shade& of, const Flux& flux, double share) const;
  [[nodiscard]] static Vec2 weight_rise(const Mesh& mesh, const Cell& cell);
  void choose(const Patch& patch, const MeshPlace& place, int depth, const Shade* plane);
  void choose(BoxMesh& of, const MeshSquare& square, const Shade* plane);
  [[nodiscard]] static CellLevel cell_level(const Mesh& mesh, const Cell& cell, int weight);
  void draw(const BoxMesh& of, const ChosenCell& chosen);
  void draw_folded(const Mesh& mesh, const Cell& cell, State state, const std::optional<Flux>& mean);
  void draw_parts(const Mesh& mesh, const Cell& cell, const CellParts& parts);
  [[nodiscard]] static std::span<const Corner> placed(const Mesh& mesh, State state,
                                                      std::span<const CellCorner> corners, std::vector<Corner>& to);
  void draw_polygon(const Mesh& mesh, State state, const Shade& shade, const Flux& flux,
                    std::span<const CellCorner> shape, std::span<const CellCorner> outline, const Behind& behind);
  void draw_pieces(const Mesh& mesh, std::span<const Corner> cell, const Shade& shade, const Flux& flux,
                   const Behind& behind);
  void draw_part(std::span<const Corner> polygon, const Shade& shade, const Flux& flux, bool triangle,
                 const Behind& behind);
  void add_seen(std::span<const Corner> polygon, double area_px, const Shade& shade, const Flux& flux,
                const Behind& behind);
  void add_shadows(std::span<const Corner> polygon, const Shade& shade, const Flux& flux, const Behind& behind);
  void draw_dirty(const Mesh& mesh, const Cell& cell, State state, const Shade& shade, const Flux& flux,
                  const StopMap* map);
  [[nodiscard]] DirtTriangle dirt_triangle(const Mesh& mesh, const std::array<std::size_t, 3>& triangle) const;
  [[nodiscard]] PastDirt past_dirt(const DirtTriangle& dirt) const;
  [[nodiscard]] int dirt_crossings(const Mesh& mesh) const;
  [[nodiscard]] Vec2 dirt_place(const Mesh& mesh, std::size_t vertex, int crossing) const;
  [[nodiscard]] bool is_dirty(const Mesh& mesh, const Cell& cell) const;  // false where the lens is clean
  [[nodiscard]] double shadow_error(const Mesh& mesh, const Cell& cell) const;
  void draw_screened(std::span<const Corner> polygon, double area_px, const Shade& shade, const StopMap& map,
                     int looks);
  void add_fringed(std::span<const PlacedCorner> polygon, const Shade& shade, const StopMap& map, int looks,
                   const EdgeTable& table);
  [[nodiscard]] bool sees_by_parts(const Mesh& mesh, const Cell& cell, double longest_px) const;
  [[nodiscard]] std::size_t parts_across(const Mesh& mesh, const Cell& cell, double longest_px) const;
  [[nodiscard]] CellParts parts_of(const Mesh& mesh, const Cell& cell, std::size_t across) const;
  [[nodiscard]] Vec2 stop_place(const Mesh& mesh, std::size_t vertex, int crossing) const;
  [[nodiscard]] StopMap stop_map(const Mesh& mesh, const Cell& cell, double softness_px) const;
  [[nodiscard]] StopMap stop_map(const Mesh& mesh, const std::array<std::size_t, 3>& triangle) const;
  template <class SeriesOf>
  [[nodiscard]] StopMap stop_map(const Mesh& mesh, double softness_px, const SeriesOf& series_of) const;
  [[nodiscard]] double map_error(const Mesh& mesh, const Cell& cell, double longest_px) const;
  [[nodiscard]] const EdgeTable& table_for(double width);
  [[nodiscard]] int looks_across_pixel(const Shade& shade, double passed, const StopMap& map) const;
  [[nodiscard]] screens::ScreenView view_of_screen(const Mesh& mesh, const Cell& cell) const;
  [[nodiscard]] bool is_dim(const Mesh& mesh, const Cell& cell, double times) const;
  [[nodiscard]] static double brightest(const Mesh& mesh, const Cell& cell);
  [[nodiscard]] bool are_uneven(const Mesh& mesh, const Cell& cell, const CellParts& parts) const;
  [[nodiscard]] double stop_size(const Mesh& mesh, const Cell& cell) const;
  // The polygon's points, in scratch memory that the next call overwrites.
  template <class AnyCorner>
  [[nodiscard]] std::span<const Point> points_of(std::span<const AnyCorner> polygon) {
    points_.clear();
    for (const AnyCorner& c : polygon)
      points_.push_back({static_cast<float>(c.position.x), static_cast<float>(c.position.y)});
    return points_;
  }
  void draw_line(std::span<const Corner> polygon, const Flux& flux);

  // The budget of the next cell. The number of cells is not known beforehand: a cell's fraction falls as they become
  // more, down to a quarter. If it fell further, most cells would be spent where light is focused, without gain.
  [[nodiscard]] double cell_budget() const { return budget_ / std::clamp(cells_, few_cells_, kManyCells * few_cells_); }
  [[nodiscard]] static Cell cell_at(const BoxMesh& of, const MeshSquare& square);
  // Empty if the cell is closed or off the frame.
  [[nodiscard]] std::optional<std::pair<Cell, State>> seen_cell(const BoxMesh& of, const MeshSquare& square) const;
  [[nodiscard]] static bool misses_stop(const Mesh& mesh, const Cell& cell, int crossing);
  [[nodiscard]] State state_of(const Mesh& mesh, const Cell& cell) const;
  [[nodiscard]] bool off_frame(const Mesh& mesh, const Cell& cell) const;
  [[nodiscard]] bool wants_finer_mesh(const BoxMesh& in, const MeshSquare& square, bool on_plane) const;
  [[nodiscard]] std::uint32_t blocking(const Mesh& mesh) const { return screen_ ? ~0U << mesh.layout.crossings : ~0U; }
  [[nodiscard]] bool serves(const IrradiancePlane& plane) const;
  [[nodiscard]] std::optional<Shade> plane_for(const Mesh& mesh, const MeshSquare& square) const;
  void find_planes(BoxMesh& of) const;
  [[nodiscard]] bool shows_facets(double area_px, double mean, double off_plane) const;
  [[nodiscard]] CellMeasure measure(const Mesh& mesh, const Cell& cell, State state, bool on_plane) const;
  [[nodiscard]] double squared_error(const Mesh& mesh, const Cell& cell, CellMeasure& of, State state,
                                     Sides sides) const;
  [[nodiscard]] SidesOff sides_off(const Mesh& mesh, const Cell& cell, State state, double left) const;
  // A picture as the iris clips triangles, within which corners on a cell's sides have no effect.
  [[nodiscard]] Sides most_bent(State state) const {
    return state == State::Cut && iris_.is_picture() ? Sides::Straight : Sides::Bent;
  }
  [[nodiscard]] static Shape shape_of(const Mesh& mesh, const Cell& cell, Sides sides);
  [[nodiscard]] static double obscuration_error(const Mesh::Field& field, const Cell& cell);
  [[nodiscard]] double limit_error(const Mesh& mesh, const Cell& cell) const;
  [[nodiscard]] double arc_step(const Mesh& mesh, std::span<const CellCorner> corners, const Shade& shade) const;

  const IrisShape& iris_;
  int width_, height_;
  double budget_, few_cells_;
  double cells_ = 0.0;  // chosen for this band
  bool sides_bend_ = false;
  double peak_;
  PolygonList& out_;
  std::shared_ptr<const screens::BandScreen> screen_;  // null: the iris is sharp
  double screen_unit_ = 1.0;
  SeenDirt dirt_;
  screens::ShadowCutter shadows_;
  std::map<std::pair<const screens::BandScreen*, int>, const EdgeTable*> tables_;  // of stop patterns, by pixel width
  std::vector<std::uint16_t> active_;
  PlacedPolygon rest_, strip_;  // scratch for cutting along edges
  std::vector<Corner> shape_, outline_;  // scratch for drawing
  BoxCells& chosen_;
  std::vector<CellCorner> all_corners_;  // of a cell
  Vec2 rise_;  // of what its rays carry: change from side to side along u and v, over the mean
  OutlineCutter cutter_;
  std::vector<Point> points_;
};

}  // namespace contrejour::inline internal::adaptive
