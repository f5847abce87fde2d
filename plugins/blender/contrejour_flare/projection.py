# SPDX-License-Identifier: Apache-2.0
"""A camera's projection as numbers: points and directions in front of it to positions in its picture.

Tangents are those of the angles to the camera's axis, x to the right and y up. A position u, v has 0, 0 at the
picture's top left corner and 1, 1 at its bottom right one. No part of Blender is needed here.
"""
from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Camera:
    """A perspective camera as Blender describes it; `sensor_fit` is AUTO, HORIZONTAL or VERTICAL."""

    focal_mm: float
    sensor_width_mm: float
    sensor_height_mm: float
    sensor_fit: str
    shift_x: float  # in units of the sensor's side that fits
    shift_y: float
    width: int  # px, after the resolution percentage
    height: int
    pixel_aspect: float = 1.0  # width over height
    border: tuple[float, float, float, float] | None = None  # the part that is kept: left, right, bottom, top, 0 to 1


@dataclass(frozen=True)
class View:
    """The picture in tangents: its sides and its middle."""

    width: int
    height: int
    tangent_width: float
    tangent_height: float
    middle_x: float
    middle_y: float
    pixel_aspect: float

    def position(self, tangents: np.ndarray) -> np.ndarray:
        """Tangents (n, 2) to u, v (n, 2)."""
        u = 0.5 + (tangents[:, 0] - self.middle_x) / self.tangent_width
        v = 0.5 - (tangents[:, 1] - self.middle_y) / self.tangent_height
        return np.stack([u, v], axis=1)

    def axis(self) -> tuple[float, float]:
        """The position of the camera's axis, which a shift moves out of the middle."""
        u, v = self.position(np.zeros((1, 2)))[0]
        return float(u), float(v)

    def pixel_solid_angle(self, tangents: np.ndarray) -> np.ndarray:
        """A pixel there has this many steradians: its area on the plane at distance 1 by the cube of the cosine."""
        area = (self.tangent_width / self.width) * (self.tangent_height / self.height)
        return area * (1.0 + np.sum(tangents**2, axis=1)) ** -1.5


def view_of(camera: Camera) -> View:
    """The picture in tangents, by the rules of Blender's manual (Camera: sensor fit, shift)."""
    tall = 1.0 / camera.pixel_aspect  # a pixel's height, of width 1
    fits_width = camera.sensor_fit == "HORIZONTAL" or (
        camera.sensor_fit == "AUTO" and camera.width >= tall * camera.height
    )
    sensor_mm = camera.sensor_height_mm if camera.sensor_fit == "VERTICAL" else camera.sensor_width_mm
    fitted_pixels = camera.width if fits_width else tall * camera.height
    side = sensor_mm / camera.focal_mm
    pixel = side / fitted_pixels
    return View(
        width=camera.width,
        height=camera.height,
        tangent_width=camera.width * pixel,
        tangent_height=camera.height * tall * pixel,
        middle_x=camera.shift_x * side,
        middle_y=camera.shift_y * side,
        pixel_aspect=camera.pixel_aspect,
    )


@dataclass(frozen=True)
class Frame:
    """The frame that the lens renders, centred on its axis, and the picture's window in it, in pixels."""

    width: int
    height: int
    left: int
    top: int
    right: int
    bottom: int
    hfov_deg: float
    offset_x: int  # of the whole picture's top left corner
    offset_y: int

    @property
    def is_whole(self) -> bool:
        return (self.left, self.top, self.right, self.bottom) == (0, 0, self.width, self.height)


def frame_of(camera: Camera, view: View) -> Frame:
    """The smallest frame around the axis that holds the picture. A shifted axis is rounded to half a pixel."""
    axis_u, axis_v = view.axis()
    width, offset_x = _centred(axis_u, view.width)
    height, offset_y = _centred(axis_v, view.height)
    left, right, top, bottom = 0, view.width, 0, view.height
    if camera.border is not None:
        low_x, high_x, low_y, high_y = camera.border
        left, right = _pixels(low_x, high_x, view.width)
        below, above = _pixels(low_y, high_y, view.height)
        top, bottom = view.height - above, view.height - below
    tangent_width = view.tangent_width * width / view.width
    return Frame(
        width=width,
        height=height,
        left=left + offset_x,
        top=top + offset_y,
        right=right + offset_x,
        bottom=bottom + offset_y,
        hfov_deg=math.degrees(2.0 * math.atan(0.5 * tangent_width)),
        offset_x=offset_x,
        offset_y=offset_y,
    )


def _centred(axis: float, pixels: int) -> tuple[int, int]:
    """The length of a side whose middle is the axis, and where the picture begins in it."""
    twice = round(2.0 * axis * pixels)
    return (twice, 0) if twice >= pixels else (2 * pixels - twice, pixels - twice)


def _pixels(low: float, high: float, pixels: int) -> tuple[int, int]:
    """Blender cuts a border down to whole pixels; one is kept at least."""
    first = min(int(low * pixels), pixels - 1)
    return first, max(int(high * pixels), first + 1)


def position_in_frame(view: View, frame: Frame, positions: np.ndarray) -> np.ndarray:
    """u, v (n, 2) of the picture to those of the frame."""
    pixels = positions * (view.width, view.height) + (frame.offset_x, frame.offset_y)
    return pixels / (frame.width, frame.height)
