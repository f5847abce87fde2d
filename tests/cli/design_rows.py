# SPDX-License-Identifier: Apache-2.0
"""Rows of sequential design files of spheres, mirrors among them, and a ray through them: as design programs have it,
with one axis for all and gaps that are negative where light goes back. Shares nothing with the program."""
import math


def zemax_rows(text):
    """Of each surface but the object: curvature, gap behind it, is it a mirror."""
    rows = []
    for line in text.splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "SURF":
            rows.append([0.0, 0.0, False])
        elif words[0] == "CURV":
            rows[-1][0] = float(words[1])
        elif words[0] == "DISZ" and words[1] != "INFINITY":
            rows[-1][1] = float(words[1])
        elif words[0] == "GLAS" and words[1] == "MIRROR":
            rows[-1][2] = True
    return rows[1:]


def codev_rows(text):
    """The same."""
    rows = []
    for line in text.splitlines():
        words = line.split()
        if words and words[0] in ("S", "SI"):
            radius = float(words[1])
            rows.append([1 / radius if radius else 0.0, float(words[2]), "REFL" in words[3:]])
        elif words and words[0] == "CUY":
            rows[-1][0] = float(words[1])
    return rows


def media_along(order, behind):
    """Index on either side of each surface that is met, by its number from 1: in front and behind."""
    return [(behind[k - 2] if k > 1 else 1.0, behind[k - 1]) for k in order]


def trace(rows, media, origin, direction):
    """Where the ray meets the last row's plane."""
    p, d = list(origin), [c / math.hypot(*direction) for c in direction]
    for k, (curvature, gap, mirror) in enumerate(rows):
        # Onto the vertex's plane, then onto the sphere: the root that is nearer to the vertex.
        way = -p[2] / d[2]
        p = [p[0] + way * d[0], p[1] + way * d[1], 0.0]
        if k == len(rows) - 1:
            return p[0], p[1]
        b = d[2] - curvature * (p[0] * d[0] + p[1] * d[1])
        c = curvature * (p[0] ** 2 + p[1] ** 2)
        root = math.sqrt(b * b - curvature * c)
        way = c / (b + math.copysign(root, b))
        p = [p[i] + way * d[i] for i in range(3)]
        normal = [-curvature * p[0], -curvature * p[1], 1 - curvature * p[2]]
        cosine = sum(normal[i] * d[i] for i in range(3))
        if mirror:
            d = [d[i] - 2 * cosine * normal[i] for i in range(3)]
        else:
            n_in, n_out = media[k] if d[2] > 0 else media[k][::-1]
            mu = n_in / n_out
            cosine_out = math.copysign(math.sqrt(1 - mu * mu * (1 - cosine * cosine)), cosine)
            d = [mu * d[i] + (cosine_out - mu * cosine) * normal[i] for i in range(3)]
        p[2] -= gap
    return None
