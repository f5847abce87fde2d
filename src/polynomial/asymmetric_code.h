// SPDX-License-Identifier: Apache-2.0
// The functions that exported source code has, besides the common ones of export_code.h, for ghosts without axial
// symmetry. Rectangles are their zones of light directions.
#pragma once

#include <string_view>

namespace contrejour::inline internal::polynomial {

// As kCommonCode. Numbers of a rectangle: its lowest and highest tangents (x, y), the pupil's radii, and the
// coefficients of both coordinates of its centre.
inline constexpr std::string_view kAsymmetricCode = R"code(
// degree_x, degree_y: the smallest degrees of a term in x and in y. step_x, step_y: 2 where all have its parity.
LOCALREAL @product_value(int sum, int degree_x, int degree_y, int step_x, int step_y, INREAL px[14], INREAL py[14],
                         INREAL sx[14], INREAL sy[14], INREAL tl[14]) {
  int degree = @sums[3 * sum], c = @sums[3 * sum + 2];
  REAL total = 0.0;
  for (int l = 0; l < @sums[3 * sum + 1]; ++l) {
    REAL part = 0.0;
    for (int a = 0; a <= degree; ++a)
      for (int b = 0; b <= degree - a; ++b)
        for (int i = (a + degree_x) % step_x; i <= degree - a - b; i += step_x)
          for (int j = (b + degree_y) % step_y; j <= degree - a - b - i; j += step_y, ++c)
            part += @COEFFICIENT(c) * px[a] * py[b] * sx[i] * sy[j];
    total += tl[l] * part;
  }
  return total;
}

// -1 where light is the mirror image of that of the rectangle, along x (axis 0) or y (1).
LOCALREAL @mirror(int k, int axis, REAL tangent) {
  return @rectangle_parts[9 * k + 7 + axis] != 0 && tangent < 0.0 ? -1.0 : 1.0;
}

LOCALint @rectangle_of(int ghost, REAL tangent_x, REAL tangent_y) {
  for (int k = @first_rectangle[ghost]; k < @first_rectangle[ghost + 1]; ++k) {
    REAL x = @mirror(k, 0, tangent_x) * tangent_x, y = @mirror(k, 1, tangent_y) * tangent_y;
    if (x < @rectangles[26 * k] || y < @rectangles[26 * k + 1]) continue;
    if (x > @rectangles[26 * k + 2] || y > @rectangles[26 * k + 3]) continue;
    return k;
  }
  return -1;
}

// A tangent, -1 and 1 at the ends of a rectangle.
LOCALREAL @tangent_in(int k, int axis, REAL tangent) {
  REAL low = @rectangles[26 * k + axis], high = @rectangles[26 * k + 2 + axis];
  return (2.0 * tangent - low - high) / (high - low);
}

LOCALREAL @centre_along(int k, int axis, INREAL sx[14], INREAL sy[14]) {
  int at = 26 * k + 6 + 10 * axis;
  REAL sum = 0.0;
  for (int i = 0; i <= 3; ++i)
    for (int j = 0; j <= 3 - i; ++j, ++at) sum += @rectangles[at] * sx[i] * sy[j];
  return sum;
}

BOOL @ray_at(int ghost, REAL tangent_x, REAL tangent_y, REAL x_mm, REAL y_mm, REAL lambda_nm, OUTREAL result[10]) {
  for (int i = 0; i < 10; ++i) result[i] = 0.0;
  int k = @rectangle_of(ghost, tangent_x, tangent_y);
  if (k < 0) return NO;
  REAL mx = @mirror(k, 0, tangent_x), my = @mirror(k, 1, tangent_y);
  REAL px[14], py[14], sx[14], sy[14], tl[14];
  @chebyshev(@tangent_in(k, 0, mx * tangent_x), sx);
  @chebyshev(@tangent_in(k, 1, my * tangent_y), sy);
  @chebyshev((mx * x_mm - @centre_along(k, 0, sx, sy)) / @rectangles[26 * k + 4], px);
  @chebyshev((my * y_mm - @centre_along(k, 1, sx, sy)) / @rectangles[26 * k + 5], py);
  @chebyshev_in_wavelength(lambda_nm, tl);
  int sum = @rectangle_parts[9 * k], step_x = 1 + @rectangle_parts[9 * k + 5], step_y = 1 + @rectangle_parts[9 * k + 6];
  for (int i = 0; i <= @rectangle_parts[9 * k + 1]; ++i, sum += 2) {
    result[2 * i] = mx * @product_value(sum, 1, 0, step_x, step_y, px, py, sx, sy, tl);
    result[2 * i + 1] = my * @product_value(sum + 1, 0, 1, step_x, step_y, px, py, sx, sy, tl);
  }
  for (int i = 0; i < @rectangle_parts[9 * k + 2]; ++i, ++sum) {
    REAL squared = @product_value(sum, 0, 0, step_x, step_y, px, py, sx, sy, tl);
    if (squared > result[8]) result[8] = squared;
  }
  result[9] = @product_value(sum, 0, 0, step_x, step_y, px, py, sx, sy, tl);
  return YES;
}

BOOL @bounds_at(int ghost, REAL tangent_x, REAL tangent_y, OUTREAL result[4]) {
  for (int i = 0; i < 4; ++i) result[i] = 0.0;
  int k = @rectangle_of(ghost, tangent_x, tangent_y);
  if (k < 0) return NO;
  REAL mx = @mirror(k, 0, tangent_x), my = @mirror(k, 1, tangent_y), tx[14], ty[14];
  REAL sx = @tangent_in(k, 0, mx * tangent_x), sy = @tangent_in(k, 1, my * tangent_y);
  int side = @rectangle_parts[9 * k + 4], column = 0, row = 0;
  for (int n = 1; n < side - 1; ++n) {
    if (0.5 * (sx + 1.0) * (side - 1) >= n) column = n;
    if (0.5 * (sy + 1.0) * (side - 1) >= n) row = n;
  }
  REAL low_x = 1e30, low_y = 1e30, high_x = -1e30, high_y = -1e30;
  for (int iy = row; iy <= row + 1; ++iy)
    for (int ix = column; ix <= column + 1; ++ix) {
      int at = 4 * (@rectangle_parts[9 * k + 3] + iy * side + ix);
      if (!(@grid[at] < @grid[at + 2])) continue;
      @chebyshev(2.0 * ix / (side - 1) - 1.0, tx);
      @chebyshev(2.0 * iy / (side - 1) - 1.0, ty);
      REAL x = @centre_along(k, 0, tx, ty), y = @centre_along(k, 1, tx, ty);
      low_x = @lower(low_x, @grid[at] - x);
      low_y = @lower(low_y, @grid[at + 1] - y);
      high_x = @higher(high_x, @grid[at + 2] - x);
      high_y = @higher(high_y, @grid[at + 3] - y);
    }
  if (!(low_x < high_x)) return NO;
  @chebyshev(sx, tx);
  @chebyshev(sy, ty);
  REAL x = @centre_along(k, 0, tx, ty), y = @centre_along(k, 1, tx, ty);
  result[0] = @lower(mx * (x + low_x), mx * (x + high_x));
  result[1] = @lower(my * (y + low_y), my * (y + high_y));
  result[2] = @higher(mx * (x + low_x), mx * (x + high_x));
  result[3] = @higher(my * (y + low_y), my * (y + high_y));
  return YES;
}
)code";

