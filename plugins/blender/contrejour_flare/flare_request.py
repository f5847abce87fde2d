# SPDX-License-Identifier: Apache-2.0
"""One frame's flare as plain data, and how it is rendered. Nothing here is Blender's, so any thread may run it."""
from __future__ import annotations

import math
import pathlib
from dataclasses import dataclass, field
from typing import Any, Callable, Optional

import numpy as np

from . import library
from .projection import Frame
from .sources import FlareLight


@dataclass(frozen=True)
class FlareRequest:
    lens: Optional[str]  # a bundled name or a file; None: that of the look
    look: Optional[str]
    settings: dict[str, Any]  # keyword arguments, lights included
    lights: list[FlareLight]
    frame: Frame
    gain: float = 1.0
    messages: list[str] = field(default_factory=list)

    def command_line(self) -> list[str]:
        """The arguments of `contrejour` that render the same frame, before its gain and its window."""
        words = ["render"] + ([self.lens] if self.lens else [])
        words += ["--preset", self.look] if self.look else []
        for keyword, value in self.settings.items():
            option = "--" + keyword.replace("_", "-")
            for one in value if isinstance(value, list) else [value]:
                if isinstance(one, bool):
                    words.append(option if one else option.replace("--", "--no-", 1))
                else:
                    words.append(f"{option}={one}")
        return words


def light_text(light: FlareLight, u: float, v: float, mm_per_unit: float, first_surface_mm: float) -> str:
    """A light as the parameter light-at takes it. first_surface_mm: from the entrance pupil, where Blender's camera is,
    to the lens's first surface."""
    distance = "inf"
    if math.isfinite(light.distance):
        distance = repr(max(1.0, light.distance * mm_per_unit - first_surface_mm))
    value = ",".join(repr(channel) for channel in light.value)
    return f"{u!r},{v!r}:{value}:{light.spectrum}:{min(light.size_deg, 80.0)!r}:{distance}"


def render(
    request: FlareRequest, progress: Optional[Callable[[float], Any]] = None, cancel: Any = None
) -> np.ndarray:
    """float32 (height, width, 3), linear, of the size of Blender's render. Raises the library's errors. cancel: a
    CancelFlag of the library's."""
    frame = request.frame
    if not any(key in request.settings for key in ("light", "light_at")):
        return np.zeros((frame.bottom - frame.top, frame.right - frame.left, 3), np.float32)
    contrejour = library.load()
    flare = contrejour.render(request.lens, preset=request.look, progress=progress, cancel=cancel, **request.settings)
    picture = flare.image
    if not frame.is_whole:
        picture = np.ascontiguousarray(picture[frame.top : frame.bottom, frame.left : frame.right])
    if request.gain != 1.0:
        picture = picture * np.float32(request.gain)
    return picture


def write(picture: np.ndarray, file: str, half: bool) -> None:
    """As OpenEXR, in a folder that is made if it is not there."""
    pathlib.Path(file).parent.mkdir(parents=True, exist_ok=True)
    library.load().write_picture(file, picture, half=half)
