# SPDX-License-Identifier: Apache-2.0
"""Lights, renderers and starbursts."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Callable, Iterable, Optional, Union

import numpy as np

from . import _native
from ._lenses import AnyLens, LensState, configured
from ._native import CancelFlag
from ._pictures import Picture, Window, png_of
from ._polynomials import Polynomials

Progress = Callable[[float], Any]


@dataclass(frozen=True)
class Light:
    """A light in front of a lens; at_angles() and at_image() say where more simply than a direction.

    value: the sum of the light's direct image over its pixels, one number or three.
    """

    direction: tuple[float, float, float]  # unit, of travel to the lens, z > 0
    value: Union[float, tuple[float, float, float]] = 1.0
    spectrum: str = "D65"  # "A", "3200K", "sodium", a file, ...
    distance_mm: float = math.inf  # to the first vertex
    radius_rad: float = 0.0  # angular radius of a disc; 0: a point

    @classmethod
    def at_angles(cls, azimuth_deg: float, elevation_deg: float, value: Any = 1.0, **others: Any) -> Light:
        """By its angles to the right and up, as the photographer sees them, in degrees."""
        direction = _native.direction_from_angles(math.radians(azimuth_deg), math.radians(elevation_deg))
        return cls(direction, value, **others)

    @classmethod
    def at_image(cls, lens: LensState, x_mm: float, y_mm: float, value: Any = 1.0, **others: Any) -> Light:
        """By the point of the sensor where its image lies: right and up in the picture are negative."""
        distance_mm = others.get("distance_mm", math.inf)
        wavelength_nm = lens.design_wavelength_nm
        direction = _native.direction_for_image_point(lens._native, x_mm, y_mm, wavelength_nm, distance_mm)
        return cls(direction, value, **others)

    def _fields(self) -> tuple[Any, ...]:
        value = np.broadcast_to(np.asarray(self.value, dtype=float), 3)
        direction = tuple(map(float, self.direction))
        return direction, tuple(map(float, value)), self.spectrum, self.distance_mm, self.radius_rad


AnyLights = Union[Light, str, tuple, Iterable[Union[Light, str, tuple]], None]


def divided(lights: AnyLights, parameters: dict[str, Any]) -> list[tuple[Any, ...]]:
    """The Light objects; texts and tuples ("12,8:1000", (12, 8)) become the parameter "light"."""
    if lights is None:
        return []
    if isinstance(lights, (Light, str, tuple)):
        lights = [lights]
    objects, texts = [], []
    for light in lights:
        if isinstance(light, Light):
            objects.append(light._fields())
        else:
            texts.append(light)
    if texts:
        given = parameters.get("light", [])
        parameters["light"] = texts + (given if isinstance(given, list) else [given])
    return objects


@dataclass(frozen=True, eq=False)
class Flare:
    """The flare that lights add to a photograph, in their own units."""

    image: np.ndarray  # float32 (height, width, 3), linear; the array given as `out`, if any
    statistics: dict[str, Any]  # time by phase in ms, rays, primitives, ghosts rendered, memory

    def _repr_png_(self) -> bytes:
        return png_of(self.image)


@dataclass(frozen=True, eq=False)
class LayeredFlare(Flare):
    """A flare, and layers that sum to it."""

    layers: dict[str, np.ndarray]  # by name, float32 (height, width, 3)


def _without_fit(parameters: dict[str, Any]) -> tuple[Optional[_native.Polynomials], dict[str, Any]]:
    """The fit that is an object in place of a file's name, and the other parameters."""
    fit = parameters.get("fit")
    if not isinstance(fit, Polynomials):
        return None, parameters
    return fit._native, {name: value for name, value in parameters.items() if name != "fit"}


def _set_lens(renderer: _native.Renderer, state: LensState, fit: Optional[_native.Polynomials] = None) -> None:
    renderer.set_fit(fit)
    if state._measured is not None:
        renderer.set_flare(state._measured)
    else:
        renderer.set_lens(state._native)


def _sized_by(out: Optional[np.ndarray], window: Optional[Window], parameters: dict[str, Any]) -> dict[str, Any]:
    """The parameters, with the size of an array that receives the whole frame."""
    if out is None or window is not None:
        return parameters
    return {**parameters, "height": out.shape[0], "width": out.shape[1]}


