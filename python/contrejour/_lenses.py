# SPDX-License-Identifier: Apache-2.0
"""Lenses as published, configured lenses, and their figures."""
from __future__ import annotations

import math
import os
from dataclasses import dataclass
from typing import Any, Optional, Union

from . import _native
from ._settings import parameters as all_parameters
from ._settings import preset_of, values_of


@dataclass(frozen=True)
class Surface:
    """A surface of a lens. Lengths in mm; light travels to +z."""

    kind: str  # "refracting" or "stop"
    radius_mm: float  # > 0 when the centre lies behind the surface; inf: a plane
    thickness_mm: float  # to the next vertex
    semi_diameter_mm: float
    glass: str  # behind it; "air"
    index_d: float  # of that medium at 587.6 nm
    abbe_d: float  # its Abbe number; not finite without dispersion
    coating: str
    is_sphere: bool  # a centred sphere or plane


class Prescription:
    """A lens as its patent lists it. find_lens() and read_lens_toml() make one; it does not change."""

    def __init__(self, native: _native.Prescription) -> None:
        self._native = native

    @property
    def name(self) -> str:
        return self._native.name

    @property
    def source(self) -> str:
        """Patent or book."""
        return self._native.source

    @property
    def f_number(self) -> float:
        """The widest."""
        return self._native.f_number

    @property
    def sensor_mm(self) -> tuple[float, float]:
        """Width and height."""
        return self._native.sensor_width_mm, self._native.sensor_height_mm

    @property
    def zoom_mm(self) -> list[float]:
        """The nominal focal lengths of a zoom's positions; empty for a prime."""
        return self._native.zoom_mm

    @property
    def warnings(self) -> list[str]:
        """Warnings of the reader, of what it interpreted differently from the file."""
        return self._native.warnings

    @property
    def surfaces(self) -> list[Surface]:
        """From the front; surface 1 of messages and ghosts is surfaces[0]."""
        return [Surface(**fields) for fields in self._native.surfaces()]

    def with_surface(
        self,
        number: int,
        *,
        radius_mm: Optional[float] = None,
        thickness_mm: Optional[float] = None,
        semi_diameter_mm: Optional[float] = None,
        glass: Optional[str] = None,
        coating: Optional[str] = None,
    ) -> Prescription:
        """A copy in which surface `number` (from 1) is changed. glass: a name of the bundled catalogue, "air" or an
        index; coating: as the parameter "coating" takes it. Errors: no such glass; a lens that cannot be."""
        if number < 1:
            raise IndexError("surfaces count from 1")
        glass = None if glass is None else str(glass)
        changed = self._native.with_surface(number - 1, radius_mm, thickness_mm, semi_diameter_mm, glass, coating)
        return Prescription(changed)

    def configure(self, *, preset: Optional[str] = None, **parameters: Any) -> LensState:
        """See configure_lens()."""
        return configure_lens(self, preset=preset, **parameters)

    def to_toml(self) -> str:
        """The library's own format (docs/formats/lens-toml.md)."""
        return self._native.toml()

    def table(self) -> str:
        """The surfaces as text."""
        headings = f"{'':>3} {'radius mm':>11} {'thickness mm':>13} {'semi-diameter mm':>17}  glass, coating"
        rows = [self.name, headings]
        for number, s in enumerate(self.surfaces, 1):
            radius = s.kind if s.kind == "stop" else "plane" if math.isinf(s.radius_mm) else f"{s.radius_mm:.4f}"
            coating = "" if s.kind == "stop" else s.coating
            rows.append(
                f"{number:>3} {radius:>11} {s.thickness_mm:>13.4f} {s.semi_diameter_mm:>17.3f}  {s.glass:<10} {coating}"
            )
        return "\n".join(row.rstrip() for row in rows)

    __str__ = table

    def __repr__(self) -> str:
        return f"<Prescription {self.name!r}, {len(self._native.surfaces())} surfaces>"


@dataclass(frozen=True)
class FirstOrder:
    """Paraxial figures, in mm; of the y-z section unless the name says x."""

    focal_length_mm: float
    back_focal_distance_mm: float  # last vertex -> rear focal point
    front_focal_distance_mm: float  # first vertex -> front focal point; negative in front of the lens
    entrance_pupil_position_mm: float  # first vertex -> entrance pupil
    entrance_pupil_diameter_mm: float
    exit_pupil_position_mm: float  # sensor -> exit pupil; negative towards the lens
    exit_pupil_diameter_mm: float
    f_number: float
    sensor_position_mm: float  # last vertex -> sensor
    half_field_rad: float  # of the sensor's half diagonal
    focal_length_x_mm: float
    back_focal_distance_x_mm: float


@dataclass(frozen=True)
class SeidelSums:
    """Third-order aberrations in mm of path: S_I to S_V, and C_I, C_II from the F to the C line."""

    spherical: float
    coma: float
    astigmatism: float
    petzval: float
    distortion: float
    axial_colour: float
    lateral_colour: float


