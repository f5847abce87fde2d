// SPDX-License-Identifier: Apache-2.0
// Rows written into pictures, small ones and some that fit into no cache, on every instruction set of this machine.
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include <doctest/doctest.h>
#include <hwy/highway.h>

#include "image/pixel_writer.h"

using namespace contrejour;

namespace {

constexpr float kBefore = 7.0F;
constexpr std::size_t kBeside = 24;  // floats that are checked on either side of the written ones

template <class Write>
void check_written(Image& image, std::size_t at, std::size_t count, const Write& write) {
  float* const to = image.pixels.data() + at;
  std::fill_n(to - kBeside, count + 2 * kBeside, kBefore);
  std::vector<float> row(count);
  std::iota(row.begin(), row.end(), 1.0F);
  {
    const PixelWriter writer(image);
    write(writer, row, to);
  }
  CHECK(std::all_of(to - kBeside, to, [](float v) { return v == kBefore; }));
  CHECK(std::all_of(to + count, to + count + kBeside, [](float v) { return v == kBefore; }));
}

}  // namespace

TEST_CASE("rows are written as they are, wherever they begin and however long, and nothing next to them") {
  Image small(64, 8), large(1920, 1080);
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    CAPTURE(hwy::TargetName(target));
    for (Image* image : {&small, &large}) {
      for (const std::size_t count : {0, 1, 3, 15, 16, 17, 64, 333}) {
        for (std::size_t shift = 0; shift < 17; ++shift) {
          const std::size_t at = 64 + shift;
          check_written(*image, at, count, [](const PixelWriter& writer, const std::vector<float>& row, float* to) {
            writer.write(row.data(), row.size(), to);
            CHECK(std::equal(row.begin(), row.end(), to));
          });
          check_written(*image, at, count, [](const PixelWriter& writer, const std::vector<float>& row, float* to) {
            writer.clear(row.size(), to);
            CHECK(std::all_of(to, to + row.size(), [](float v) { return v == 0.0F; }));
          });
        }
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}
