# SPDX-License-Identifier: Apache-2.0
"""Rays in bulk, and the ghosts of a lens."""
from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, Optional, Sequence

import numpy as np

from . import _native
from ._lenses import AnyLens, configured
from ._native import CancelFlag
from ._rendering import AnyLights, Progress, divided


@dataclass(frozen=True, eq=False)
class TracedRays:
    """n rays at the sensor. The rays are not clipped; blocked_by says which get through."""

    status: np.ndarray  # uint8 (n,): 0 ok, 1 missed a surface, 2 total reflection, 3 not finite
    sensor_mm: np.ndarray  # float64 (n, 2): right and up in the picture are negative
    direction: np.ndarray  # float64 (n, 3)
    transmission: np.ndarray  # float64 (n,): product of the reflectances and transmittances along the path
    relative_height: np.ndarray  # float64 (n,): largest distance from the axis over the clear semi-diameter
    blocked_by: np.ndarray  # float64 (n,): how far outside rims and iris; <= 0 gets through
    stop: np.ndarray  # float64 (n, crossings, 2): stop coordinates over the stop's radius at each crossing

    @property
    def passed(self) -> np.ndarray:
        """bool (n,): the rays that reach the sensor."""
        return (self.status == 0) & (self.blocked_by <= 0)


def trace(
    lens: AnyLens,
    origins_mm: np.ndarray,
    directions: np.ndarray,
    *,
    ghost: Sequence[int] = (),
    lambda_nm: Optional[float] = None,
    out: Optional[TracedRays] = None,
    progress: Optional[Progress] = None,
    cancel: Optional[CancelFlag] = None,
    **parameters: Any,
) -> TracedRays:
    """Traces n rays along one path: the direct one, or a ghost's.

    origins_mm, directions: (n, 3); z = 0 at the first vertex, light travels to +z; directions need not have length 1.
    ghost: (i, j) or (i, j, k, l), surfaces from 1: the light reflects first at j, then at i.
    lambda_nm: without it, the lens's design wavelength.
    out: receives the results: those of an earlier call for as many rays, whose path crossed the stop as often. New
        arrays take eighty bytes a ray, for which the system needs a few per cent of the time of tracing.
    progress, cancel, parameters: as of render(). threads=1 traces on one thread, with the same results.
    """
    state = configured(lens, None, parameters)
    state._require_surfaces()
    wavelength_nm = lambda_nm or state.design_wavelength_nm
    arrays = None if out is None else tuple(getattr(out, field.name) for field in fields(out))
    traced = _native.trace(
        state._native, list(ghost), wavelength_nm, origins_mm, directions, state._values, arrays, progress, cancel
    )
    return out if out is not None else TracedRays(*traced)


@dataclass(frozen=True)
class GhostFigures:
    """A ghost for one light. Fluxes are accurate to 1e-3, positions and sizes to a hundredth of the size."""

    surfaces: tuple[int, ...]  # (i, j) or (i, j, k, l), from 1: reflected first at j, then at i
    relative_flux: float  # luminance of rgb
    rgb: tuple[float, float, float]  # flux over the direct image's flux, per channel
    peak_irradiance: float  # over the light's irradiance at the front, as a mean over a pixel
    reflectance: float  # product of its surfaces' reflectances at normal incidence
    centroid_px: tuple[float, float]  # flux-weighted middle
    size_px: tuple[float, float]  # sides of the box around its footprint
    centroid_mm: tuple[float, float]  # on the sensor: right and up in the picture are negative
    size_mm: tuple[float, float]
    focus_mm: Optional[float]  # from the sensor to its paraxial focus, positive behind; None: it leaves parallel
    blur_mm: float  # first-order diameter of its spot on the sensor
    in_focus: bool
    pupil_ghost: bool  # an image of the stop that stays in the middle of the picture

    @property
    def name(self) -> str:
        return "-".join(map(str, self.surfaces))


def ghosts(
    lens: Optional[AnyLens] = None,
    light: AnyLights = None,
    *,
    progress: Optional[Progress] = None,
    cancel: Optional[CancelFlag] = None,
    preset: Optional[str] = None,
    **parameters: Any,
) -> list[GhostFigures]:
    """The ghosts of a lens for one light, in order of decreasing flux. Fluxes are relative to the light's, so that its
    value does not matter. lens, light, progress, cancel, preset, parameters: as of render()."""
    objects = divided(light, parameters)
    state = configured(lens, preset, parameters)
    state._require_surfaces()
    found = _native.ghosts(state._native, state._values, objects[0] if objects else None, progress, cancel)
    return [GhostFigures(**fields) for fields in found]
