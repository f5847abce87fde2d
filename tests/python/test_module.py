# SPDX-License-Identifier: Apache-2.0
"""The Python package: lenses, rendering into arrays, photographs, ghosts, rays, errors, Ctrl-C."""
import math
import os
import pathlib
import signal
import tempfile
import threading
import time
import unittest

import numpy as np

import contrejour
from contrejour._settings import values_of

LENS = "cooke-triplet"
QUICK = {"width": 48, "height": 32, "wavelengths": 3, "error": 0.02}
LIGHT = "9,5:1000"


def photograph(dtype=np.float32, channels=3):
    picture = np.full((32, 48, channels), 0.1, dtype)
    picture[8, 34, :3] = 50000
    return picture


class LensTest(unittest.TestCase):
    def test_bundled(self):
        self.assertIn(LENS, contrejour.bundled_lenses())
        lens = contrejour.find_lens(LENS)
        self.assertEqual(len(lens.surfaces), 7)
        self.assertEqual([s.kind for s in lens.surfaces].count("stop"), 1)
        self.assertEqual(contrejour.read_lens_toml(lens.to_toml()).to_toml(), lens.to_toml())
        self.assertIn("semi-diameter mm", str(lens))
        self.assertIn(lens.name, repr(lens))

    def test_states(self):
        state = contrejour.configure_lens(LENS, f_number=8, focus="2m", blades=5)
        self.assertAlmostEqual(state.f_number, 8)
        self.assertEqual(state.object_distance_mm, 2000)
        self.assertAlmostEqual(state.first_order().focal_length_mm, state.focal_length_mm, places=6)
        # Parameters that are not given stay.
        other = state.configure(f_number=11)
        self.assertEqual((other.object_distance_mm, round(other.f_number, 6)), (2000, 11))
        zoom = contrejour.find_lens("nikon-80-200")
        self.assertAlmostEqual(zoom.configure(focal=140).focal_length_mm, 140, delta=1)
        self.assertEqual(zoom.zoom_mm, sorted(zoom.zoom_mm))

    def test_seidel(self):
        sums = contrejour.configure_lens(LENS).seidel()
        self.assertEqual(len(sums), 7)
        self.assertGreater(sum(s.petzval for s in sums), 0)  # the field of a lens of positive power bends inwards

    def test_changed_surface(self):
        lens = contrejour.find_lens(LENS)
        changed = lens.with_surface(1, radius_mm=lens.surfaces[0].radius_mm * 1.1, glass="N-BK7", coating="none")
        self.assertEqual(changed.surfaces[0].glass, "N-BK7")
        self.assertAlmostEqual(changed.surfaces[0].radius_mm, lens.surfaces[0].radius_mm * 1.1)
        self.assertNotAlmostEqual(changed.configure().focal_length_mm, lens.configure().focal_length_mm, places=2)
        with self.assertRaises(contrejour.InvalidArgumentError):
            lens.with_surface(1, glass="no such glass")

    def test_errors(self):
        with self.assertRaisesRegex(contrejour.InvalidArgumentError, "did you mean 'heliar'"):
            contrejour.find_lens("heliaar")
        with self.assertRaisesRegex(contrejour.ParseError, "mine.toml:1: "):
            contrejour.read_lens_toml("name = 3\n", "mine.toml")
        with self.assertRaises(OSError):
            contrejour.find_lens("none/such.toml")
        with self.assertRaisesRegex(ValueError, "fnumber: 0 is out of range"):
            contrejour.configure_lens(LENS, f_number=0)
        with self.assertRaisesRegex(TypeError, "did you mean fnumber"):
            contrejour.configure_lens(LENS, fnumbr=8)


class ParametersTest(unittest.TestCase):
    def test_table(self):
        table = {p.name: p for p in contrejour.parameters()}
        self.assertEqual(table["fnumber"].maximum, 1000)
        self.assertIn("points", table["anisotropic"].choices)
        # Every parameter is a keyword argument: its default may be given.
        for p in table.values():
            if p.default and not p.repeats:
                values = values_of({p.name.replace("-", "_"): p.default})
                self.assertEqual(values.texts(p.name), [p.default])

    def test_presets(self):
        self.assertIn("old-portrait", contrejour.bundled_presets())
        preset = contrejour.find_preset("old-portrait")
        by_preset = contrejour.render(preset="old-portrait", **QUICK, light=LIGHT).image
        by_settings = contrejour.render(preset.lens, **{**preset.settings, **QUICK}, light=LIGHT).image
        np.testing.assert_array_equal(by_preset, by_settings)


