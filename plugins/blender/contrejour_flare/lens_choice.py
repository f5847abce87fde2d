# SPDX-License-Identifier: Apache-2.0
"""The lens for a camera: zoom, f-number and focus by the camera, and where the two do not agree."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

from . import library

_AGREES = 0.03  # relative difference of two focal lengths below which nobody sees one


@dataclass(frozen=True)
class CameraLens:
    """The camera's statements on its lens; None where the parameters hold."""

    focal_mm: float
    f_number: Optional[float]
    focus_mm: Optional[float]  # from the entrance pupil
    sets_zoom: bool


@dataclass(frozen=True)
class ChosenLens:
    settings: dict[str, Any]  # in addition to the parameters
    focal_mm: float
    pupil_radius_mm: float
    first_surface_mm: float  # from the entrance pupil to the first surface
    messages: list[str]


def choose(lens: Optional[str], look: Optional[str], settings: dict[str, Any], camera: CameraLens) -> ChosenLens:
    """Raises the library's errors: no such lens, a file that is no lens, parameters out of range."""
    contrejour = library.load()
    added: dict[str, Any] = {}
    messages: list[str] = []
    state = contrejour.configure_lens(lens, preset=look, **settings)
    if camera.sets_zoom and state.prescription.zoom_mm:
        added["focal"] = _zoom(state.prescription, camera.focal_mm)
    if camera.f_number is not None:
        try:
            state.configure(f_number=camera.f_number, **added)
            added["fnumber"] = repr(camera.f_number)
        except contrejour.InvalidArgumentError as error:
            messages.append(f"the camera's f/{camera.f_number:.3g} is not the lens's, which stays at its own: {error}")
    state = state.configure(**added)
    figures = state.first_order()
    if camera.focus_mm is not None:
        # The plane of focus counts from the first surface, the camera's distances from the entrance pupil.
        added["focus"] = repr(max(1.0, camera.focus_mm - figures.entrance_pupil_position_mm))
        state = state.configure(focus=added["focus"])
    messages += _disagreement(state, figures.focal_length_x_mm, camera, bool(state.prescription.zoom_mm))
    messages += state.warnings
    return ChosenLens(
        settings=added,
        focal_mm=figures.focal_length_x_mm,
        pupil_radius_mm=0.5 * figures.entrance_pupil_diameter_mm,
        first_surface_mm=figures.entrance_pupil_position_mm,
        messages=messages,
    )


def _zoom(prescription, focal_mm: float) -> str:
    """The focal length within the zoom's range."""
    return repr(min(max(focal_mm, prescription.zoom_mm[0]), prescription.zoom_mm[-1]))


def _disagreement(state, focal_mm: float, camera: CameraLens, is_zoom: bool) -> list[str]:
    if abs(focal_mm / camera.focal_mm - 1.0) <= _AGREES:
        return []
    kind = "zoom reaches" if is_zoom and camera.sets_zoom else "lens has"
    return [
        f"the camera has {camera.focal_mm:.4g} mm, the {kind} {focal_mm:.4g} mm: the flare has the camera's field of "
        f"view, as of a sensor {focal_mm / camera.focal_mm:.2f} times as large; Set Camera to Lens makes them agree"
    ]
