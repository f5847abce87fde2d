# SPDX-License-Identifier: Apache-2.0
"""The Python package: glasses, coatings, spectra, sections, lens files, layers, measured flares."""
import pathlib
import tempfile
import unittest

import numpy as np

import contrejour

ROOT = pathlib.Path(__file__).resolve().parents[2]
FLARE = ROOT / "fuzz/corpus/measured_flare/one.flare.toml"
LENS = "cooke-triplet"
QUICK = {"width": 48, "height": 32, "wavelengths": 3, "error": 0.02}


class GlassTest(unittest.TestCase):
    def test_glasses(self):
        glass = contrejour.find_glass("N-BK7")
        self.assertAlmostEqual(glass.index_d, 1.5168, places=4)
        self.assertAlmostEqual(glass.abbe_d, 64.17, places=2)
        # Schott's data sheet: n_F = 1.52238, n_C = 1.51432.
        np.testing.assert_allclose(glass.index([486.1327, 656.2725]), [1.52238, 1.51432], atol=5e-6)
        self.assertEqual(glass.index(np.full((2, 3), 550.0)).shape, (2, 3))
        self.assertLess(glass.transmittance(400, 100), glass.transmittance(400, 10))
        self.assertIn("SCHOTT N-BK7", contrejour.bundled_glasses())
        self.assertIn("SCHOTT N-BK7", contrejour.closest_glasses(1.5168, 64.17, 10))
        self.assertEqual(contrejour.find_glass(1.7).index_d, 1.7)
        self.assertAlmostEqual(contrejour.find_glass("517642").abbe_d, 64.2, delta=0.1)
        with self.assertRaisesRegex(contrejour.InvalidArgumentError, "N-BK7"):
            contrejour.find_glass("N-BK77")
        with self.assertRaises(ValueError):
            glass.index(-1)

    def test_spectra(self):
        self.assertIn("sodium", contrejour.bundled_spectra())
        np.testing.assert_allclose(contrejour.spectrum_rgb("D65"), 1, atol=1e-3)
        red, _, blue = contrejour.spectrum_rgb("2500K", "acescg")
        self.assertGreater(red, blue)
        self.assertAlmostEqual(float(contrejour.spectral_power("A", 560)), 1)


class CoatingTest(unittest.TestCase):
    def test_reflectance(self):
        bare = contrejour.read_coating("none")
        self.assertAlmostEqual(float(bare.reflectance("1.5", 550)), 0.04)
        brewster = np.degrees(np.arctan(1.5))
        rs = ((np.cos(np.radians(brewster)) - 1.5 * np.sin(np.radians(brewster)) / 1.0) /
              (np.cos(np.radians(brewster)) + 1.5 * np.sin(np.radians(brewster)) / 1.0))
        self.assertAlmostEqual(float(bare.reflectance("1.5", 550, brewster)), 0.5 * rs**2, places=12)
        by_angle = bare.reflectance("N-BK7", np.linspace(400, 700, 7)[:, None], [0, 30, 60])
        self.assertEqual(by_angle.shape, (7, 3))
        total = by_angle + bare.transmittance("N-BK7", np.linspace(400, 700, 7)[:, None], [0, 30, 60])
        np.testing.assert_allclose(total, 1, atol=1e-12)

    def test_design(self):
        coating = contrejour.read_coating("v-coat:550")
        self.assertIn("v-coat", contrejour.coating_designs())
        self.assertEqual(coating.films, [])
        films = coating.on_glass("N-BK7")
        self.assertEqual([film.material for film in films.films], ["MgF2", "ZrO2"])
        self.assertLess(float(films.reflectance("N-BK7", 550)), 1e-6)
        again = contrejour.read_coating(films.to_text())
        np.testing.assert_allclose(again.reflectance("N-BK7", [450, 650]), films.reflectance("N-BK7", [450, 650]), atol=1e-6)
        nm = np.linspace(420, 680, 27)
        start = contrejour.read_coating("broadband-4").on_glass("N-SF11")
        refined = start.refined("N-SF11", nm, 0.0)
        self.assertLessEqual(np.sum(refined.reflectance("N-SF11", nm) ** 2), np.sum(start.reflectance("N-SF11", nm) ** 2))
        # A refined coating is one of a lens, too.
        contrejour.find_lens(LENS).with_surface(1, coating=refined.to_text()).configure()


