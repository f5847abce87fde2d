# SPDX-License-Identifier: Apache-2.0
"""Operators and menus."""
import bpy

from . import compositor, lens_operators, presets, render_operators

_classes = (*render_operators.classes, *lens_operators.classes, *compositor.classes, *presets.classes)


def register() -> None:
    for cls in _classes:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(_classes):
        bpy.utils.unregister_class(cls)
