# SPDX-License-Identifier: Apache-2.0
"""The lamps, emitting meshes and sky sun of a scene, as sources in the camera's coordinates."""
from __future__ import annotations

import math
from typing import Iterator, Optional

import numpy as np
from mathutils import Vector

from . import photometry, shader_nodes, sky
from .mesh_lights import MESH_TYPES, EmissionCache, emissions, emitting_points
from .scene_camera import settled
from .sources import Source, disc_points, square_points

_LEAST_RADIUS = 1e-6  # below it a lamp is a point, in the scene's units


def sources_of(scene, depsgraph, camera, samples: int) -> Iterator[Source]:
    """All that shines, whether or not it is in the picture. camera: the evaluated object."""
    to_camera = camera.matrix_world.normalized().inverted()
    exposure = scene.cycles.film_exposure if scene.render.engine == "CYCLES" and hasattr(scene, "cycles") else 1.0
    cache = EmissionCache()
    for instance in depsgraph.object_instances:
        evaluated = instance.object
        settings = settled(evaluated, depsgraph).contrejour
        if evaluated.hide_render or not settings.use or not instance.show_self:
            continue
        source = None
        if evaluated.type == "LIGHT":
            source = _lamp(evaluated, to_camera @ instance.matrix_world, samples)
        elif evaluated.type in MESH_TYPES and evaluated.visible_camera:
            source = _mesh(evaluated, to_camera @ instance.matrix_world, samples, cache)
        if source is None:
            continue
        source.intensity = source.intensity * (exposure * settings.gain)
        source.is_hideable = settings.use_occlusion
        source.spectrum = settings.spectrum.strip() or "D65"
        yield source
    world = scene.world.evaluated_get(depsgraph) if scene.world is not None else None
    sun = _sky_sun(world, to_camera, samples)
    if sun is not None:
        sun.intensity = sun.intensity * exposure
        yield sun


def _lamp(evaluated, matrix, samples: int) -> Optional[Source]:
    lamp = evaluated.data
    colour = np.array(lamp.color) * lamp.energy * shader_nodes.lamp_factor(lamp)
    if not (np.isfinite(colour).all() and colour.max() > 0.0):
        return None
    if lamp.type == "SUN":
        towards = np.array((matrix.to_3x3() @ Vector((0.0, 0.0, 1.0))).normalized())
        return _sun(evaluated.name, towards, colour, 0.5 * lamp.angle, samples)
    if lamp.type == "AREA":
        return _area(evaluated.name, lamp, matrix, colour, samples)
    return _ball(evaluated.name, lamp, matrix, colour, samples)


def _frame_across(direction: np.ndarray) -> np.ndarray:
    """Two unit vectors (2, 3) at right angles to a direction and to each other."""
    helper = np.eye(3)[int(np.argmin(np.abs(direction)))]
    first = np.cross(direction, helper)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(direction, first)])


def _sun(name: str, towards: np.ndarray, irradiance: np.ndarray, radius_rad: float, samples: int) -> Source:
    count = samples if radius_rad > 0.0 else 1
    points = towards + math.tan(min(radius_rad, 0.75)) * disc_points(count) @ _frame_across(towards)
    points /= np.linalg.norm(points, axis=1)[:, None]
    parts = np.broadcast_to(irradiance / count, (count, 3))
    return Source(name, points, parts, is_distant=True, radius_rad=min(radius_rad, 0.75))


def _ball(name: str, lamp, matrix, colour: np.ndarray, samples: int) -> Source:
    """A point or spot lamp: a ball, of which the camera sees a disc. Points lie on it even without a radius, because
    the lens's pupil is what softens such a lamp's occlusion."""
    middle = np.array(matrix.translation)
    distance = max(float(np.linalg.norm(middle)), _LEAST_RADIUS)
    intensity = colour * photometry.point_intensity(1.0)
    if lamp.type == "SPOT":
        axis = np.array((matrix.to_3x3() @ Vector((0.0, 0.0, -1.0))).normalized())
        cosine = float(axis @ -middle) / distance
        intensity = intensity * photometry.spot_factor(cosine, lamp.spot_size, lamp.spot_blend)
    radius = min(lamp.shadow_soft_size, 0.5 * distance)
    points = middle + radius * disc_points(samples) @ _frame_across(middle / distance)
    parts = np.broadcast_to(intensity / samples, (samples, 3))
    return Source(name, points, parts, radius_rad=math.asin(radius / distance))


def _area(name: str, lamp, matrix, colour: np.ndarray, samples: int) -> Optional[Source]:
    axes = np.array(matrix.to_3x3()).T
    is_round = lamp.shape in ("DISK", "ELLIPSE")
    height = lamp.size_y if lamp.shape in ("RECTANGLE", "ELLIPSE") else lamp.size
    sides = np.stack([axes[0] * lamp.size, axes[1] * height])
    area = float(np.linalg.norm(np.cross(sides[0], sides[1]))) * (0.25 * math.pi if is_round else 1.0)
    within = 0.5 * disc_points(samples) if is_round else square_points(samples)
    points = np.array(matrix.translation) + within @ sides
    forward = -axes[2] / max(float(np.linalg.norm(axes[2])), 1e-12)
    cosines = -(points @ forward) / np.maximum(np.linalg.norm(points, axis=1), 1e-9)
    if area <= 0.0 or cosines.max() <= 0.0:
        return None
    radiance = photometry.area_radiance(1.0, area) * photometry.spread_factor(cosines, lamp.spread)
    part = np.maximum(0.0, cosines) * radiance * (area / samples)
    return Source(name, points, part[:, None] * colour)


def _mesh(evaluated, matrix, samples: int, cache: EmissionCache) -> Optional[Source]:
    slots = emissions(evaluated, cache)
    if len(slots) == 0 or slots.max() <= 0.0:
        return None
    found = emitting_points(evaluated, matrix, slots, samples)
    if found is None:
        return None
    points, intensity = found
    return Source(evaluated.name, points, intensity, owner=evaluated.original)


def _sky_sun(world, to_camera, samples: int) -> Optional[Source]:
    """The disc of a Nishita sky; the other skies show none."""
    found = shader_nodes.sky_of(world)
    if found is None or found[0].sky_type != "NISHITA" or not found[0].sun_disc:
        return None
    node, strength = found
    irradiance = sky.sun_irradiance(node.sun_elevation, node.altitude, node.air_density, node.dust_density)
    irradiance = irradiance * node.sun_intensity * strength
    if irradiance.max() <= 0.0:
        return None
    level = math.cos(node.sun_elevation)
    turn, height = node.sun_rotation, math.sin(node.sun_elevation)
    towards = Vector((math.sin(turn) * level, math.cos(turn) * level, height))
    towards = np.array((to_camera.to_3x3() @ towards).normalized())
    return _sun(f"{world.name}, sun", towards, irradiance, 0.5 * node.sun_size, samples)
