// SPDX-License-Identifier: Apache-2.0
// The functions that exported source code of the direct image consists of, besides its tables.
#pragma once

#include <string_view>

namespace contrejour::inline internal::polynomial {

// As kCommonCode of export_code.h.
inline constexpr std::string_view kDirectCode = R"code(
LOCALvoid @chebyshev(REAL x, OUTREAL t[13], OUTREAL d[13]) {
  t[0] = 1.0; t[1] = x;
  d[0] = 0.0; d[1] = 1.0;
  for (int k = 2; k < 13; ++k) {
    t[k] = 2.0 * x * t[k - 1] - t[k - 2];
    d[k] = 2.0 * t[k - 1] + 2.0 * x * d[k - 1] - d[k - 2];
  }
}

// Numbers of a point: sensor point over the largest height, stop point over the margin, then Chebyshev polynomials and
// their slopes in u, v, w and the wavelength's.
LOCALvoid @point(REAL sx, REAL sy, REAL ax, REAL ay, REAL lambda_nm, OUTREAL q[95]) {
  REAL hx = sx / @HEIGHT, hy = sy / @HEIGHT, px = ax / @MARGIN, py = ay / @MARGIN, r = 550.0 / lambda_nm, t[13], d[13];
  q[0] = hx; q[1] = hy; q[2] = px; q[3] = py;
  for (int i = 0; i < 4; ++i) {
    REAL x = 2.0 * (hx * hx + hy * hy) - 1.0;
    if (i == 1) x = hx * px + hy * py;
    if (i == 2) x = 2.0 * (px * px + py * py) - 1.0;
    if (i == 3) x = (2.0 * r * r - 302500.0 * (@SHORTEST + @LONGEST)) / (302500.0 * (@SHORTEST - @LONGEST));
    @chebyshev(x, t, d);
    for (int k = 0; k < 13; ++k) {
      q[4 + 13 * i + k] = t[k];
      if (i < 3) q[56 + 13 * i + k] = d[k];
    }
  }
}

// A polynomial's value and its derivatives by u, v and w.
LOCALvoid @sum(int index, INREAL q[95], OUTREAL s[4]) {
  int degree = @sums[3 * index], c = @sums[3 * index + 2];
  s[0] = s[1] = s[2] = s[3] = 0.0;
  for (int l = 0; l < @sums[3 * index + 1]; ++l)
    for (int v = 0; v <= degree; ++v)
      for (int w = 0; w <= degree - v; ++w) {
        REAL a = 0.0, b = 0.0;
        for (int u = 0; u <= degree - v - w; ++u, ++c) {
          a += @COEFFICIENT(c) * q[4 + u];
          b += @COEFFICIENT(c) * q[56 + u];
        }
        a *= q[43 + l];
        b *= q[43 + l];
        s[0] += a * q[17 + v] * q[30 + w];
        s[1] += b * q[17 + v] * q[30 + w];
        s[2] += a * q[69 + v] * q[30 + w];
        s[3] += a * q[17 + v] * q[82 + w];
      }
}

// A vector's x and y, their derivatives by the sensor's x (x, y) and y, and by the stop's x and y.
LOCALvoid @vector(int index, INREAL q[95], OUTREAL o[10]) {
  REAL a[4], b[4];
  @sum(index, q, a);
  @sum(index + 1, q, b);
  o[0] = q[0] * a[0] + q[2] * b[0];
  o[1] = q[1] * a[0] + q[3] * b[0];
  for (int j = 0; j < 2; ++j) {
    REAL h = q[j], p = q[2 + j];
    REAL ah = 4.0 * h * a[1] + p * a[2], bh = 4.0 * h * b[1] + p * b[2];
    REAL ap = h * a[2] + 4.0 * p * a[3], bp = h * b[2] + 4.0 * p * b[3];
    for (int i = 0; i < 2; ++i) {
      REAL one = i == j ? 1.0 : 0.0;
      o[2 + 2 * j + i] = (q[i] * ah + q[2 + i] * bh + one * a[0]) / @HEIGHT;
      o[6 + 2 * j + i] = (q[i] * ap + q[2 + i] * bp + one * b[0]) / @MARGIN;
    }
  }
}

BOOL @ray(REAL sensor_x_mm, REAL sensor_y_mm, REAL stop_x, REAL stop_y, REAL lambda_nm, OUTREAL result[9]) {
  REAL q[95], o[10], s[4];
  for (int i = 0; i < 9; ++i) result[i] = 0.0;
  if (!(sensor_x_mm * sensor_x_mm + sensor_y_mm * sensor_y_mm <= @HEIGHT * @HEIGHT)) return NO;
  if (!(stop_x * stop_x + stop_y * stop_y <= @MARGIN * @MARGIN)) return NO;
  @point(sensor_x_mm, sensor_y_mm, stop_x, stop_y, lambda_nm, q);
  @vector(2, q, o);
  REAL rest = 1.0 - o[0] * o[0] - o[1] * o[1];
  if (!(rest > 0.0)) return NO;
  result[3] = o[0];
  result[4] = o[1];
  result[5] = -sqrt(rest);
  @vector(0, q, o);
  result[0] = o[0];
  result[1] = o[1];
  result[2] = @FRONT;
  @vector(4, q, o);
  result[8] = ABS(o[6] * o[9] - o[7] * o[8]);
  @sum(6, q, s);
  if (s[0] > 0.0) result[6] = s[0];
  for (int i = 7; i < @COUNT; ++i) {
    @sum(i, q, s);
    if (s[0] > result[7]) result[7] = s[0];
  }
  return YES;
}

BOOL @sensor(REAL x, REAL y, REAL z, REAL w, REAL stop_x, REAL stop_y, REAL lambda_nm, OUTREAL result[2]) {
  REAL q[95], e[10], d[10], j[4];
  result[0] = result[1] = 0.0;
  if (!(z < w * @FRONT) || !(stop_x * stop_x + stop_y * stop_y <= @MARGIN * @MARGIN)) return NO;
  for (int k = 0; k < 12; ++k) {
    @point(result[0], result[1], stop_x, stop_y, lambda_nm, q);
    @vector(0, q, e);
    @vector(2, q, d);
    REAL tx = x - w * e[0], ty = y - w * e[1], tz = z - w * @FRONT, distance = sqrt(tx * tx + ty * ty + tz * tz);
    if (!(distance > 0.0)) return NO;
    tx /= distance;
    ty /= distance;
    for (int i = 0; i < 2; ++i) {
      REAL ex = e[2 + 2 * i], ey = e[3 + 2 * i], along = tx * ex + ty * ey;
      j[2 * i] = (tx * along - ex) * w / distance - d[2 + 2 * i];
      j[2 * i + 1] = (ty * along - ey) * w / distance - d[3 + 2 * i];
    }
    REAL mx = tx - d[0], my = ty - d[1], determinant = j[0] * j[3] - j[1] * j[2];
    REAL dx = -(mx * j[3] - my * j[2]) / determinant, dy = -(j[0] * my - j[1] * mx) / determinant;
    REAL size = sqrt(dx * dx + dy * dy), largest = 0.5 * @HEIGHT;
    if (!(size < 1e30)) return NO;
    if (size > largest) {
      dx *= largest / size;
      dy *= largest / size;
    }
    result[0] += dx;
    result[1] += dy;
    REAL height = sqrt(result[0] * result[0] + result[1] * result[1]);
    if (size < @CONVERGED) return height <= @HEIGHT ? YES : NO;
    if (height > 1.05 * @HEIGHT) {
      result[0] *= 1.05 * @HEIGHT / height;
      result[1] *= 1.05 * @HEIGHT / height;
    }
  }
  return NO;
}
)code";

