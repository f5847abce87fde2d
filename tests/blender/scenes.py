# SPDX-License-Identifier: Apache-2.0
"""Small scenes for the add-on's tests, made from nothing, and what Cycles renders of them."""
import math
import pathlib

import bpy
import numpy as np


def new_scene(width=96, height=64, lens_mm=50.0):
    """An empty scene in the dark with a camera at the origin that looks along -z."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = 16, False, False
    scene.cycles.max_bounces = 0
    scene.cycles.pixel_filter_type = "BOX"
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.0
    data = bpy.data.cameras.new("Camera")
    data.lens = lens_mm
    scene.camera = add(bpy.data.objects.new("Camera", data))
    return scene


def add(new):
    bpy.context.scene.collection.objects.link(new)
    return new


def add_lamp(kind, location=(0, 0, -10), rotation=(0, 0, 0), **settings):
    lamp = bpy.data.lights.new(kind.title(), kind)
    for name, value in settings.items():
        setattr(lamp, name, value)
    made = add(bpy.data.objects.new(kind.title(), lamp))
    made.location, made.rotation_euler = location, rotation
    return made


def material(shader, **inputs):
    made = bpy.data.materials.new(shader)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    node, output = tree.nodes.new(shader), tree.nodes.new("ShaderNodeOutputMaterial")
    for name, value in inputs.items():
        node.inputs[name].default_value = value
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return made


def add_ball(location, radius, made_of):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=radius, location=location)
    bpy.context.object.data.materials.append(made_of)
    return bpy.context.object


def add_plane(location, size, made_of):
    bpy.ops.mesh.primitive_plane_add(size=size, location=location)
    bpy.context.object.data.materials.append(made_of)
    return bpy.context.object


def pixels_of(file):
    """float (height, width, 4), from the top."""
    image = bpy.data.images.load(str(file))
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    width, height = image.size
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)[::-1]


def rendered(scene, folder: pathlib.Path):
    scene.render.filepath = str(folder / "render.exr")
    bpy.ops.render.render(write_still=True)
    return pixels_of(folder / "render.exr")


def add_sky(scene, elevation_deg, rotation_deg, size_deg=2.0):
    tree = scene.world.node_tree
    sky = tree.nodes.new("ShaderNodeTexSky")
    sky.sky_type, sky.sun_disc = "NISHITA", True
    sky.sun_size, sky.sun_elevation = math.radians(size_deg), math.radians(elevation_deg)
    sky.sun_rotation = math.radians(rotation_deg)
    tree.links.new(sky.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    tree.nodes["Background"].inputs["Strength"].default_value = 1.0
    return sky
