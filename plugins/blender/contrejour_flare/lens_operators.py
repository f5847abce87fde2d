# SPDX-License-Identifier: Apache-2.0
"""Load Look into Parameters, Set Camera to Lens."""
import bpy

from . import library, messages, properties


def _camera(context):
    """The camera whose properties are shown, or else the scene's."""
    if getattr(context, "camera", None) is not None:
        return context.camera
    active = context.scene.camera
    return active.data if active is not None and active.type == "CAMERA" else None


class _CameraOperator:
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return _camera(context) is not None

    def execute(self, context):
        try:
            self.change(_camera(context))
        except messages.expected_errors() as error:
            self.report({"ERROR"}, messages.one_line(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class CONTREJOUR_OT_load_look(_CameraOperator, bpy.types.Operator):
    """Set every parameter as the look does, to change them from there; the look is then empty"""

    bl_idname = "contrejour.load_look"
    bl_label = "Load Look into Parameters"

    def change(self, camera) -> None:
        look = properties.lens_and_look(camera.contrejour)[1]
        if look is None:
            raise ValueError("choose a look first")
        properties.load_look(camera.contrejour, look)


class CONTREJOUR_OT_camera_to_lens(_CameraOperator, bpy.types.Operator):
    """Set the camera's focal length and sensor to those of the lens, so that the flare is that of this very picture"""

    bl_idname = "contrejour.camera_to_lens"
    bl_label = "Set Camera to Lens"

    def change(self, camera) -> None:
        options = camera.contrejour
        lens, look = properties.lens_and_look(options)
        settings = properties.settings_of(options, camera, look)[0]
        state = library.load().configure_lens(lens, preset=look, **settings)
        camera.lens = state.first_order().focal_length_x_mm
        camera.sensor_width, camera.sensor_height = state.sensor_mm


classes = (CONTREJOUR_OT_load_look, CONTREJOUR_OT_camera_to_lens)