inline constexpr std::string_view kDirectCodeInPython = R"code(

def @chebyshev(x):
    t, d = [1.0, x], [0.0, 1.0]
    while len(t) < 13:
        d.append(2.0 * t[-1] + 2.0 * x * d[-1] - d[-2])
        t.append(2.0 * x * t[-1] - t[-2])
    return t, d


def @point(sx, sy, ax, ay, lambda_nm):
    h, p = (sx / @HEIGHT, sy / @HEIGHT), (ax / @MARGIN, ay / @MARGIN)
    u, v, w = 2.0 * (h[0] ** 2 + h[1] ** 2) - 1.0, h[0] * p[0] + h[1] * p[1], 2.0 * (p[0] ** 2 + p[1] ** 2) - 1.0
    wavelength = (2.0 / lambda_nm**2 - @SHORTEST - @LONGEST) / (@SHORTEST - @LONGEST)
    return (h, p) + tuple(@chebyshev(x) for x in (u, v, w, wavelength))


def @sum(index, point):
    """A polynomial's value and its derivatives by u, v and w."""
    degree, terms, c = @sums[3 * index : 3 * index + 3]
    (tu, du), (tv, dv), (tw, dw), (tl, _) = point[2:]
    out = [0.0] * 4
    for l in range(terms):
        for v in range(degree + 1):
            for w in range(degree - v + 1):
                a = b = 0.0
                for u in range(degree - v - w + 1):
                    a += @coefficients[c] * tu[u]
                    b += @coefficients[c] * du[u]
                    c += 1
                a, b = a * tl[l], b * tl[l]
                out[0] += a * tv[v] * tw[w]
                out[1] += b * tv[v] * tw[w]
                out[2] += a * dv[v] * tw[w]
                out[3] += a * tv[v] * dw[w]
    return out


