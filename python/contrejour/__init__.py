# SPDX-License-Identifier: Apache-2.0
"""Contrejour: physically based lens flare.

    import contrejour
    flare = contrejour.render("heliar", "12,8:1000", f_number=8, width=960, height=640)
    flare.image                                  # float32 (640, 960, 3), linear
    contrejour.ghosts("heliar", "12,8")[0]       # the brightest ghost
    contrejour.apply(photograph, preset="old-portrait").image

Functions take every parameter of parameters() as a keyword argument, in the units that it names. Lengths are in mm,
wavelengths in nm, pixels linear; a picture is an array of shape (height, width, channels), rows from the top.
"""
from ._errors import CancelledError, Error, InvalidArgumentError, IoError, ParseError, UnsupportedError
from ._lenses import (
    FirstOrder,
    LensState,
    MeasuredFlare,
    Prescription,
    SectionLine,
    SeidelSums,
    Surface,
    bundled_lenses,
    configure_lens,
    find_lens,
    read_flare,
    read_lens_toml,
)
from ._native import CancelFlag
from ._native import version as __version__
from ._optics import (
    Coating,
    Film,
    Glass,
    bundled_glasses,
    bundled_spectra,
    closest_glasses,
    coating_designs,
    find_glass,
    read_coating,
    spectral_power,
    spectrum_rgb,
)
from ._pictures import (
    AppliedFlare,
    Comparison,
    DetectedLight,
    Detection,
    apply,
    compare,
    detect_lights,
    png_of,
    read_picture,
    write_picture,
)
from ._direct_polynomials import CameraRays, DirectPolynomials, fit_direct_polynomials, read_direct_polynomials
from ._polynomials import PolynomialRays, Polynomials, fit_polynomials, read_polynomials
from ._rays import GhostFigures, TracedRays, ghosts, trace
from ._rendering import Flare, LayeredFlare, Light, Renderer, render, render_layers, starburst
from ._settings import Parameter, Preset, bundled_presets, find_preset, parameters

__all__ = [
    "AppliedFlare",
    "CameraRays",
    "CancelFlag",
    "CancelledError",
    "Coating",
    "Comparison",
    "DetectedLight",
    "Detection",
    "DirectPolynomials",
    "Error",
    "Film",
    "FirstOrder",
    "Flare",
    "GhostFigures",
    "Glass",
    "InvalidArgumentError",
    "IoError",
    "LayeredFlare",
    "LensState",
    "Light",
    "MeasuredFlare",
    "Parameter",
    "ParseError",
    "PolynomialRays",
    "Polynomials",
    "Prescription",
    "Preset",
    "Renderer",
    "SectionLine",
    "SeidelSums",
    "Surface",
    "TracedRays",
    "UnsupportedError",
    "__version__",
    "apply",
    "bundled_glasses",
    "bundled_lenses",
    "bundled_presets",
    "bundled_spectra",
    "closest_glasses",
    "coating_designs",
    "compare",
    "configure_lens",
    "detect_lights",
    "find_glass",
    "find_lens",
    "find_preset",
    "fit_direct_polynomials",
    "fit_polynomials",
    "ghosts",
    "parameters",
    "png_of",
    "read_coating",
    "read_direct_polynomials",
    "read_flare",
    "read_lens_toml",
    "read_picture",
    "read_polynomials",
    "render",
    "render_layers",
    "spectral_power",
    "spectrum_rgb",
    "starburst",
    "trace",
    "write_picture",
]
