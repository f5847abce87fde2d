// SPDX-License-Identifier: Apache-2.0
// RGB spaces from their primaries: docs/physics/colour.md.
#include "image/rgb_spaces.h"

namespace contrejour::inline internal {
namespace {

// ITU-R BT.709-6 item 1.3.
constexpr Primaries kRec709{{0.640, 0.330}, {0.300, 0.600}, {0.150, 0.060}, {0.3127, 0.3290}};
// AMPAS S-2014-004 (ACEScg): AP1, and the ACES white point of TB-2018-001.
constexpr Primaries kAcesCg{{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}};

// Bradford cone responses: Lam 1985, as in ICC.1:2022 annex E.
constexpr Matrix3 kBradford{{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};

Matrix3 product_of(const Matrix3& a, const Matrix3& b) {
  Matrix3 product{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < 3; ++k) product[r][c] += a[r][k] * b[k][c];
  return product;
}

// The inverse by cofactors: cross products of the rows as columns, over the determinant.
Matrix3 inverse(const Matrix3& m) {
  Matrix3 out{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t r1 = (c + 1) % 3, r2 = (c + 2) % 3, c1 = (r + 1) % 3, c2 = (r + 2) % 3;
      out[r][c] = m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
    }
  const double determinant = m[0][0] * out[0][0] + m[0][1] * out[1][0] + m[0][2] * out[2][0];
  for (auto& row : out)
    for (double& value : row) value /= determinant;
  return out;
}

Xyz xyz_from_xy(const std::array<double, 2>& xy) { return {xy[0] / xy[1], 1.0, (1 - xy[0] - xy[1]) / xy[1]}; }

// SMPTE RP 177:1993: the primaries as columns, scaled so that they sum to the white.
Matrix3 xyz_from_primaries(const Primaries& p, const Xyz& white) {
  const Xyz columns[3] = {xyz_from_xy(p.red), xyz_from_xy(p.green), xyz_from_xy(p.blue)};
  Matrix3 m{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) m[r][c] = columns[c][r];
  const Xyz scale = multiply(inverse(m), white);
  for (auto& row : m)
    for (std::size_t c = 0; c < 3; ++c) row[c] *= scale[c];
  return m;
}

Matrix3 bradford_adaptation(const Xyz& from_white, const Xyz& to_white) {
  const Xyz from = multiply(kBradford, from_white), to = multiply(kBradford, to_white);
  Matrix3 scaled = kBradford;
  for (std::size_t r = 0; r < 3; ++r)
    for (double& value : scaled[r]) value *= to[r] / from[r];
  return product_of(inverse(kBradford), scaled);
}

// Differs: Rec.709's white is (0.3127, 0.3290), D65 rounded; the tabulated D65 is used instead, so that a light of
// spectrum D65 is neutral to the last digit. The matrix moves by less than 5e-4.
struct Matrices {
  Matrix3 xyz_from_rgb, rgb_from_xyz;
  explicit Matrices(ColourSpace space) {
    const Xyz d65 = xyz_of(IlluminantD65{});
    if (space == ColourSpace::Rec709) {
      xyz_from_rgb = xyz_from_primaries(kRec709, d65);
    } else {
      const Xyz white = xyz_from_xy(kAcesCg.white);
      xyz_from_rgb = product_of(bradford_adaptation(white, d65), xyz_from_primaries(kAcesCg, white));
    }
    rgb_from_xyz = inverse(xyz_from_rgb);
  }
};

const Matrices& matrices(ColourSpace space) {
  static const Matrices rec709(ColourSpace::Rec709), aces_cg(ColourSpace::AcesCg);
  return space == ColourSpace::Rec709 ? rec709 : aces_cg;
}

}  // namespace

const Primaries& primaries_of(ColourSpace space) { return space == ColourSpace::Rec709 ? kRec709 : kAcesCg; }
const Matrix3& rgb_from_xyz_matrix(ColourSpace space) { return matrices(space).rgb_from_xyz; }
const Matrix3& xyz_from_rgb_matrix(ColourSpace space) { return matrices(space).xyz_from_rgb; }

std::array<double, 3> multiply(const Matrix3& m, const std::array<double, 3>& v) {
  std::array<double, 3> product{};
  for (std::size_t r = 0; r < 3; ++r) product[r] = m[r][0] * v[0] + m[r][1] * v[1] + m[r][2] * v[2];
  return product;
}

}  // namespace contrejour::inline internal

namespace contrejour {

Rgb rgb_from_xyz(const Xyz& xyz, ColourSpace space) { return multiply(rgb_from_xyz_matrix(space), xyz); }
Xyz xyz_from_rgb(const Rgb& rgb, ColourSpace space) { return multiply(xyz_from_rgb_matrix(space), rgb); }
double luminance(const Rgb& rgb, ColourSpace space) { return xyz_from_rgb(rgb, space)[1]; }

Rgb rgb_of(const Spectrum& spectrum, ColourSpace space) { return rgb_from_xyz(xyz_of(spectrum), space); }

}  // namespace contrejour
