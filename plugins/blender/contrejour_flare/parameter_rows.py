# SPDX-License-Identifier: Apache-2.0
"""Rows of the library's table of parameters as properties: names, ranges, defaults, and back to settings.

No part of Blender is needed here. The rules are those of the OpenFX plug-in: a parameter at its default that is not
animated leaves its setting to the look; 0, or a number below the range if 0 is in it, stands for a derived default.
"""
from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass, field
from typing import Any, Optional

# The scene has these, or they belong to photographs; lights by text add to the scene's.
_OF_THE_SCENE = {"size", "hfov", "pixel-aspect", "exposure", "wavelength"}
_LIGHTS = {"light", "light-at"}
_LARGEST = 1e15
_LARGEST_INTEGER = 2**31 - 1
SEPARATOR = ";"


@dataclass(frozen=True)
class Row:
    """A parameter as a property of Blender."""

    attribute: str  # the name in Python
    name: str  # in the table
    group: str
    label: str
    kind: str  # real, integer, choice, switch, text or file
    description: str
    default: Any
    minimum: float = 0.0
    maximum: float = 0.0
    soft_minimum: float = 0.0
    soft_maximum: float = 0.0
    choices: tuple[tuple[str, int], ...] = field(default=())  # name and number, which files keep
    repeats: bool = False


def belongs(parameter) -> bool:
    """True for a row of the table that has a use in Blender."""
    if parameter.name in _OF_THE_SCENE:
        return False
    if parameter.group == "Lights":
        return parameter.name in _LIGHTS
    return not (parameter.group == "Light detection" and parameter.scene)


def rows(parameters) -> list[Row]:
    return [row_of(parameter) for parameter in parameters if belongs(parameter)]


def row_of(parameter) -> Row:
    common = {
        "attribute": parameter.name.replace("-", "_"),
        "name": parameter.name,
        "group": parameter.group,
        "label": _label(parameter),
        "description": parameter.help,
        "repeats": parameter.repeats,
    }
    if parameter.kind in ("real", "integer"):
        return _number(parameter, common)
    if parameter.kind == "choice":
        names = (() if parameter.default else (AUTOMATIC,)) + parameter.choices
        choices = tuple((name, zlib.crc32(name.encode()) & 0x7FFFFFFF) for name in names)
        return Row(kind="choice", default=parameter.default or AUTOMATIC, choices=choices, **common)
    if parameter.kind == "switch":
        return Row(kind="switch", default=parameter.default == "on", **common)
    common["description"] += f" ({parameter.unit})" if parameter.unit else ""
    if parameter.repeats:
        common["description"] += f"; several are separated by {SEPARATOR}"
    return Row(kind="file" if parameter.unit == "FILE" else "text", default=parameter.default, **common)


AUTOMATIC = "automatic"


def _label(parameter) -> str:
    label = parameter.name.replace("-", " ").capitalize()
    is_number = parameter.kind in ("real", "integer")
    has_unit = is_number and parameter.unit not in ("", "N", parameter.name.upper())
    return f"{label} ({parameter.unit})" if has_unit else label


def _number(parameter, common: dict) -> Row:
    minimum = max(parameter.minimum, -_LARGEST)
    maximum = min(parameter.maximum, _LARGEST_INTEGER if parameter.kind == "integer" else _LARGEST)
    if parameter.default:
        default = float(parameter.default)
    else:
        default = 0.0 if minimum > 0.0 else minimum - 1.0
        minimum = default
        common["description"] += f"; {default:g}: that default"
    reach = _slider_reach(parameter, default)
    soft_minimum, soft_maximum = max(minimum, -reach), max(min(maximum, reach), default)
    if parameter.kind == "integer":
        default = int(default)
    return Row(
        kind=parameter.kind,
        default=default,
        minimum=minimum,
        maximum=maximum,
        soft_minimum=soft_minimum,
        soft_maximum=soft_maximum if soft_maximum > soft_minimum else maximum,
        **common,
    )


def _slider_reach(parameter, default: float) -> float:
    if parameter.unit == "deg":
        return 180.0
    if parameter.unit == "mm":
        return 500.0
    if parameter.kind == "integer":
        return max(100.0, 10.0 * default)
    return max(10.0 if parameter.default else 32.0, 10.0 * abs(default))


def number_text(value: float) -> str:
    """The shortest text of a number that Blender keeps in single precision: 5.6, not 5.599999904632568."""
    single = struct.unpack("f", struct.pack("f", value))[0]
    for digits in range(6, 10):
        text = f"{single:.{digits}g}"
        if struct.unpack("f", struct.pack("f", float(text)))[0] == single:
            return text
    return repr(single)


def setting(row: Row, value: Any, is_animated: bool = False) -> Optional[Any]:
    """The keyword argument that a property's value stands for; None where it leaves the setting to the look."""
    if row.kind == "real":
        text = number_text(value)
        return None if float(text) == row.default and not is_animated else _in_range(row, text)
    if value == row.default and not is_animated:
        return None
    if row.kind == "integer":
        return _in_range(row, str(value))
    if row.kind == "choice":
        return None if value == AUTOMATIC else value
    if row.kind == "switch":
        return bool(value)
    if row.repeats:
        parts = [part.strip() for part in value.split(SEPARATOR)]
        return [part for part in parts if part] or None
    return value.strip() or None


def _in_range(row: Row, text: str) -> Optional[str]:
    """An animated number at the value that stands for the derived default is none."""
    is_derived = row.minimum == row.default and f"{row.default:g}: that default" in row.description
    return None if is_derived and float(text) == row.default else text


def value_of_setting(row: Row, text: Any) -> Any:
    """The property's value for a setting of a look."""
    if row.kind == "real":
        return float(text)
    if row.kind == "integer":
        return int(float(text))
    if row.kind == "switch":
        return text in (True, "on")
    if isinstance(text, list):
        return f"{SEPARATOR} ".join(text)
    return text
