// SPDX-License-Identifier: Apache-2.0
// The tables and plots of sabatschus2022 5.3 of its polynomial fits, measured again on the same rays, and the sparse
// polynomials in zones of 2025.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/console.h"
#include "contrejour/context.h"
#include "contrejour/expert/published_fits.h"
#include "contrejour/expert/vec.h"
#include "contrejour/result.h"

namespace contrejour::cli {

struct PolynomialRow {
  std::string table;  // "algorithms"
  std::string fit;
  int terms = 0, samples = 0, iterations = 0;  // samples of each step; 0: does not apply
  double error = 0.0, unseen = 0.0;  // over the samples fitted to, and over others
  double seconds = 0.0;
  std::optional<double> thesis_error = std::nullopt, thesis_seconds = std::nullopt;
  std::string note = {};
};

// One curve of the plot of that name: the errors of a search, or a line.
struct PolynomialCurve {
  std::string plot, name;
  std::vector<published::CurvePoint> points = {};
  std::vector<Vec2> line = {};
};

struct PolynomialFits {
  std::vector<PolynomialRow> rows;
  std::vector<PolynomialCurve> curves;
};

struct PolynomialBenchOptions {
  // The published numbers of samples and iterations for all rows; else those that take up to a minute together, with
  // the published degree and number of terms.
  bool full = false;
  std::vector<std::string> tables;  // dense, algorithms, annealing, variation, unfitted, zones; empty: all
  std::string lens = "tessar";  // of zones
  std::uint64_t seed = 1;
};

[[nodiscard]] const std::vector<std::string>& published_fit_tables();
[[nodiscard]] Result<PolynomialFits> measure_polynomial_fits(const PolynomialBenchOptions& options,
                                                             const Context& context);

[[nodiscard]] std::string polynomial_fits_text(const PolynomialFits& fits);
[[nodiscard]] Json polynomial_fits_json(const PolynomialFits& fits);
[[nodiscard]] std::string polynomial_fits_csv(const PolynomialFits& fits);

// Each plot's name and its SVG.
struct PolynomialPlot {
  std::string name, svg;
};
[[nodiscard]] std::vector<PolynomialPlot> polynomial_plots(const PolynomialFits& fits);

}  // namespace contrejour::cli
