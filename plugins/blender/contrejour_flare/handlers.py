# SPDX-License-Identifier: Apache-2.0
"""Flares with each frame that Blender renders.

Blender calls these with the scene at the frame that it renders. Before a frame, the flare's file is there when the
compositor wants it; after it, the flare does not hold up the render.
"""
import bpy
from bpy.app.handlers import persistent

from . import compositor, messages
from .render_operators import render_now


def _render(scene, depsgraph, when: str) -> None:
    """A handler must not raise: Blender would print a traceback, and go on all the same."""
    output = scene.contrejour
    if output.with_render != when:
        return
    if depsgraph is None:
        depsgraph = bpy.context.evaluated_depsgraph_get()
    try:
        said = render_now(scene, depsgraph)
        compositor.refresh(scene)
    except messages.expected_errors() as error:
        said = [messages.one_line(error)]
        print(f"Contrejour: frame {scene.frame_current}: {said[0]}")
    output.message = "; ".join(said)


@persistent
def before_frame(scene, depsgraph=None):
    _render(scene, depsgraph, "BEFORE")


@persistent
def after_frame(scene, depsgraph=None):
    _render(scene, depsgraph, "AFTER")


def register() -> None:
    bpy.app.handlers.render_pre.append(before_frame)
    bpy.app.handlers.render_post.append(after_frame)


def unregister() -> None:
    bpy.app.handlers.render_pre.remove(before_frame)
    bpy.app.handlers.render_post.remove(after_frame)
