// SPDX-License-Identifier: Apache-2.0
// contrejour polynomial fit --direct: a lens's direct image as polynomials, and the description of such a fit.
#include "cli/polynomial_direct.h"

#include <filesystem>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/lens_choice.h"
#include "cli/long_task.h"
#include "cli/outputs.h"

namespace contrejour::cli {
namespace {

Json direct_json(const DirectPolynomials& fit, std::size_t bytes) {
  const DirectAccuracy& accuracy = fit.accuracy;
  return {{"lens", fit.lens},
          {"fingerprint", fmt::format("{:016x}", fit.fingerprint)},
          {"kind", "direct"},
          {"bytes", bytes},
          {"order", order_of(fit)},
          {"rims", fit.rims.size()},
          {"focal_length_mm", fit.focal_length_mm},
          {"front_z_mm", fit.front_z_mm},
          {"sensor_z_mm", fit.sensor_z_mm},
          {"stop_radius_mm", fit.stop_radius_mm},
          {"max_height_mm", fit.max_height_mm},
          {"pixel_mm", fit.pixel_mm},
          {"rays", accuracy.rays},
          {"sensor_p50_px", accuracy.sensor_p50_px},
          {"sensor_p95_px", accuracy.sensor_p95_px},
          {"sensor_max_px", accuracy.sensor_max_px},
          {"stop_p95", accuracy.stop_p95},
          {"rim_p95", accuracy.rim_p95},
          {"transmittance_p95", accuracy.transmittance_p95},
          {"let_through", accuracy.let_through},
          {"blocked", accuracy.blocked}};
}

std::string direct_text(const DirectPolynomials& fit, std::size_t bytes) {
  const DirectAccuracy& a = fit.accuracy;
  return fmt::format(
      "{}: the direct image, order {}, {} bytes\n"
      "sensor up to {:.2f} mm from the axis at z = {:.3f} mm, rays at z = {:.3f} mm, stop radius {:.3f} mm\n\n"
      "{} rays left out of the fit, traced:\n"
      "  on the sensor    {:.4f} px (50 %), {:.4f} px (95 %), {:.4f} px (largest)\n"
      "  at the stop      {:.6f} radii (95 %)\n"
      "  at {} rim{}        {:.6f} radii (95 %); {:.2f} % let through that are blocked, {:.2f} % blocked\n"
      "  transmittance    {:.3f} % (95 %)\n",
      fit.lens, order_of(fit), bytes, fit.max_height_mm, fit.sensor_z_mm, fit.front_z_mm, fit.stop_radius_mm, a.rays,
      a.sensor_p50_px, a.sensor_p95_px, a.sensor_max_px, a.stop_p95, fit.rims.size(), fit.rims.size() == 1 ? " " : "s",
      a.rim_p95, 100.0 * a.let_through, 100.0 * a.blocked, 100.0 * a.transmittance_p95);
}

}  // namespace

Result<int> run_direct_fit(const DirectFitRequest& request, const params::Values& values) {
  const auto lens = open_lens(request.lens, values);
  if (!lens) return tl::unexpected(lens.error());
  const auto fitted = [&] {
    const LongTask task("fitting", request.threads);
    return fit_direct_polynomials(*lens, {.max_order = request.max_order}, task.context());
  }();
  if (!fitted) return tl::unexpected(fitted.error());
  const std::string bytes = write_direct_polynomials(*fitted);
  Outputs outputs;
  const auto file = outputs.add(request.output);
  if (!file) return tl::unexpected(file.error());
  if (const auto written = (*file)->write(bytes); !written) return tl::unexpected(written.error());
  if (const auto done = outputs.commit(); !done) return tl::unexpected(done.error());
  if (request.json)
    print_json(direct_json(*fitted, bytes.size()));
  else
    print_summary(fmt::format("{}: direct image of order {}, {} bytes; 95 per cent of rays within {:.4f} pixels\n",
                              request.output, order_of(*fitted), bytes.size(), fitted->accuracy.sensor_p95_px));
  return kDone;
}

Result<int> run_direct_info(const std::string& file, bool json) {
  const auto fit = read_direct_polynomial_file(file);
  if (!fit) return tl::unexpected(fit.error());
  std::error_code ignored;  // it was read
  const auto bytes = static_cast<std::size_t>(std::filesystem::file_size(file, ignored));
  if (json)
    print_json(direct_json(*fit, bytes));
  else
    print(direct_text(*fit, bytes));
  return kDone;
}

}  // namespace contrejour::cli
