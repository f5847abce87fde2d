# SPDX-License-Identifier: Apache-2.0
"""Ghosts fitted by polynomials, once for the whole field, all visible wavelengths and every f-number."""
from __future__ import annotations

import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from ._lenses import AnyLens, configured
from ._native import CancelFlag

_Ends = tuple[float, float]


@dataclass(frozen=True, eq=False)
class PolynomialRays:
    """n evaluated rays. The light comes from -x; a ray with a relative height or a distance from the stop's centre above
    1 is blocked."""

    sensor_mm: np.ndarray  # float64 (n, 2)
    stop: np.ndarray  # float64 (n, crossings, 2): over the radius of the widest stop
    relative_height: np.ndarray  # float64 (n,): the largest at the rims that can block
    transmittance: np.ndarray  # float64 (n,)

    @property
    def passed(self) -> np.ndarray:
        """bool (n,): the rays that get through the wide open lens."""
        return (self.relative_height <= 1) & (np.hypot(self.stop[..., 0], self.stop[..., 1]) <= 1).all(axis=1)


class Polynomials:
    """The fit of a lens's ghosts; fit_polynomials() and read_polynomials() make one. render() takes it:

        fit = contrejour.fit_polynomials("nikon-80-200", zoom=(80, 200), ghosts="one-side")
        contrejour.render("nikon-80-200", "8,3:1000", focal=120, ghosts="one-side", method="polynomial", fit=fit)
    """

    def __init__(self, native: _native.Polynomials) -> None:
        self._native = native

    @property
    def lens(self) -> str:
        """The lens's name."""
        return self._native.lens

    @property
    def is_range(self) -> bool:
        """Of a range of zoom or focus; at() has the fit of one of its states."""
        return self._native.is_range

    @property
    def half_field_deg(self) -> float:
        """The largest angle of a light to the axis."""
        return math.degrees(math.atan(self._native.max_field))

    @property
    def entrance_z_mm(self) -> float:
        """The plane in which rays enter, from the first vertex."""
        return self._native.entrance_z_mm

    @property
    def traced_flux(self) -> float:
        """The fraction of the ghosts' flux that the fit does not reach its accuracy for, whose rays are traced."""
        return self._native.traced_flux

    @property
    def ghosts(self) -> dict[tuple[int, ...], list[dict[str, Any]]]:
        """The zones of the field of each ghost, by its surfaces: their state ("fitted", "traced" or "dark"), the
        tangents at which they begin and end (of ghosts without axial symmetry, the lowest x and y and the highest), order, the errors of rays that were left out of the fit, and flux. Those of
        a range are its zones at all nodes."""
        return dict(self._native.ghosts())

    def at(self, lens: AnyLens, **parameters: Any) -> Polynomials:
        """The fit of one state of a range: at("nikon-80-200", focal=120)."""
        return Polynomials(self._native.at(configured(lens, None, parameters)._native))

    def evaluate(
        self,
        ghost: Sequence[int],
        field_deg: Union[float, tuple[float, float]],
        entrance_mm: ArrayLike,
        lambda_nm: float = 587.56,
    ) -> PolynomialRays:
        """The rays of a distant light through n points (n, 2) of the entrance plane, in the light's meridional frame.
        For a ghost without axial symmetry, field_deg is a pair, the angles whose tangents are the direction's x / z and
        y / z, and the frame is the lens's.

        Errors: ValueError for a fit of a range, and where the ghost has no polynomials at that angle.
        """
        points = np.asarray(entrance_mm, dtype=float)
        field: Union[float, tuple[float, ...]]
        if isinstance(field_deg, tuple):
            field = tuple(math.tan(math.radians(angle)) for angle in field_deg)
        else:
            field = math.tan(math.radians(field_deg))
        return PolynomialRays(*self._native.evaluate(list(ghost), field, points, lambda_nm))

    def write(self, file: Union[str, "os.PathLike[str]"]) -> None:
        """Writes a file (docs/formats/poly.md)."""
        Path(file).write_bytes(self._native.written())

    def __repr__(self) -> str:
        return f"<Polynomials of {self.lens!r}, {len(self.ghosts)} ghosts, {100 * self.traced_flux:.1f} % traced>"


def fit_polynomials(
    lens: AnyLens,
    *,
    zoom: Optional[_Ends] = None,
    focus: Optional[_Ends] = None,
    half_field_deg: float = 0.0,
    max_order: int = 17,
    only: Sequence[Sequence[int]] = (),
    progress: Any = None,
    cancel: Optional[CancelFlag] = None,
    **parameters: Any,
) -> Polynomials:
    """Fits the ghosts of a lens.

    zoom, focus: two focal lengths, or two distances of the object, in mm: one fit for all between them.
    half_field_deg: the largest angle of a light to the axis; 0: that of the sensor's corner and a tenth more.
    max_order: odd, 5 to 17.
    only: the surfaces of ghosts, (2, 5): no others are fitted. Without it, those of the parameter "ghosts".
    progress, cancel: as of render(). parameters: of the lens, and "ghosts", "reflections", "threads".
    """
    state = configured(lens, None, parameters)
    state._require_surfaces()
    options = math.radians(half_field_deg), max_order, [list(surfaces) for surfaces in only]
    if zoom is not None and focus is not None:
        raise TypeError("a fit has a range of zoom or of focus, not of both")
    ends = zoom if zoom is not None else focus
    if ends is None:
        return Polynomials(_native.fit_polynomials(state._native, state._values, *options, progress, cancel))
    variable = "zoom" if zoom is not None else "focus"
    low, high = ends
    return Polynomials(
        _native.fit_polynomial_range(
            state.prescription._native, state._values, variable, (low, high), *options, progress, cancel
        )
    )


def read_polynomials(file: Union[str, "os.PathLike[str]"]) -> Polynomials:
    """A fit that Polynomials.write() or `contrejour polynomial fit` wrote."""
    return Polynomials(_native.read_polynomials(Path(file).read_bytes(), os.fspath(file)))
