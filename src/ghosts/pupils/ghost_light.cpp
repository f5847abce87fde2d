#include "ghosts/pupils/ghost_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ghosts/pupils/footprint.h"
#include "ghosts/pupils/lobatto.h"

namespace contrejour::pupils {
namespace {

constexpr std::array kNodes{5, 9, 17};
constexpr double kWorthShrinking = 0.5;  // a box whose lit part has no more of its area is shrunk to it

// How a pupil is gone through: mesh sides by depth, how often a box is quartered, and by what polynomials may be off:
// stop radii, shares of the largest transmission and of the image's extent.
struct Scheme {
  int deepest;
  std::array<int, 5> side;
  double stop, transmission, position;
};
constexpr Scheme kFine{4, {65, 33, 33, 17, 17}, 1e-3, 2e-3, 5e-3};
constexpr Scheme kRough{2, {33, 17, 17, 17, 17}, 5e-3, 1e-2, 0.1};
constexpr int kPictureSide = 129;  // a picture's details are smaller than blades

double area(const Rectangle& r) { return (r.high.x - r.low.x) * (r.high.y - r.low.y); }

double extent(const std::vector<float>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return static_cast<double>(*high) - *low;
}

bool is_smooth(const RaySheet& sheet, const Scheme& scheme) {
  const int n = sheet.nodes;
  const auto holds = [&](const std::vector<float>& field, double allowed) {
    return highest_terms(field.data(), n) <= allowed;
  };
  for (const auto& crossing : sheet.stop)
    if (!holds(crossing[0], scheme.stop) || !holds(crossing[1], scheme.stop)) return false;
  for (const std::size_t step : rims_in_play({&sheet, 1}))
    if (highest_terms(sheet.rim_squared.data() + step * sheet.count(), n) > 2.0 * scheme.stop) return false;
  const double most = *std::max_element(sheet.transmission.begin(), sheet.transmission.end());
  const double image_mm = std::max(extent(sheet.sensor_x_mm), extent(sheet.sensor_y_mm));
  return holds(sheet.transmission, scheme.transmission * most) &&
         holds(sheet.sensor_x_mm, scheme.position * image_mm) && holds(sheet.sensor_y_mm, scheme.position * image_mm);
}

class MeshWalk {
 public:
  MeshWalk(SheetTracer& tracer, const LightFrame& light, const IrisShape& iris, MeshCare care, const VisitMesh& visit)
      : tracer_(tracer), light_(light), iris_(iris), scheme_(care == MeshCare::Fine ? kFine : kRough), visit_(visit) {}

  // As PatchFitter: shrunk to what is lit, more nodes, quarters, and where rays fail even in small ones the rays alone.
  void walk(const Rectangle& box, bool with_mirror_image, int depth) {
    const bool last_part = depth >= scheme_.deepest;
    for (std::size_t k = 0; k < kNodes.size(); ++k) {
      const RaySheet sheet = tracer_.trace(box, kNodes[k], PacketPrecision::Double);
      const auto lit = bounds_of_cells(sheet, [&](const CellCorners& corners) { return may_pass(sheet, corners); });
      if (!lit) return;
      if (!last_part && area(*lit) < kWorthShrinking * area(box)) return walk(*lit, with_mirror_image, depth + 1);
      if (sheet.failed > 0 && !last_part) break;
      const bool last = k + 1 == kNodes.size();
      if (sheet.failed > 0 ? last : is_smooth(sheet, scheme_) || (last && last_part))
        return visit_both(sheet, with_mirror_image, depth);
    }
    walk_quarters(box, with_mirror_image, depth);
  }

 private:
  void walk_quarters(const Rectangle& box, bool with_mirror_image, int depth) {
    const Vec2 middle = (box.low + box.high) * 0.5;
    const bool symmetric = light_.symmetric && box.low.y == -box.high.y;
    for (const bool upper : {true, false}) {
      if (symmetric && !upper) return;
      for (const bool right : {false, true}) {
        const Rectangle quarter{{right ? middle.x : box.low.x, upper ? middle.y : box.low.y},
                                {right ? box.high.x : middle.x, upper ? box.high.y : middle.y}};
        walk(quarter, with_mirror_image || symmetric, depth + 1);
      }
    }
  }

