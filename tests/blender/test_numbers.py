# SPDX-License-Identifier: Apache-2.0
"""The parts of the Blender add-on that need no Blender: projection, values, samples, the table's rows, file names."""
import math
import pathlib
import sys
import types
import unittest

import numpy as np

import contrejour

ADDON = pathlib.Path(__file__).parents[2] / "plugins" / "blender" / "contrejour_flare"
package = types.ModuleType("contrejour_flare")  # its __init__ is Blender's business
package.__path__ = [str(ADDON)]
sys.modules["contrejour_flare"] = package

from contrejour_flare import flare_request, lens_choice, parameter_rows  # noqa: E402
from contrejour_flare import photometry, projection, sky, sources  # noqa: E402
from contrejour_flare.frame_files import frame_file  # noqa: E402


def camera(**changes):
    plain = dict(focal_mm=50.0, sensor_width_mm=36.0, sensor_height_mm=24.0, sensor_fit="AUTO", shift_x=0.0,
                 shift_y=0.0, width=1920, height=1080)
    return projection.Camera(**{**plain, **changes})


class ProjectionTest(unittest.TestCase):
    def test_sides(self):
        view = projection.view_of(camera())
        self.assertAlmostEqual(view.tangent_width, 36 / 50)
        self.assertAlmostEqual(view.tangent_height, 36 / 50 * 1080 / 1920)
        upright = projection.view_of(camera(width=1080, height=1920))
        self.assertAlmostEqual(upright.tangent_height, 36 / 50)
        vertical = projection.view_of(camera(sensor_fit="VERTICAL"))
        self.assertAlmostEqual(vertical.tangent_height, 24 / 50)
        wide = projection.view_of(camera(pixel_aspect=2.0, sensor_fit="HORIZONTAL"))
        self.assertAlmostEqual(wide.tangent_height, 36 / 50 * 540 / 1920)

    def test_all_pixels_make_the_field_of_view(self):
        view = projection.view_of(camera(width=192, height=108))
        x, y = np.meshgrid((np.arange(192) + 0.5) / 192 - 0.5, (np.arange(108) + 0.5) / 108 - 0.5)
        tangents = np.stack([x.ravel() * view.tangent_width, y.ravel() * view.tangent_height], axis=1)
        a, b = 0.5 * view.tangent_width, 0.5 * view.tangent_height
        whole = 4 * math.atan(a * b / math.sqrt(1 + a * a + b * b))  # of a rectangle, from a point above its middle
        self.assertAlmostEqual(view.pixel_solid_angle(tangents).sum() / whole, 1.0, places=4)

    def test_frame_of_a_shifted_picture(self):
        for shift_x, shift_y in ((0, 0), (0.2, 0), (-0.13, 0.31), (1.2, -0.7)):
            numbers = camera(width=200, height=100, shift_x=shift_x, shift_y=shift_y)
            view = projection.view_of(numbers)
            frame = projection.frame_of(numbers, view)
            self.assertEqual((frame.right - frame.left, frame.bottom - frame.top), (200, 100))
            self.assertGreaterEqual(min(frame.left, frame.top), 0)
            self.assertTrue(frame.right <= frame.width and frame.bottom <= frame.height)
            axis = projection.position_in_frame(view, frame, np.array([view.axis()]))[0]
            self.assertLessEqual(abs(axis[0] - 0.5) * frame.width, 0.25 + 1e-9)
            self.assertLessEqual(abs(axis[1] - 0.5) * frame.height, 0.25 + 1e-9)
            pitch = 2 * math.tan(math.radians(frame.hfov_deg) / 2) / frame.width
            self.assertAlmostEqual(pitch, view.tangent_width / 200)

    def test_border(self):
        numbers = camera(width=200, height=100, border=(0.25, 0.5, 0.1, 0.4))
        frame = projection.frame_of(numbers, projection.view_of(numbers))
        self.assertEqual((frame.left, frame.right, frame.top, frame.bottom), (50, 100, 60, 90))