class RenderTest(unittest.TestCase):
    def test_arrays(self):
        flare = contrejour.render(LENS, LIGHT, **QUICK)
        self.assertEqual((flare.image.shape, flare.image.dtype), ((32, 48, 3), np.float32))
        self.assertGreater(flare.image.sum(), 0)
        self.assertFalse(flare.image.flags.owndata)  # the library's memory, not a copy
        self.assertGreater(flare.statistics["ghosts_rendered"], 5)
        self.assertTrue(flare._repr_png_().startswith(b"\x89PNG"))
        # Into every second row of an array with alpha, from the bottom up.
        host = np.full((64, 48, 4), 7, np.float32)
        view = host[::-2]
        into = contrejour.render(LENS, LIGHT, out=view, wavelengths=3, error=0.02)
        self.assertIs(into.image, view)
        np.testing.assert_array_equal(view[..., :3], flare.image)
        self.assertTrue((view[..., 3] == 7).all() and (host[::2] == 7).all())
        half = np.zeros((32, 48, 3), np.float16)
        contrejour.render(LENS, LIGHT, out=half, **QUICK)
        np.testing.assert_array_equal(half, flare.image.astype(np.float16))
        for wrong in (np.zeros((32, 48, 3)), np.zeros((32, 48, 2), np.float32)):
            with self.assertRaises((TypeError, ValueError)):
                contrejour.render(LENS, LIGHT, out=wrong, **QUICK)
        wrong = np.zeros((32, 48, 3), np.float32)
        wrong.flags.writeable = False
        with self.assertRaises(ValueError):
            contrejour.render(LENS, LIGHT, out=wrong, **QUICK)

    def test_lights(self):
        reference = contrejour.render(LENS, LIGHT, **QUICK).image
        light = contrejour.Light.at_angles(9, 5, 1000)
        np.testing.assert_array_equal(contrejour.render(LENS, light, **QUICK).image, reference)
        np.testing.assert_array_equal(contrejour.render(LENS, (9, 5), value=1000, **QUICK).image, reference)
        both = contrejour.render(LENS, [light, "-9,5:1000"], **QUICK).image
        np.testing.assert_allclose(both.sum(), 2 * reference.sum(), rtol=0.05)
        state = contrejour.configure_lens(LENS)
        middle = contrejour.Light.at_image(state, 0, 0, (3, 2, 1), spectrum="E")
        np.testing.assert_allclose(middle.direction, (0, 0, 1), atol=1e-12)
        with self.assertRaises(contrejour.InvalidArgumentError):
            contrejour.render(LENS, contrejour.Light((0, 0, -1)), **QUICK)

    def test_renderer(self):
        renderer = contrejour.Renderer(LENS, **QUICK)
        for f_number in (5.6, 8):
            np.testing.assert_array_equal(
                renderer.render(LIGHT, f_number=f_number).image,
                contrejour.render(LENS, LIGHT, f_number=f_number, **QUICK).image,
            )

    def test_starburst(self):
        image = contrejour.starburst(LENS, "0,0:1000", f_number=16, width=96, height=64)
        self.assertAlmostEqual(image.sum() / 3000, 1, delta=0.05)
        self.assertEqual(np.unravel_index(image.sum(axis=2).argmax(), (64, 96)), (31, 47))

    def test_progress_and_exceptions(self):
        seen = []
        contrejour.render(LENS, LIGHT, progress=seen.append, **QUICK)
        self.assertEqual(seen, sorted(seen))
        self.assertAlmostEqual(seen[-1], 1)

        def stop(done):
            raise KeyError("enough")

        with self.assertRaisesRegex(KeyError, "enough"):
            contrejour.render(LENS, LIGHT, progress=stop, **QUICK)

    def test_interrupt(self):
        # As Ctrl-C does, in the middle of a rendering of minutes.
        timer = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        began = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            contrejour.render("canon-70-200", LIGHT, method="reference", density=16, width=640, height=400)
        self.assertLess(time.monotonic() - began, 60)
        timer.join()
        self.assertIs(signal.getsignal(signal.SIGINT), signal.default_int_handler)
        self.assertGreater(contrejour.render(LENS, LIGHT, **QUICK).image.sum(), 0)

    def test_cancel(self):
        # From another thread, in phases that take seconds to minutes. A busy machine may make the call wait.
        picture = np.full((540, 960, 3), 0.1, np.float32)
        picture[::60, ::80] = 5000
        frame = {"width": 640, "height": 400}
        flag = contrejour.CancelFlag()
        calls = {
            "reference": lambda: contrejour.render("canon-70-200", LIGHT, method="reference", density=16, cancel=flag, **frame),
            "polynomial": lambda: contrejour.render("canon-70-200", LIGHT, method="polynomial", cancel=flag, **frame),
            "starburst": lambda: contrejour.render("canon-70-200", LIGHT, starburst=True, cancel=flag, width=1920, height=1280),
            "layers": lambda: contrejour.render_layers("canon-70-200", LIGHT, by="ghost", cancel=flag, width=1920, height=1280),
            "apply": lambda: contrejour.apply(picture, "canon-70-200", cancel=flag),
            "rays": lambda: contrejour.trace(LENS, np.zeros((5_000_000, 3)), np.ones((5_000_000, 3)), cancel=flag),
        }
        for name, call in calls.items():
            flag.clear()
            flagged = []
            timer = threading.Timer(0.3, lambda: (flagged.append(time.process_time()), flag.set()))
            timer.start()
            with self.assertRaises(contrejour.CancelledError, msg=name):
                call()
            # Processor time, of two threads at most beside the timer's own. Programs on the same core's other thread
            # lengthen it by up to half.
            self.assertLess(time.process_time() - flagged[0], 0.3, name)
            timer.join()
        self.assertTrue(flag.is_set())
        with self.assertRaises(contrejour.CancelledError):
            contrejour.render(LENS, LIGHT, cancel=flag, **QUICK)
        flag.clear()
        self.assertGreater(contrejour.render(LENS, LIGHT, cancel=flag, **QUICK).image.sum(), 0)

    def test_window(self):
        whole = contrejour.render(LENS, LIGHT, **QUICK).image
        frame = contrejour.render(LENS, LIGHT, window=(0, 0, 48, 32), **QUICK).image
        np.testing.assert_array_equal(frame, whole)
        part = contrejour.render(LENS, LIGHT, window=(20, 4, 15, 9), **QUICK).image
        self.assertEqual(part.shape, (9, 15, 3))
        np.testing.assert_allclose(part, whole[4:13, 20:35], atol=0.05 * whole.max())
        self.assertGreater(np.corrcoef(part.ravel(), whole[4:13, 20:35].ravel())[0, 1], 0.97)
        into = np.zeros((9, 15, 4), np.float32)
        contrejour.render(LENS, LIGHT, window=(20, 4, 15, 9), out=into, **QUICK)
        np.testing.assert_array_equal(into[..., :3], part)
        for wrong in ((40, 0, 9, 9), (-1, 0, 9, 9), (0, 0, 0, 9)):
            with self.assertRaisesRegex(contrejour.InvalidArgumentError, "48 x 32"):
                contrejour.render(LENS, LIGHT, window=wrong, **QUICK)
        # Pixels that are not square on the sensor.
        wide = contrejour.render(LENS, LIGHT, pixel_aspect=2, **QUICK).image
        half = contrejour.render(LENS, LIGHT, pixel_aspect=2, window=(24, 0, 24, 32), **QUICK).image
        np.testing.assert_allclose(half, wide[:, 24:], atol=0.05 * wide.max())

    def test_other_threads_run(self):
        counted = [0]
        done = threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        during = 0
        for _ in range(20):  # a busy machine may let the thread wait
            before = counted[0]
            contrejour.render(LENS, LIGHT, width=640, height=400, error=0.001)
            during = max(during, counted[0] - before)
            if during > 3:
                break
        done.set()
        thread.join()
        self.assertGreater(during, 3)


