# SPDX-License-Identifier: Apache-2.0
"""In Blender: the camera's projection, and lights beside what Cycles renders of them."""
import math
import random
import unittest

import bpy
import numpy as np
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector

from contrejour_flare import collect, projection, scene_camera
from scenes import add_ball, add_lamp, add_plane, add_sky, material, new_scene, rendered
from temporary import TemporaryFolderTest


def lights(scene):
    return collect.request_of(scene, bpy.context.evaluated_depsgraph_get()).lights


class ProjectionTest(unittest.TestCase):
    def test_random_cameras(self):
        choose = random.Random(3)
        for number in range(20):
            scene = bpy.context.scene if number else new_scene()
            render, camera = scene.render, scene.camera
            render.resolution_x, render.resolution_y = choose.randint(50, 4000), choose.randint(50, 4000)
            render.pixel_aspect_x, render.pixel_aspect_y = choose.choice([(1, 1), (2, 1), (1, 1.5), (1.3, 1)])
            data = camera.data
            data.sensor_fit = choose.choice(["AUTO", "HORIZONTAL", "VERTICAL"])
            data.lens = choose.uniform(10, 200)
            data.sensor_width, data.sensor_height = choose.uniform(5, 60), choose.uniform(5, 60)
            data.shift_x, data.shift_y = choose.uniform(-1, 1), choose.uniform(-1, 1)
            camera.location = [choose.uniform(-5, 5) for _ in range(3)]
            camera.rotation_euler = [choose.uniform(-3, 3) for _ in range(3)]
            camera.scale = [choose.uniform(0.5, 2)] * 3
            bpy.context.view_layer.update()
            view = projection.view_of(scene_camera.camera_of(scene, camera))
            to_camera = camera.matrix_world.normalized().inverted()
            for _ in range(5):
                point = camera.matrix_world.normalized() @ Vector([choose.uniform(-3, 3), choose.uniform(-3, 3), -4])
                x, y, z = to_camera @ point
                u, v = view.position(np.array([[x / -z, y / -z]]))[0]
                expected = world_to_camera_view(scene, camera, point)
                self.assertAlmostEqual(u, expected.x, delta=2e-5 * max(1, abs(u)))
                self.assertAlmostEqual(v, 1 - expected.y, delta=2e-5 * max(1, abs(v)))

    def test_percentage_and_border(self):
        scene = new_scene(200, 100)
        scene.render.resolution_percentage = 50
        scene.render.use_border = scene.render.use_crop_to_border = True
        scene.render.border_min_x, scene.render.border_max_x = 0.1, 0.6
        numbers = scene_camera.camera_of(scene, scene.camera)
        self.assertEqual((numbers.width, numbers.height), (100, 50))
        self.assertEqual(tuple(round(side, 6) for side in numbers.border), (0.1, 0.6, 0.0, 1.0))


class ValuesTest(TemporaryFolderTest):
    """The sum of a light's image, beside the sum of what Cycles renders."""

    def assert_as_rendered(self, scene, light, tolerance):
        picture = rendered(scene, self.folder)[..., :3].astype(float)
        np.testing.assert_allclose(light.value, picture.sum(axis=(0, 1)), rtol=tolerance)
        y, x = np.mgrid[0 : picture.shape[0], 0 : picture.shape[1]] + 0.5
        weight = picture.sum(axis=2) / picture.sum()
        self.assertAlmostEqual(light.u * picture.shape[1], (x * weight).sum(), delta=0.3)
        self.assertAlmostEqual(light.v * picture.shape[0], (y * weight).sum(), delta=0.3)

    def test_point_lamp_and_its_ball(self):
        # A ball of radius r with the radiance P / (4 pi^2 r^2) sends P watts, as the lamp does.
        power, radius, place = 300.0, 0.4, (2.4, 1.2, -10.0)
        scene = new_scene()
        lamp = add_lamp("POINT", place, energy=power, shadow_soft_size=radius, color=(1.0, 0.5, 0.25))
        scene.camera.data.shift_x = 0.05
        (light,) = lights(scene)
        strength = power / (4 * math.pi**2 * radius**2)
        bpy.data.objects.remove(lamp)
        add_ball(place, radius, material("ShaderNodeEmission", Color=(1.0, 0.5, 0.25, 1.0), Strength=strength))
        self.assert_as_rendered(scene, light, 0.02)
        (ball,) = lights(scene)
        np.testing.assert_allclose(ball.value, light.value, rtol=0.02)
        self.assertAlmostEqual(ball.size_deg / light.size_deg, 1, delta=0.05)

    def test_exposure_of_the_film(self):
        scene = new_scene()
        add_lamp("POINT", energy=100)
        (light,) = lights(scene)
        scene.cycles.film_exposure = 2.0
        self.assertAlmostEqual(lights(scene)[0].value[0] / light.value[0], 2, places=5)

    def test_area_lamp_and_its_plane(self):
        scene = new_scene()
        lamp = add_lamp("AREA", (1.0, 0.5, -8.0), (math.pi + 0.5, 0, 0), energy=50, size=0.8)
        (light,) = lights(scene)
        self.assertLess(lights(scene)[0].visible, 1.001)
        lamp.rotation_euler = (0.5, 0, 0)  # away from the camera
        self.assertEqual(lights(scene), [])
        bpy.data.objects.remove(lamp)
        plane = add_plane((1.0, 0.5, -8.0), 0.8, material("ShaderNodeEmission", Strength=50 / (4 * 0.64)))
        plane.rotation_euler = (math.pi + 0.5, 0, 0)
        self.assert_as_rendered(scene, light, 0.02)
        (same,) = lights(scene)
        np.testing.assert_allclose(same.value, light.value, rtol=0.02)

    def test_materials(self):
        scene = new_scene()
        principled = material("ShaderNodeBsdfPrincipled")
        principled.node_tree.nodes["Principled BSDF"].inputs["Emission"].default_value = (2.0, 1.0, 0.5, 1.0)
        add_ball((-1.0, -1.0, -9.0), 0.3, principled)
        (light,) = lights(scene)
        self.assert_as_rendered(scene, light, 0.02)

    def test_sky(self):
        scene = new_scene()
        add_sky(scene, 30, 40)
        turn, height = math.radians(40), math.radians(30)
        direction = Vector((math.sin(turn), math.cos(turn), math.tan(height)))
        scene.camera.rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()
        scene.camera.data.lens = 200
        bpy.context.view_layer.update()
        (light,) = lights(scene)
        self.assertAlmostEqual(light.size_deg, 2.0, places=3)
        self.assertAlmostEqual(light.u, 0.5, delta=1e-3)
        picture = rendered(scene, self.folder)[..., :3].astype(float)
        np.testing.assert_allclose(light.value, picture[picture[..., 1] > 1000].sum(axis=0), rtol=0.03)

    def test_sun(self):
        scene = new_scene()
        add_lamp("SUN", rotation=(math.pi, 0, 0), energy=4.0, angle=math.radians(0.53))  # shines along +z
        (light,) = lights(scene)
        self.assertAlmostEqual(light.size_deg, 0.53, places=3)
        self.assertEqual(light.distance, math.inf)
        self.assertAlmostEqual(light.value[0] / (4.0 / (0.72 / 96) ** 2), 1, delta=1e-3)
        self.assertAlmostEqual(light.u, 0.5, delta=1e-3)