class Renderer:
    """A renderer that lives from frame to frame: it keeps what frames have in common (reflectances, patterns, memory),
    and its pictures are those of render(), bit for bit. One thread at a time uses it.

        renderer = contrejour.Renderer("heliar", f_number=8, width=960, height=640)
        for angle in range(20):
            flare = renderer.render(f"{angle},5:1000")
    """

    def __init__(self, lens: Optional[AnyLens] = None, *, preset: Optional[str] = None, **parameters: Any) -> None:
        self._native = _native.Renderer()
        self._fit, parameters = _without_fit(parameters)
        self.lens = configured(lens, preset, parameters)

    def render(
        self,
        lights: AnyLights = None,
        *,
        window: Optional[Window] = None,
        out: Optional[np.ndarray] = None,
        progress: Optional[Progress] = None,
        cancel: Optional[CancelFlag] = None,
        preset: Optional[str] = None,
        **parameters: Any,
    ) -> Flare:
        """One frame; parameters count for this frame alone. See render()."""
        objects = divided(lights, parameters)
        fit, parameters = _without_fit(_sized_by(out, window, parameters))
        state = configured(self.lens, preset, parameters)
        _set_lens(self._native, state, fit or self._fit)
        return Flare(*self._native.render(state._values, objects, window, out, progress, cancel))

    def render_layers(
        self,
        lights: AnyLights = None,
        *,
        by: str = "part",
        count: int = 10,
        min_percent: float = 0.0,
        progress: Optional[Progress] = None,
        cancel: Optional[CancelFlag] = None,
        **parameters: Any,
    ) -> LayeredFlare:
        """One frame in layers. See render_layers()."""
        objects = divided(lights, parameters)
        fit, parameters = _without_fit(parameters)
        state = configured(self.lens, None, parameters)
        _set_lens(self._native, state, fit or self._fit)
        return LayeredFlare(
            *self._native.render_layers(state._values, objects, by, count, min_percent, progress, cancel)
        )

    def starburst(
        self,
        lights: AnyLights = None,
        *,
        progress: Optional[Progress] = None,
        cancel: Optional[CancelFlag] = None,
        **parameters: Any,
    ) -> Picture:
        """The lights' own images alone. See starburst()."""
        objects = divided(lights, parameters)
        fit, parameters = _without_fit(parameters)
        state = configured(self.lens, None, parameters)
        _set_lens(self._native, state, fit or self._fit)
        return self._native.starburst(state._values, objects, progress, cancel)


def render(
    lens: Optional[AnyLens] = None,
    lights: AnyLights = None,
    *,
    window: Optional[Window] = None,
    out: Optional[np.ndarray] = None,
    progress: Optional[Progress] = None,
    cancel: Optional[CancelFlag] = None,
    preset: Optional[str] = None,
    **parameters: Any,
) -> Flare:
    """Renders the flare of lights in a lens.

        render("heliar", "12,8:1000", f_number=8, width=960, height=640)

    lens: a bundled name, a file, a Prescription or a LensState; without one, that of the preset.
    lights: Light objects, texts as of the parameter "light" ("12,8:1000:3200K"), tuples of degrees (12, 8), or a list
        of these; without any, one light at u, v = 0.70, 0.33.
    window: (x, y, width, height) in pixels from the frame's top left corner: only these are rendered, and the image has
        that size. They equal the whole frame's to the method's error, and C++'s window bit for bit.
    out: a float32 or float16 array of shape (height, width, 3 or more), of any strides, to render into.
    progress: called with rising numbers from 0 to 1, from any thread; what it raises ends the call.
    cancel: ends the call, which then raises CancelledError, when another thread sets the flag.
    preset: a bundled preset or a file; parameters override it.
    parameters: any of parameters(), by name: width and height (px), f_number, focus, blades, method, wavelengths, ...
        fit is a file or Polynomials.

    Ctrl-C ends the call. Other Python threads run while it computes.
    """
    objects = divided(lights, parameters)
    fit, parameters = _without_fit(_sized_by(out, window, parameters))
    state = configured(lens, preset, parameters)
    renderer = _native.Renderer()
    _set_lens(renderer, state, fit)
    return Flare(*renderer.render(state._values, objects, window, out, progress, cancel))


def render_layers(
    lens: Optional[AnyLens] = None,
    lights: AnyLights = None,
    *,
    by: str = "part",
    count: int = 10,
    min_percent: float = 0.0,
    progress: Optional[Progress] = None,
    cancel: Optional[CancelFlag] = None,
    preset: Optional[str] = None,
    **parameters: Any,
) -> LayeredFlare:
    """The flare in layers that sum to it (docs/layers.md).

    by: "light", "ghost", "part" or "surface".
    count, min_percent: by ghost, how many have a layer of their own, the brightest, and the percentage of the flux that
        such a ghost has at least; the others are in the layer "rest".
    lens, lights, progress, cancel, preset, parameters: as of render().
    """
    renderer = Renderer(lens, preset=preset)
    return renderer.render_layers(
        lights, by=by, count=count, min_percent=min_percent, progress=progress, cancel=cancel, **parameters
    )


def starburst(
    lens: AnyLens,
    lights: AnyLights = None,
    *,
    progress: Optional[Progress] = None,
    cancel: Optional[CancelFlag] = None,
    preset: Optional[str] = None,
    **parameters: Any,
) -> Picture:
    """The lights' own images, spread by diffraction at the iris, without ghosts: float32 (height, width, 3). Each sums
    to its light's value over the whole plane. lens, lights and parameters: as of render()."""
    return Renderer(lens, preset=preset).starburst(lights, progress=progress, cancel=cancel, **parameters)