class PhotographTest(unittest.TestCase):
    def test_apply(self):
        picture = photograph(channels=4)
        result = contrejour.apply(picture, LENS, error=0.02, wavelengths=3)
        self.assertEqual(len(result.lights), 1)
        np.testing.assert_allclose(result.lights[0].centroid_px, (34.5, 8.5))
        self.assertGreater(result.flare.max(), 0)
        np.testing.assert_allclose(result.image[..., :3], picture[..., :3] + np.maximum(result.flare, 0), rtol=1e-6)
        np.testing.assert_array_equal(result.image[..., 3], picture[..., 3])
        half = photograph(np.float16)
        in_place = contrejour.apply(half, LENS, out=half, error=0.02, wavelengths=3)
        self.assertIs(in_place.image, half)
        self.assertTrue((half > 0.1).any())

    def test_window(self):
        picture = photograph(channels=4)
        settings = {"error": 0.02, "wavelengths": 3, "starburst": True}
        whole = contrejour.apply(picture, LENS, **settings)
        part = contrejour.apply(picture, LENS, window=(10, 2, 30, 20), **settings)
        self.assertEqual((part.image.shape, part.flare.shape), ((20, 30, 4), (20, 30, 3)))
        self.assertEqual(part.lights, whole.lights)  # found in the whole picture
        np.testing.assert_allclose(part.flare, whole.flare[2:22, 10:40], atol=0.02 * whole.flare.max())
        np.testing.assert_array_equal(part.image[..., 3], picture[2:22, 10:40, 3])
        away = contrejour.apply(picture, LENS, window=(0, 20, 9, 9), **settings)  # without the light
        np.testing.assert_allclose(away.flare, whole.flare[20:29, :9], atol=0.02 * whole.flare.max())
        with self.assertRaises(contrejour.InvalidArgumentError):
            contrejour.apply(picture, LENS, window=(0, 20, 9, 90), **settings)

    def test_detection(self):
        found = contrejour.detect_lights(photograph())
        self.assertEqual(found.lights[0].bounds_px, (34, 8, 34, 8))
        self.assertEqual(found.matte.shape, (32, 48, 1))
        self.assertEqual(found.matte[8, 34, 0], 1)
        self.assertEqual(contrejour.detect_lights(photograph(), region="0,0,0.5,1", threshold=1).lights, [])

    def test_files_and_comparison(self):
        picture = photograph()
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "a.exr"
            contrejour.write_picture(file, picture)
            np.testing.assert_array_equal(contrejour.read_picture(file), picture)
        self.assertIsNone(contrejour.compare(picture, picture).psnr_db)
        self.assertAlmostEqual(contrejour.compare(picture, picture * 2).flux_ratio[0], 2, places=5)
        with self.assertRaises(contrejour.InvalidArgumentError):
            contrejour.compare(picture, picture[:5])


