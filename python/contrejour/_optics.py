# SPDX-License-Identifier: Apache-2.0
"""Glasses, coatings and spectra. Wavelengths in nm, angles in degrees; arrays of any shape in, the same shape out."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _native


class Glass:
    """An optical medium; find_glass() makes one."""

    def __init__(self, native: _native.Glass) -> None:
        self._native = native
        self._figures = native.figures()

    @property
    def name(self) -> str:
        return self._figures["name"]

    @property
    def index_d(self) -> float:
        """At 587.6 nm."""
        return self._figures["index_d"]

    @property
    def abbe_d(self) -> float:
        """(n_d - 1) / (n_F - n_C); not finite without dispersion."""
        return self._figures["abbe_d"]

    @property
    def abbe_e(self) -> float:
        return self._figures["abbe_e"]

    @property
    def p_gf(self) -> float:
        """Partial dispersion (n_g - n_F) / (n_F - n_C)."""
        return self._figures["p_gf"]

    @property
    def range_nm(self) -> Optional[tuple[float, float]]:
        """Where the glass's formula holds; None: unknown."""
        return self._figures["range_nm"]

    def index(self, lambda_nm: ArrayLike) -> np.ndarray:
        """The refractive index relative to air at each wavelength."""
        lambda_nm = np.asarray(lambda_nm, dtype=float)
        return self._native.index(lambda_nm.ravel()).reshape(lambda_nm.shape)

    def transmittance(self, lambda_nm: ArrayLike, path_mm: float) -> np.ndarray:
        """The internal transmittance of a path; 1 where the catalogue has no measurements."""
        lambda_nm = np.asarray(lambda_nm, dtype=float)
        return self._native.transmittance(path_mm, lambda_nm.ravel()).reshape(lambda_nm.shape)

    def __repr__(self) -> str:
        return f"<Glass {self.name!r}, n_d {self.index_d:.5f}, V_d {self.abbe_d:.2f}>"


AnyGlass = Union[Glass, str]


def find_glass(text: Union[str, float]) -> Glass:
    """A glass by name ("N-BK7", "SCHOTT N-BK7"), six-digit code ("517642"), index ("1.52"), n_d and Abbe number
    ("1.5168,64.17"), or "air". Errors: no such glass; the message names the nearest."""
    return Glass(_native.find_glass(str(text)))


def _glass(glass: AnyGlass) -> Glass:
    return glass if isinstance(glass, Glass) else find_glass(glass)


def bundled_glasses() -> list[str]:
    """The names of the glasses that come with the library, with their makers: "SCHOTT N-BK7"."""
    return _native.bundled_glasses()


def closest_glasses(index_d: float, abbe_d: float, count: int = 5) -> list[str]:
    """The names of the glasses nearest to an index and an Abbe number, nearest first."""
    return _native.closest_glasses(index_d, abbe_d, count)


@dataclass(frozen=True)
class Film:
    """A layer of a coating."""

    material: str  # "MgF2"; empty: the same index at every wavelength
    index: complex  # n + i k at 550 nm
    thickness_nm: float


class Coating:
    """Thin films on a surface; read_coating() makes one. Exact for plane films of any number, unpolarised light."""

    def __init__(self, native: _native.Coating) -> None:
        self._native = native

    @property
    def films(self) -> list[Film]:
        """From air to glass; empty for a design, whose films on_glass() computes."""
        return [Film(*film) for film in self._native.films()]

    def on_glass(self, glass: AnyGlass) -> Coating:
        """The films of a design, a quarter wave or a stack on a glass."""
        return Coating(self._native.on_glass(_glass(glass)._native))

    def _powers(self, of: str, glass: AnyGlass, lambda_nm: ArrayLike, angle_deg: ArrayLike) -> np.ndarray:
        nm, deg = np.broadcast_arrays(np.asarray(lambda_nm, dtype=float), np.asarray(angle_deg, dtype=float))
        powers = getattr(self._native, of)(_glass(glass)._native, nm.ravel(), np.radians(deg.ravel()))
        return powers.reshape(nm.shape)

    def reflectance(self, glass: AnyGlass, lambda_nm: ArrayLike, angle_deg: ArrayLike = 0.0) -> np.ndarray:
        """Of the coated glass in air, for light from air; wavelengths and angles of incidence are broadcast."""
        return self._powers("reflectance", glass, lambda_nm, angle_deg)

    def transmittance(self, glass: AnyGlass, lambda_nm: ArrayLike, angle_deg: ArrayLike = 0.0) -> np.ndarray:
        """Of the coated surface: 1 - reflectance unless a film absorbs."""
        return self._powers("transmittance", glass, lambda_nm, angle_deg)

    def refined(
        self, glass: AnyGlass, lambda_nm: ArrayLike, target: ArrayLike, weight: Optional[ArrayLike] = None
    ) -> Coating:
        """The films with thicknesses that bring the reflectance at normal incidence nearest to `target` (0 to 1, one a
        wavelength or one for all) in the sense of weighted least squares. The optimum is local."""
        nm = np.atleast_1d(np.asarray(lambda_nm, dtype=float))
        targets = np.broadcast_to(np.asarray(target, dtype=float), nm.shape)
        weights = None if weight is None else np.broadcast_to(np.asarray(weight, dtype=float), nm.shape)
        return Coating(self._native.refined(_glass(glass)._native, nm, targets, weights))

    def to_text(self) -> str:
        """A stack as a value of the parameter "coating": "stack:MgF2@99.6,ZrO2@137.2"."""
        films = self.films
        if not films:
            raise ValueError("the coating has no films; on_glass() gives a design's")
        if any(not film.material and film.index.imag for film in films):
            raise ValueError("a film that absorbs has no text unless it is of a catalogued material")
        names = [film.material or repr(film.index.real) for film in films]
        return "stack:" + ",".join(f"{name}@{film.thickness_nm:.4f}" for name, film in zip(names, films))

    def __str__(self) -> str:
        return self._native.description()

    def __repr__(self) -> str:
        return f"<Coating {self._native.description()!r}>"


def read_coating(text: str) -> Coating:
    """A coating as the parameter "coating" takes it: "v-coat:550", "broadband-6", "stack:MgF2@99.6,ZrO2@137" from air to
    glass, "measured:FILE", "none"."""
    return Coating(_native.read_coating(text))


def coating_designs() -> list[str]:
    """The names of the designs: "v-coat", "broadband-6", ..."""
    return _native.coating_designs()


def bundled_spectra() -> dict[str, str]:
    """The lamps that come with the library, and what they are."""
    return _native.bundled_spectra()


def spectral_power(spectrum: str, lambda_nm: ArrayLike) -> np.ndarray:
    """The relative power of a light's spectrum ("D65", "3200K", "sodium", a file) at each wavelength."""
    lambda_nm = np.asarray(lambda_nm, dtype=float)
    return _native.spectral_power(spectrum, lambda_nm.ravel()).reshape(lambda_nm.shape)


def spectrum_rgb(spectrum: str, colour_space: str = "rec709") -> tuple[float, float, float]:
    """The linear colour of a spectrum with luminance 1; D65 is (1, 1, 1). colour_space: "rec709" or "acescg"."""
    if colour_space not in ("rec709", "acescg"):
        raise ValueError(f"{colour_space!r} is not a colour space; give rec709 or acescg")
    return _native.spectrum_rgb(spectrum, colour_space == "acescg")
