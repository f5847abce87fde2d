// SPDX-License-Identifier: Apache-2.0
// The functions that exported source code consists of, besides its tables, in each language.
#pragma once

#include <string_view>

namespace contrejour::inline internal::polynomial {

// @ stands for the prefix of all names.

inline constexpr std::string_view kCodeInC = R"code(
static double @value(const int *sum, const double *tu, const double *tv, const double *tw, const double *tl) {
  const float *c = @coefficients + sum[2];
  double total = 0.0;
  for (int l = 0; l < sum[1]; ++l) {
    double part = 0.0;
    for (int v = 0; v <= sum[0]; ++v)
      for (int w = 0; w <= sum[0] - v; ++w)
        for (int u = 0; u <= sum[0] - v - w; ++u) part += *c++ * tv[v] * tw[w] * tu[u];
    total += tl[l] * part;
  }
  return total;
}

static void @chebyshev(double x, double *t) {
  t[0] = 1.0;
  t[1] = x;
  for (int k = 2; k < 13; ++k) t[k] = 2.0 * x * t[k - 1] - t[k - 2];
}

int @ray(int ghost, double field, double x_mm, double y_mm, double lambda_nm, double *out) {
  for (int k = @first_zone[ghost]; k < @first_zone[ghost + 1]; ++k) {
    const double *zone = @zones + 5 * k;
    if (field < zone[0] || field > zone[1]) continue;
    const int *parts = @parts + 5 * k;
    const int *sum = @sums + 3 * parts[0];
    double tu[13], tv[13], tw[13], tl[13];
    const double low = zone[0] * zone[0], high = zone[1] * zone[1];
    const double u = (2.0 * field * field - low - high) / (high - low), h = field / zone[1];
    const double px = (x_mm - (zone[2] + zone[3] * u) * field) / zone[4], py = y_mm / zone[4];
    @chebyshev(u, tu);
    @chebyshev(h * px, tv);
    @chebyshev(2.0 * (px * px + py * py) - 1.0, tw);
    @chebyshev((2.0 / (lambda_nm * lambda_nm) - @SHORTEST - @LONGEST) / (@SHORTEST - @LONGEST), tl);
    for (int i = 0; i < 10; ++i) out[i] = 0.0;
    for (int i = 0; i <= parts[1]; ++i, sum += 6) {
      const double a = @value(sum, tu, tv, tw, tl), b = @value(sum + 3, tu, tv, tw, tl);
      out[2 * i] = h * a + px * b;
      out[2 * i + 1] = py * b;
    }
    for (int i = 0; i < parts[2]; ++i, sum += 3) {
      const double squared = @value(sum, tu, tv, tw, tl);
      if (squared > out[8]) out[8] = squared;
    }
    out[9] = @value(sum, tu, tv, tw, tl);
    return 1;
  }
  return 0;
}

static double @centre(int zone, double field) {
  const double *z = @zones + 5 * zone, low = z[0] * z[0], high = z[1] * z[1];
  return (z[2] + z[3] * (2.0 * field * field - low - high) / (high - low)) * field;
}

int @bounds(int ghost, double field, double *out) {
  for (int k = @first_zone[ghost]; k < @first_zone[ghost + 1]; ++k) {
    const double *b = @fields + 4 * @parts[5 * k + 3];
    if (field < @zones[5 * k] || field > @zones[5 * k + 1]) continue;
    for (int i = 1; i < @parts[5 * k + 4]; ++i, b += 4) {
      if (field < b[0] || field > b[4] || !(b[1] < b[2]) || !(b[5] < b[6])) continue;
      const double here = @centre(k, field), before = @centre(k, b[0]), after = @centre(k, b[4]);
      out[0] = here + (b[1] - before < b[5] - after ? b[1] - before : b[5] - after);
      out[1] = here + (b[2] - before > b[6] - after ? b[2] - before : b[6] - after);
      out[2] = b[3] > b[7] ? b[3] : b[7];
      return 1;
    }
  }
  return 0;
}
)code";

// GLSL and HLSL alike.
inline constexpr std::string_view kCodeInShaders = R"code(
float @value(int sum, float tu[13], float tv[13], float tw[13], float tl[13]) {
  int degree = @sums[3 * sum], c = @sums[3 * sum + 2];
  float total = 0.0;
  for (int l = 0; l < @sums[3 * sum + 1]; ++l) {
    float part = 0.0;
    for (int v = 0; v <= degree; ++v)
      for (int w = 0; w <= degree - v; ++w)
        for (int u = 0; u <= degree - v - w; ++u, ++c) part += @COEFFICIENT(c) * tv[v] * tw[w] * tu[u];
    total += tl[l] * part;
  }
  return total;
}

void @chebyshev(float x, out float t[13]) {
  t[0] = 1.0;
  t[1] = x;
  for (int k = 2; k < 13; ++k) t[k] = 2.0 * x * t[k - 1] - t[k - 2];
}

