# SPDX-License-Identifier: Apache-2.0
"""Presets of a camera's flare, as Blender keeps them: one file each in the user's scripts folder."""
import bpy
from bl_operators.presets import AddPresetBase

from .properties import CameraOptions, table

FOLDER = "contrejour_flare"


class CONTREJOUR_MT_presets(bpy.types.Menu):
    bl_label = "Flare Presets"
    preset_subdir = FOLDER
    preset_operator = "script.execute_preset"
    draw = bpy.types.Menu.draw_preset


class CONTREJOUR_OT_add_preset(AddPresetBase, bpy.types.Operator):
    """Keep the lens, the look and all parameters of this camera as a preset, or remove a preset"""

    bl_idname = "contrejour.add_preset"
    bl_label = "Add Flare Preset"
    preset_menu = "CONTREJOUR_MT_presets"
    preset_subdir = FOLDER
    preset_defines = ["flare = bpy.context.scene.camera.data.contrejour"]

    @property
    def preset_values(self):
        names = [*CameraOptions.__annotations__, *(row.attribute for row in table())]
        return [f"flare.{name}" for name in names]


classes = (CONTREJOUR_MT_presets, CONTREJOUR_OT_add_preset)
