// SPDX-License-Identifier: Apache-2.0
#include "render/polynomial/kept_fits.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "contrejour/expert/polynomial_range.h"

namespace contrejour::inline internal {
namespace {

using polynomial::FittedLens;
using Fit = std::shared_ptr<const LensPolynomials>;
using FitRange = std::shared_ptr<const LensPolynomialRange>;

// The fingerprint of a lens, which takes longer to find than a frame of few lights.
struct KeptFingerprint {
  struct Key {
    std::vector<SurfaceState> surfaces;
    double sensor_z_mm = 0.0;
    bool absorption = false;
    friend bool operator==(const Key&, const Key&) = default;
  };
  explicit KeptFingerprint(const Key& /*key*/) {}
  [[nodiscard]] static std::size_t memory_bytes() { return 0; }
  std::optional<std::uint64_t> value;
};

std::uint64_t fingerprint_of(const PlannedFrame& planned) {
  const std::shared_ptr<KeptFingerprint> kept = planned.cache.section<KeptFingerprint>(
      {planned.lens.surfaces, planned.lens.sensor_z_mm, planned.lens.absorption});
  if (!kept->value) kept->value = polynomial_fingerprint(planned.lens);
  return *kept->value;
}

// The contents of a fit's file: the fit of one state, or that of a range.
struct KeptFile {
  struct Key {
    std::filesystem::path file;
    std::filesystem::file_time_type written;
    friend bool operator==(const Key&, const Key&) = default;
  };
  explicit KeptFile(const Key& /*key*/) {}
  [[nodiscard]] std::size_t memory_bytes() const { return bytes; }
  Fit fit;
  FitRange range;
  std::size_t bytes = 0;
};

// A fit that was given, or that of the lens's state in a range; for the latter, the state.
struct KeptFit {
  struct Key {
    Fit fit;
    FitRange range;
    std::vector<SurfaceState> surfaces;
    double sensor_z_mm = 0.0, focal_length_mm = 0.0, object_distance_mm = 0.0;
    bool absorption = false;
    friend bool operator==(const Key&, const Key&) = default;
  };
  explicit KeptFit(const Key& /*key*/) {}
  [[nodiscard]] std::size_t memory_bytes() const { return lens ? lens->bytes() : 0; }
  std::shared_ptr<const FittedLens> lens;
};

// A fit of the ghosts that frames needed so far. The sensor's size is that within which rays must land exactly.
struct MadeFit {
  struct Key {
    std::vector<SurfaceState> surfaces;
    int stop_index = 0;
    double sensor_z_mm = 0.0, sensor_width_mm = 0.0, sensor_height_mm = 0.0, design_wavelength_nm = 0.0;
    bool absorption = false;
    friend bool operator==(const Key&, const Key&) = default;
  };
  explicit MadeFit(const Key& /*key*/) {}
  [[nodiscard]] std::size_t memory_bytes() const { return lens ? 2 * lens->bytes() : 0; }
  std::shared_ptr<const FittedLens> lens;
};

Result<std::shared_ptr<KeptFile>> read_fit(const PlannedFrame& planned, const std::filesystem::path& file) {
  std::error_code ignored;  // reading tells what is wrong
  const std::shared_ptr<KeptFile> kept =
      planned.cache.section<KeptFile>({file, std::filesystem::last_write_time(file, ignored)});
  if (kept->fit || kept->range) return kept;
  auto read = read_any_polynomial_file(file);
  if (!read) return tl::unexpected(read.error());
  kept->bytes = std::filesystem::file_size(file, ignored);
  if (auto* const fit = std::get_if<LensPolynomials>(&*read))
    kept->fit = std::make_shared<const LensPolynomials>(std::move(*fit));
  else
    kept->range = std::make_shared<const LensPolynomialRange>(std::get<LensPolynomialRange>(std::move(*read)));
  return kept;
}

Result<std::shared_ptr<const FittedLens>> fit_in_range(const PlannedFrame& planned, const FitRange& range) {
  const LensState& lens = planned.lens;
  const std::shared_ptr<KeptFit> kept =
      planned.cache.section<KeptFit>({nullptr, range, lens.surfaces, lens.sensor_z_mm, lens.focal_length_mm,
                                      lens.object_distance_mm, lens.absorption});
  if (kept->lens) return kept->lens;
  auto fit = polynomials_at(*range, lens);
  if (!fit) return tl::unexpected(fit.error());
  kept->lens = std::make_shared<const FittedLens>(std::make_shared<const LensPolynomials>(std::move(*fit)));
  return kept->lens;
}

Result<std::shared_ptr<const FittedLens>> kept_fit(const PlannedFrame& planned, const Fit& given) {
  const std::shared_ptr<KeptFit> kept = planned.cache.section<KeptFit>({given, nullptr, {}, 0.0, 0.0, 0.0, false});
  if (!kept->lens) kept->lens = std::make_shared<const FittedLens>(given);
  const LensPolynomials& fit = kept->lens->fit();
  if (fit.fingerprint != fingerprint_of(planned))
    return invalid_argument(fmt::format(
        "the fit is one of '{}' at other settings, or of another lens; zoom, focus, coatings and the sensor's "
        "place need a fit of their own, or one of a range (`contrejour polynomial fit`)",
        fit.lens));
  return kept->lens;
}

bool is_known(const FittedLens* fitted, const Ghost& ghost) {
  return fitted != nullptr &&
         std::ranges::find(fitted->fit().ghosts, ghost, &GhostPolynomials::ghost) != fitted->fit().ghosts.end();
}

// Fits the frame's ghosts that no earlier frame needed.
Result<std::shared_ptr<const FittedLens>> made_fit(const PlannedFrame& planned, const Context& context) {
  const LensState& lens = planned.lens;
  const std::shared_ptr<MadeFit> kept =
      planned.cache.section<MadeFit>({lens.surfaces, lens.stop_index, lens.sensor_z_mm, lens.sensor_width_mm,
                                      lens.sensor_height_mm, lens.design_wavelength_nm, lens.absorption});
  PolynomialOptions missing;
  missing.asymmetric = false;  // these fits take longer than drawing many frames
  std::ranges::copy_if(planned.plan.ghosts, std::back_inserter(missing.ghosts),
                       [&](const Ghost& ghost) { return !is_known(kept->lens.get(), ghost); });
  if (missing.ghosts.empty() && kept->lens) return kept->lens;
  Context quiet = context;
  quiet.progress = {};
  auto made = fit_polynomials(lens, missing, quiet);
  if (!made) return tl::unexpected(made.error());
  if (kept->lens) std::ranges::copy(kept->lens->fit().ghosts, std::back_inserter(made->ghosts));
  kept->lens = std::make_shared<const FittedLens>(std::make_shared<const LensPolynomials>(std::move(*made)));
  return kept->lens;
}

}  // namespace

Result<std::shared_ptr<const FittedLens>> fitted_lens(const PlannedFrame& planned,
                                                      const PolynomialRenderOptions& options, const Context& context) {
  if (options.fit) return kept_fit(planned, options.fit);
  if (options.range) return fit_in_range(planned, options.range);
  if (options.file.empty()) return made_fit(planned, context);
  const auto file = read_fit(planned, options.file);
  if (!file) return tl::unexpected(file.error());
  return (*file)->fit ? kept_fit(planned, (*file)->fit) : fit_in_range(planned, (*file)->range);
}

}  // namespace contrejour::inline internal
