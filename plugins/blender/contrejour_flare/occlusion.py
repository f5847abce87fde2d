# SPDX-License-Identifier: Apache-2.0
"""Objects that hide lights from the camera, found by ray casts.

The k-th ray goes from a point of the lens's entrance pupil to the k-th point of a source, so that the part that gets
through falls smoothly as an edge passes the light or the pupil.
"""
from __future__ import annotations

import numpy as np
from mathutils import Vector

from . import shader_nodes
from .sources import Source, disc_points

_MAX_SURFACES = 24  # that one ray passes; more count as opaque
_REACHED = 1e-3  # relative: a hit this close to a source's own point is that point
_STEP = 1e-5  # relative to the distance, beyond a surface that a ray has passed
_FAR = 1e7


class Occlusion:
    def __init__(self, scene, depsgraph, camera, pupil_radius: float) -> None:
        self._scene, self._depsgraph = scene, depsgraph
        self._matrix = camera.matrix_world.normalized()
        self._pupil_radius = pupil_radius
        self._transmittances = {}

    def visible(self, source: Source) -> np.ndarray:
        """The part of each point's light that arrives (n,)."""
        count = len(source.points)
        if not source.is_hideable:
            return np.ones(count)
        # The pupil's points are taken in another order than the source's, so that they are not alike.
        pupil = self._pupil_radius * disc_points(max(count, 2))[_shuffled(count)]
        return np.array([self._along(source, point, at) for point, at in zip(source.points, pupil)])

    def _along(self, source: Source, point: np.ndarray, at: np.ndarray) -> float:
        origin = self._matrix @ Vector((at[0], at[1], 0.0))
        if source.is_distant:
            ray, left = self._matrix.to_3x3() @ Vector(point), _FAR
        else:
            ray = self._matrix @ Vector(point) - origin
            left = ray.length
        ray.normalize()
        whole, passed = left, 1.0
        for _ in range(_MAX_SURFACES):
            hit, where, _, face, hit_object, _ = self._scene.ray_cast(self._depsgraph, origin, ray, distance=left)
            if not hit:
                return passed
            travelled = (where - origin).length
            left -= travelled
            if source.owner is not None and hit_object.original == source.owner and left < _REACHED * whole:
                return passed
            passed *= self._through(hit_object, face)
            if passed < 1e-3:
                return 0.0
            step = _STEP * max(1.0, min(whole, 1e3))
            origin, left = where + ray * step, left - step
            if left <= 0.0:
                return passed
        return 0.0

    def _through(self, hit_object, face: int) -> float:
        """The transmittance of an object at one of its faces."""
        hit_object = hit_object.original
        if hit_object.hide_render or not hit_object.visible_camera or not hit_object.contrejour.hides_lights:
            return 1.0
        material = self._material(hit_object, face)
        if material is None:
            return 0.0
        if material.name not in self._transmittances:
            self._transmittances[material.name] = float(shader_nodes.transmittance(material).mean())
        return self._transmittances[material.name]

    def _material(self, hit_object, face: int):
        slots = hit_object.material_slots
        if len(slots) == 0:
            return None
        data = hit_object.evaluated_get(self._depsgraph).data  # of the faces that rays meet
        polygons = getattr(data, "polygons", ())
        index = polygons[face].material_index if 0 <= face < len(polygons) else 0
        return slots[min(index, len(slots) - 1)].material


def _shuffled(count: int) -> np.ndarray:
    """An order of `count` numbers in which neighbours are far apart."""
    return np.argsort((np.arange(count) * 0.6180339887498949) % 1.0)
