# SPDX-License-Identifier: Apache-2.0
"""Photographs: their lights, their flare, files, and differences between pictures."""
from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Callable, Optional, Union

import numpy as np

from . import _native
from ._lenses import AnyLens, configured
from ._native import CancelFlag
from ._settings import values_of

Picture = np.ndarray  # (height, width, channels), linear
Window = tuple[int, int, int, int]  # x, y, width and height of some pixels of a picture, from its top left corner
FileName = Union[str, "os.PathLike[str]"]


@dataclass(frozen=True)
class DetectedLight:
    """A bright area of a photograph."""

    centroid_px: tuple[float, float]  # flux-weighted; the top left pixel's centre is (0.5, 0.5)
    flux: tuple[float, float, float]  # sum over its pixels, per channel
    rms_radius_px: float
    bounds_px: tuple[int, int, int, int]  # x and y of its first pixels, x and y of its last
    pixel_count: int
    peak: float  # largest level in the picture


@dataclass(frozen=True, eq=False)
class Detection:
    threshold: float  # the level above which a pixel belongs to a light
    lights: list[DetectedLight]  # by flux, largest first
    matte: Picture  # float32 (height, width, 1): each pixel's weight in its light, 0 to 1


def detect_lights(picture: Picture, **parameters: Any) -> Detection:
    """The lights of a linear photograph, white at 1, of shape (height, width, 3 or more). parameters: threshold,
    softness, max_lights, min_pixels, max_value, region."""
    threshold, lights, matte = _native.detect_lights(picture, values_of(parameters))
    return Detection(threshold, [DetectedLight(**fields) for fields in lights], matte)


@dataclass(frozen=True, eq=False)
class AppliedFlare:
    image: Picture  # the photograph with its flare, or the array given as `out`
    flare: Picture  # float32 (height, width, 3): the flare alone
    lights: list[DetectedLight]
    warnings: list[str]
    brightest: float  # the flare's luminance at its 99.5th percentile, without the lights' pixels
    relative_to_picture: float  # the 99.5th percentile of the flare's luminance over the picture's
    stops_to_obvious: Optional[float]  # gain in stops at which the flare is obvious; None: there is no flare

    def _repr_png_(self) -> bytes:
        return png_of(self.image)


def apply(
    picture: Picture,
    lens: Optional[AnyLens] = None,
    *,
    window: Optional[Window] = None,
    out: Optional[Picture] = None,
    progress: Optional[Callable[[float], Any]] = None,
    cancel: Optional[CancelFlag] = None,
    preset: Optional[str] = None,
    **parameters: Any,
) -> AppliedFlare:
    """Adds to a photograph the flare of its own lights.

    picture: linear, white at 1, of shape (height, width, 3 or more); further channels are kept.
    window: as of render(): lights are found in the whole picture, and the result is that part of it.
    out: receives the result; may be the picture itself. Without it, a new float32 array does.
    lens, progress, cancel, preset, parameters: as of render(); also gain, stops, threshold, light, ...
    """
    state = configured(lens, preset, parameters)
    rgb, flare, lights, warnings, seen = _native.apply(
        picture, state._native, state._measured, state._values, window, progress, cancel
    )
    if window is not None:
        x, y, width, height = window
        picture = picture[y : y + height, x : x + width]
    if out is None:
        out = np.array(picture, dtype=np.float32) if picture.shape[2] > 3 else rgb
    if out is not rgb:
        out[..., :3] = rgb
        if out is not picture:
            out[..., 3:] = picture[..., 3:]
    return AppliedFlare(out, flare, [DetectedLight(**fields) for fields in lights], warnings, *seen)


@dataclass(frozen=True)
class Comparison:
    psnr_db: Optional[float]  # None: equal
    peak: float  # the first picture's 99.9th percentile
    max_abs_error: float
    flux_ratio: list[float]  # per channel, the second picture's sum over the first one's
    non_finite_mismatches: int


def compare(a: Picture, b: Picture) -> Comparison:
    """The difference of picture b from picture a, of the same shape."""
    return Comparison(*_native.compare(a, b))


def read_picture(file: FileName) -> Picture:
    """The colour of an OpenEXR or PNG file: float32 (height, width, 3), linear."""
    return _native.read_picture(os.fspath(file))


def write_picture(file: FileName, picture: Picture, *, half: bool = False) -> None:
    """Writes (height, width, 3) as OpenEXR (float32, or half) or as PNG (sRGB, clipped), by the file's extension."""
    _native.write_picture(os.fspath(file), picture, half)


def png_of(picture: Picture, exposure_stops: Optional[float] = None) -> bytes:
    """An 8-bit sRGB preview as PNG; without an exposure, one that suits the picture."""
    return _native.preview_png(np.asarray(picture), exposure_stops)