class PhotometryTest(unittest.TestCase):
    def test_spot_as_cycles_renders_it(self):
        # Intensities of a spot of 100 W, cone 80 degrees, that Cycles 3.4 gives a small plane at these angles.
        soft, hard = {0: 7.9577, 0.2: 7.7990, 0.4: 7.3295, 0.6: 3.3514}, {0.4: 7.3295, 0.6: 6.5678}
        for blend, measured in ((0.5, soft), (0.0, hard)):
            for angle, intensity in measured.items():
                factor = photometry.spot_factor(math.cos(angle), math.radians(80), blend)
                self.assertAlmostEqual(photometry.point_intensity(100) * factor / intensity, 1, delta=2e-3)
        self.assertEqual(photometry.spot_factor(math.cos(0.8), math.radians(80), 0.5), 0.0)

    def test_area_as_cycles_renders_it(self):
        # The lamp has 100 W and the side 0.1: without a spread, and with 1.5 rad, at the same angles.
        for spread, measured in ((math.pi, {0: 24.986, 0.4: 23.013}), (1.5, {0.2: 98.279, 0.4: 64.479, 0.6: 28.104})):
            for angle, intensity in measured.items():
                cosine = np.array([math.cos(angle)])
                radiance = photometry.area_radiance(100, 0.01) * photometry.spread_factor(cosine, spread)
                self.assertAlmostEqual(float(radiance[0] * cosine[0] * 0.01) / intensity, 1, delta=5e-3)

    def test_spread_keeps_the_power(self):
        angles = (np.arange(20000) + 0.5) / 20000 * math.pi / 2
        weights = np.cos(angles) * np.sin(angles)
        for spread in (0.3, 1.0, 2.5, math.pi):
            power = (photometry.spread_factor(np.cos(angles), spread) * weights).sum() / weights.sum()
            self.assertAlmostEqual(power, 1.0, places=3)

    def test_black_body(self):
        red, green, blue = photometry.blackbody_rgb(3200)
        self.assertTrue(red > green > blue)
        self.assertAlmostEqual(max(photometry.blackbody_rgb(6500)) / min(photometry.blackbody_rgb(6500)), 1, delta=0.08)

    def test_sky_as_cycles_renders_it(self):
        # Mean radiance of a disc of 2 degrees by elevation, altitude, air and dust.
        solid_angle = math.pi * math.radians(1) ** 2
        for elevation, altitude, air, dust, rgb in (
            (90, 0, 1, 1, (156487, 130691, 106275)), (30, 0, 1, 1, (144749, 114934, 81656)),
            (15, 0, 1, 1, (125098, 90462, 50172)), (30, 0, 2, 1, (130496, 93495, 50560)),
            (30, 0, 1, 3, (130125, 103324, 73409)), (30, 3000, 1, 1, (156975, 128664, 99490)),
        ):
            radiance = sky.sun_irradiance(math.radians(elevation), altitude, air, dust) / solid_angle
            np.testing.assert_allclose(radiance, rgb, rtol=0.02)
        self.assertEqual(sky.sun_irradiance(math.radians(-5), 0, 1, 1).max(), 0)


def lamp(distance=10.0, radius=0.0, count=64, at=(0.0, 0.0)):
    middle = np.array([at[0] * distance, at[1] * distance, -distance])
    points = middle + radius * np.pad(sources.disc_points(count), ((0, 0), (0, 1)))
    return sources.Source("lamp", points, np.full((count, 3), 5.0 / count), radius_rad=math.asin(radius / distance))


class SourcesTest(unittest.TestCase):
    view = projection.view_of(camera())

    def test_value(self):
        # Intensity 5 at the distance 10 gives the irradiance 0.05; a pixel on the axis has (0.72/1920)^2 steradians.
        (light,) = sources.lights_of(lamp(radius=0.1), self.view, np.ones(64))
        self.assertAlmostEqual(light.value[0] / (0.05 / (0.72 / 1920) ** 2), 1, delta=1e-3)
        self.assertAlmostEqual(light.size_deg, 2 * math.degrees(math.asin(0.01)), places=6)
        self.assertAlmostEqual(light.distance, 10, delta=0.01)
        self.assertAlmostEqual(light.u, 0.5, delta=1e-3)

    def test_hidden_points(self):
        source = lamp(radius=0.1)
        half = (source.points[:, 0] > 0).astype(float)
        (light,) = sources.lights_of(source, self.view, half)
        self.assertAlmostEqual(light.visible, 0.5, delta=0.02)
        self.assertGreater(light.u, 0.5)
        self.assertLess(light.size_deg, 2 * math.degrees(math.asin(0.01)))
        self.assertEqual(sources.lights_of(source, self.view, np.zeros(64)), [])

    def test_behind_and_beside(self):
        source = lamp()
        source.points[:, 2] *= -1
        self.assertEqual(sources.lights_of(source, self.view, np.ones(64)), [])
        (light,) = sources.lights_of(lamp(at=(1.0, 0.0)), self.view, np.ones(64))
        self.assertGreater(light.u, 1.0)

    def test_a_long_source_is_divided(self):
        points = np.stack([np.linspace(-3, 3, 128), np.zeros(128), np.full(128, -10.0)], axis=1)
        tube = sources.Source("tube", points, np.ones((128, 3)))
        lights = sources.lights_of(tube, self.view, np.ones(128))
        self.assertEqual(len(lights), sources.MAX_PARTS)
        whole = sources.image_of(tube, self.view).values.sum(axis=0)
        np.testing.assert_allclose(np.sum([light.value for light in lights], axis=0), whole)

    def test_size_of_a_disc_without_a_known_radius(self):
        source = lamp(radius=0.2)
        source.radius_rad = None
        (light,) = sources.lights_of(source, self.view, np.ones(64))
        self.assertAlmostEqual(light.size_deg / math.degrees(2 * 0.02), 1, delta=0.02)


