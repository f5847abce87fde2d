# SPDX-License-Identifier: Apache-2.0
"""In Blender: flares as files, the compositor, handlers, presets, errors, Esc."""
import os
import pathlib
import subprocess
import time
import types
import unittest

import bpy
import numpy as np

import contrejour
import contrejour_flare
from contrejour_flare import collect, compositor, flare_request, properties, render_operators
from scenes import add_ball, add_lamp, material, new_scene, pixels_of, rendered
from temporary import TemporaryFolderTest


def fast(scene, lens="cooke-triplet"):
    options = scene.camera.data.contrejour
    options.lens, options.error, options.wavelengths = lens, "0.02", "3"
    return options


class OperatorTest(TemporaryFolderTest):
    def setUp(self):
        super().setUp()
        self.scene = new_scene()
        self.scene.contrejour.output = str(self.folder / "flare" / "f_####.exr")
        self.options = fast(self.scene)
        self.lamp = add_lamp("POINT", (1.8, 0.9, -10), energy=1000, shadow_soft_size=0.1)

    def request(self):
        return collect.request_of(self.scene, bpy.context.evaluated_depsgraph_get())

    def file(self, frame=1):
        return self.folder / "flare" / f"f_{frame:04}.exr"

    def assert_refused(self, words, operator=bpy.ops.contrejour.render_flare):
        with self.assertRaisesRegex(RuntimeError, words) as caught:
            operator()
        self.assertNotIn("Traceback", str(caught.exception))


