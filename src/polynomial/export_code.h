// SPDX-License-Identifier: Apache-2.0
// The functions that exported source code consists of, besides its tables, in each language.
#pragma once

#include <string_view>

namespace contrejour::inline internal::polynomial {

// @ stands for the prefix of all names. One text for C, GLSL and HLSL, in which REAL, OUT and IN stand for a number and
// for arrays as results and as arguments, LOCAL for `static`, BOOL, YES and NO for truth values.
inline constexpr std::string_view kCommonCode = R"code(
LOCALvoid @chebyshev(REAL x, OUTREAL t[14]) {
  t[0] = 1.0;
  t[1] = x;
  for (int k = 2; k < 14; ++k) t[k] = 2.0 * x * t[k - 1] - t[k - 2];
}

LOCALvoid @chebyshev_in_wavelength(REAL lambda_nm, OUTREAL t[14]) {
  REAL r = 550.0 / lambda_nm;
  @chebyshev((2.0 * r * r - 302500.0 * (@SHORTEST + @LONGEST)) / (302500.0 * (@SHORTEST - @LONGEST)), t);
}

LOCALREAL @lower(REAL a, REAL b) { return a < b ? a : b; }
LOCALREAL @higher(REAL a, REAL b) { return a > b ? a : b; }
)code";

// Ghosts of centred lenses.
inline constexpr std::string_view kCentredCode = R"code(
LOCALREAL @value(int sum, INREAL tu[14], INREAL tv[14], INREAL tw[14], INREAL tl[14]) {
  int degree = @sums[3 * sum], c = @sums[3 * sum + 2];
  REAL total = 0.0;
  for (int l = 0; l < @sums[3 * sum + 1]; ++l) {
    REAL part = 0.0;
    for (int v = 0; v <= degree; ++v)
      for (int w = 0; w <= degree - v; ++w)
        for (int u = 0; u <= degree - v - w; ++u, ++c) part += @COEFFICIENT(c) * tv[v] * tw[w] * tu[u];
    total += tl[l] * part;
  }
  return total;
}

// The squared tangent, -1 and 1 at the ends of a zone.
LOCALREAL @field_in(int zone, REAL field) {
  REAL low = @zones[6 * zone], high = @zones[6 * zone + 1];
  return (2.0 * field * field - low * low - high * high) / (high * high - low * low);
}

LOCALREAL @centre(int zone, REAL field) {
  return (@zones[6 * zone + 2] + @zones[6 * zone + 3] * @field_in(zone, field)) * field;
}

BOOL @ray(int ghost, REAL field, REAL x_mm, REAL y_mm, REAL lambda_nm, OUTREAL result[10]) {
  for (int i = 0; i < 10; ++i) result[i] = 0.0;
  for (int k = @first_zone[ghost]; k < @first_zone[ghost + 1]; ++k) {
    if (field < @zones[6 * k] || field > @zones[6 * k + 1]) continue;
    int sum = @parts[5 * k];
    REAL tu[14], tv[14], tw[14], ts[14], tl[14];
    REAL h = field / @zones[6 * k + 1], radius = @zones[6 * k + 4];
    REAL px = (x_mm - @centre(k, field)) / radius, py = y_mm / radius;
    @chebyshev(@field_in(k, field), tu);
    @chebyshev(h * px, tv);
    REAL squared = px * px + py * py, per_end = @zones[6 * k + 5];
    REAL w = 2.0 * squared - 1.0;
    @chebyshev(w, tw);
    @chebyshev(per_end > 0.0 ? 1.0 - 2.0 * sqrt(@higher(1.0 - squared * per_end, 0.0)) : w, ts);
    @chebyshev_in_wavelength(lambda_nm, tl);
    for (int i = 0; i <= @parts[5 * k + 1]; ++i, sum += 2) {
      REAL a, b;
      if (i == 0) {
        a = @value(sum, tu, tv, ts, tl);
        b = @value(sum + 1, tu, tv, ts, tl);
      } else {
        a = @value(sum, tu, tv, tw, tl);
        b = @value(sum + 1, tu, tv, tw, tl);
      }
      result[2 * i] = h * a + px * b;
      result[2 * i + 1] = py * b;
    }
    for (int i = 0; i < @parts[5 * k + 2]; ++i, ++sum) {
      REAL height = @value(sum, tu, tv, tw, tl);
      if (height > result[8]) result[8] = height;
    }
    result[9] = @value(sum, tu, tv, ts, tl);
    return YES;
  }
  return NO;
}

