#include "cli/paper_figures.h"

namespace contrejour::cli {
namespace {

// One light's row of table 5 for the Heliar is partly lost in the text at hand: its 122,129 and 19,577 are there,
// the heavily merged count is not; 0 stands for it.
constexpr PaperSystem kSystems[] = {
    {"heliar", "Heliar Tronnier", "heliar", 0, 16,
     {{0.26, 0.10, 0.36, 0.72, 0.14, 0.96, 1.1, 50.27, 122129, 19577, 0},
      {0.44, 0.11, 0.54, 1.09, 0.23, 1.37, 1.6, 46.86, 210809, 28877, 23453}}},
    {"itoh", "Itoh", "itoh-zoom", 123, 32,
     {{1.17, 0.13, 0.57, 2.01, 0.78, 1.27, 2.05, 49.50, 210309, 31347, 31011},
      {1.96, 0.17, 0.87, 3.00, 1.30, 2.12, 3.42, 46.81, 315335, 50657, 50543}}},
    {"nikon", "Nikon", "nikon-80-200", 140, 16,
     {{3.47, 0.28, 1.65, 5.4, 2.36, 5.46, 7.82, 49.91, 665942, 99767, 80021},
      {5.87, 0.50, 2.87, 9.24, 4.29, 13.36, 17.65, 48.27, 1280183, 188204, 153584}}},
    {"canon-135", "Canon 135 mm", "canon-70-200", 135, 32,
     {{8.09, 0.31, 1.83, 10.23, 6.42, 13.09, 19.51, 46.33, 562492, 143413, 109120},
      {9.38, 0.36, 2.73, 12.47, 6.77, 14.3, 21.07, 45.91, 643200, 148146, 131781}}},
    {"canon-200", "Canon 200 mm", "canon-70-200", 200, 32,
     {{17.27, 0.49, 4.54, 22.30, 13.49, 19.44, 32.93, 46.23, 1953436, 244855, 204673},
      {24.95, 0.66, 5.49, 31.10, 18.70, 27.07, 45.77, 47.59, 2721915, 343908, 293430}}},
};

}  // namespace

std::span<const PaperSystem> paper_systems() { return kSystems; }

}  // namespace contrejour::cli
