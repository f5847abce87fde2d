// SPDX-License-Identifier: Apache-2.0
#include "render/polynomial/polynomial.h"

#include "base/clock.h"
#include "render/adaptive/adaptive.h"
#include "render/planning/statistics.h"
#include "render/polynomial/kept_fits.h"
#include "render/polynomial/splat_ghosts.h"

namespace contrejour::inline internal {

Result<DrawnFlare> render_polynomial(const PlannedFrame& planned, const PolynomialRenderOptions& options,
                                     const Context& context) {
  if (options.points != 0)
    if (const auto ok = check_splatting(planned, options.points); !ok) return tl::unexpected(ok.error());
  const auto start = Clock::now();
  const auto fitted = fitted_lens(planned, options, context);
  if (!fitted) return tl::unexpected(fitted.error());
  const double fit_ms = ms_since(start);
  auto flare = options.points != 0 ? splat_ghosts(planned, options.points, **fitted, context)
                                   : draw_adaptive(planned, options.error, fitted->get(), context);
  if (!flare) return flare;
  flare->statistics.method = PolynomialRenderOptions::kMethod;
  count_first(flare->statistics, "fit", fit_ms);
  return flare;
}

}  // namespace contrejour::inline internal
