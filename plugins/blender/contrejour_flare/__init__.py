# SPDX-License-Identifier: Apache-2.0
"""Contrejour in Blender: the lens flare that a real lens makes of a scene's lights (docs/blender.md)."""
bl_info = {
    "name": "Contrejour Lens Flare",
    "author": "The Contrejour authors",
    "version": (0, 1, 0),
    "blender": (3, 3, 0),
    "location": "Camera and Render properties, Lens Flare",
    "description": "Physically based lens flare of the scene's lights, by the lens's prescription",
    "category": "Render",
}


def _parts():
    """The modules that register something, in order. They are imported late: tests use the others without Blender."""
    from . import handlers, panels, properties, registered_classes

    return properties, registered_classes, panels, handlers


def register():
    from . import library

    library.load()  # an add-on that lacks the library says so before anything is registered
    for part in _parts():
        part.register()


def unregister():
    for part in reversed(_parts()):
        part.unregister()