class RaysTest(unittest.TestCase):
    def test_ghosts(self):
        ghosts = contrejour.ghosts(LENS, (9, 5), f_number=8)
        fluxes = [g.relative_flux for g in ghosts]
        self.assertEqual(len(ghosts), 15)
        self.assertEqual(fluxes, sorted(fluxes, reverse=True))
        self.assertEqual(ghosts[0].name, "{}-{}".format(*ghosts[0].surfaces))

    def test_trace(self):
        state = contrejour.configure_lens(LENS)
        n = 2000
        # Paraxial rays parallel to the axis meet it in the focus; infinity is in focus.
        origins = np.zeros((n, 3))
        origins[:, 1] = np.linspace(-0.05, 0.05, n)
        directions = np.tile([0.0, 0.0, 3.0], (n, 1))
        rays = contrejour.trace(state, origins, directions)
        self.assertEqual(rays.stop.shape, (n, 1, 2))
        self.assertTrue(rays.passed.all())
        self.assertLess(np.abs(rays.sensor_mm).max(), 1e-4)
        angle = 1e-4
        directions = np.tile([0.0, math.sin(angle), math.cos(angle)], (n, 1))
        y_mm = contrejour.trace(state, origins, directions).sensor_mm[:, 1]
        np.testing.assert_allclose(y_mm, state.focal_length_mm * math.tan(angle), rtol=1e-2)
        ghost = contrejour.ghosts(state, (0, 0))[0]
        self.assertLess(contrejour.trace(state, origins, directions, ghost=ghost.surfaces).transmission.max(), 0.1)
        # Into the arrays of an earlier call, and on any number of threads.
        again = contrejour.trace(state, origins, directions, threads=1)
        into = contrejour.trace(state, np.flip(origins, 0), directions, out=again, threads=3)
        self.assertIs(into, again)
        np.testing.assert_array_equal(into.sensor_mm[::-1], contrejour.trace(state, origins, directions).sensor_mm)
        with self.assertRaisesRegex(ValueError, "out"):
            contrejour.trace(state, origins[:5], directions[:5], out=again)
        with self.assertRaises(ValueError):
            contrejour.trace(state, origins, directions[:5])
        with self.assertRaises(ValueError):
            contrejour.trace(state, origins, directions, ghost=(1, 40))


