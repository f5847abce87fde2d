#include "render/adaptive/ghost_painter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "render/adaptive/extremes.h"
#include "render/adaptive/lobatto.h"
#include "render/adaptive/screened_boxes.h"
#include "render/screens/ringing_patterns.h"

namespace contrejour::adaptive {
namespace {

constexpr std::array kNodes{5, 9, 17};
// Float places a ray on the sensor to some 1e-3 mm at worst; it must be given room enough at the entrance, too.
constexpr double kFloatError_mm = 1e-3;
constexpr double kFloatBox_mm = 0.05;
constexpr double kWorthShrinking = 0.5;  // a box whose lit part has no more of its area is shrunk to it
constexpr double kLightLeft = 0.05;  // of a channel's absolute sum over wavelengths, for its parts to mean anything
constexpr std::size_t kMostSamples = 9;  // of wavelengths, that are tried
constexpr double kNoFit = std::numeric_limits<double>::infinity();
// Behind a screen: how much worse fits of dim light may be, and what is so dim, over what does not count at all, that
// any will do.
constexpr double kMostLooser = 64.0, kRough = 10.0;
constexpr double kHopeless = 2.0;  // times the tolerance, foretold of more nodes
constexpr int kWorthBending = 2;     // quarterings that might be saved
// A band's squared error is shared among so many cells; that of fewer bands as if they were three.
constexpr double kFewCells = 64.0, kFewBands = 3.0;

// Bounds of the cells between the nodes that may let light through, none if none may; the iris counts as its
// circumscribed circle.
std::optional<Rectangle> lit_part(const RaySheet& sheet) {
  const auto n = static_cast<std::size_t>(sheet.nodes);
  const auto& points = lobatto_points(sheet.nodes);
  const Vec2 half = (sheet.box.high - sheet.box.low) * 0.5;
  std::optional<Rectangle> part;
  for (std::size_t cell = 0; cell + n < sheet.count(); ++cell) {
    const std::size_t ix = cell % n;
    const std::size_t iy = cell / n;
    if (ix == n - 1) continue;
    std::array<Extremes, 1 + kMaxStopCrossings> extremes;
    bool any = false;
    for (const std::size_t k : {cell, cell + 1, cell + n, cell + n + 1}) {
      if (std::isinf(sheet.r_rel[k])) continue;
      any = true;
      extremes[0].add(sheet.r_rel[k] - 1.0F);
      for (std::size_t c = 0; c < sheet.stop.size(); ++c) {
        const float x = sheet.stop[c][0][k];
        const float y = sheet.stop[c][1][k];
        extremes[1 + c].add(std::sqrt(x * x + y * y) - 1.0F);
      }
    }
    for (std::size_t l = 0; l < 1 + sheet.stop.size(); ++l) any = any && extremes[l].may_pass(1.0F);
    if (!any) continue;
    const Vec2 low = sheet.box.low + Vec2{half.x * (1.0 + points[ix]), half.y * (1.0 + points[iy])};
    const Vec2 high = sheet.box.low + Vec2{half.x * (1.0 + points[ix + 1]), half.y * (1.0 + points[iy + 1])};
    if (!part) part = {low, high};
    part->low = {std::min(part->low.x, low.x), std::min(part->low.y, low.y)};
    part->high = {std::max(part->high.x, high.x), std::max(part->high.y, high.y)};
  }
  return part;
}

double area(const Rectangle& r) { return (r.high.x - r.low.x) * (r.high.y - r.low.y); }

// Of the cells of any of the sheets, which are of one box.
std::optional<Rectangle> lit_part(std::span<const RaySheet> sheets) {
  std::optional<Rectangle> part;
  for (const RaySheet& sheet : sheets) {
    const auto one = lit_part(sheet);
    if (one) part = part ? both(*part, *one) : *one;
  }
  return part;
}

// A patch's error over what is allowed.
double misfit(const Patch& patch, const Tolerance& tolerance) {
  const PatchError e = estimated_error(patch);
  return std::max({e.position_px / tolerance.position_px, e.stop / tolerance.stop, e.rim / (2.0 * tolerance.stop),
                   e.weight / tolerance.weight});
}

bool all_arrive(std::span<const RaySheet> sheets) {
  return std::all_of(sheets.begin(), sheets.end(), [](const RaySheet& sheet) { return sheet.failed == 0; });
}

// A band's first rays: the geometry of its middle and the light of all its passes.
RaySheet band_sheet(const FirstRays& rays, const Band& band, std::span<const PlannedPass> passes) {
  RaySheet sheet = rays.sheets[band.middle()];
  add_light(sheet, rays.transmission[band.middle()], passes[band.middle()].gain);
  for (std::size_t k = band.first; k < band.last; ++k)
    if (k != band.middle()) add_light(sheet, rays.transmission[k], passes[k].gain);
  return sheet;
}

std::vector<double> wavelengths_of(std::span<const PlannedPass> passes) {
  std::vector<double> lambda_nm;
  for (const PlannedPass& pass : passes) lambda_nm.push_back(pass.lambda_nm);
  return lambda_nm;
}

}  // namespace

GhostPainter::GhostPainter(GhostTracers& tracers, const IrisShape& iris, const Frame& frame, int deepest,
                           GhostRoom& room, const GhostScreens* screens, const screens::DirtField* dirt)
    : tracers_(tracers), samples_(wavelengths_of(tracers.passes()), kMostSamples), iris_(iris), frame_(frame),
      deepest_(deepest), screens_(screens), dirt_(dirt), room_(room) {}

PacketPrecision GhostPainter::precision_for(const Rectangle& box, const Tolerance& tolerance) const {
  const bool coarse = tolerance.position_px * frame_.pixel_pitch_mm > 2.0 * kFloatError_mm;
  const Vec2 size = box.high - box.low;
  return coarse && std::min(size.x, size.y) > kFloatBox_mm ? PacketPrecision::Float : PacketPrecision::Double;
}

// The screens of a band's wavelengths, at most three, each with the light of those nearest.
std::shared_ptr<const BandScreen> GhostPainter::band_screen(const FirstRays& rays, const Band& of) const {
  const std::size_t passes = of.last - of.first, count = std::min<std::size_t>(passes, 3);
  auto band = std::make_shared<BandScreen>();
  std::array<double, 3> sum{}, size{};
  std::vector<std::array<double, 3>> light(count);
  for (std::size_t part = 0; part < count; ++part) {
    const std::size_t from = of.first + part * passes / count, to = of.first + (part + 1) * passes / count;
    band->parts.push_back({screens_->by_pass[(from + to) / 2].screen, {}});
    band->hull.hold(screens_->by_pass[(from + to) / 2].hull);
    for (std::size_t k = from; k < to; ++k) {
      const auto of_pass = light_of(rays, tracers_.passes(), k);
      for (std::size_t c = 0; c < 3; ++c) light[part][c] += of_pass[c];
    }
    for (std::size_t c = 0; c < 3; ++c) sum[c] += light[part][c], size[c] += std::abs(light[part][c]);
  }
  for (std::size_t part = 0; part < count; ++part)
    for (std::size_t c = 0; c < 3; ++c)
      band->parts[part].channel[c] = static_cast<float>(
          std::abs(sum[c]) > kLightLeft * size[c] ? light[part][c] / sum[c] : 1.0 / static_cast<double>(count));
  bool all_edges = true;
  std::vector<const screens::PatternTexture*> textures;
  for (const auto& part : band->parts) {
    const auto* const edge = dynamic_cast<const screens::EdgeScreen*>(part.screen.get());
    const auto* const pattern = dynamic_cast<const screens::TextureScreen*>(part.screen.get());
    if (pattern != nullptr) textures.push_back(&pattern->texture());
    all_edges = all_edges && edge != nullptr;
    if (edge == nullptr) continue;
    band->unit = std::min(band->unit, edge->unit());
    band->dark_beyond = std::max(band->dark_beyond, -screens_->range.dark * edge->unit());
    band->level_within = std::max(band->level_within, screens_->range.level * edge->unit());
  }
  if (all_edges) band->edges = static_cast<const screens::EdgeScreen*>(band->parts.front().screen.get());
  band->unseen = screens_->unseen;
  if (textures.size() == band->parts.size()) band->pattern = screens_->patterns->contents().band(textures);
  return band;
}

void GhostPainter::paint(const Rectangle& box, bool with_mirror_image, const ErrorBudget& budget, PolygonList& out) {
  FirstRays rays = first_rays(tracers_, samples_, box, kNodes.front(), frame_, budget);
  if (const auto bent = bent_about(rays, box)) {
    tracers_.bend(bent->bend);
    rays = first_rays(tracers_, samples_, bent->box, kNodes.front(), frame_, budget);
  }
  paint(rays, with_mirror_image, budget, out);
  tracers_.bend({});
}

// A box about the same light where rays fail in this one, which would have to be quartered. Dirt is looked up by place
// in the straight one.
std::optional<BentBox> GhostPainter::bent_about(const FirstRays& rays, const Rectangle& box) {
  const bool fail = std::ranges::any_of(rays.sheets, [](const RaySheet& sheet) { return sheet.failed > 0; });
  if (!fail || deepest_ < kWorthBending || dirt_ != nullptr || !tracers_.light().symmetric || box.low.y != -box.high.y)
    return std::nullopt;
  std::vector<ClearanceGrid> grids{tracers_.clearance(0)};
  if (tracers_.passes().size() > 1) grids.push_back(tracers_.clearance(tracers_.passes().size() - 1));
  auto bent = bent_box(grids, box);
  for (const ClearanceGrid& grid : grids) tracers_.count(grid);
  return bent;
}

void GhostPainter::paint(const FirstRays& rays, bool with_mirror_image, const ErrorBudget& budget, PolygonList& out) {
  const std::vector<Band> bands = bands_for(rays, tracers_.passes(), samples_, frame_.pixel_pitch_mm);
  BandScreens screens;
  for (const Band& band : bands) screens.push_back(screens_ != nullptr ? band_screen(rays, band) : nullptr);
  const auto few_cells = kFewCells * std::max(static_cast<double>(bands.size()), kFewBands);
  const auto painter = [&](CellRoom& room) {
    CellPainter cells(iris_, frame_, budget.squared_error, few_cells, budget.peak, room, out);
    cells.sides_bend(tracers_.is_bent());
    cells.stand_behind(SeenDirt{dirt_, &tracers_.light(), tracers_.plane_z_mm()});
    return cells;
  };
  CellPainter cells = painter(room_.cells), cells_of_image = painter(room_.of_mirror_image);
  CellPainter* const mirror_image = with_mirror_image ? &cells_of_image : nullptr;
  if (rays.samples > 0) {
    BandSet all(tracers_, samples_, rays.samples, bands);
    std::vector<RaySheet> sheets;
    for (std::size_t k = 0; k < rays.samples; ++k) sheets.push_back(rays.sheets[samples_[k]]);
    all.add_weights(sheets, PacketPrecision::Double);
    paint_bands(all, sheets, {rays.tolerance, screens, cells, mirror_image});
  }
  for (std::size_t k = 0; k < bands.size() && rays.samples == 0; ++k) {
    BandSet one(tracers_, bands[k]);
    const RaySheet sheet = band_sheet(rays, bands[k], tracers_.passes());
    paint_bands(one, {&sheet, 1}, {rays.tolerance, {screens[k]}, cells, mirror_image, k});
  }
  for (CellPainter* const all : {&cells, mirror_image}) {
    for (std::size_t k = 0; k < bands.size() && all != nullptr; ++k) {
      stand_behind(screens[k], *all);
      all->draw(k);
    }
  }
}

// A box that no other one touches.
GhostPainter::BoxPart GhostPainter::whole(const Rectangle& box, int depth) {
  const MeshPlace place{boxes_, is_symmetric(box) ? boxes_ : boxes_ + 1};
  boxes_ += 2;
  return {box, place, depth};
}

bool GhostPainter::is_symmetric(const Rectangle& box) const {
  return tracers_.light().symmetric && box.low.y == -box.high.y;
}

// first: sheets of the fewest nodes, with weights.
void GhostPainter::paint_bands(BandSet& bands, std::span<const RaySheet> first, const Painting& painting) {
  const BoxPart part = whole(first.front().box);
  double first_misfit = kNoFit;
  if (all_arrive(first)) {
    const std::vector<Patch> patches = bands.make_patches(first, frame_);
    first_misfit = misfit(bands, patches, painting.tolerance);
    if (first_misfit <= 1.0) return paint_patches(bands, first, patches, part.place, painting);
  }
  paint_part(bands, part, first_misfit, painting);
}

// first_misfit: that of the fewest nodes, where it is known.
void GhostPainter::paint_part(BandSet& bands, const BoxPart& part, std::optional<double> first_misfit,
                              const Painting& painting) {
  const Rectangle& box = part.box;
  double before = first_misfit.value_or(kNoFit);
  for (std::size_t k = first_misfit ? 1 : 0; k < kNodes.size(); ++k) {
    const PacketPrecision precision = precision_for(box, painting.tolerance);
    std::vector<RaySheet> sheets = bands.trace(box, kNodes[k], precision);
    const std::optional<double> level = level_behind(bands, sheets, painting);
    if (level && *level < screens_->unseen) return;
    const bool rough = level && *level < kRough * screens_->unseen;
    const double looser = level ? std::clamp(painting.tolerance.level / *level, 1.0, kMostLooser) : 1.0;
    const auto lit = lit_part(sheets);
    if (!lit) return;
    const bool last_part = part.depth >= deepest_;
    if (!last_part && area(*lit) < kWorthShrinking * area(box))
      return paint_part(bands, whole(*lit, part.depth + 1), std::nullopt, painting);
    const bool last = k + 1 == kNodes.size();
    const bool arrive = all_arrive(sheets);
    if (!arrive && !last_part && !rough) break;
    bands.add_weights(sheets, precision);
    if (!arrive) return paint_between_rays(bands, part, sheets, painting);
    const std::vector<Patch> patches = bands.make_patches(sheets, frame_);
    const double now = misfit(bands, patches, painting.tolerance) / looser;
    if (now <= 1.0 || rough || (last && last_part)) return paint_patches(bands, sheets, patches, part.place, painting);
    // Errors fall by a like factor for a like number of nodes, which the next step has twice more of.
    const double next = now * (now / before) * (now / before);
    if (next > kHopeless && !last_part) break;
    before = now;
  }
  paint_quarters(bands, part, painting);
}

// About the brightest pixel of a box behind a screen, or of its mirror image, as far as it matters. None: the iris is
// sharp, or that is not told: of several bands, or where no four rays side by side arrive.
std::optional<double> GhostPainter::level_behind(const BandSet& bands, std::span<const RaySheet> sheets,
                                                 const Painting& painting) const {
  if (screens_ == nullptr || bands.size() > 1 || sheets.size() > 1) return std::nullopt;
  Rgb gain{};
  for (std::size_t k = bands.band(0).first; k < bands.band(0).last; ++k)
    for (std::size_t c = 0; c < 3; ++c) gain[c] += tracers_.passes()[k].gain[c];
  const double pixel_mm2 = frame_.pixel_pitch_mm * frame_.pixel_pitch_mm;
  const double scale = std::max({std::abs(gain[0]), std::abs(gain[1]), std::abs(gain[2])}) * pixel_mm2;
  const double enough = std::max(painting.tolerance.level, kRough * screens_->unseen);
  const auto brightest = brightest_passed(sheets.front(), painting.mirror_image != nullptr, *painting.screens.front(),
                                          tracers_.stop_times(), tracers_.light(), enough / scale);
  return brightest ? std::optional(*brightest * scale) : std::nullopt;
}

// The worst of three bands', at most: those between them are blended like them.
double GhostPainter::misfit(const BandSet& bands, std::span<const Patch> patches, const Tolerance& tolerance) const {
  Patch patch;
  double worst = 0.0;
  const std::size_t step = std::max<std::size_t>(1, (bands.size() - 1) / 2);
  for (std::size_t band = 0; band < bands.size(); band += step) {
    bands.band_patch(patches, band, patch);
    worst = std::max(worst, adaptive::misfit(patch, tolerance));
  }
  return worst;
}

// patches: of the sheets.
void GhostPainter::paint_patches(const BandSet& bands, std::span<const RaySheet> sheets, std::span<const Patch> patches,
                                 const MeshPlace& place, const Painting& painting) const {
  const auto paint_all = [&](std::span<const Patch> of, const MeshPlace& at, CellPainter& cells) {
    Patch patch;
    for (std::size_t band = 0; band < bands.size(); ++band) {
      bands.band_patch(of, band, patch);
      stand_behind(painting.screens[band], cells);
      cells.choose(patch, painting.first_band + band, at);
    }
  };
  paint_all(patches, place, painting.cells);
  if (painting.mirror_image == nullptr) return;
  std::vector<RaySheet> others;
  for (const RaySheet& sheet : sheets) others.push_back(mirrored(sheet));
  paint_all(bands.make_patches(others, frame_), place.mirrored(), *painting.mirror_image);
}

// Straight lines between the rays that arrive, of each band by itself: they fail at different places.
void GhostPainter::paint_between_rays(BandSet& bands, const BoxPart& part, std::span<const RaySheet> sheets,
                                      const Painting& painting) {
  if (bands.size() == 1 && sheets.size() == 1) {
    const auto paint_cells = [&](const RaySheet& sheet, CellPainter& cells) {
      stand_behind(painting.screens.front(), cells);
      for (const Patch& patch : patches_of_cells(sheet, tracers_.light(), frame_))
        cells.choose(patch, painting.first_band, whole(patch.box).place);
    };
    paint_cells(sheets.front(), painting.cells);
    if (painting.mirror_image != nullptr) paint_cells(mirrored(sheets.front()), *painting.mirror_image);
    return;
  }
  for (std::size_t k = 0; k < bands.size(); ++k) {
    BandSet alone(tracers_, bands.band(k));
    paint_part(
        alone, part, std::nullopt,
        {painting.tolerance, {painting.screens[k]}, painting.cells, painting.mirror_image, painting.first_band + k});
  }
}

// Of a box that is its own mirror image those on one side of the axis tell the others.
void GhostPainter::paint_quarters(BandSet& bands, const BoxPart& part, const Painting& painting) {
  const Rectangle& box = part.box;
  const Vec2 middle = (box.low + box.high) * 0.5;
  const bool symmetric = is_symmetric(box);
  Painting of_quarter = painting;
  if (symmetric) of_quarter.mirror_image = &painting.cells;
  for (const std::size_t q : {2U, 3U, 0U, 1U}) {
    const bool right = q % 2 != 0, upper = q / 2 != 0;
    if (symmetric && !upper) return;
    const Rectangle quarter{{right ? middle.x : box.low.x, upper ? middle.y : box.low.y},
                            {right ? box.high.x : middle.x, upper ? box.high.y : middle.y}};
    paint_part(bands, {quarter, part.place.quarter(q), part.depth + 1}, std::nullopt, of_quarter);
  }
}

void GhostPainter::stand_behind(const std::shared_ptr<const BandScreen>& screen, CellPainter& cells) const {
  if (screen) cells.stand_behind(screen, tracers_.stop_times());
}

}  // namespace contrejour::adaptive
