# SPDX-License-Identifier: Apache-2.0
"""Sources of light as sample points with intensities, and what a picture receives of them.

Everything that shines (a lamp, a mesh that emits, the sun) becomes a Source: points spread over what the camera sees of
it. Each point has its part of the intensity towards the camera, so that what hides some points takes just their part.
No part of Blender is needed here.
"""
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .photometry import LUMINANCE
from .projection import View

MAX_ANGLE_TANGENT = math.tan(math.radians(85.0))  # light farther from the axis than this does not meet the lens
_GOLDEN_ANGLE = math.pi * (3.0 - math.sqrt(5.0))


def disc_points(count: int, turn: float = 0.0) -> np.ndarray:
    """Points (n, 2) spread evenly over the unit disc (Vogel 1979); one point is its centre."""
    if count == 1:
        return np.zeros((1, 2))
    number = np.arange(count)
    radius = np.sqrt((number + 0.5) / count)
    angle = number * _GOLDEN_ANGLE + turn
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)


def square_points(count: int) -> np.ndarray:
    """Points (n, 2) spread evenly over the square from -0.5 to 0.5: a lattice of Fibonacci's kind."""
    number = np.arange(count)
    return np.stack([(number + 0.5) / count, (number / ((1.0 + math.sqrt(5.0)) / 2.0)) % 1.0], axis=1) - 0.5


@dataclass(eq=False)
class Source:
    """Sample points of one source of light, in the camera's own coordinates: x right, y up, -z forward."""

    name: str
    points: np.ndarray  # (n, 3); a distant source's are unit directions to it
    intensity: np.ndarray  # (n, 3): each point's part, per steradian; a distant source's is irradiance
    is_distant: bool = False
    radius_rad: float | None = None  # its angular radius, where it is known to be a disc
    spectrum: str = "D65"
    owner: Any = None  # the object whose surface the points lie on, for occlusion
    is_hideable: bool = True


@dataclass(frozen=True)
class FlareLight:
    """A light of the flare: where its image lies in the picture, and what it sums to."""

    name: str
    u: float
    v: float
    value: tuple[float, float, float]
    size_deg: float
    distance: float  # from the camera, in the scene's units of length
    visible: float = 1.0  # the fraction of its source that nothing hides
    spectrum: str = "D65"

    @property
    def luminance(self) -> float:
        return float(LUMINANCE @ np.array(self.value))


@dataclass(eq=False)
class Image:
    """The picture receives this from a source's points."""

    tangents: np.ndarray  # (n, 2)
    values: np.ndarray  # (n, 3): the sum over the pixels of each point's image
    distances: np.ndarray = field(repr=False)  # (n,)


def image_of(source: Source, view: View) -> Image:
    """value = intensity / distance^2 / solid angle of a pixel there; points that are not in front count nothing."""
    depth = -source.points[:, 2]
    in_front = depth > 1e-9
    safe_depth = np.where(in_front, depth, 1.0)
    tangents = source.points[:, :2] / safe_depth[:, None]
    in_front &= np.hypot(tangents[:, 0], tangents[:, 1]) < MAX_ANGLE_TANGENT
    tangents = np.where(in_front[:, None], tangents, 0.0)
    distances = np.full(len(depth), math.inf) if source.is_distant else np.linalg.norm(source.points, axis=1)
    falloff = 1.0 if source.is_distant else np.maximum(distances, 1e-9) ** -2.0
    per_pixel = in_front * falloff / view.pixel_solid_angle(tangents)
    return Image(tangents, source.intensity * per_pixel[:, None], distances)


MAX_PARTS = 8
_LONG = 1.8  # a source that is this much longer than wide is divided
_SMALL_RAD = 0.01  # and one below this length is not