def @vector(index, point):
    """A vector, and its derivatives by the sensor's x and y and by the stop's x and y."""
    h, p = point[:2]
    a, b = @sum(index, point), @sum(index + 1, point)
    by_sensor, by_stop = [], []
    for j in range(2):
        ah, bh = 4.0 * h[j] * a[1] + p[j] * a[2], 4.0 * h[j] * b[1] + p[j] * b[2]
        ap, bp = h[j] * a[2] + 4.0 * p[j] * a[3], h[j] * b[2] + 4.0 * p[j] * b[3]
        by_sensor.append([(h[i] * ah + p[i] * bh + (a[0] if i == j else 0.0)) / @HEIGHT for i in range(2)])
        by_stop.append([(h[i] * ap + p[i] * bp + (b[0] if i == j else 0.0)) / @MARGIN for i in range(2)])
    return [h[i] * a[0] + p[i] * b[0] for i in range(2)], by_sensor, by_stop


def @ray(sensor_x_mm, sensor_y_mm, stop_x, stop_y, lambda_nm):
    if not (math.hypot(sensor_x_mm, sensor_y_mm) <= @HEIGHT and math.hypot(stop_x, stop_y) <= @MARGIN):
        return None
    point = @point(sensor_x_mm, sensor_y_mm, stop_x, stop_y, lambda_nm)
    (dx, dy), _, _ = @vector(2, point)
    rest = 1.0 - dx * dx - dy * dy
    if not rest > 0.0:
        return None
    (x, y), _, _ = @vector(0, point)
    _, _, ((a, b), (c, d)) = @vector(4, point)
    squared = max([0.0] + [@sum(k, point)[0] for k in range(7, @COUNT)])
    return [x, y, @FRONT, dx, dy, -math.sqrt(rest), max(@sum(6, point)[0], 0.0), squared, abs(a * d - b * c)]


def @sensor(x, y, z, w, stop_x, stop_y, lambda_nm):
    if not (z < w * @FRONT and math.hypot(stop_x, stop_y) <= @MARGIN):
        return None
    sx = sy = 0.0
    for _ in range(12):
        point = @point(sx, sy, stop_x, stop_y, lambda_nm)
        (ex, ey), by_sensor, _ = @vector(0, point)
        (dx, dy), turned, _ = @vector(2, point)
        tx, ty, tz = x - w * ex, y - w * ey, z - w * @FRONT
        distance = math.sqrt(tx * tx + ty * ty + tz * tz)
        if not distance > 0.0:
            return None
        tx, ty = tx / distance, ty / distance
        j = []
        for moved, turn in zip(by_sensor, turned):
            along = tx * moved[0] + ty * moved[1]
            j += [(tx * along - moved[0]) * w / distance - turn[0], (ty * along - moved[1]) * w / distance - turn[1]]
        mx, my, determinant = tx - dx, ty - dy, j[0] * j[3] - j[1] * j[2]
        if determinant == 0.0:
            return None
        step_x, step_y = -(mx * j[3] - my * j[2]) / determinant, -(j[0] * my - j[1] * mx) / determinant
        size, largest = math.hypot(step_x, step_y), 0.5 * @HEIGHT
        scale = largest / size if size > largest else 1.0
        sx, sy = sx + scale * step_x, sy + scale * step_y
        height = math.hypot(sx, sy)
        if size < @CONVERGED:
            return [sx, sy] if height <= @HEIGHT else None
        if height > 1.05 * @HEIGHT:
            sx, sy = sx * 1.05 * @HEIGHT / height, sy * 1.05 * @HEIGHT / height
    return None
)code";

}  // namespace contrejour::inline internal::polynomial