class OcclusionTest(unittest.TestCase):
    def setUp(self):
        self.scene = new_scene()
        self.scene.camera.data.contrejour.fnumber = 16.0
        self.lamp = add_lamp("POINT", (0, 0, -10), energy=100, shadow_soft_size=0.5)

    def visible(self):
        bpy.context.view_layer.update()
        found = lights(self.scene)
        return found[0].visible if found else 0.0

    def test_on_half_and_off(self):
        wall = add_plane((0, 0, -5), 2.0, material("ShaderNodeBsdfDiffuse"))
        self.assertEqual(self.visible(), 0.0)
        wall.location.x = 1.0  # its edge is in the middle of the lamp
        self.assertAlmostEqual(self.visible(), 0.5, delta=0.05)
        steps = []
        for x in np.linspace(0.7, 1.3, 25):
            wall.location.x = x
            steps.append(self.visible())
        self.assertEqual(steps, sorted(steps))
        self.assertLess(max(np.diff(steps)), 0.1)
        wall.location.x = 5.0
        self.assertEqual(self.visible(), 1.0)
        wall.location = (0, 0, -15)  # behind the lamp
        self.assertEqual(self.visible(), 1.0)

    def test_a_point_enters_softly_through_the_pupil(self):
        self.lamp.data.shadow_soft_size = 0.0
        self.scene.camera.data.contrejour.fnumber = 1.4
        wall = add_plane((1.0, 0, -5), 2.0, material("ShaderNodeBsdfDiffuse"))
        self.assertAlmostEqual(self.visible(), 0.5, delta=0.05)
        wall.location.x = 1.02  # the pupil has a radius of 18 mm, half of it at the wall
        self.assertEqual(self.visible(), 1.0)

    def test_what_is_transparent(self):
        glass = add_plane((0, 0, -5), 2.0, material("ShaderNodeBsdfTransparent", Color=(0.6, 0.6, 0.6, 1.0)))
        self.assertAlmostEqual(self.visible(), 0.6, places=4)
        glass.hide_render = True
        self.assertEqual(self.visible(), 1.0)
        glass.hide_render = False
        glass.contrejour.hides_lights = False
        self.assertEqual(self.visible(), 1.0)

    def test_switches_of_a_light(self):
        add_plane((0, 0, -5), 2.0, material("ShaderNodeBsdfDiffuse"))
        self.lamp.contrejour.use_occlusion = False
        self.assertEqual(self.visible(), 1.0)
        self.lamp.contrejour.use = False
        self.assertEqual(self.visible(), 0.0)

    def test_lamp_in_a_glass_globe(self):
        add_ball((0, 0, -10), 0.8, material("ShaderNodeBsdfGlass"))
        self.assertAlmostEqual(self.visible(), 1.0, places=4)

    def test_instances(self):
        group = bpy.data.collections.new("Lamps")
        lamp = bpy.data.objects.new("Inner", bpy.data.lights.new("Inner", "POINT"))
        group.objects.link(lamp)
        for x in (-2, 2):
            empty = bpy.data.objects.new("Instance", None)
            empty.instance_type, empty.instance_collection, empty.location = "COLLECTION", group, (x, 0, -8)
            self.scene.collection.objects.link(empty)
        bpy.context.view_layer.update()
        self.assertEqual(len(lights(self.scene)), 3)