inline constexpr std::string_view kAsymmetricCodeInPython = R"code(

def @product_value(index, degree_x, degree_y, step_x, step_y, px, py, sx, sy, tl):
    degree, terms, c = @sums[3 * index : 3 * index + 3]
    total = 0.0
    for l in range(terms):
        part = 0.0
        for a in range(degree + 1):
            for b in range(degree - a + 1):
                for i in range((a + degree_x) % step_x, degree - a - b + 1, step_x):
                    for j in range((b + degree_y) % step_y, degree - a - b - i + 1, step_y):
                        part += @coefficients[c] * px[a] * py[b] * sx[i] * sy[j]
                        c += 1
        total += tl[l] * part
    return total


def @rectangle_of(ghost, tangents):
    """The rectangle, the signs that mirror the light into it, and the tangents there, -1 and 1 at its ends."""
    for k in range(@first_rectangle[ghost], @first_rectangle[ghost + 1]):
        signs = [-1.0 if @rectangle_parts[9 * k + 7 + i] and tangents[i] < 0.0 else 1.0 for i in range(2)]
        at = [signs[i] * tangents[i] for i in range(2)]
        low, high = @rectangles[26 * k : 26 * k + 2], @rectangles[26 * k + 2 : 26 * k + 4]
        if all(low[i] <= at[i] <= high[i] for i in range(2)):
            return k, signs, [(2.0 * at[i] - low[i] - high[i]) / (high[i] - low[i]) for i in range(2)]
    return None


