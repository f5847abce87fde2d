# SPDX-License-Identifier: Apache-2.0
"""A lens's direct image as polynomials: camera rays for path tracers and renderers of bokeh, and the way back."""
from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from ._lenses import AnyLens, configured
from ._native import CancelFlag


@dataclass(frozen=True, eq=False)
class CameraRays:
    """n rays in front of a lens; NaN where there is none. Rays go to -z: x points right and y up in the scene."""

    origin_mm: np.ndarray  # float64 (n, 3): in the front plane
    direction: np.ndarray  # float64 (n, 3): unit, to the scene
    relative_height: np.ndarray  # float64 (n,): the largest at the rims that can block; above 1 is blocked
    transmittance: np.ndarray  # float64 (n,)
    # float64 (n,): projected solid angle at the sensor by area of the stop, in which the widest stop is the unit disc
    weight: np.ndarray


class DirectPolynomials:
    """The fit of a lens's direct image; fit_direct_polynomials() and read_direct_polynomials() make one."""

    def __init__(self, native: _native.DirectPolynomials) -> None:
        self._native = native

    @property
    def lens(self) -> str:
        """The lens's name."""
        return self._native.lens

    @property
    def order(self) -> int:
        """The highest order of the rays' coordinates."""
        return self._native.order

    @property
    def focal_length_mm(self) -> float:
        """The focal length."""
        return self._native.focal_length_mm

    @property
    def front_z_mm(self) -> float:
        """The plane in which rays are given, from the first vertex."""
        return self._native.front_z_mm

    @property
    def sensor_z_mm(self) -> float:
        """The sensor, from the first vertex."""
        return self._native.sensor_z_mm

    @property
    def stop_radius_mm(self) -> float:
        """The radius of the widest stop, in which stop points are given."""
        return self._native.stop_radius_mm

    @property
    def max_height_mm(self) -> float:
        """The largest distance of a sensor's point from the axis."""
        return self._native.max_height_mm

    @property
    def accuracy(self) -> dict[str, Any]:
        """The errors of rays that were left out of the fit, as `contrejour polynomial info --json` has them."""
        return dict(self._native.accuracy())

    def rays(self, sensor_mm: ArrayLike, stop: ArrayLike, lambda_nm: float = 587.56) -> CameraRays:
        """The camera rays from n points (n, 2) of the sensor through n points (n, 2) of the stop, in widest radii."""
        return CameraRays(
            *self._native.rays(np.asarray(sensor_mm, dtype=float), np.asarray(stop, dtype=float), lambda_nm)
        )

    def sensor_points(
        self, points_mm: ArrayLike, stop: ArrayLike, lambda_nm: float = 587.56, *, distant: bool = False
    ) -> np.ndarray:
        """The points (n, 2) of the sensor at which light from points (n, 3) of the scene arrives through n points of the
        stop; NaN outside of the fit. distant: the points are directions to points at infinity."""
        return self._native.sensor_points(
            np.asarray(points_mm, dtype=float), distant, np.asarray(stop, dtype=float), lambda_nm
        )

    def at_wavelength(self, lambda_nm: float) -> DirectPolynomials:
        """The polynomials at one wavelength, which are smaller and faster and ignore the wavelength that they are given."""
        return DirectPolynomials(self._native.at_wavelength(lambda_nm))

    def source(self, language: str, prefix: str = "lens_") -> str:
        """Source code without this library: "c", "glsl", "hlsl" or "python" (docs/polynomial-export.md)."""
        return self._native.source(language, prefix)

    def write(self, file: Union[str, "os.PathLike[str]"]) -> None:
        """Writes a file (docs/formats/poly.md)."""
        Path(file).write_bytes(self._native.written())

    def __repr__(self) -> str:
        return f"<DirectPolynomials of {self.lens!r}, order {self.order}>"


def fit_direct_polynomials(
    lens: AnyLens,
    *,
    max_order: int = 17,
    progress: Any = None,
    cancel: Optional[CancelFlag] = None,
    **parameters: Any,
) -> DirectPolynomials:
    """Fits the direct image of a lens: fit_direct_polynomials("planar-50", focus=2000).

    max_order: odd, 5 to 17. progress, cancel: as of render(). parameters: of the lens, and "threads".
    Errors: UnsupportedError for lenses without axial symmetry.
    """
    state = configured(lens, None, parameters)
    state._require_surfaces()
    return DirectPolynomials(
        _native.fit_direct_polynomials(state._native, state._values, max_order, progress, cancel)
    )


def read_direct_polynomials(file: Union[str, "os.PathLike[str]"]) -> DirectPolynomials:
    """A fit that DirectPolynomials.write() or `contrejour polynomial fit --direct` wrote."""
    return DirectPolynomials(_native.read_direct_polynomials(Path(file).read_bytes(), os.fspath(file)))