class DirectPolynomialsTest(unittest.TestCase):
    def test_rays_and_back(self):
        fit = contrejour.fit_direct_polynomials(LENS, focus=2000)
        random = np.random.default_rng(3)
        sensor, stop = random.uniform(-8, 8, (50, 2)), random.uniform(-0.6, 0.6, (50, 2))
        rays = fit.rays(sensor, stop, 500)
        traced = contrejour.trace(LENS, rays.origin_mm, -rays.direction, lambda_nm=500, focus=2000)
        np.testing.assert_allclose(traced.sensor_mm, sensor, atol=36 / 1920)
        np.testing.assert_allclose(rays.transmittance, traced.transmission, rtol=2e-3)
        points = rays.origin_mm + 1500 * rays.direction
        np.testing.assert_allclose(fit.sensor_points(points, stop, 500), sensor, atol=1e-6)
        np.testing.assert_allclose(fit.sensor_points(rays.direction, stop, 500, distant=True), sensor, atol=1e-6)
        self.assertTrue(np.isnan(fit.rays([[1000, 0]], [[0, 0]]).weight).all())
        self.assertLess(fit.accuracy["sensor_p95_px"], 0.05)

    def test_file_and_source(self):
        fit = contrejour.fit_direct_polynomials(LENS, max_order=5)
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "a.poly")
            fit.at_wavelength(550).write(file)
            again = contrejour.read_direct_polynomials(file)
        names: dict = {}
        exec(again.source("python"), names)
        ray, rays = names["lens_ray"](3.0, 4.0, 0.2, 0.1, 550), again.rays([[3, 4]], [[0.2, 0.1]])
        np.testing.assert_allclose(ray[:6], [*rays.origin_mm[0], *rays.direction[0]], atol=1e-12)
        self.assertIn("bool lens_sensor", again.source("hlsl"))
        with self.assertRaises(ValueError):
            again.source("fortran")
        with self.assertRaisesRegex(ValueError, "shape"):
            again.rays([1, 2], [0, 0])
        with self.assertRaises(contrejour.UnsupportedError):
            contrejour.fit_direct_polynomials("schneider-anamorphic-31")


