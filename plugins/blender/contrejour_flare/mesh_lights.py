# SPDX-License-Identifier: Apache-2.0
"""Meshes with materials that emit, as sources of light."""
from __future__ import annotations

import numpy as np

from . import shader_nodes

MESH_TYPES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}


class EmissionCache:
    """The emission of materials, which the objects of a scene share."""

    def __init__(self) -> None:
        self._known = {}

    def of(self, material) -> np.ndarray:
        if material is None:
            return shader_nodes.BLACK
        if material.name not in self._known:
            self._known[material.name] = shader_nodes.emission(material)
        return self._known[material.name]


def emissions(evaluated, cache: EmissionCache) -> np.ndarray:
    """The radiance of each of the object's material slots (m, 3)."""
    return np.array([cache.of(slot.material) for slot in evaluated.material_slots]).reshape(-1, 3)


def emitting_points(evaluated, to_camera, slots: np.ndarray, count: int):
    """Points (n, 3) on the surface in the camera's coordinates, and their intensities towards it (n, 3).

    Points are chosen in proportion to what each triangle sends to the camera, so that few points give the whole sum
    exactly. A closed mesh shines towards the camera from its front; an open one from both sides of its faces.
    """
    mesh = evaluated.to_mesh()
    try:
        corners, material, is_closed = _triangles(mesh, to_camera)
    finally:
        evaluated.to_mesh_clear()
    if len(corners) == 0:
        return None
    radiance = slots[np.minimum(material, len(slots) - 1)]
    normals = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])  # length: the area
    middles = corners.mean(axis=1)
    distances = np.maximum(np.linalg.norm(middles, axis=1), 1e-9)
    towards = -np.sum(normals * middles, axis=1) / distances
    if is_closed:
        volume = np.sum(normals * middles)
        towards = np.maximum(0.0, towards if volume >= 0.0 else -towards)
    intensity = radiance * np.abs(towards)[:, None]
    # The picture receives the intensity by the square of the distance.
    weights = (intensity @ np.ones(3)) * distances**-2.0 * (middles[:, 2] < 0.0)
    total = weights.sum()
    if total <= 0.0:
        return None
    chosen = np.searchsorted(np.cumsum(weights), (np.arange(count) + 0.5) / count * total)
    chosen = np.minimum(chosen, len(weights) - 1)
    points = _within(corners[chosen])
    # Each triangle's intensity, divided by how often it is chosen on average.
    share = total / (weights[chosen] * count)
    moved = np.sum(points**2, axis=1) / distances[chosen] ** 2
    return points, intensity[chosen] * (share * moved)[:, None]


def _triangles(mesh, to_camera):
    mesh.calc_loop_triangles()
    triangles = np.empty(3 * len(mesh.loop_triangles), np.int32)
    material = np.empty(len(mesh.loop_triangles), np.int32)
    positions = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.loop_triangles.foreach_get("vertices", triangles)
    mesh.loop_triangles.foreach_get("material_index", material)
    mesh.vertices.foreach_get("co", positions)
    matrix = np.array(to_camera)
    positions = positions.reshape(-1, 3).astype(float) @ matrix[:3, :3].T + matrix[:3, 3]
    triangles = triangles.reshape(-1, 3)
    return positions[triangles], material, _is_closed(triangles)


def _is_closed(triangles: np.ndarray) -> bool:
    """True if each edge is used once in each direction."""
    if len(triangles) == 0:
        return False
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).astype(np.int64)
    size = int(edges.max()) + 1
    forward = np.sort(edges[:, 0] * size + edges[:, 1])
    backward = np.sort(edges[:, 1] * size + edges[:, 0])
    return bool(np.array_equal(forward, backward))


def _within(corners: np.ndarray) -> np.ndarray:
    """A point in each triangle, spread evenly where one is chosen again and again (Fibonacci's lattice, folded)."""
    number = np.arange(len(corners))
    a = (number * 0.7548776662466927) % 1.0
    b = (number * 0.5698402909980532) % 1.0
    outside = a + b > 1.0
    a, b = np.where(outside, 1.0 - a, a)[:, None], np.where(outside, 1.0 - b, b)[:, None]
    return corners[:, 0] + a * (corners[:, 1] - corners[:, 0]) + b * (corners[:, 2] - corners[:, 0])