class LensFileTest(unittest.TestCase):
    def test_write_and_read(self):
        lens = contrejour.find_lens(LENS)
        with tempfile.TemporaryDirectory() as folder:
            for ending in (".toml", ".zmx", ".seq"):
                file = pathlib.Path(folder, "lens" + ending)
                losses = lens.write(file)
                again = contrejour.find_lens(file)
                self.assertEqual([s.radius_mm for s in again.surfaces], [s.radius_mm for s in lens.surfaces], ending)
                self.assertEqual(bool(losses), ending != ".toml", losses)
            lens.configure().write_ghost(pathlib.Path(folder, "ghost.zmx"), (1, 3))
            with self.assertRaises(ValueError):
                lens.write(pathlib.Path(folder, "lens.obj"))

    def test_section(self):
        state = contrejour.configure_lens(LENS)
        self.assertIn("<svg", state._repr_svg_())
        self.assertEqual(state._repr_svg_(), contrejour.find_lens(LENS)._repr_svg_())
        stored = (ROOT / "tests/optics/drawing/heliar.svg").read_text(encoding="utf-8")
        self.assertEqual(contrejour.find_lens("heliar")._repr_svg_(), stored)
        lines = state.section_lines(ghosts=[(1, 3)], light_deg=5)
        self.assertEqual(sum(line.kind == "element" for line in lines), 3)
        ray = next(line for line in lines if line.kind == "ghost ray")
        self.assertEqual(ray.points_mm.shape[1], 2)
        self.assertAlmostEqual(ray.points_mm[-1, 0], state.sensor_z_mm)
        with self.assertRaises(ValueError):
            state.section_svg(ghosts=[(1, 90)])


class LayersTest(unittest.TestCase):
    def test_layers_sum_to_the_flare(self):
        lights = ["9,5:1000", "-6,2:500"]
        whole = contrejour.render(LENS, lights, **QUICK).image
        for by, count in (("light", 2), ("ghost", 4), ("part", 1)):
            flare = contrejour.render_layers(LENS, lights, by=by, count=3, **QUICK)
            self.assertEqual(len(flare.layers), count, list(flare.layers))
            np.testing.assert_allclose(sum(flare.layers.values()), flare.image, atol=1e-6 * whole.max())
            np.testing.assert_allclose(flare.image, whole, atol=1e-3 * whole.max())
        with self.assertRaises(ValueError):
            contrejour.render_layers(LENS, by="colour", **QUICK)


class MeasuredFlareTest(unittest.TestCase):
    def test_stands_for_a_lens(self):
        flare = contrejour.read_flare(FLARE)
        self.assertEqual(flare.ghosts, ["1"])
        self.assertEqual(flare.exposure, (1.4, 100, 1))
        size = {"width": 48, "height": 32}
        image = contrejour.render(flare, "9,5:1000", **size).image
        self.assertGreater(image.max(), 0)
        np.testing.assert_array_equal(contrejour.render(str(FLARE), "9,5:1000", **size).image, image)
        # A stop slower: half the light (walch2018 eq. 2).
        slower = contrejour.render(flare, "9,5:1000", shutter="0.5", **size).image
        np.testing.assert_allclose(slower, 0.5 * image, rtol=1e-5)
        renderer = contrejour.Renderer(flare, **size)
        np.testing.assert_array_equal(renderer.render("9,5:1000").image, image)
        layers = contrejour.render_layers(flare, ["9,5:1000", "-9,5:1000"], by="light", **size)
        self.assertEqual(list(layers.layers), ["light1", "light2"])
        np.testing.assert_array_equal(layers.layers["light1"], image)
        by_ghost = contrejour.render_layers(flare, "9,5:1000", by="ghost", **size)
        self.assertEqual(list(by_ghost.layers), ["_1", "rest"])
        with self.assertRaisesRegex(contrejour.InvalidArgumentError, "surfaces"):
            contrejour.render_layers(flare, "9,5:1000", by="surface", **size)
        picture = np.full((32, 48, 3), 0.1, np.float32)
        picture[8, 34] = 50000
        self.assertGreater(contrejour.apply(picture, flare).flare.max(), 0)

    def test_says_what_it_does_not_have(self):
        state = contrejour.configure_lens(FLARE)
        self.assertIsNone(state._repr_svg_())
        self.assertIn("1 ghosts", str(state))
        for call in (state.first_order, state.seidel, state.section_svg, lambda: contrejour.ghosts(state)):
            with self.assertRaisesRegex(contrejour.UnsupportedError, "measured flare"):
                call()
        with self.assertRaisesRegex(contrejour.InvalidArgumentError, "blades"):
            contrejour.render(FLARE, blades=6)


if __name__ == "__main__":
    unittest.main()
