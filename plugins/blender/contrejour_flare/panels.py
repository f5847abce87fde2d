# SPDX-License-Identifier: Apache-2.0
"""Panels: the lens at the camera's data, its parameters below it by group, output at the render properties, a switch at
each light and mesh."""
import bpy

from .properties import table

_IN_FIRST_PANEL = ("gain", "stops")
_LABELS = {"Lens": "Lens Settings", "Lights": "Further Lights"}  # of groups whose own name would mislead here


class _CameraPanel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "data"

    @classmethod
    def poll(cls, context):
        return context.camera is not None


class CONTREJOUR_PT_lens(_CameraPanel, bpy.types.Panel):
    bl_label = "Lens Flare"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, _context):
        row = self.layout.row(align=True)
        row.menu("CONTREJOUR_MT_presets", text="", icon="PRESET")
        row.operator("contrejour.add_preset", text="", icon="ADD")

    def draw(self, context):
        options, layout = context.camera.contrejour, self.layout
        layout.use_property_split = True
        column = layout.column()
        column.prop(options, "lens", icon="CAMERA_DATA")
        column.prop(options, "lens_file")
        column.prop(options, "look", icon="PRESET")
        column.prop(options, "look_file")
        layout.operator("contrejour.load_look")
        column = layout.column()
        column.prop(options, "match_focal")
        column.prop(options, "use_camera_focus")
        layout.operator("contrejour.camera_to_lens")
        column = layout.column()
        for name in _IN_FIRST_PANEL:
            column.prop(options, name)


def _group_panels() -> list[type]:
    """One closed panel for each group of the table, in the table's order."""
    panels = []
    for group in dict.fromkeys(row.group for row in table()):
        rows = [row for row in table() if row.group == group and row.attribute not in _IN_FIRST_PANEL]
        if rows:
            panels.append(_group_panel(group, [row.attribute for row in rows]))
    return panels


def _group_panel(group: str, attributes: list[str]) -> type:
    def draw(self, context):
        self.layout.use_property_split = True
        column = self.layout.column()
        for attribute in attributes:
            column.prop(context.camera.contrejour, attribute)

    members = {
        "bl_label": _LABELS.get(group, group),
        "bl_parent_id": "CONTREJOUR_PT_lens",
        "bl_options": {"DEFAULT_CLOSED"},
        "draw": draw,
    }
    name = "CONTREJOUR_PT_group_" + group.lower().replace(" ", "_")
    return type(name, (_CameraPanel, bpy.types.Panel), members)


class CONTREJOUR_UL_found_lights(bpy.types.UIList):
    def draw_item(self, _context, layout, _data, item, _icon, _active_data, _active_property):
        row = layout.row()
        row.label(text=item.name, icon="LIGHT")
        row.label(text=f"{item.u:.2f}, {item.v:.2f}")
        row.label(text=f"{item.value:.3g}")
        row.label(text=f"{100.0 * item.visible:.0f} %")


class CONTREJOUR_PT_output(bpy.types.Panel):
    bl_label = "Lens Flare"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        scene, layout = context.scene, self.layout
        output = scene.contrejour
        layout.use_property_split = True
        row = layout.row(align=True)
        row.operator("contrejour.render_flare", icon="RENDER_STILL")
        row.operator("contrejour.render_flare_animation", text="Animation", icon="RENDER_ANIMATION")
        column = layout.column()
        column.prop(output, "output")
        column.prop(output, "half")
        column.prop(output, "with_render")
        layout.operator("contrejour.flare_to_compositor", icon="NODE_COMPOSITING")
        column = layout.column()
        column.prop(output, "samples")
        column.prop(output, "max_lights")
        layout.operator("contrejour.find_lights", icon="LIGHT")
        if output.found:
            layout.template_list("CONTREJOUR_UL_found_lights", "", output, "found", output, "found_index", rows=3)
        if output.message:
            layout.label(text=output.message, icon="INFO")


class CONTREJOUR_PT_object(bpy.types.Panel):
    bl_label = "Lens Flare"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type not in ("CAMERA", "EMPTY", "SPEAKER")

    def draw(self, context):
        options, layout = context.object.contrejour, self.layout
        layout.use_property_split = True
        column = layout.column()
        for name in ("use", "gain", "spectrum", "use_occlusion"):
            column.prop(options, name)
        if context.object.type != "LIGHT":
            layout.prop(options, "hides_lights")


_classes = (CONTREJOUR_PT_lens, CONTREJOUR_UL_found_lights, CONTREJOUR_PT_output, CONTREJOUR_PT_object)
_registered: list[type] = []


def register() -> None:
    for cls in (*_classes, *_group_panels()):
        bpy.utils.register_class(cls)
        _registered.append(cls)


def unregister() -> None:
    while _registered:
        bpy.utils.unregister_class(_registered.pop())
