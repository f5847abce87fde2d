# SPDX-License-Identifier: Apache-2.0
"""Lenses as published, configured lenses, and their figures."""
from __future__ import annotations

import math
import os
import pathlib
from dataclasses import dataclass
from typing import Any, Iterable, Optional, Sequence, Union

import numpy as np

from . import _native
from ._errors import UnsupportedError
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
        """A copy in which surface `number` (from 1) is changed. glass: as find_glass() takes it; coating: as the parameter "coating" takes it. Errors: no such glass; a lens that cannot be."""
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
        return self._native.written("toml")[0]

    def write(self, file: Union[str, "os.PathLike[str]"]) -> list[str]:
        """Writes a file by its extension: .toml, .zmx (Zemax) or .seq (CODE V). Returns what the format cannot hold."""
        path = pathlib.Path(file)
        text, losses = self._native.written(path.suffix.lower().lstrip("."))
        path.write_text(text, encoding="utf-8")
        return losses

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

    def _repr_svg_(self) -> str:
        return self.configure().section_svg()

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


@dataclass(frozen=True, eq=False)
class SectionLine:
    """A line of a drawn section."""

    kind: str  # "element", "surface", "obscuration", "stop", "sensor", "axis ray", "field ray", "ghost ray"
    index: int  # the surface, from 1; of an element its front surface; of a ghost's ray the ghost's index
    blocked: bool  # a ray that a clear aperture blocks
    points_mm: np.ndarray  # float64 (n, 2): z from the first vertex, y upwards


class MeasuredFlare:
    """A flare measured from photographs (docs/measure.md). read_flare() makes one; it stands for a lens in render() and
    apply(), where it takes lights, size, hfov, exposure and the detection of lights, and no setting of a lens."""

    def __init__(self, native: _native.MeasuredFlare) -> None:
        self._native = native

    @property
    def name(self) -> str:
        return self._native.name

    @property
    def source(self) -> str:
        return self._native.source

    @property
    def measured_deg(self) -> float:
        """Measured for lights up to this angle from the axis."""
        return math.degrees(math.atan(self._native.s_max))

    @property
    def exposure(self) -> Optional[tuple[float, float, float]]:
        """f-number, ISO and seconds of the photographs; None: unknown."""
        return self._native.exposure

    @property
    def ghosts(self) -> list[str]:
        """The names of its ghosts."""
        return self._native.ghosts

    def to_toml(self) -> str:
        """The format of its file (docs/formats/measured-flare.md)."""
        return self._native.toml()

    def __repr__(self) -> str:
        return f"<MeasuredFlare {self.name!r}, {len(self.ghosts)} ghosts, to {self.measured_deg:.1f} degrees>"