bool @ray(int ghost, float field, float x_mm, float y_mm, float lambda_nm, out float result[10]) {
  for (int i = 0; i < 10; ++i) result[i] = 0.0;
  for (int k = @first_zone[ghost]; k < @first_zone[ghost + 1]; ++k) {
    float low = @zones[5 * k], high = @zones[5 * k + 1];
    if (field < low || field > high) continue;
    int sum = @parts[5 * k];
    float tu[13], tv[13], tw[13], tl[13];
    float u = (2.0 * field * field - low * low - high * high) / (high * high - low * low), h = field / high;
    float px = (x_mm - (@zones[5 * k + 2] + @zones[5 * k + 3] * u) * field) / @zones[5 * k + 4];
    float py = y_mm / @zones[5 * k + 4];
    @chebyshev(u, tu);
    @chebyshev(h * px, tv);
    @chebyshev(2.0 * (px * px + py * py) - 1.0, tw);
    float ratio = 550.0 / lambda_nm;
    @chebyshev((2.0 * ratio * ratio - 302500.0 * (@SHORTEST + @LONGEST)) / (302500.0 * (@SHORTEST - @LONGEST)), tl);
    for (int i = 0; i <= @parts[5 * k + 1]; ++i, sum += 2) {
      float a = @value(sum, tu, tv, tw, tl), b = @value(sum + 1, tu, tv, tw, tl);
      result[2 * i] = h * a + px * b;
      result[2 * i + 1] = py * b;
    }
    for (int i = 0; i < @parts[5 * k + 2]; ++i, ++sum)
      result[8] = max(result[8], @value(sum, tu, tv, tw, tl));
    result[9] = @value(sum, tu, tv, tw, tl);
    return true;
  }
  return false;
}

float @centre(int zone, float field) {
  float low = @zones[5 * zone], high = @zones[5 * zone + 1];
  float u = (2.0 * field * field - low * low - high * high) / (high * high - low * low);
  return (@zones[5 * zone + 2] + @zones[5 * zone + 3] * u) * field;
}

bool @bounds(int ghost, float field, out float result[3]) {
  for (int i = 0; i < 3; ++i) result[i] = 0.0;
  for (int k = @first_zone[ghost]; k < @first_zone[ghost + 1]; ++k) {
    if (field < @zones[5 * k] || field > @zones[5 * k + 1]) continue;
    int b = 4 * @parts[5 * k + 3];
    for (int j = 1; j < @parts[5 * k + 4]; ++j, b += 4) {
      if (field < @fields[b] || field > @fields[b + 4]) continue;
      if (!(@fields[b + 1] < @fields[b + 2]) || !(@fields[b + 5] < @fields[b + 6])) continue;
      float here = @centre(k, field), before = @centre(k, @fields[b]), after = @centre(k, @fields[b + 4]);
      result[0] = here + min(@fields[b + 1] - before, @fields[b + 5] - after);
      result[1] = here + max(@fields[b + 2] - before, @fields[b + 6] - after);
      result[2] = max(@fields[b + 3], @fields[b + 7]);
      return true;
    }
  }
  return false;
}
)code";

inline constexpr std::string_view kCodeInPython = R"code(

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


def @chebyshev(x):
    t = [1.0, x]
    while len(t) < 13:
        t.append(2.0 * x * t[-1] - t[-2])
    return t


def @ray(ghost, field, x_mm, y_mm, lambda_nm):
    for k in range(@first_zone[ghost], @first_zone[ghost + 1]):
        low, high, centre, slope, radius = @zones[5 * k : 5 * k + 5]
        if field < low or field > high:
            continue
        at, crossings, rims = @parts[5 * k : 5 * k + 3]
        u = (2.0 * field * field - low * low - high * high) / (high * high - low * low)
        h = field / high
        px, py = (x_mm - (centre + slope * u) * field) / radius, y_mm / radius
        bases = (
            @chebyshev(u),
            @chebyshev(h * px),
            @chebyshev(2.0 * (px * px + py * py) - 1.0),
            @chebyshev((2.0 / lambda_nm**2 - @SHORTEST - @LONGEST) / (@SHORTEST - @LONGEST)),
        )
        out = [0.0] * 10
        for i in range(crossings + 1):
            a, b = @value(at, *bases), @value(at + 1, *bases)
            out[2 * i], out[2 * i + 1] = h * a + px * b, py * b
            at += 2
        for _ in range(rims):
            out[8] = max(out[8], @value(at, *bases))
            at += 1
        out[9] = @value(at, *bases)
        return out
    return None


def @centre(zone, field):
    low, high, centre, slope = @zones[5 * zone : 5 * zone + 4]
    return (centre + slope * (2.0 * field * field - low * low - high * high) / (high * high - low * low)) * field


def @bounds(ghost, field):
    for k in range(@first_zone[ghost], @first_zone[ghost + 1]):
        if field < @zones[5 * k] or field > @zones[5 * k + 1]:
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