class StillTest(OperatorTest):
    def test_file_and_image(self):
        self.assertEqual(bpy.ops.contrejour.render_flare(), {"FINISHED"})
        picture = contrejour.read_picture(self.file())
        self.assertEqual(picture.shape, (64, 96, 3))
        self.assertGreater(picture.sum(), 0)
        image = bpy.data.images["Contrejour Flare"]
        self.assertEqual(tuple(image.size), (96, 64))
        self.assertEqual(image.colorspace_settings.name, "Linear")
        np.testing.assert_array_equal(pixels_of(self.file())[..., :3], picture)

    def test_bit_for_bit_as_the_command_line(self):
        self.options.blades, self.options.fnumber, self.options.starburst = 6, 8.0, True
        for shift in (0.0, 0.21):
            self.scene.camera.data.shift_x = shift
            bpy.context.view_layer.update()
            request = self.request()
            words = [os.environ["CONTREJOUR"], *request.command_line(), "-o", str(self.folder / "cli.exr")]
            done = subprocess.run(words, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            frame = request.frame
            expected = contrejour.read_picture(self.folder / "cli.exr")
            expected = expected[frame.top : frame.bottom, frame.left : frame.right]
            bpy.ops.contrejour.render_flare()
            self.assertGreater(expected.max(), 0)
            self.assertEqual(contrejour.read_picture(self.file()).tobytes(), expected.tobytes())

    def test_lamp_on_its_pixel(self):
        self.options.starburst = True
        for shift, aspect in ((0.0, 1.0), (0.1, 1.0), (0.0, 1.5)):
            self.scene.camera.data.shift_y, self.scene.render.pixel_aspect_x = shift, aspect
            bpy.ops.contrejour.render_flare()
            flare = contrejour.read_picture(self.file()).sum(axis=2)
            ball = add_ball(self.lamp.location, 0.05, material("ShaderNodeEmission", Strength=100.0))
            direct = rendered(self.scene, self.folder)[..., 0].astype(float)
            bpy.data.objects.remove(ball)
            rows, columns = np.mgrid[0:64, 0:96] + 0.5
            where = [(grid * direct).sum() / direct.sum() for grid in (rows, columns)]
            near = np.where(flare > 0.05 * flare.max(), flare, 0.0)
            for grid, expected in zip((rows, columns), where):
                self.assertAlmostEqual((grid * near).sum() / near.sum(), expected, delta=0.6)

    def test_border_and_percentage(self):
        bpy.ops.contrejour.render_flare()
        whole = contrejour.read_picture(self.file())
        render = self.scene.render
        render.use_border = render.use_crop_to_border = True
        render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.75, 0.5, 1.0
        bpy.ops.contrejour.render_flare()
        part = contrejour.read_picture(self.file())
        np.testing.assert_array_equal(part, whole[0:32, 24:72])
        self.assertEqual(rendered(self.scene, self.folder).shape[:2], part.shape[:2])

    def test_looks_gain_and_presets(self):
        self.options.lens, self.options.look, self.options.wavelengths = "", "old-portrait", ""
        bpy.ops.contrejour.render_flare()
        by_look = contrejour.read_picture(self.file())
        bpy.ops.contrejour.load_look()
        self.assertEqual(self.options.look, "")
        self.assertEqual(self.options.lens, contrejour.find_preset("old-portrait").lens)
        self.options.error = "0.02"
        bpy.ops.contrejour.render_flare()
        np.testing.assert_array_equal(contrejour.read_picture(self.file()), by_look)
        self.options.stops = 1.0
        bpy.ops.contrejour.render_flare()
        np.testing.assert_array_equal(contrejour.read_picture(self.file()), 2 * by_look)

    def test_presets_are_kept(self):
        self.options.blades, self.options.lens = 9, "tessar"
        bpy.ops.contrejour.add_preset(name="Nine blades")
        self.options.blades, self.options.lens = 0, "heliar"
        (file,) = pathlib.Path(bpy.utils.user_resource("SCRIPTS"), "presets", "contrejour_flare").glob("*.py")
        bpy.ops.script.execute_preset(filepath=str(file), menu_idname="CONTREJOUR_MT_presets")
        self.assertEqual((self.options.blades, self.options.lens), (9, "tessar"))

    def test_camera_and_lens(self):
        self.options.lens = "distagon-25"
        self.assertIn("the lens has 25 mm", " ".join(self.request().messages))
        bpy.ops.contrejour.camera_to_lens()
        self.assertAlmostEqual(self.scene.camera.data.lens, 25, delta=0.1)
        self.assertEqual(self.request().messages, [])
        focus = self.scene.camera.data.dof
        focus.use_dof, focus.focus_distance, focus.aperture_fstop = True, 3.0, 5.6
        settings = self.request().settings
        self.assertAlmostEqual(float(settings["fnumber"]), 5.6, places=5)
        self.assertTrue(2950 < float(settings["focus"]) < 3000)

    def test_errors(self):
        self.options.lens = "cooke-triplett"
        self.assert_refused("did you mean 'cooke-triplet'")
        self.assertIn("cooke-triplet", self.scene.contrejour.message)
        self.assert_refused("did you mean", bpy.ops.contrejour.find_lights)
        self.options.lens_file = str(self.folder / "none.toml")
        self.assert_refused("none.toml")
        self.options.lens_file, self.options.lens = "", "tessar"
        self.options.cover_glass = "thick"
        self.assert_refused("cover-glass")
        self.options.cover_glass = ""
        (self.folder / "taken").write_text("a file")
        self.scene.contrejour.output = str(self.folder / "taken" / "f.exr")
        self.assert_refused("taken")
        self.scene.camera.data.type = "ORTHO"
        self.assert_refused("perspective")
        self.scene.camera = None
        self.assertFalse(bpy.ops.contrejour.render_flare.poll())


class AnimationTest(OperatorTest):
    def setUp(self):
        super().setUp()
        self.scene.frame_start, self.scene.frame_end = 1, 3
        for frame, x in ((1, -2.0), (3, 2.0)):
            self.lamp.location.x = x
            self.lamp.keyframe_insert("location", frame=frame)

    def frames(self):
        return [contrejour.read_picture(self.file(frame)) for frame in (1, 2, 3)]

    def test_three_frames(self):
        self.scene.frame_set(2)
        self.options.keyframe_insert("blades", frame=2)
        bpy.ops.contrejour.render_flare_animation()
        self.assertEqual(self.scene.frame_current, 2)
        first, middle, last = self.frames()
        self.assertFalse(np.array_equal(first, middle) or np.array_equal(middle, last))
        bpy.ops.contrejour.render_flare()
        np.testing.assert_array_equal(contrejour.read_picture(self.file(2)), middle)

    def composited(self):
        self.scene.render.filepath = str(self.folder / "out_")
        bpy.ops.render.render(animation=True)
        return [pixels_of(self.folder / f"out_{frame:04}.exr")[..., :3] for frame in (1, 2, 3)]

    def test_compositor_reads_what_the_handler_wrote(self):
        add_ball((0.5, 0.5, -9), 0.6, material("ShaderNodeEmission", Strength=0.5))
        plain = self.composited()
        self.assertFalse(self.file().exists())
        self.scene.contrejour.with_render = "BEFORE"
        bpy.ops.contrejour.flare_to_compositor()
        bpy.ops.contrejour.flare_to_compositor()  # a second time adds nothing
        self.assertEqual(sum(node.type == "MIX_RGB" for node in self.scene.node_tree.nodes), 1)
        sums = self.composited()
        for frame in range(3):
            np.testing.assert_allclose(sums[frame], plain[frame] + self.frames()[frame], rtol=1e-5, atol=1e-6)
        # Later flares are read in place of those that the compositor knows.
        self.options.stops = 3.0
        brighter = self.composited()
        np.testing.assert_allclose(brighter[1], plain[1] + self.frames()[1], rtol=1e-5, atol=1e-6)

    def test_after_each_frame(self):
        self.options.blades = 5
        self.options.keyframe_insert("blades", frame=1)
        self.options.blades = 9
        self.options.keyframe_insert("blades", frame=3)
        self.scene.contrejour.with_render = "AFTER"
        self.composited()
        by_handler = self.frames()
        bpy.ops.contrejour.render_flare_animation()
        for one, other in zip(by_handler, self.frames()):
            np.testing.assert_array_equal(one, other)
        self.options.lens = "no such lens"
        self.composited()  # renders all the same
        self.assertIn("no such lens", self.scene.contrejour.message)


class _Window:
    """The parts of a window manager and a workspace that modal operators use."""

    def __init__(self):
        self.texts, self.has_timer = [], True

    def progress_update(self, _percent):
        pass

    def progress_end(self):
        pass

    def event_timer_remove(self, _timer):
        self.has_timer = False

    def status_text_set(self, text):
        self.texts.append(text)


class _Operator(render_operators._FlareOperator):
    """The operator without Blender's window: background mode has none."""

    def __init__(self, scene, frames):
        self._scene, self._start, self._said, self._left = scene, scene.frame_current, [], list(frames)
        self._render, self._count, self._timer = None, len(frames), None
        self.reports, self.done = [], []

    def report(self, kind, text):
        self.reports.append((kind, text))

    def _done(self, _scene, frame):
        self.done.append(frame)


class ModalTest(OperatorTest):
    def run_modal(self, operator, stop_at=None):
        window = _Window()
        context = types.SimpleNamespace(window_manager=window, workspace=window,
                                        evaluated_depsgraph_get=bpy.context.evaluated_depsgraph_get)
        timer, escape = types.SimpleNamespace(type="TIMER", value=""), types.SimpleNamespace(type="ESC", value="PRESS")
        for step in range(2000):
            result = operator.modal(context, escape if step == stop_at else timer)
            if not result & {"RUNNING_MODAL", "PASS_THROUGH"}:
                self.assertFalse(window.has_timer)
                self.assertIsNone(window.texts[-1])
                return result, window
            time.sleep(0.01)
        self.fail("it does not end")

    def test_frames(self):
        operator = _Operator(self.scene, [1, 2, 3])
        self.assertEqual(self.run_modal(operator)[0], {"FINISHED"})
        self.assertEqual(operator.done, [1, 2, 3])
        self.assertTrue(self.file(3).exists())
        self.assertEqual(self.scene.frame_current, 1)

    def test_escape(self):
        self.options.lens, self.options.error = "canon-70-200", "0.003"
        operator = _Operator(self.scene, [1, 2])
        result, window = self.run_modal(operator, stop_at=10)
        self.assertEqual(result, {"CANCELLED"})
        self.assertIn("Esc", window.texts[0])
        operator._render.join(60)  # the call ends by itself, and writes nothing
        self.assertFalse(operator._render.is_alive())
        self.assertEqual((operator.done, self.file().exists()), ([], False))

    def test_error(self):
        self.options.lens = "no such lens"
        operator = _Operator(self.scene, [1])
        self.assertEqual(self.run_modal(operator)[0], {"CANCELLED"})
        self.assertIn("no such lens", operator.reports[0][1])


class RegisterTest(unittest.TestCase):
    def test_register_and_unregister_twice(self):
        for _ in range(2):
            contrejour_flare.unregister()
            self.assertFalse(hasattr(bpy.types.Camera, "contrejour"))
            contrejour_flare.register()
        handlers = bpy.app.handlers.render_post
        self.assertEqual(sum(handler.__module__.startswith("contrejour_flare") for handler in handlers), 1)

    def test_panels_show_every_parameter(self):
        scene = new_scene()
        shown = []

        class Layout:
            use_property_split = False

            def prop(self, _owner, name, **_):
                shown.append(name)

            def __getattr__(self, name):
                return (lambda *_, **__: self) if not name.startswith("__") else object.__getattribute__(self, name)

        from contrejour_flare import panels

        context = types.SimpleNamespace(camera=scene.camera.data, scene=scene, object=scene.camera)
        for panel in panels._registered:
            if hasattr(panel, "draw"):
                panel.draw(types.SimpleNamespace(layout=Layout()), context)
        self.assertLessEqual({row.attribute for row in properties.table()}, set(shown))
