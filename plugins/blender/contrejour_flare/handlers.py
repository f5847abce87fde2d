# SPDX-License-Identifier: Apache-2.0
"""Flares with each frame that Blender renders.

Blender evaluates a frame that it renders apart from the scene that is shown, and hands over the result in one place
only: the handler of a changed frame, before the frame is rendered, for stills too. The lights are read there. With
BEFORE the flare is rendered at once, so that its file is there when the compositor wants it; with AFTER, when the frame
is done.
"""
import bpy
from bpy.app.handlers import persistent

from . import collect, compositor, messages
from .render_operators import render_to_file

_waiting = {}  # requests by the scene's name, for AFTER


def _guarded(scene, work) -> None:
    """A handler must not raise: Blender would print a traceback, and go on all the same."""
    try:
        said = work()
    except messages.expected_errors() as error:
        said = [messages.one_line(error)]
        print(f"Contrejour: frame {scene.frame_current}: {said[0]}")
    scene.contrejour.message = "; ".join(said)


@persistent
def frame_is_evaluated(scene, depsgraph=None):
    when = scene.contrejour.with_render
    if when == "OFF" or depsgraph is None or depsgraph.mode != "RENDER":
        return

    def work() -> list[str]:
        _waiting.pop(scene.name, None)
        request = collect.request_of(scene, depsgraph)
        if when == "AFTER":
            _waiting[scene.name] = request
        else:
            render_to_file(request, scene)
            compositor.refresh(scene)
        return request.messages

    _guarded(scene, work)


@persistent
def frame_is_rendered(scene, _depsgraph=None):
    request = _waiting.pop(scene.name, None)
    if request is not None:
        _guarded(scene, lambda: render_to_file(request, scene))


def register() -> None:
    bpy.app.handlers.frame_change_post.append(frame_is_evaluated)
    bpy.app.handlers.render_post.append(frame_is_rendered)


def unregister() -> None:
    bpy.app.handlers.frame_change_post.remove(frame_is_evaluated)
    bpy.app.handlers.render_post.remove(frame_is_rendered)
    _waiting.clear()
