# SPDX-License-Identifier: Apache-2.0
"""Intensities and radiances of Blender's lamps. docs/blender.md has the formulas, and how Cycles confirmed them.

Intensities are per steradian, radiances per steradian and square unit of length, in a rendered pixel's units.
"""
from __future__ import annotations

import math

import numpy as np


def point_intensity(power: float) -> float:
    """A point lamp's intensity is alike in all directions."""
    return power / (4.0 * math.pi)


def spot_factor(cosine: float, cone_rad: float, blend: float) -> float:
    """The part of a spot's intensity that remains at an angle to its axis: Cycles has the cosine, and a smooth step at
    the cone's edge. cone_rad is the whole angle."""
    edge = math.cos(0.5 * cone_rad)
    inside = cosine - edge
    if inside <= 0.0:
        return 0.0
    width = (1.0 - edge) * blend
    if inside >= width:
        return cosine
    part = inside / width
    return cosine * part * part * (3.0 - 2.0 * part)


def area_radiance(power: float, area: float) -> float:
    """An area lamp's radiance at its front."""
    return power / (4.0 * area) if area > 0.0 else 0.0


def spread_factor(cosines: np.ndarray, spread_rad: float) -> np.ndarray:
    """The factor by which an area lamp's spread (the whole angle, pi: none) changes its radiance at equal power."""
    half = 0.5 * spread_rad
    cosines = np.maximum(cosines, 1e-9)
    if half >= 0.5 * math.pi - 1e-6:
        return np.ones_like(cosines)
    slope = 1.0 / math.tan(half)
    tangents = np.sqrt(np.maximum(0.0, 1.0 - cosines**2)) / cosines
    return np.maximum(0.0, 1.0 - slope * tangents) / (1.0 - half * slope)


def blackbody_rgb(kelvin: float) -> tuple[float, float, float]:
    """Linear Rec.709 of a black body, with luminance 1, from Planck's law and Wyman's fits of the CIE 1931 observer."""
    wavelengths_nm = np.arange(380.0, 781.0, 5.0)
    radiance = wavelengths_nm**-5.0 / np.expm1(1.4388e7 / (wavelengths_nm * max(kelvin, 800.0)))
    rgb = np.maximum(0.0, rgb_of_spectrum(wavelengths_nm, radiance))
    luminance = float(rgb @ LUMINANCE)
    return tuple(float(channel) / luminance for channel in rgb)


LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
_RGB_FROM_XYZ = np.array([[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]])


def rgb_of_spectrum(wavelengths_nm: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Linear Rec.709 (D65) of a spectrum on equal steps: the sum over its values times the step in nm."""
    step_nm = wavelengths_nm[1] - wavelengths_nm[0]
    return _RGB_FROM_XYZ @ (_cie_1931(wavelengths_nm) @ values) * step_nm


def _cie_1931(wavelengths_nm: np.ndarray) -> np.ndarray:
    """The observer's three functions (3, n): Wyman, Sloan, Shirley 2013, multi-lobe fits."""

    def lobe(height: float, middle_nm: float, below: float, above: float) -> np.ndarray:
        slope = np.where(wavelengths_nm < middle_nm, below, above)
        return height * np.exp(-0.5 * ((wavelengths_nm - middle_nm) * slope) ** 2)

    x = lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323) + lobe(-0.065, 501.1, 0.0490, 0.0382)
    y = lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322)
    z = lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725)
    return np.stack([x, y, z])
