// SPDX-License-Identifier: Apache-2.0
// Figures that sabatschus2022 prints for its fits (5.3): root mean square errors of the sensor's x of the first ghost,
// in units of its scene, and times on a Core i7-8700K with up to six threads.
#pragma once

#include <array>

namespace contrejour::cli::thesis {

inline constexpr int kDegree = 10, kTerms = 100, kGridSide = 13, kSamples = 10000, kDenseSamples = 11673;
inline constexpr double kDenseGrid = 0.002368, kDenseRandom = 0.001752;  // 5.3.1
inline constexpr double kDenseOfSparse = 0.001614;  // of the dense polynomial that the sparse ones start from, 5.3.2

struct Figure {
  double error = 0.0, seconds = 0.0;
};
inline constexpr Figure kPursuit{1.078, 284.0}, kReplacement{1.315, 1965.0}, kAnnealing{0.06954, 280.0};

struct AnnealingFigure {
  int samples = 0, iterations = 0;
  double seconds = 0.0, error = 0.0;
};
inline constexpr std::array<AnnealingFigure, 5> kAnnealingTable{{{1000, 5000, 139.0, 0.0667},
                                                                 {1000, 10000, 275.0, 0.0538},
                                                                 {2000, 5000, 275.0, 0.0511},
                                                                 {10000, 5000, 1450.0, 0.0511},
                                                                 {2000, 30000, 1656.0, 0.0377}}};

// Ten runs of 2000 samples and 30000 iterations: their mean and standard deviation.
inline constexpr double kVariationMean = 0.04557, kVariationDeviation = 0.007845;
// 2000 samples and 5000 iterations without a fit in each step.
inline constexpr Figure kUnfitted{1.3, 12.0};

}  // namespace contrejour::cli::thesis