class RowsTest(unittest.TestCase):
    rows = {row.name: row for row in parameter_rows.rows(contrejour.parameters())}

    def test_each_row_of_the_table_has_a_property(self):
        left_out = {p.name for p in contrejour.parameters() if p.name not in self.rows}
        self.assertLessEqual({"size", "hfov", "detect", "value"}, left_out)
        self.assertTrue(all(p.scene for p in contrejour.parameters() if p.name in left_out))
        for row in self.rows.values():
            if row.kind in ("real", "integer"):
                self.assertLessEqual(row.minimum, row.default, row.name)
                self.assertLessEqual(row.default, row.maximum, row.name)
                self.assertLessEqual(row.soft_minimum, row.soft_maximum, row.name)
            self.assertTrue(row.description and row.label)

    def test_a_new_row_appears(self):
        new = contrejour.Parameter(name="new-thing", group="New", kind="real", unit="mm", minimum=0, maximum=2,
                                   default="1", help="a new thing", choices=(), repeats=False, scene=False)
        (row,) = parameter_rows.rows([new])
        self.assertEqual((row.attribute, row.label, row.default, row.maximum), ("new_thing", "New thing (mm)", 1.0, 2))

    def test_defaults_leave_settings_to_the_look(self):
        for row in self.rows.values():
            self.assertIsNone(parameter_rows.setting(row, row.default), row.name)
        blades = self.rows["blades"]
        self.assertEqual(parameter_rows.setting(blades, 0, is_animated=True), "0")
        f_number = self.rows["fnumber"]
        self.assertIsNone(parameter_rows.setting(f_number, 0.0, is_animated=True))
        self.assertEqual(parameter_rows.setting(f_number, 5.599999904632568), "5.6")
        texts = parameter_rows.setting(self.rows["ghost"], "2-5:gain=0.5; 1-3:gain=2")
        self.assertEqual(texts, ["2-5:gain=0.5", "1-3:gain=2"])

    def test_settings_are_what_the_library_takes(self):
        for name in contrejour.bundled_presets():
            look = contrejour.find_preset(name)
            for attribute, text in look.settings.items():
                row = self.rows[attribute.replace("_", "-")]
                again = parameter_rows.setting(row, parameter_rows.value_of_setting(row, text), is_animated=True)
                self.assertTrue(again is not None or text in ("", []), (name, attribute, text))

    def test_file_names(self):
        self.assertEqual(frame_file("/a/f_####.exr", 7), "/a/f_0007.exr")
        self.assertEqual(frame_file("/a##/f", 7), "/a##/f0007.exr")
        self.assertEqual(frame_file("//x/##_f_###.exr", 12345), "//x/##_f_12345.exr")


class LensChoiceTest(unittest.TestCase):
    @staticmethod
    def choose(lens, focal_mm, **changes):
        plain = dict(focal_mm=focal_mm, f_number=None, focus_mm=None, sets_zoom=True)
        return lens_choice.choose(lens, None, {}, lens_choice.CameraLens(**{**plain, **changes}))

    def test_zooms_and_primes(self):
        zoomed = self.choose("canon-70-200", 135.0)
        self.assertEqual((zoomed.settings["focal"], zoomed.messages), ("135.0", []))
        self.assertIn("the zoom reaches 72", self.choose("canon-70-200", 35.0).messages[0])
        self.assertEqual(self.choose("planar-50", 50.0).messages, [])
        self.assertIn("the lens has 50 mm", self.choose("planar-50", 35.0).messages[0])

    def test_depth_of_field(self):
        chosen = self.choose("planar-50", 50.0, f_number=8.0, focus_mm=2000.0)
        self.assertEqual(chosen.settings["fnumber"], "8.0")
        self.assertAlmostEqual(float(chosen.settings["focus"]), 2000.0 - chosen.first_surface_mm)
        self.assertAlmostEqual(chosen.pupil_radius_mm, 50 / 8 / 2, delta=0.02)
        too_wide = self.choose("planar-50", 50.0, f_number=0.7)
        self.assertNotIn("fnumber", too_wide.settings)
        self.assertIn("opens to f/1.4", too_wide.messages[0])

    def test_nothing_shines(self):
        numbers = camera(width=20, height=10)
        frame = projection.frame_of(numbers, projection.view_of(numbers))
        picture = flare_request.render(flare_request.FlareRequest("planar-50", None, {}, [], frame))
        self.assertEqual((picture.shape, picture.max()), ((10, 20, 3), 0))


if __name__ == "__main__":
    unittest.main()
