# SPDX-License-Identifier: Apache-2.0
"""From a scene, at the frame for which it is evaluated, to the request for its flare. This reads Blender's data."""
from __future__ import annotations

import numpy as np

from . import lens_choice, properties
from .flare_request import FlareRequest, light_text
from .occlusion import Occlusion
from .projection import View, frame_of, position_in_frame, view_of
from .scene_camera import camera_object, camera_of, focus_distance, settled
from .scene_lights import sources_of
from .sources import FlareLight, brightest, image_of, lights_of


def request_of(scene, depsgraph) -> FlareRequest:
    """Raises SceneError, or the library's errors."""
    original = camera_object(scene)
    camera = original.evaluated_get(depsgraph)
    options, output = settled(camera, depsgraph).data.contrejour, scene.contrejour
    numbers = camera_of(scene, camera)
    view = view_of(numbers)
    frame = frame_of(numbers, view)
    mm_per_unit = 1000.0 * scene.unit_settings.scale_length
    lens, look = properties.lens_and_look(options)
    settings, gain = properties.settings_of(options, original.data, look)
    chosen = lens_choice.choose(lens, look, settings, _camera_lens(options, camera, mm_per_unit))
    settings.update(chosen.settings)
    occlusion = Occlusion(scene, depsgraph, camera, chosen.pupil_radius_mm / mm_per_unit)
    sources = list(sources_of(scene, depsgraph, camera, output.samples))
    lights, messages = _visible_lights(sources, view, occlusion, output.max_lights)
    _add_picture(settings, lights, view, frame, mm_per_unit, chosen.first_surface_mm)
    return FlareRequest(lens, look, settings, lights, frame, gain, chosen.messages + messages)


def _camera_lens(options, camera, mm_per_unit: float) -> lens_choice.CameraLens:
    distance = focus_distance(camera) if options.use_camera_focus else None
    f_number = camera.data.dof.aperture_fstop if distance is not None else None
    return lens_choice.CameraLens(
        focal_mm=camera.data.lens,
        f_number=f_number if f_number and f_number > 0.0 else None,
        focus_mm=distance * mm_per_unit if distance is not None else None,
        sets_zoom=options.match_focal,
    )


def _visible_lights(sources, view: View, occlusion: Occlusion, count: int) -> tuple[list[FlareLight], list[str]]:
    """Rays are cast for sources that can matter beside the brightest one alone."""
    levels = np.array([image_of(source, view).values.sum() for source in sources])
    lights = []
    for source, level in zip(sources, levels):
        if level > 1e-6 * levels.max():
            lights += lights_of(source, view, occlusion.visible(source))
    kept = brightest(lights, count)
    if len(lights) > count:
        return kept, [f"the {count} brightest of {len(lights)} lights are used (Lights, at most)"]
    return kept, []


def _add_picture(
    settings: dict, lights: list[FlareLight], view, frame, mm_per_unit: float, first_surface_mm: float
) -> None:
    """The picture's size and field, and its lights before those that are given as text."""
    positions = position_in_frame(view, frame, np.array([(light.u, light.v) for light in lights]).reshape(-1, 2))
    texts = [
        light_text(light, float(u), float(v), mm_per_unit, first_surface_mm)
        for light, (u, v) in zip(lights, positions)
    ]
    texts += settings.pop("light_at", [])
    if texts:
        settings["light_at"] = texts
    settings["size"] = f"{frame.width}x{frame.height}"
    settings["hfov"] = repr(frame.hfov_deg)
    settings["pixel_aspect"] = repr(view.pixel_aspect)