def @centre_at(k, s):
    tx, ty = @chebyshev(s[0]), @chebyshev(s[1])
    terms = [tx[i] * ty[j] for i in range(4) for j in range(4 - i)]
    numbers = @rectangles[26 * k + 6 : 26 * k + 26]
    return [sum(a * b for a, b in zip(numbers[10 * axis :], terms)) for axis in range(2)]


def @ray_at(ghost, tangent_x, tangent_y, x_mm, y_mm, lambda_nm):
    found = @rectangle_of(ghost, (tangent_x, tangent_y))
    if found is None:
        return None
    k, (mx, my), s = found
    x, y = @centre_at(k, s)
    radius_x, radius_y = @rectangles[26 * k + 4 : 26 * k + 6]
    at, crossings, rims, _, _, even_x, even_y, _, _ = @rectangle_parts[9 * k : 9 * k + 9]
    p = (mx * x_mm - x) / radius_x, (my * y_mm - y) / radius_y
    bases = tuple(@chebyshev(value) for value in (*p, *s)) + (@chebyshev_in_wavelength(lambda_nm),)
    steps = 1 + even_x, 1 + even_y
    out = [0.0] * 10
    for i in range(crossings + 1):
        out[2 * i] = mx * @product_value(at, 1, 0, *steps, *bases)
        out[2 * i + 1] = my * @product_value(at + 1, 0, 1, *steps, *bases)
        at += 2
    for _ in range(rims):
        out[8] = max(out[8], @product_value(at, 0, 0, *steps, *bases))
        at += 1
    out[9] = @product_value(at, 0, 0, *steps, *bases)
    return out


def @bounds_at(ghost, tangent_x, tangent_y):
    found = @rectangle_of(ghost, (tangent_x, tangent_y))
    if found is None:
        return None
    k, signs, s = found
    first, side = @rectangle_parts[9 * k + 3 : 9 * k + 5]
    column, row = (min(max(int(0.5 * (value + 1.0) * (side - 1)), 0), side - 2) for value in s)
    around = []
    for iy in (row, row + 1):
        for ix in (column, column + 1):
            at = 4 * (first + iy * side + ix)
            low_x, low_y, high_x, high_y = @grid[at : at + 4]
            if low_x < high_x:
                x, y = @centre_at(k, [2.0 * ix / (side - 1) - 1.0, 2.0 * iy / (side - 1) - 1.0])
                around.append((low_x - x, low_y - y, high_x - x, high_y - y))
    if not around:
        return None
    low_x, low_y, high_x, high_y = (f(b) for f, b in zip((min, min, max, max), zip(*around)))
    x, y = @centre_at(k, s)
    ends_x = [signs[0] * (x + end) for end in (low_x, high_x)]
    ends_y = [signs[1] * (y + end) for end in (low_y, high_y)]
    return [min(ends_x), min(ends_y), max(ends_x), max(ends_y)]
)code";

}  // namespace contrejour::inline internal::polynomial
