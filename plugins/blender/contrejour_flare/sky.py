# SPDX-License-Identifier: Apache-2.0
"""The sun of Blender's Nishita sky: its irradiance after the air.

Nishita 1993's atmosphere as Cycles has it: air and dust whose densities fall with e^(-height / scale height), which
scatter by lambda^-4 and alike at all wavelengths. The sun is dimmed by the optical depth along the ray towards it. The
irradiance above the air is what Cycles 3.4 renders with both densities at 0. Ozone does not dim its sun.
"""
from __future__ import annotations

import math

import numpy as np

from .photometry import rgb_of_spectrum

_SUN_ABOVE_AIR = np.array([161.9, 142.1, 132.4])  # measured in Cycles: mean radiance of the disc by its solid angle
_EARTH_RADIUS_M = 6360e3
_AIR_TOP_M = 60e3
_AIR_HEIGHT_M, _DUST_HEIGHT_M = 8000.0, 1200.0
_AIR_AT_380_PER_M, _DUST_PER_M = 5.4248e-5, 2e-5
_STEPS = 400


def sun_irradiance(elevation_rad: float, altitude_m: float, air: float, dust: float) -> np.ndarray:
    """RGB at right angles to the sun, for densities of which 1 is a clear day's; 0 below the horizon."""
    depths = _column_m(elevation_rad, altitude_m)
    if depths is None:
        return np.zeros(3)
    wavelengths_nm = np.arange(380.0, 781.0, 10.0)
    air_depth = air * _AIR_AT_380_PER_M * (380.0 / wavelengths_nm) ** 4 * depths[0]
    transmittance = np.exp(-air_depth - dust * _DUST_PER_M * depths[1])
    without_air = rgb_of_spectrum(wavelengths_nm, np.ones_like(wavelengths_nm))
    return np.maximum(0.0, _SUN_ABOVE_AIR * rgb_of_spectrum(wavelengths_nm, transmittance) / without_air)


def _column_m(elevation_rad: float, altitude_m: float) -> tuple[float, float] | None:
    """The lengths of air and of dust of the ground's density along the ray; None where the earth is in its way."""
    start = _EARTH_RADIUS_M + max(altitude_m, 1.0)
    sine = math.sin(elevation_rad)
    if sine < 0.0 and start * math.cos(elevation_rad) < _EARTH_RADIUS_M:
        return None
    top = _EARTH_RADIUS_M + _AIR_TOP_M
    end = -start * sine + math.sqrt(max(0.0, (start * sine) ** 2 + top**2 - start**2))
    # Steps that grow with the distance: the density changes near the ground.
    edges = end * np.linspace(0.0, 1.0, _STEPS + 1) ** 2
    along, step = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)
    height = np.sqrt(start**2 + along**2 + 2.0 * start * along * sine) - _EARTH_RADIUS_M
    return float(np.exp(-height / _AIR_HEIGHT_M) @ step), float(np.exp(-height / _DUST_HEIGHT_M) @ step)
