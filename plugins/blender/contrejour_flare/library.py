# SPDX-License-Identifier: Apache-2.0
"""The Python package `contrejour`: the one that comes with the add-on, or one that Blender's Python finds."""
from __future__ import annotations

import importlib
import pathlib
import sys

_BUNDLED = pathlib.Path(__file__).parent / "lib"


def load():
    """The package. Raises ImportError with what to do."""
    if _BUNDLED.is_dir() and str(_BUNDLED) not in sys.path:
        sys.path.append(str(_BUNDLED))
    try:
        return importlib.import_module("contrejour")
    except ImportError as error:
        version = f"{sys.version_info.major}.{sys.version_info.minor}"
        raise ImportError(
            f"the Python package contrejour does not load in Blender's Python {version} ({error}); build the add-on "
            f"with this Python, as docs/blender.md says"
        ) from error
