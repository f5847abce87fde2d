# SPDX-License-Identifier: Apache-2.0
"""A night street with lamps and a car, with the flare of its lights added in the compositor.

    blender --background --python street.py -- FOLDER [LOOK] [WIDTH] [SAMPLES]

The add-on must be installed and enabled (docs/blender.md). Writes street.png and the flare to FOLDER.
"""
import math
import pathlib
import random
import sys

import bpy


def material(name, colour, emission=0.0, roughness=0.6):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1.0)
    shader.inputs["Roughness"].default_value = roughness
    shader.inputs["Emission"].default_value = (*colour, 1.0)
    shader.inputs["Emission Strength"].default_value = emission
    return made


def box(middle, size, made_of):
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=middle)
    bpy.context.object.scale = size
    bpy.context.object.data.materials.append(made_of)


def street_lamp(x, y, pole, bulb):
    side = -1 if x > 0 else 1
    box((x, y, 2.5), (0.12, 0.12, 5.0), pole)
    box((x + side * 0.6, y, 5.0), (1.3, 0.1, 0.1), pole)
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.12, location=(x + side * 1.2, y, 4.8))
    shown = bpy.context.object
    shown.data.materials.append(bulb)
    # The bulb is what the camera sees, and causes the flare; a lamp in it lights the street with less noise.
    shown.visible_diffuse = shown.visible_glossy = False
    lamp = bpy.data.lights.new("Street lamp", "POINT")
    lamp.energy, lamp.shadow_soft_size, lamp.color = 900.0 * 4 * math.pi**2 * 0.12**2, 0.13, (1.0, 0.62, 0.28)
    made = bpy.data.objects.new("Street lamp", lamp)
    made.location, made.contrejour.use = shown.location, False
    bpy.context.scene.collection.objects.link(made)


def headlight(x, y, z):
    lamp = bpy.data.lights.new("Headlight", "SPOT")
    lamp.energy, lamp.spot_size, lamp.spot_blend, lamp.shadow_soft_size = 600.0, math.radians(70), 0.6, 0.06
    lamp.color = (1.0, 0.95, 0.85)
    made = bpy.data.objects.new("Headlight", lamp)
    made.location, made.rotation_euler = (x, y, z), (math.radians(82), 0, math.radians(4))
    made.rotation_euler[2] += math.pi  # towards the camera
    bpy.context.scene.collection.objects.link(made)


def build(scene):
    choose = random.Random(2)
    box((0, 30, -0.05), (12, 90, 0.1), material("Road", (0.05, 0.05, 0.055), roughness=0.25))
    wall = material("Wall", (0.18, 0.16, 0.15))
    window = material("Window", (1.0, 0.7, 0.35), emission=1.5)
    pole, bulb = material("Pole", (0.05, 0.05, 0.05)), material("Bulb", (1.0, 0.62, 0.28), emission=900.0)
    for side in (-1, 1):
        for k in range(7):
            height = choose.uniform(6, 13)
            box((side * 9, 4 + 10 * k, height / 2), (6, 9.5, height), wall)
            for _ in range(3):
                middle = (side * 5.99, choose.uniform(10 * k, 8 + 10 * k), choose.uniform(2, height - 1))
                box(middle, (0.05, 0.8, 1.1), window)
        for k in range(4):
            street_lamp(side * 4.8, 8 + 13 * k + 4 * (side > 0), pole, bulb)
    for x in (-2.3, -1.0):
        headlight(x, 24, 0.7)
    background = scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (0.02, 0.03, 0.06, 1), 1.0
    camera = scene.camera
    camera.location, camera.rotation_euler = (0.6, -6, 1.6), (math.radians(94), 0, 0)
    camera.data.lens = 50


def main(folder, look="sixties-normal", width="640", samples="64"):
    folder = pathlib.Path(folder).resolve()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="contrejour_flare")
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("Night")
    scene.world.use_nodes = True
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(scene.camera)
    build(scene)
    render = scene.render
    render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", int(samples), False
    scene.cycles.sample_clamp_indirect = 1.0
    render.resolution_x, render.resolution_y = int(width), int(width) * 9 // 16
    scene.view_settings.view_transform = "Standard"
    scene.camera.data.contrejour.look = look
    scene.contrejour.output = str(folder / "flare_####.exr")
    scene.contrejour.with_render = "BEFORE"
    bpy.ops.contrejour.find_lights()
    for light in scene.contrejour.found:
        print(f"{light.name}: at {light.u:.3f}, {light.v:.3f}, value {light.value:.4g}, visible {light.visible:.2f}")
    print(scene.contrejour.message)
    bpy.ops.contrejour.flare_to_compositor()
    render.filepath = str(folder / "street.png")
    bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    if not arguments:
        sys.exit(__doc__)
    main(*arguments)