class PolynomialsTest(unittest.TestCase):
    ONLY = {"only": [(1, 2), (3, 6)], "max_order": 9}

    def test_a_ghost_without_axial_symmetry(self):
        fit = contrejour.fit_polynomials(
            "cooke-triplet", only=[(1, 2)], max_order=9, half_field_deg=3, decentre=0.1, build_seed=3
        )
        points = np.random.default_rng(1).uniform(-3, 3, (200, 2))
        rays = fit.evaluate((1, 2), (1.5, -2.0), points, 550)
        x, y = math.tan(math.radians(1.5)), math.tan(math.radians(-2.0))
        direction = np.array([x, y, 1.0]) / math.sqrt(1 + x * x + y * y)
        origins = np.column_stack([points, np.full(200, fit.entrance_z_mm)])
        traced = contrejour.trace(
            "cooke-triplet",
            origins,
            np.tile(direction, (200, 1)),
            ghost=(1, 2),
            lambda_nm=550,
            decentre=0.1,
            build_seed=3,
        )
        both = rays.passed & traced.passed
        self.assertGreater(both.sum(), 20)
        errors = np.linalg.norm(rays.sensor_mm - traced.sensor_mm, axis=1)[both]
        self.assertLess(np.quantile(errors, 0.95), 0.25 * 36 / 1920)
        with self.assertRaisesRegex(ValueError, "as .x, y."):
            fit.evaluate((1, 2), 1.5, points)

    def test_fit_and_evaluate(self):
        fit = contrejour.fit_polynomials(LENS, **self.ONLY)
        self.assertEqual(sorted(fit.ghosts), [(1, 2), (3, 6)])
        self.assertFalse(fit.is_range)
        self.assertIn("2 ghosts", repr(fit))
        zone = fit.ghosts[1, 2][0]
        self.assertEqual(zone["state"], "fitted")
        self.assertLess(zone["position_p95_px"], 0.25)
        # Against traced rays of the same light: from -x, through points of the entrance plane.
        angle = 0.5 * math.atan(zone["field"][0] + zone["field"][1])
        points = np.random.default_rng(1).uniform(-3, 3, (200, 2))
        rays = fit.evaluate((1, 2), math.degrees(angle), points, 550)
        origins = np.column_stack([points, np.full(200, fit.entrance_z_mm)])
        directions = np.tile([math.sin(angle), 0.0, math.cos(angle)], (200, 1))
        traced = contrejour.trace(LENS, origins, directions, ghost=(1, 2), lambda_nm=550)
        both = rays.passed & traced.passed
        self.assertGreater(both.sum(), 20)
        pixel_mm = 36 / 1920
        errors = np.linalg.norm(rays.sensor_mm - traced.sensor_mm, axis=1)[both]
        self.assertLess(np.quantile(errors, 0.95), 0.25 * pixel_mm)
        np.testing.assert_allclose(rays.transmittance[both], traced.transmission[both], rtol=0.02)
        with self.assertRaisesRegex(ValueError, "no such ghost"):
            fit.evaluate((1, 3), 5, points)
        with self.assertRaisesRegex(ValueError, "shape"):
            fit.evaluate((1, 2), 5, points[0])

    def test_renderer_and_file(self):
        fit = contrejour.fit_polynomials(LENS, **self.ONLY)
        frame = {**QUICK, "error": 0.005, "ghosts": "one-side"}
        adaptive = contrejour.render(LENS, LIGHT, **frame).image
        flare = contrejour.render(LENS, LIGHT, method="polynomial", fit=fit, **frame)
        np.testing.assert_allclose(flare.image.sum(), adaptive.sum(), rtol=0.02)
        self.assertLess(flare.statistics["traced_flux"], 1)  # the ghosts that are not in the fit are traced
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "a.poly")
            fit.write(file)
            again = contrejour.read_polynomials(file)
            self.assertEqual(again.ghosts, fit.ghosts)
            renderer = contrejour.Renderer(LENS, method="polynomial", fit=again, **frame)
            np.testing.assert_array_equal(renderer.render(LIGHT).image, flare.image)
            np.testing.assert_array_equal(
                contrejour.render(LENS, LIGHT, method="polynomial", fit=file, **frame).image, flare.image
            )
        with self.assertRaisesRegex(ValueError, "polynomial"):
            contrejour.render(LENS, LIGHT, method="bundle", fit=fit, **frame)
        with self.assertRaisesRegex(contrejour.Error, "another lens"):
            contrejour.render("tessar", LIGHT, method="polynomial", fit=fit, **frame)

    def test_range(self):
        fit = contrejour.fit_polynomials(LENS, focus=(2000, math.inf), **self.ONLY)
        self.assertTrue(fit.is_range)
        near = {"focus": "4m"}
        state = fit.at(LENS, **near)
        frame = {**QUICK, "ghosts": "one-side", "method": "polynomial", **near}
        np.testing.assert_array_equal(
            contrejour.render(LENS, LIGHT, fit=fit, **frame).image,
            contrejour.render(LENS, LIGHT, fit=state, **frame).image,
        )
        with self.assertRaisesRegex(ValueError, "at\\(\\)"):
            fit.evaluate((1, 2), 5, np.zeros((1, 2)))
        with self.assertRaises(contrejour.Error):
            fit.at(LENS, focus="1m")
        with self.assertRaises(TypeError):
            contrejour.fit_polynomials(LENS, zoom=(1, 2), focus=(1, 2))


if __name__ == "__main__":
    unittest.main()
