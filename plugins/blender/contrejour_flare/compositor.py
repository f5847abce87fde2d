# SPDX-License-Identifier: Apache-2.0
"""The flare as an input of the compositor: its sequence of files, added to the render."""
import os

import bpy

from .render_operators import flare_file

NODE_NAME = "Contrejour Flare"
_SEQUENCE_NAME = "Contrejour Flare Sequence"


def _sequence_image(scene):
    """The sequence of files as one image. Blender needs a file that is there to load it."""
    file = flare_file(scene, scene.frame_current)
    image = bpy.data.images.get(_SEQUENCE_NAME)
    if image is None:
        image = bpy.data.images.new(_SEQUENCE_NAME, 1, 1, float_buffer=True)
    image.source, image.filepath = "SEQUENCE", file
    return image


def _feeding(socket):
    return socket.links[0].from_socket if socket.is_linked else None


def _render_layers(tree):
    found = next((node for node in tree.nodes if node.type == "R_LAYERS"), None)
    return found or tree.nodes.new("CompositorNodeRLayers")


def add_nodes(scene):
    """An image node and a Mix node that adds it to what the Composite node has got so far. Returns the image node.

    Where the image node is there already, its frames are set anew."""
    scene.use_nodes = True
    tree = scene.node_tree
    node = tree.nodes.get(NODE_NAME)
    if node is None:
        composite = next((one for one in tree.nodes if one.type == "COMPOSITE"), None)
        composite = composite or tree.nodes.new("CompositorNodeComposite")
        before = _feeding(composite.inputs["Image"]) or _render_layers(tree).outputs["Image"]
        node = tree.nodes.new("CompositorNodeImage")
        node.name = node.label = NODE_NAME
        mix = tree.nodes.new("CompositorNodeMixRGB")
        mix.name, mix.label, mix.blend_type = f"{NODE_NAME} Add", "Add Flare", "ADD"
        mix.inputs[0].default_value = 1.0
        x, y = composite.location
        composite.location = (x + 220, y)
        mix.location, node.location = (x, y), (x - 220, y - 220)
        tree.links.new(before, mix.inputs[1])
        tree.links.new(node.outputs["Image"], mix.inputs[2])
        tree.links.new(mix.outputs[0], composite.inputs["Image"])
    node.image = _sequence_image(scene)
    node.frame_start, node.frame_duration = scene.frame_start, scene.frame_end - scene.frame_start + 1
    node.frame_offset = scene.frame_start - 1
    node.use_auto_refresh = True
    return node


class CONTREJOUR_OT_flare_to_compositor(bpy.types.Operator):
    """Add the flare's files to the render in the compositor: an Image node with the sequence, and a Mix node"""

    bl_idname = "contrejour.flare_to_compositor"
    bl_label = "Add Flare in Compositor"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        scene = context.scene
        add_nodes(scene)
        file = flare_file(scene, scene.frame_current)
        if not os.path.exists(file) and scene.contrejour.with_render != "BEFORE":
            remedy = "render the flare first, or set With Each Rendered Frame to Before"
            self.report({"WARNING"}, f"{file} is not there yet: {remedy}")
        return {"FINISHED"}


def refresh(scene) -> None:
    """Makes the compositor read the file of the present frame, which was written just now."""
    node = scene.node_tree.nodes.get(NODE_NAME) if scene.use_nodes and scene.node_tree else None
    if node is not None and node.image is not None:
        node.image.reload()


classes = (CONTREJOUR_OT_flare_to_compositor,)
