# SPDX-License-Identifier: Apache-2.0
"""The table of parameters, and keyword arguments as settings."""
from __future__ import annotations

import difflib
import functools
import math
import os
from dataclasses import dataclass
from typing import Any, Iterable, Mapping

from . import _native


@dataclass(frozen=True)
class Parameter:
    """A parameter: as a keyword argument its dashes are underscores, which may stand anywhere (f_number: fnumber)."""

    name: str  # "fnumber"
    group: str  # heading in a list of parameters
    kind: str  # "real", "integer", "choice", "switch" or "text"
    unit: str  # "mm", "deg", ..., or how a text is written: "WxH"
    minimum: float
    maximum: float
    default: str  # empty: derived from the lens or the picture, as the help says
    help: str
    choices: tuple[str, ...]
    repeats: bool  # takes a list, too
    scene: bool  # describes one picture, as lights and size do; no part of a preset


@functools.lru_cache(maxsize=None)
def parameters() -> tuple[Parameter, ...]:
    """All parameters: the keyword arguments of render(), configure_lens(), ghosts(), apply() and the others."""
    return tuple(Parameter(**fields) for fields in _native.parameters())


@functools.lru_cache(maxsize=None)
def _by_plain_name() -> Mapping[str, Parameter]:
    return {_plain(parameter.name): parameter for parameter in parameters()}


def _plain(name: str) -> str:
    return name.replace("-", "").replace("_", "")


def _parameter_of(keyword: str) -> Parameter:
    found = _by_plain_name().get(_plain(keyword))
    if found is not None:
        return found
    near = difflib.get_close_matches(_plain(keyword), _by_plain_name(), n=1)
    remedy = f"did you mean {_by_plain_name()[near[0]].name.replace('-', '_')}?" if near else "see parameters()"
    raise TypeError(f"there is no parameter {keyword!r}; {remedy}")


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, (tuple, list)):
        return ",".join(_text(part) for part in value)
    number = float(value)
    if math.isinf(number) and number > 0:
        return "inf"
    return repr(int(number)) if number.is_integer() and abs(number) < 1e15 else repr(number)


def _texts(parameter: Parameter, value: Any) -> Iterable[str]:
    """One text, or those of a list: a tuple of numbers is one value, as (12, 8) is 12,8."""
    if parameter.repeats and isinstance(value, list):
        return [_text(one) for one in value]
    return [_text(value)]


def preset_of(name_or_file: str) -> tuple[str, _native.Values]:
    """The lens and the values of a preset."""
    _, _, lens, values = _native.find_preset(os.fspath(name_or_file))
    return lens, values


def values_of(keywords: Mapping[str, Any]) -> _native.Values:
    """The settings that keyword arguments give. None stands for an argument that is not given."""
    rest = {keyword: value for keyword, value in keywords.items() if value is not None}
    values = _native.Values()
    if "width" in rest or "height" in rest:
        if "width" not in rest or "height" not in rest:
            raise TypeError("width and height belong together")
        values.set("size", f"{int(rest.pop('width'))}x{int(rest.pop('height'))}")
    for keyword, value in rest.items():
        parameter = _parameter_of(keyword)
        for text in _texts(parameter, value):
            values.set(parameter.name, text)
    return values


@dataclass(frozen=True)
class Preset:
    """All settings of a flare except the scene's: render(lens, preset="night-zoom")."""

    name: str
    description: str
    lens: str  # the lens that it was made for, or empty
    settings: Mapping[str, str | list[str]]  # by parameter, as keyword arguments take them


def find_preset(name_or_file: str) -> Preset:
    """A bundled preset, or else one of a file (docs/formats/preset.md)."""
    name, description, lens, values = _native.find_preset(os.fspath(name_or_file))
    given: dict[str, str | list[str]] = {}
    for parameter in parameters():
        if values.given(parameter.name):
            texts = values.texts(parameter.name)
            given[parameter.name.replace("-", "_")] = texts if parameter.repeats else texts[0]
    return Preset(name, description, lens, given)


def bundled_presets() -> list[str]:
    """The names of the presets that come with the library."""
    return _native.bundled_presets()
