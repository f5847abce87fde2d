# SPDX-License-Identifier: Apache-2.0
"""Render Flare and Render Flare Animation.

With a window they run as modal operators: Blender's data is read in the main thread, the library renders in another
one, and a timer looks after it. Esc ends the operator at once, and the library's call within a moment, which then writes
nothing. In background mode, and from scripts, they run in the main thread.
"""
import threading

import bpy

from . import collect, flare_request, library, messages
from .frame_files import frame_file

IMAGE_NAME = "Contrejour Flare"
_POLL_SECONDS = 0.05


class _Render(threading.Thread):
    """Renders one frame and writes its file."""

    def __init__(self, request, file: str, half: bool) -> None:
        super().__init__(name="contrejour")
        self.progress, self.error = 0.0, None
        self._request, self._file, self._half = request, file, half
        self._unwanted = library.load().CancelFlag()

    def run(self) -> None:
        try:
            picture = flare_request.render(self._request, self._report, self._unwanted)
            if not self._unwanted.is_set():
                flare_request.write(picture, self._file, self._half)
        except BaseException as error:  # it is raised again in the main thread
            self.error = error

    def stop(self) -> None:
        self._unwanted.set()

    def _report(self, fraction: float) -> None:
        self.progress = fraction


def flare_file(scene, frame: int) -> str:
    return bpy.path.abspath(frame_file(scene.contrejour.output, frame))


def render_to_file(request, scene) -> list[str]:
    """Renders a request to the file of the present frame, and returns what there is to know of it."""
    picture = flare_request.render(request)
    flare_request.write(picture, flare_file(scene, scene.frame_current), scene.contrejour.half)
    return request.messages


def show_image(file: str) -> None:
    """The flare as an image of Blender's, for the image editor."""
    image = bpy.data.images.get(IMAGE_NAME)
    if image is None:
        image = bpy.data.images.load(file)
        image.name = IMAGE_NAME
    image.source, image.filepath = "FILE", file
    image.reload()


class _FlareOperator:
    """Both operators have this in common; `frames` of the class says which frames they render."""

    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context):
        return context.scene is not None and context.scene.camera is not None

    def execute(self, context):
        scene, start, said = context.scene, context.scene.frame_current, []
        try:
            for frame in self.frames(scene):
                self._go_to(scene, frame)
                said += render_to_file(collect.request_of(scene, context.evaluated_depsgraph_get()), scene)
                self._done(scene, frame)
        except messages.expected_errors() as error:
            return self._failed(scene, error)
        finally:
            self._go_to(scene, start)
        self._say(scene, said)
        return {"FINISHED"}

    def invoke(self, context, _event):
        self._scene, self._start, self._said = context.scene, context.scene.frame_current, []
        self._left, self._render = list(self.frames(context.scene)), None
        self._count = len(self._left)
        manager = context.window_manager
        self._timer = manager.event_timer_add(_POLL_SECONDS, window=context.window)
        manager.progress_begin(0, 100)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC" and event.value == "PRESS":
            self._end(context)
            self.report({"WARNING"}, "Flare: stopped")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        try:
            return self._step(context)
        except messages.expected_errors() as error:
            self._end(context)
            return self._failed(self._scene, error)

    def _step(self, context):
        """Looks after the frame that is being rendered, and starts the next."""
        if self._render is not None:
            if self._render.is_alive():
                self._show_progress(context)
                return {"RUNNING_MODAL"}
            if self._render.error is not None:
                raise self._render.error
            self._done(self._scene, self._frame)
            self._render = None
        if not self._left:
            self._end(context)
            self._say(self._scene, self._said)
            return {"FINISHED"}
        self._frame = self._left.pop(0)
        self._go_to(self._scene, self._frame)
        request = collect.request_of(self._scene, context.evaluated_depsgraph_get())
        self._said += request.messages
        self._render = _Render(request, flare_file(self._scene, self._frame), self._scene.contrejour.half)
        self._render.start()
        return {"RUNNING_MODAL"}

    def _show_progress(self, context) -> None:
        done = self._count - len(self._left) - 1 + self._render.progress
        percent = 100.0 * done / self._count
        context.window_manager.progress_update(percent)
        context.workspace.status_text_set(f"Flare, frame {self._frame}: {percent:.0f} %   Esc: stop")

    def _end(self, context) -> None:
        if self._render is not None:
            self._render.stop()
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
        self._go_to(self._scene, self._start)

    @staticmethod
    def _go_to(scene, frame: int) -> None:
        if scene.frame_current != frame:
            scene.frame_set(frame)

    def _failed(self, scene, error):
        text = messages.one_line(error)
        scene.contrejour.message = text
        self.report({"ERROR"}, text)
        return {"CANCELLED"}

    def _say(self, scene, said: list[str]) -> None:
        said = list(dict.fromkeys(said))
        scene.contrejour.message = "; ".join(said)
        for text in said:
            self.report({"WARNING"}, text)


class CONTREJOUR_OT_render_flare(_FlareOperator, bpy.types.Operator):
    """Render the lens flare of this frame to its file and to the image "Contrejour Flare" """

    bl_idname = "contrejour.render_flare"
    bl_label = "Render Flare"

    def frames(self, scene):
        return [scene.frame_current]

    def _done(self, scene, frame: int) -> None:
        show_image(flare_file(scene, frame))


class CONTREJOUR_OT_render_flare_animation(_FlareOperator, bpy.types.Operator):
    """Render the lens flare of every frame of the scene's range to a file each"""

    bl_idname = "contrejour.render_flare_animation"
    bl_label = "Render Flare Animation"

    def frames(self, scene):
        return range(scene.frame_start, scene.frame_end + 1, scene.frame_step)

    def _done(self, scene, frame: int) -> None:
        pass


class CONTREJOUR_OT_find_lights(bpy.types.Operator):
    """List the lights of this frame: where they lie in the picture, and how bright they are"""

    bl_idname = "contrejour.find_lights"
    bl_label = "Find Lights"

    @classmethod
    def poll(cls, context):
        return context.scene is not None and context.scene.camera is not None

    def execute(self, context):
        output = context.scene.contrejour
        try:
            request = collect.request_of(context.scene, context.evaluated_depsgraph_get())
        except messages.expected_errors() as error:
            output.message = messages.one_line(error)
            self.report({"ERROR"}, output.message)
            return {"CANCELLED"}
        output.found.clear()
        for light in request.lights:
            entry = output.found.add()
            entry.name, entry.u, entry.v = light.name, light.u, light.v
            entry.value, entry.visible = light.luminance, light.visible
        output.message = "; ".join(request.messages)
        self.report({"INFO"}, f"{len(request.lights)} lights")
        return {"FINISHED"}


classes = (CONTREJOUR_OT_render_flare, CONTREJOUR_OT_render_flare_animation, CONTREJOUR_OT_find_lights)
