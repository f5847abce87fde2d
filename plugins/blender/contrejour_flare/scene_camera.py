# SPDX-License-Identifier: Apache-2.0
"""The scene's camera as numbers."""
from __future__ import annotations

from typing import Optional

from .projection import Camera


class SceneError(Exception):
    """The message says what is wrong with the scene, and what to do."""


def camera_object(scene):
    """The active camera, which must be one in perspective."""
    camera = scene.camera
    if camera is None or camera.type != "CAMERA":
        raise SceneError("the scene has no active camera; add one, and make it active (View, Cameras)")
    if camera.data.type != "PERSP":
        raise SceneError(
            f'the camera "{camera.name}" is {camera.data.type.lower()}; a lens flare needs a perspective camera'
        )
    return camera


def settled(evaluated, depsgraph):
    """The object whose properties of this add-on hold: scripts change them without Blender's evaluating the object
    anew, so that the original one has them; but while a frame is rendered, its own copy alone has animated values."""
    return evaluated if depsgraph.mode == "RENDER" else evaluated.original


def camera_of(scene, camera) -> Camera:
    """The numbers of an evaluated camera object."""
    data, render = camera.data, scene.render
    border = None
    if render.use_border and render.use_crop_to_border:
        border = (render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y)
    return Camera(
        focal_mm=data.lens,
        sensor_width_mm=data.sensor_width,
        sensor_height_mm=data.sensor_height,
        sensor_fit=data.sensor_fit,
        shift_x=data.shift_x,
        shift_y=data.shift_y,
        width=max(1, render.resolution_x * render.resolution_percentage // 100),
        height=max(1, render.resolution_y * render.resolution_percentage // 100),
        pixel_aspect=render.pixel_aspect_x / render.pixel_aspect_y,
        border=border,
    )


def focus_distance(camera) -> Optional[float]:
    """From the camera to its plane of focus, in the scene's units; None without depth of field."""
    focus = camera.data.dof
    if not focus.use_dof:
        return None
    if focus.focus_object is None:
        return focus.focus_distance
    matrix = camera.matrix_world.normalized()
    return -(matrix.inverted() @ focus.focus_object.matrix_world.translation).z