class LensState:
    """A lens configured for a picture: zoom, f-number, focus, iris, coatings. configure_lens() makes one. Of a measured
    flare it has a name, lights and size, but no surfaces."""

    def __init__(
        self, native: _native.LensState, prescription: Union[Prescription, MeasuredFlare], values: _native.Values
    ) -> None:
        self._native = native
        self._values = values
        self.prescription = prescription

    @property
    def _measured(self) -> Optional[_native.MeasuredFlare]:
        return self.prescription._native if isinstance(self.prescription, MeasuredFlare) else None

    def _require_surfaces(self) -> None:
        if self._measured is not None:
            raise UnsupportedError(f"{self.name!r} is a measured flare, which has no surfaces; this needs a lens")

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
        self._require_surfaces()
        return FirstOrder(**self._native.first_order(lambda_nm or self.design_wavelength_nm))

    def seidel(self, lambda_nm: Optional[float] = None, half_field_rad: Optional[float] = None) -> list[SeidelSums]:
        """The sums of each surface, zero for the stop; their total is the lens's. Without a field, the sensor's."""
        self._require_surfaces()
        lambda_nm = lambda_nm or self.design_wavelength_nm
        if half_field_rad is None:
            half_field_rad = self.first_order(lambda_nm).half_field_rad
        return [SeidelSums(*sums) for sums in self._native.seidel(lambda_nm, half_field_rad)]

    def configure(self, *, preset: Optional[str] = None, **parameters: Any) -> LensState:
        """The same lens with other parameters; those that are not given stay."""
        return configure_lens(self, preset=preset, **parameters)

    def _section(self, ghosts: Iterable[Sequence[int]], light_deg: Optional[float]) -> tuple[Any, ...]:
        self._require_surfaces()
        light_rad = None if light_deg is None else math.radians(light_deg)
        return self._native, self.design_wavelength_nm, [list(ghost) for ghost in ghosts], light_rad

    def section_svg(self, ghosts: Iterable[Sequence[int]] = (), light_deg: Optional[float] = None) -> str:
        """The lens in section, as `contrejour lens draw` writes it: with the rays that form the image, or with those of
        `ghosts`, as [(2, 5)], for a light at this elevation (default: a third of the field)."""
        return _native.section_svg(*self._section(ghosts, light_deg))

    def section_lines(
        self, ghosts: Iterable[Sequence[int]] = (), light_deg: Optional[float] = None
    ) -> list[SectionLine]:
        """The lines of this drawing, to draw them otherwise."""
        return [SectionLine(**line) for line in _native.section_lines(*self._section(ghosts, light_deg))]

    def write_ghost(self, file: Union[str, "os.PathLike[str]"], ghost: Sequence[int]) -> list[str]:
        """Writes a ghost's path, with mirrors, as .zmx or .seq. Returns what the format cannot hold."""
        self._require_surfaces()
        path = pathlib.Path(file)
        text, losses = self._native.written_ghost(list(ghost), path.suffix.lower().lstrip("."))
        path.write_text(text, encoding="utf-8")
        return losses

    def _repr_svg_(self) -> Optional[str]:
        return None if self._measured is not None else self.section_svg()

    def __str__(self) -> str:
        if self._measured is not None:
            return repr(self.prescription)
        figures = self.first_order()
        return (
            f"{self.prescription}\n{self.focal_length_mm:.2f} mm, f/{self.f_number:.3g}; entrance pupil "
            f"{figures.entrance_pupil_diameter_mm:.3f} mm at {figures.entrance_pupil_position_mm:.3f} mm, back focal "
            f"distance {figures.back_focal_distance_mm:.3f} mm"
        )

    def __repr__(self) -> str:
        return f"<LensState {self.name!r}, {self.focal_length_mm:.2f} mm, f/{self.f_number:.3g}>"


AnyLens = Union[str, "os.PathLike[str]", Prescription, MeasuredFlare, LensState]


def bundled_lenses() -> list[str]:
    """The names of the lenses that come with the library."""
    return _native.bundled_lenses()


def find_lens(name_or_file: Union[str, "os.PathLike[str]"]) -> Prescription:
    """A bundled lens, or else a file in any format that the library reads (docs/formats)."""
    return Prescription(_native.find_lens(os.fspath(name_or_file)))


def read_flare(file: Union[str, "os.PathLike[str]"]) -> MeasuredFlare:
    """A flare measured from photographs: NAME.flare.toml. A file's name may also stand for a lens."""
    return MeasuredFlare(_native.read_flare(os.fspath(file)))


def read_lens_toml(text: str, file: str = "") -> Prescription:
    """The library's own format from memory; `file` names it in errors."""
    return Prescription(_native.read_lens_toml(text, file))


def _opened(lens: Union[str, "os.PathLike[str]", Prescription, MeasuredFlare]) -> Union[Prescription, MeasuredFlare]:
    if isinstance(lens, (Prescription, MeasuredFlare)):
        return lens
    return read_flare(lens) if _native.is_measured_flare(os.fspath(lens)) else find_lens(lens)


def _configure(lens: Union[Prescription, MeasuredFlare], values: _native.Values) -> _native.LensState:
    return lens._native.geometry() if isinstance(lens, MeasuredFlare) else _native.configure_lens(lens._native, values)


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
        native = _configure(lens.prescription, values) if changed else lens._native
        return LensState(native, lens.prescription, values)
    opened = _opened(lens)
    return LensState(_configure(opened, values), opened, values)


def configure_lens(lens: Optional[AnyLens] = None, *, preset: Optional[str] = None, **parameters: Any) -> LensState:
    """Sets zoom (focal, mm), f-number (f_number), focus, blades, coating and all other parameters of a lens:

        configure_lens("nikon-80-200", focal=140, f_number=8, blades=7)

    What is given here is also the default of later calls with this state: lights, size, method.
    """
    return configured(lens, preset, parameters)