class LensState:
    """A lens configured for a picture: zoom, f-number, focus, iris, coatings. configure_lens() makes one."""

    def __init__(self, native: _native.LensState, prescription: Prescription, values: _native.Values) -> None:
        self._native = native
        self._values = values
        self.prescription = prescription

    @property
    def name(self) -> str:
        return self._native.name

    @property
    def focal_length_mm(self) -> float:
        return self._native.focal_length_mm

    @property
    def f_number(self) -> float:
        return self._native.f_number

    @property
    def object_distance_mm(self) -> float:
        """Focus: from surface 1; inf."""
        return self._native.object_distance_mm

    @property
    def stop_radius_mm(self) -> float:
        return self._native.stop_radius_mm

    @property
    def sensor_mm(self) -> tuple[float, float]:
        """Width and height."""
        return self._native.sensor_width_mm, self._native.sensor_height_mm

    @property
    def sensor_z_mm(self) -> float:
        """From the first vertex."""
        return self._native.sensor_z_mm

    @property
    def design_wavelength_nm(self) -> float:
        return self._native.design_wavelength_nm

    @property
    def warnings(self) -> list[str]:
        return self._native.warnings

    def first_order(self, lambda_nm: Optional[float] = None) -> FirstOrder:
        """Figures at a wavelength; without one, at the design wavelength."""
        return FirstOrder(**self._native.first_order(lambda_nm or self.design_wavelength_nm))

    def seidel(self, lambda_nm: Optional[float] = None, half_field_rad: Optional[float] = None) -> list[SeidelSums]:
        """The sums of each surface, zero for the stop; their total is the lens's. Without a field, the sensor's."""
        lambda_nm = lambda_nm or self.design_wavelength_nm
        if half_field_rad is None:
            half_field_rad = self.first_order(lambda_nm).half_field_rad
        return [SeidelSums(*sums) for sums in self._native.seidel(lambda_nm, half_field_rad)]

    def configure(self, *, preset: Optional[str] = None, **parameters: Any) -> LensState:
        """The same lens with other parameters; those that are not given stay."""
        return configure_lens(self, preset=preset, **parameters)

    def __str__(self) -> str:
        figures = self.first_order()
        return (
            f"{self.prescription}\n{self.focal_length_mm:.2f} mm, f/{self.f_number:.3g}; entrance pupil "
            f"{figures.entrance_pupil_diameter_mm:.3f} mm at {figures.entrance_pupil_position_mm:.3f} mm, back focal "
            f"distance {figures.back_focal_distance_mm:.3f} mm"
        )

    def __repr__(self) -> str:
        return f"<LensState {self.name!r}, {self.focal_length_mm:.2f} mm, f/{self.f_number:.3g}>"


AnyLens = Union[str, "os.PathLike[str]", Prescription, LensState]


def bundled_lenses() -> list[str]:
    """The names of the lenses that come with the library."""
    return _native.bundled_lenses()


def find_lens(name_or_file: Union[str, "os.PathLike[str]"]) -> Prescription:
    """A bundled lens, or else a file in any format that the library reads (docs/formats)."""
    return Prescription(_native.find_lens(os.fspath(name_or_file)))


def read_lens_toml(text: str, file: str = "") -> Prescription:
    """The library's own format from memory; `file` names it in errors."""
    return Prescription(_native.read_lens_toml(text, file))


def configured(lens: Optional[AnyLens], preset: Optional[str], parameters: dict[str, Any]) -> LensState:
    """A lens with parameters over a preset's over those that it has already. Without a lens, the preset's."""
    base = lens._values if isinstance(lens, LensState) else _native.Values()
    if preset is not None:
        lens_of_preset, values = preset_of(preset)
        base = values.over(base)
        lens = lens if lens is not None else lens_of_preset or None
    if lens is None:
        raise TypeError("give a lens, or a preset that names one")
    given = values_of(parameters)
    values = given.over(base)
    if isinstance(lens, LensState):
        # The parameters of this group, and no others, configure a lens.
        changed = preset is not None or any(p.group == "Lens" and given.given(p.name) for p in all_parameters())
        native = _native.configure_lens(lens.prescription._native, values) if changed else lens._native
        return LensState(native, lens.prescription, values)
    prescription = lens if isinstance(lens, Prescription) else find_lens(lens)
    return LensState(_native.configure_lens(prescription._native, values), prescription, values)


def configure_lens(lens: Optional[AnyLens] = None, *, preset: Optional[str] = None, **parameters: Any) -> LensState:
    """Sets zoom (focal, mm), f-number (f_number), focus, blades, coating and all other parameters of a lens:

        configure_lens("nikon-80-200", focal=140, f_number=8, blades=7)

    What is given here is also the default of later calls with this state: lights, size, method.
    """
    return configured(lens, preset, parameters)