BOOL @bounds(int ghost, REAL field, OUTREAL result[3]) {
  for (int i = 0; i < 3; ++i) result[i] = 0.0;
  for (int k = @first_zone[ghost]; k < @first_zone[ghost + 1]; ++k) {
    if (field < @zones[6 * k] || field > @zones[6 * k + 1]) continue;
    int b = 4 * @parts[5 * k + 3];
    for (int j = 1; j < @parts[5 * k + 4]; ++j, b += 4) {
      if (field < @fields[b] || field > @fields[b + 4]) continue;
      if (!(@fields[b + 1] < @fields[b + 2]) || !(@fields[b + 5] < @fields[b + 6])) continue;
      REAL here = @centre(k, field), before = @centre(k, @fields[b]), after = @centre(k, @fields[b + 4]);
      result[0] = here + @lower(@fields[b + 1] - before, @fields[b + 5] - after);
      result[1] = here + @higher(@fields[b + 2] - before, @fields[b + 6] - after);
      result[2] = @higher(@fields[b + 3], @fields[b + 7]);
      return YES;
    }
  }
  return NO;
}
)code";

inline constexpr std::string_view kCommonCodeInPython = R"code(

def @chebyshev(x):
    t = [1.0, x]
    while len(t) < 14:
        t.append(2.0 * x * t[-1] - t[-2])
    return t


def @chebyshev_in_wavelength(lambda_nm):
    return @chebyshev((2.0 / lambda_nm**2 - @SHORTEST - @LONGEST) / (@SHORTEST - @LONGEST))
)code";

inline constexpr std::string_view kCentredCodeInPython = R"code(

def @value(index, tu, tv, tw, tl):
    degree, terms, c = @sums[3 * index : 3 * index + 3]
    total = 0.0
    for l in range(terms):
        part = 0.0
        for v in range(degree + 1):
            for w in range(degree - v + 1):
                for u in range(degree - v - w + 1):
                    part += @coefficients[c] * tv[v] * tw[w] * tu[u]
                    c += 1
        total += tl[l] * part
    return total


def @ray(ghost, field, x_mm, y_mm, lambda_nm):
    for k in range(@first_zone[ghost], @first_zone[ghost + 1]):
        low, high, centre, slope, radius, per_end = @zones[6 * k : 6 * k + 6]
        if field < low or field > high:
            continue
        at, crossings, rims = @parts[5 * k : 5 * k + 3]
        u = (2.0 * field * field - low * low - high * high) / (high * high - low * low)
        h = field / high
        px, py = (x_mm - (centre + slope * u) * field) / radius, y_mm / radius
        squared = px * px + py * py
        w = 2.0 * squared - 1.0
        s = 1.0 - 2.0 * max(1.0 - squared * per_end, 0.0) ** 0.5 if per_end > 0.0 else w
        tu, tv, tl = @chebyshev(u), @chebyshev(h * px), @chebyshev_in_wavelength(lambda_nm)
        bases, light_bases = (tu, tv, @chebyshev(w), tl), (tu, tv, @chebyshev(s), tl)
        out = [0.0] * 10
        for i in range(crossings + 1):
            here = light_bases if i == 0 else bases
            a, b = @value(at, *here), @value(at + 1, *here)
            out[2 * i], out[2 * i + 1] = h * a + px * b, py * b
            at += 2
        for _ in range(rims):
            out[8] = max(out[8], @value(at, *bases))
            at += 1
        out[9] = @value(at, *light_bases)
        return out
    return None


def @centre(zone, field):
    low, high, centre, slope = @zones[6 * zone : 6 * zone + 4]
    return (centre + slope * (2.0 * field * field - low * low - high * high) / (high * high - low * low)) * field


def @bounds(ghost, field):
    for k in range(@first_zone[ghost], @first_zone[ghost + 1]):
        if field < @zones[6 * k] or field > @zones[6 * k + 1]:
            continue
        first, count = @parts[5 * k + 3 : 5 * k + 5]
        for b in range(4 * first, 4 * (first + count - 1), 4):
            field_a, low_a, high_a, half_a, field_b, low_b, high_b, half_b = @fields[b : b + 8]
            if not field_a <= field <= field_b or low_a >= high_a or low_b >= high_b:
                continue
            here, before, after = @centre(k, field), @centre(k, field_a), @centre(k, field_b)
            low, high = min(low_a - before, low_b - after), max(high_a - before, high_b - after)
            return [here + low, here + high, max(half_a, half_b)]
    return None
)code";

}  // namespace contrejour::inline internal::polynomial
