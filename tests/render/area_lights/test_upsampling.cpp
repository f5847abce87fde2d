// SPDX-License-Identifier: Apache-2.0
// Splits pixels into halves, against the means of polynomials; on every instruction set of this machine.
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <doctest/doctest.h>
#include <hwy/highway.h>

#include "render/area_lights/convolve_block.h"
#include "render/area_lights/upsampling.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::area;

namespace {

constexpr std::size_t kBorder = 3 * kUpsamplingStencil;  // floats

// The light between two points of a polynomial of degree 4, a different one in each channel.
double light(double from, double to, std::size_t channel) {
  const auto integral = [&](double x) {
    double sum = 0.0, power = x;
    for (int degree = 0; degree <= 4; ++degree, power *= x)
      sum += (1.0 + static_cast<double>(channel)) * std::cos(degree) * power / (degree + 1);
    return sum;
  };
  return integral(to) - integral(from);
}

// The light of pixel k of several between -1 and 1.
double light_of_pixel(std::size_t k, std::size_t pixels, std::size_t channel) {
  const double width = 2.0 / static_cast<double>(pixels), from = -1.0 + width * static_cast<double>(k);
  return light(from, from + width, channel);
}

template <class Check>
void on_every_target(const Check& check) {
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    CAPTURE(hwy::TargetName(target));
    check();
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace

TEST_CASE("halves across a row keep the light of polynomials of degree 4") {
  on_every_target([] {
    for (std::size_t pixels = 5; pixels < 40; ++pixels) {
      std::vector<float> row(3 * pixels), fine(6 * pixels, std::numeric_limits<float>::quiet_NaN());
      for (std::size_t k = 0; k < row.size(); ++k) row[k] = static_cast<float>(light_of_pixel(k / 3, pixels, k % 3));
      upsample_across(Upsampling::Interpolating, row.data(), row.size(), fine.data());
      double worst = 0.0;
      for (std::size_t k = 2 * kBorder; k < fine.size() - 2 * kBorder; ++k)
        worst = std::max(worst, std::abs(fine[k] - light_of_pixel(k / 3, 2 * pixels, k % 3)));
      CHECK(worst < 1e-6);
    }
  });
}

TEST_CASE("halves down rows keep the light of polynomials of degree 4") {
  on_every_target([] {
    for (std::size_t count = 1; count < 40; ++count) {
      std::array<std::vector<float>, 2 * kUpsamplingStencil + 1> rows;
      RowsAround around{};
      for (std::size_t y = 0; y < rows.size(); ++y) {
        for (std::size_t k = 0; k < count; ++k)
          rows[y].push_back(static_cast<float>(light_of_pixel(y, rows.size(), k % 3)));
        around[y] = rows[y].data();
      }
      std::vector<float> upper(count), lower(count);
      halve_down(Upsampling::Interpolating, around, count, upper.data(), lower.data());
      double worst = 0.0;
      for (std::size_t k = 0; k < count; ++k) {
        worst = std::max(worst, std::abs(upper[k] - light_of_pixel(2 * kUpsamplingStencil, 2 * rows.size(), k % 3)));
        worst =
            std::max(worst, std::abs(lower[k] - light_of_pixel(2 * kUpsamplingStencil + 1, 2 * rows.size(), k % 3)));
      }
      CHECK(worst < 1e-6);
    }
  });
}

// Pixels that differ from their neighbours by up to eight decades.
std::vector<float> spiky_row(std::size_t pixels) {
  std::vector<float> row(3 * pixels);
  for (std::size_t k = 0; k < row.size(); ++k)
    row[k] = std::pow(10.0F, -4.0F + 4.0F * std::sin(12.9898F * static_cast<float>(k * k)));
  return row;
}

TEST_CASE("halves of what is not negative are not, however much pixels differ, and keep their light") {
  on_every_target([] {
    constexpr std::size_t kPixels = 61;
    const std::vector<float> row = spiky_row(kPixels);
    for (const Upsampling how : {Upsampling::Interpolating, Upsampling::Smooth}) {
      std::vector<float> fine(6 * kPixels, std::numeric_limits<float>::quiet_NaN());
      upsample_across(how, row.data(), row.size(), fine.data());
      double coarse_sum = 0.0, fine_sum = 0.0;
      for (std::size_t k = 2 * kBorder; k < fine.size() - 2 * kBorder; ++k) {
        CHECK(fine[k] >= 0.0F);
        fine_sum += fine[k];
      }
      for (std::size_t k = kBorder; k < row.size() - kBorder; ++k) coarse_sum += row[k];
      // With smooth halving, light is exchanged between the last pixel and the one beyond.
      for (const std::size_t at : {kBorder, row.size() - kBorder})
        for (std::size_t c = 0; c < 3 && how == Upsampling::Smooth; ++c) {
          const bool first = at == kBorder;
          const double in = row[first ? at - 3 + c : at + c], out = row[first ? at + c : at - 3 + c];
          coarse_sum += 0.125 * (in - out);
        }
      CHECK(fine_sum == test::approx(coarse_sum).epsilon(1e-6));
    }
  });
}

TEST_CASE("blocks tell any light, and any bend in it") {
  on_every_target([] {
    std::array<std::vector<float>, 3> rows;
    for (auto& row : rows) row.assign(kBlockFloats + 6, 0.0F);
    const auto curved = [&](float largest) {
      return is_curved(rows[0].data() + 3, rows[1].data() + 3, rows[2].data() + 3, largest);
    };
    CHECK_FALSE(has_light(rows[1].data() + 3));
    for (std::size_t y = 0; y < rows.size(); ++y)
      for (std::size_t k = 0; k < rows[y].size(); ++k)
        rows[y][k] = 5.0F + 0.25F * static_cast<float>(k / 3) - 0.5F * static_cast<float>(y);
    CHECK_FALSE(curved(1e-6F));
    for (std::size_t k = 3; k < kBlockFloats + 3; ++k) {
      CAPTURE(k);
      std::vector<float> one(kBlockFloats, 0.0F);
      one[k - 3] = 1e-30F;
      CHECK(has_light(one.data()));
      for (const std::size_t y : {std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
        rows[y][k] += 0.01F;
        CHECK(curved(0.009F));
        CHECK_FALSE(curved(0.021F));
        rows[y][k] -= 0.01F;
      }
    }
  });
}
