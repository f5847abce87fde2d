// SPDX-License-Identifier: Apache-2.0
// The C++ side of bench_speed.py: processor time in ms of frames and of rays, one number a line.
//   python_bench_native render LENS WIDTH HEIGHT FRAMES
//   python_bench_native trace LENS RAYS ROUNDS     a loop over trace()
//   python_bench_native arrays LENS RAYS ROUNDS    trace_rays(), which Python calls
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/trace.h"
#include "contrejour/expert/trace_rays.h"
#include "contrejour/renderer.h"

using namespace contrejour;

namespace {

double processor_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

int render_frames(const std::string& lens, const std::string& size, int frames) {
  for (int frame = 0; frame < frames; ++frame) {
    params::Values values;
    const std::string light = std::to_string(4 + frame % 5) + ",5:1000";
    if (!values.set("size", size) || !values.set("light", light) || !values.set("threads", "1")) return 1;
    const double before = processor_ms();
    const auto state = params::lens_of(*find_lens(lens), values);
    auto renderer = Renderer::create(params::method_options(values));
    if (!state || !renderer || !renderer->set_lens(*state)) return 1;
    const auto request = picture_request(values, *state);
    Context context;
    context.threads = 1;
    const auto flare = render_picture(*request, *renderer, context);
    if (!flare) return 1;
    std::printf("%.3f\n", processor_ms() - before);
  }
  return 0;
}

int trace_rays(const std::string& lens, std::size_t rays, int rounds) {
  const auto state = configure_lens(*find_lens(lens));
  if (!state) return 1;
  const OpticalPath path = direct_path(*state, state->design_wavelength_nm);
  std::vector<Ray> from(rays);
  for (std::size_t k = 0; k < rays; ++k)
    from[k] = {
        {8.0 * static_cast<double>(k % 1000) / 1000.0 - 4.0, 8.0 * static_cast<double>(k / 1000) / 1000.0 - 4.0, -20.0},
        {0, 0, 1}};
  std::vector<TracedRay> traced(rays);
  std::vector<double> blocked(rays);
  for (int round = 0; round < rounds; ++round) {
    const double before = processor_ms();
    for (std::size_t k = 0; k < rays; ++k) {
      traced[k] = trace(path, from[k]);
      blocked[k] = blocked_by(traced[k], path, state->iris);
    }
    std::printf("%.3f\n", processor_ms() - before);
  }
  return 0;
}

int trace_arrays(const std::string& lens, std::size_t rays, int rounds) {
  const auto state = configure_lens(*find_lens(lens));
  if (!state) return 1;
  const OpticalPath path = direct_path(*state, state->design_wavelength_nm);
  std::vector<double> origins(3 * rays), directions(3 * rays);
  for (std::size_t k = 0; k < rays; ++k) {
    origins[3 * k] = 8.0 * static_cast<double>(k % 1000) / 1000.0 - 4.0;
    origins[3 * k + 1] = 8.0 * static_cast<double>(k / 1000) / 1000.0 - 4.0;
    origins[3 * k + 2] = -20.0;
    directions[3 * k + 2] = 1.0;
  }
  std::vector<RayStatus> status(rays);
  std::vector<double> sensor(2 * rays), direction(3 * rays), transmission(rays), height(rays), blocked(rays),
      stop(2 * recorded_crossings(path) * rays);
  Context context;
  context.threads = 1;
  for (int round = 0; round < rounds; ++round) {
    const double before = processor_ms();
    if (!trace_rays(path, state->iris, {origins, directions},
                    {status, sensor, direction, transmission, height, blocked, stop}, context))
      return 1;
    std::printf("%.3f\n", processor_ms() - before);
  }
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count == 6 && std::string(arguments[1]) == "render")
    return render_frames(arguments[2], std::string(arguments[3]) + "x" + arguments[4], std::atoi(arguments[5]));
  if (count == 5 && std::string(arguments[1]) == "trace")
    return trace_rays(arguments[2], static_cast<std::size_t>(std::atoll(arguments[3])), std::atoi(arguments[4]));
  if (count == 5 && std::string(arguments[1]) == "arrays")
    return trace_arrays(arguments[2], static_cast<std::size_t>(std::atoll(arguments[3])), std::atoi(arguments[4]));
  return 2;
}