def lights_of(source: Source, view: View, visible: np.ndarray) -> list[FlareLight]:
    """The lights that a source's visible points make: one, or several where it is long. visible: (n,), 0 to 1."""
    image = image_of(source, view)
    values = image.values * visible[:, None]
    weights = values @ LUMINANCE
    everything = float((image.values @ LUMINANCE).sum())
    if everything <= 0.0 or weights.sum() <= 1e-6 * everything:
        return []
    lit = np.flatnonzero(weights > 0.0)
    parts = [lit] if source.radius_rad is not None else _divided(image.tangents, weights, lit)
    lights = []
    for part in parts:
        weight = weights[part]
        tangents = np.average(image.tangents[part], axis=0, weights=weight)
        u, v = view.position(tangents[None])[0]
        lights.append(
            FlareLight(
                name=source.name if len(parts) == 1 else f"{source.name}, part {len(lights) + 1}",
                u=float(u),
                v=float(v),
                value=tuple(float(channel) for channel in values[part].sum(axis=0)),
                size_deg=_size_deg(source, image, part, weight),
                distance=math.inf if source.is_distant else float(np.average(image.distances[part], weights=weight)),
                visible=float(weights.sum() / everything),
                spectrum=source.spectrum,
            )
        )
    return lights


def _directions(tangents: np.ndarray) -> np.ndarray:
    directions = np.concatenate([tangents, np.ones((len(tangents), 1))], axis=1)
    return directions / np.linalg.norm(directions, axis=1)[:, None]


def _spread_rad(tangents: np.ndarray, weights: np.ndarray) -> float:
    """Root of the mean square angle from the middle."""
    directions = _directions(tangents)
    middle = np.average(directions, axis=0, weights=weights)
    middle /= np.linalg.norm(middle)
    return float(np.sqrt(np.average(np.sum((directions - middle) ** 2, axis=1), weights=weights)))


def _size_deg(source: Source, image: Image, part: np.ndarray, weights: np.ndarray) -> float:
    """The diameter of the disc with the part's mean square angle, which is half the square of a disc's radius. A
    disc that is partly hidden keeps the fraction of its own radius."""
    if len(part) == 1:
        return math.degrees(2.0 * (source.radius_rad or 0.0))
    spread = _spread_rad(image.tangents[part], weights)
    if source.radius_rad is None:
        return math.degrees(2.0 * math.sqrt(2.0) * spread)
    whole = _spread_rad(image.tangents, image.values @ LUMINANCE)
    return math.degrees(2.0 * source.radius_rad) * (min(1.0, spread / whole) if whole > 0.0 else 1.0)


def _divided(tangents: np.ndarray, weights: np.ndarray, lit: np.ndarray) -> list[np.ndarray]:
    """Halves the longest part across until none is long and large, or there are MAX_PARTS."""
    parts = [lit]
    while len(parts) < MAX_PARTS:
        lengths = [_long_side(tangents[part], weights[part])[0] for part in parts]
        longest = int(np.argmax(lengths))
        if lengths[longest] <= 0.0:
            break
        part = parts.pop(longest)
        along = _long_side(tangents[part], weights[part])[1]
        order = part[np.argsort(along)]
        parts += [order[: len(order) // 2], order[len(order) // 2 :]]
    return parts


def _long_side(tangents: np.ndarray, weights: np.ndarray) -> tuple[float, np.ndarray]:
    """The length in radians of what shall be divided, 0 for what shall not, and the points' positions along it."""
    along = np.zeros(len(tangents))
    if len(tangents) < 8:
        return 0.0, along
    offsets = tangents - np.average(tangents, axis=0, weights=weights)
    covariance = (offsets * weights[:, None]).T @ offsets / weights.sum()
    squares, axes = np.linalg.eigh(covariance)
    length, width = (math.sqrt(12.0 * max(0.0, square)) for square in (squares[1], squares[0]))
    if length < _SMALL_RAD or length < _LONG * width:
        return 0.0, along
    return length, offsets @ axes[:, 1]


def brightest(lights: list[FlareLight], count: int, least: float = 1e-6) -> list[FlareLight]:
    """The brightest lights; one with less than `least` of the brightest one's luminance is lost beside it."""
    ordered = sorted(lights, key=lambda light: -light.luminance)[:count]
    return [light for light in ordered if light.luminance > least * ordered[0].luminance]