  void visit_both(const RaySheet& sheet, bool with_mirror_image, int depth) {
    make_mesh(sheet, depth);
    visit_(sheet, mesh_, false);
    if (!with_mirror_image) return;
    const RaySheet image = mirrored(sheet);
    make_mesh(image, depth);
    visit_(image, mesh_, true);
  }

  void make_mesh(const RaySheet& sheet, int depth) {
    if (sheet.failed > 0) return connect(sheet, light_, iris_, mesh_);
    const int side = iris_.is_picture() && depth == 0 ? kPictureSide : scheme_.side[static_cast<std::size_t>(depth)];
    interpolate(sheet, light_, iris_, side, mesh_);
  }

  SheetTracer& tracer_;
  const LightFrame& light_;
  const IrisShape& iris_;
  const Scheme& scheme_;
  const VisitMesh& visit_;
  OpenMesh mesh_;
};

LightFrame frame_of(const PupilRequest& request) {
  return LightFrame(request.light, has_axial_symmetry(request.steps.begin()->second.lens(), request.ghost));
}

SheetTracer tracer_of(const PupilRequest& request, const LightFrame& light, double lambda_nm) {
  const LightRays rays{{0.0, 0.0, request.window.z_mm}, light.source};
  return {PacketPath(request.steps.at(lambda_nm), request.ghost, rays, request.stop_times), light};
}

// Rows in the opposite order.
void turn_over(std::vector<double>& weights, int nodes) {
  const auto n = static_cast<std::ptrdiff_t>(nodes);
  for (std::ptrdiff_t row = 0; row < n / 2; ++row)
    std::swap_ranges(weights.begin() + row * n, weights.begin() + (row + 1) * n, weights.begin() + (n - 1 - row) * n);
}

}  // namespace

void for_each_mesh(SheetTracer& tracer, std::span<const Rectangle> boxes, const LightFrame& light,
                   const IrisShape& iris, MeshCare care, const VisitMesh& visit) {
  MeshWalk walk(tracer, light, iris, care, visit);
  for (const Rectangle& box : boxes) {
    const bool aside = light.symmetric && box.low.y != -box.high.y;
    const bool has_image = aside && std::ranges::count(boxes, mirrored(box)) > 0;
    if (has_image && is_mirror_image(box)) continue;  // with the other
    walk.walk(box, has_image, 0);
  }
}

GhostMeasure measure_ghost(const PupilRequest& request, const GhostPupil& pupil, double lambda_nm,
                           const IrisShape& iris, double pixel_mm) {
  if (pupil.boxes.empty()) return {};
  const LightFrame light = frame_of(request);
  SheetTracer tracer = tracer_of(request, light, lambda_nm);
  Footprint footprint(light.source.shared_flux(), pixel_mm);
  for_each_mesh(tracer, pupil.boxes, light, iris, MeshCare::Fine,
                [&](const RaySheet&, const OpenMesh& mesh, bool) { footprint.add(mesh); });
  return footprint.measure();
}

std::vector<double> rough_fluxes(const PupilRequest& request, const GhostPupil& pupil, const IrisShape& iris) {
  if (pupil.boxes.empty()) return std::vector<double>(request.lambda_nm.size(), 0.0);
  const LightFrame light = frame_of(request);
  const std::size_t middle = request.lambda_nm.size() / 2;
  std::vector<SheetTracer> tracers;
  for (const double lambda_nm : request.lambda_nm) tracers.push_back(tracer_of(request, light, lambda_nm));
  std::vector<double> flux(tracers.size(), 0.0);
  for_each_mesh(tracers[middle], pupil.boxes, light, iris, MeshCare::Rough,
                [&](const RaySheet& sheet, const OpenMesh& mesh, bool is_mirrored) {
                  std::vector<double> weights = node_weights(mesh, open_cells(mesh));
                  if (is_mirrored) turn_over(weights, sheet.nodes);
                  const Rectangle box = is_mirrored ? mirrored(sheet.box) : sheet.box;
                  for (std::size_t k = 0; k < tracers.size(); ++k) {
                    const auto light_at = tracers[k].transmissions(box, sheet.nodes, PacketPrecision::Double);
                    for (std::size_t node = 0; node < weights.size(); ++node) flux[k] += weights[node] * light_at[node];
                  }
                });
  for (double& one : flux) one *= light.source.shared_flux();
  return flux;
}

}  // namespace contrejour::pupils
