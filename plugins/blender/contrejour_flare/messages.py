# SPDX-License-Identifier: Apache-2.0
"""Errors as one line for a person."""
from __future__ import annotations

from . import library
from .scene_camera import SceneError


def expected_errors() -> tuple[type, ...]:
    """Errors of the scene, of settings and of files: they have a message for the artist. Others are faults of ours."""
    return (SceneError, library.load().Error, OSError, ValueError, TypeError)


def one_line(error: BaseException) -> str:
    return " ".join(str(error).split()) or type(error).__name__
