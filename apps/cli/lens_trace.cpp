// SPDX-License-Identifier: Apache-2.0
// contrejour lens trace: traces one ray, surface by surface.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/lens_choice.h"
#include "cli/options.h"
#include "cli/text_table.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/trace.h"

namespace contrejour::cli {
namespace {

constexpr const char* kLensTraceExamples =
    "The ray starts at X,Y,Z mm (z = 0 at the first vertex) in the direction DX,DY,DZ, a vector of any length with\n"
    "DZ > 0. Light of the ghost I,J reflects first at surface J, then at surface I. The ray is traced beyond clear\n"
    "apertures; \"blocked\" says whether it passes outside one.\n\n"
    "Examples:\n"
    "  contrejour lens trace heliar --ray 0,5,-10,0,0,1\n"
    "  contrejour lens trace heliar -f 16 --ray 1,2,0,0.02,-0.1,1 --ghost 2,5 --wavelength 550 --json";

struct TraceOptions {
  std::string lens, ray, ghost;
  bool json = false;
  params::Values values;
};

struct Traced {
  RayRecord record;
  double lambda_nm = 0;
  double excess = 0;  // blocked_by(); the ray is blocked if this is above 0
};

const char* name_of(PathEvent event) {
  switch (event) {
    case PathEvent::Refract: return "refract";
    case PathEvent::Reflect: return "reflect";
    case PathEvent::Stop: return "stop";
  }
  return "";
}

Json vector_json(Vec3 v) { return Json::array({v.x, v.y, v.z}); }

// A ray that is totally reflected where its path refracts has no direction afterwards.
bool ends_at(const Traced& traced, const TraceStep& step) {
  return traced.record.ray.status == RayStatus::TotalReflection && &step == &traced.record.steps.back();
}

Json traced_json(const Traced& traced) {
  const TracedRay& ray = traced.record.ray;
  const bool reaches_sensor = ray.status == RayStatus::Ok;
  Json steps = Json::array();
  for (const TraceStep& step : traced.record.steps) {
    steps.push_back({{"surface", step.surface},
                     {"event", name_of(step.event)},
                     {"position_mm", vector_json(step.position_mm)},
                     {"direction", ends_at(traced, step) ? Json() : vector_json(step.direction_after)},
                     {"angle_of_incidence_rad", step.angle_of_incidence_rad},
                     {"reflectance", step.reflectance}});
  }
  return {{"wavelength_nm", traced.lambda_nm},
          {"status", to_string(ray.status)},
          {"steps", steps},
          {"sensor_mm", reaches_sensor ? Json::array({ray.sensor_mm.x, ray.sensor_mm.y}) : Json()},
          {"transmission", reaches_sensor ? Json(ray.transmission) : Json()},
          {"r_rel", reaches_sensor ? Json(ray.relative_height) : Json()},
          {"blocked", reaches_sensor ? Json(traced.excess > 0.0) : Json()}};
}

std::string traced_text(const Traced& traced) {
  TextTable table({"surface", "<event", "x mm", "y mm", "z mm", "dx", "dy", "dz", "incidence deg", "reflectance"});
  for (const TraceStep& step : traced.record.steps) {
    const Vec3 p = step.position_mm;
    const Vec3 d = step.direction_after;
    const auto part = [&](double value) { return ends_at(traced, step) ? "-" : fmt::format("{:.7f}", value); };
    table.add({fmt::format("{}", step.surface), name_of(step.event), fmt::format("{:.6f}", p.x),
               fmt::format("{:.6f}", p.y), fmt::format("{:.6f}", p.z), part(d.x), part(d.y), part(d.z),
               fmt::format("{:.4f}", step.angle_of_incidence_rad / params::kDegree_rad),
               fmt::format("{:.6f}", step.reflectance)});
  }
  const TracedRay& ray = traced.record.ray;
  std::string text = fmt::format("at {:g} nm: {}\n{}", traced.lambda_nm, to_string(ray.status), table.text());
  if (ray.status != RayStatus::Ok) return text;
  return text + fmt::format("sensor {:.6f}, {:.6f} mm; transmittance {:.6g}; {}\n", ray.sensor_mm.x, ray.sensor_mm.y,
                            ray.transmission, traced.excess > 0.0 ? "blocked" : "passes");
}

Result<OpticalPath> path_of(const LensState& lens, const std::string& ghost_text, double lambda_nm) {
  if (ghost_text.empty()) return direct_path(lens, lambda_nm);
  const auto ghost = choose_ghost(lens, ghost_text);
  if (!ghost) return tl::unexpected(ghost.error());
  return ghost_path(lens, *ghost, lambda_nm);
}

// Accepts a vector of any length that a double can hold: it is scaled before it is squared, so that nothing overflows.
Vec3 unit_vector(double x, double y, double z) {
  const double largest = std::max({std::abs(x), std::abs(y), std::abs(z)});
  return normalized({x / largest, y / largest, z / largest});
}

Result<int> run_trace(const TraceOptions& options) {
  const auto lens = open_lens(options.lens, options.values);
  if (!lens) return tl::unexpected(lens.error());
  Traced traced;
  traced.lambda_nm = wavelength_nm(options.values, *lens);
  const auto path = path_of(*lens, options.ghost, traced.lambda_nm);
  if (!path) return tl::unexpected(path.error());
  const std::vector<double> r = *params::parse_reals(options.ray, 6);
  traced.record = trace_recorded(*path, {{r[0], r[1], r[2]}, unit_vector(r[3], r[4], r[5])});
  std::erase_if(traced.record.steps, [](const TraceStep& step) { return step.is_rim_only; });
  traced.excess = blocked_by(traced.record.ray, *path, lens->iris);
  if (options.json) {
    print_json(traced_json(traced));
  } else {
    print(traced_text(traced));
  }
  return kDone;
}

std::string problem_with_ray(const std::string& text) {
  const auto numbers = params::parse_reals(text, 6);
  if (!numbers) return numbers.error().message;
  return (*numbers)[5] > 0.0 ? "" : "the ray does not travel towards the sensor; give DZ above 0";
}

}  // namespace

void add_lens_trace(CLI::App& lens, Action& action) {
  const auto options = std::make_shared<TraceOptions>();
  CLI::App* command = lens.add_subcommand("trace", "trace one ray, surface by surface");
  add_lens_argument(*command, options->lens);
  command->add_option("--ray", options->ray, "origin and direction of the ray")
      ->required()
      ->check(CLI::Validator(problem_with_ray, "", "ray"))
      ->option_text("X,Y,Z,DX,DY,DZ");
  add_ghost_option(*command, "--ghost", options->ghost,
                   "trace along the optical path of this ghost (default: the direct path)");
  command->add_flag("--json", options->json, "print JSON");
  add_parameters(*command, options->values, {"wavelength"});
  add_lens_parameters(*command, options->values);
  hide_parameters(*command, kDirt);
  command->footer(kLensTraceExamples);
  command->callback([options, &action] { action = [options] { return run_trace(*options); }; });
}

}  // namespace contrejour::cli
