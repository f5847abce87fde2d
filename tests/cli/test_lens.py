#!/usr/bin/env python3
"""contrejour lens ... and ghosts."""
import base64
import math
import re
import struct
import unittest
import xml.etree.ElementTree

from program import ProgramTest

INFO_KEYS = {
    "name", "source", "surfaces", "stop_index", "focal_length_mm", "back_focal_distance_mm", "front_focal_distance_mm",
    "entrance_pupil_position_mm", "entrance_pupil_diameter_mm", "exit_pupil_position_mm", "exit_pupil_diameter_mm",
    "f_number", "sensor_position_mm", "sensor_width_mm", "sensor_height_mm", "zoom", "warnings"}
SURFACE_KEYS = {"index", "kind", "radius_mm", "thickness_mm", "semi_diameter_mm", "glass", "n_d", "coating"}


class Lens(ProgramTest):
    def test_list_names_lenses_that_info_knows(self):
        names = [lens["id"] for lens in self.json_of("lens", "list")["lenses"]]
        self.assertGreaterEqual(len(names), 10)
        for name in names:
            self.run_program("lens", "info", name)
        self.assertIn("heliar", self.run_program("lens", "list").stdout.decode())

    def test_info_json(self):
        info = self.json_of("lens", "info", "heliar", "-f", "16")
        self.assertLessEqual(INFO_KEYS, set(info))
        for surface in info["surfaces"]:
            self.assertLessEqual(SURFACE_KEYS, set(surface))
        self.assertEqual([s["index"] for s in info["surfaces"]], list(range(1, 10)))
        self.assertEqual(info["surfaces"][info["stop_index"] - 1]["kind"], "stop")
        self.assertAlmostEqual(info["focal_length_mm"], 99.24, delta=0.02)
        self.assertAlmostEqual(info["entrance_pupil_diameter_mm"], info["focal_length_mm"] / 16, delta=1e-3)
        self.assertAlmostEqual(info["surfaces"][-1]["thickness_mm"], info["sensor_position_mm"], delta=1e-12)

    def test_zoom_and_wavelength(self):
        info = self.json_of("lens", "info", "canon-70-200", "--focal", "100")
        self.assertEqual(info["zoom"], [70, 135, 200])
        self.assertAlmostEqual(info["focal_length_mm"], 100, delta=0.01)
        blue = self.json_of("lens", "info", "heliar", "--wavelength", "450")
        red = self.json_of("lens", "info", "heliar", "--wavelength", "650")
        self.assertGreater(blue["surfaces"][0]["n"], red["surfaces"][0]["n"])
        self.assertEqual(blue["surfaces"][0]["n_d"], red["surfaces"][0]["n_d"])

    def test_trace_json(self):
        traced = self.json_of("lens", "trace", "heliar", "--ray", "1,5,-10,0,0,3")
        self.assertEqual(traced["status"], "ok")
        self.assertEqual([step["surface"] for step in traced["steps"]], list(range(1, 10)))
        for step in traced["steps"]:
            self.assertLessEqual(
                {"surface", "event", "position_mm", "direction", "angle_of_incidence_rad", "reflectance"}, set(step))
            self.assertAlmostEqual(math.hypot(*step["direction"]), 1, delta=1e-12)
        self.assertEqual(len(traced["sensor_mm"]), 2)

    def test_ray_up_the_axis_obeys_snell(self):
        """First surface by hand: the sphere's normal, then n1 sin a = n2 sin b."""
        info = self.json_of("lens", "info", "heliar", "--wavelength", "550")
        radius, n = info["surfaces"][0]["radius_mm"], info["surfaces"][0]["n"]
        step = self.json_of("lens", "trace", "heliar", "--ray", "0,6,-5,0,0,1", "--wavelength", "550")["steps"][0]
        incidence = math.asin(6 / radius)
        self.assertAlmostEqual(step["angle_of_incidence_rad"], incidence, delta=1e-12)
        self.assertAlmostEqual(step["position_mm"][2], radius - math.sqrt(radius**2 - 36), delta=1e-10)
        bend = incidence - math.asin(math.sin(incidence) / n)
        self.assertAlmostEqual(step["direction"][1], -math.sin(bend), delta=1e-12)

    def test_trace_ghost_reflects_at_j_then_i(self):
        traced = self.json_of("lens", "trace", "heliar", "--ray", "0,1,-10,0,0,1", "--ghost", "2,5")
        reflected = [step["surface"] for step in traced["steps"] if step["event"] == "reflect"]
        self.assertEqual(reflected, [5, 2])

    def test_ray_that_misses_is_data(self):
        traced = self.json_of("lens", "trace", "heliar", "--ray", "0,500,-10,0,0,1")
        self.assertEqual(traced["status"], "missed")
        self.assertIsNone(traced["sensor_mm"])

    def test_draw(self):
        self.run_program("lens", "draw", "heliar", "-o", "plain.svg")
        self.run_program("lens", "draw", "heliar", "-o", "ghost.svg", "--ghost", "3,4", "--light", "0,5")
        for name, words in (("plain.svg", "corner of the field"), ("ghost.svg", "ghost 3-4")):
            root = xml.etree.ElementTree.parse(self.folder / name).getroot()
            texts = [element.text for element in root.iter("{http://www.w3.org/2000/svg}text")]
            self.assertIn(words, texts)
            self.assertTrue({str(k) for k in range(1, 10)} <= set(texts))
            self.assertGreater(len(list(root.iter("{http://www.w3.org/2000/svg}polyline"))), 9)
            self.assertNotIn("nan", (self.folder / name).read_text())

    def test_convert_and_check(self):
        self.run_program("lens", "convert", "canon-70-200", "mine.toml")
        self.assertEqual(self.files(), ["mine.toml"])
        a, b = self.json_of("lens", "info", "canon-70-200"), self.json_of("lens", "info", "mine.toml")
        self.assertEqual(a, b)
        self.run_program("lens", "check", "mine.toml", "heliar")
        (self.folder / "bad.toml").write_text("name = \"x\"\nsource = 5\nsurfaces = [ { radius_mm = nan } ]\n")
        done = self.run_program("lens", "check", "mine.toml", "bad.toml", code=1)
        self.assertIn("refused", done.stdout.decode())
        self.assertIn("bad.toml:2:", done.stderr.decode())

    def test_browse(self):
        """A card for each lens with its two pictures; what is refused is listed; names are text."""
        self.run_program("lens", "convert", "tessar", "t.toml")
        text = (self.folder / "t.toml").read_text()
        name = re.search('^name = "(.*)"', text, re.M)
        (self.folder / "sub").mkdir()
        (self.folder / "sub" / "t.toml").write_text(text.replace(name.group(0), 'name = "<script>A & B"'))
        (self.folder / "sub" / "broken.toml").write_text("surfaces = 3\n")
        self.run_program("lens", "browse", "heliar", "sub", "-f", "2", "--size", "64x36", "--wavelengths", "1", "-o", "page.html")
        page = (self.folder / "page.html").read_text()
        self.assertEqual(page.count('class="card"'), 2)
        self.assertIn("&lt;script&gt;A &amp; B", page)
        self.assertNotIn("<script>A", page)
        self.assertRegex(page, r"<li>sub/broken\.toml: .*broken\.toml:")
        pictures = [base64.b64decode(data) for data in re.findall('data:image/png;base64,([^"]*)', page)]
        self.assertEqual([struct.unpack(">2I", png[16:24]) for png in pictures], [(64, 36), (64, 36)])
        self.run_program("lens", "draw", "heliar", "-f", "3.5", "-o", "heliar.svg")
        sections = [base64.b64decode(data) for data in re.findall(r'data:image/svg\+xml;base64,([^"]*)', page)]
        self.assertEqual(len(sections), 2)
        self.assertEqual(sections[0], (self.folder / "heliar.svg").read_bytes())
        self.error_of("lens", "browse", "sub/broken.toml", "-o", "none.html", code=1)
        self.assertFalse((self.folder / "none.html").exists())

    def test_convert_with_a_named_output(self):
        self.run_program("lens", "convert", "heliar", "a.toml")
        self.run_program("lens", "convert", "heliar", "-o", "b.toml")
        self.run_program("lens", "convert", "--output", "c.toml", "heliar")
        for name in ("b.toml", "c.toml"):
            self.assertEqual((self.folder / "a.toml").read_bytes(), (self.folder / name).read_bytes())
        self.error_of("lens", "convert", "heliar", code=2)
        self.error_of("lens", "convert", "heliar", "-o", "a.json", code=2)

    def test_convert_to_design_programs_and_back(self):
        a = self.json_of("lens", "info", "canon-70-200")
        for name in ("canon.zmx", "canon.seq"):
            done = self.run_program("lens", "convert", "canon-70-200", name)
            self.assertIn("warning: the coatings of", done.stderr.decode())
            b = self.json_of("lens", "info", name)
            for key in ("zoom", "f_number", "sensor_width_mm", "sensor_height_mm", "stop_index"):
                self.assertEqual(a[key], b[key])
            self.assertAlmostEqual(a["focal_length_mm"], b["focal_length_mm"], delta=1e-9)
            self.assertAlmostEqual(a["sensor_position_mm"], b["sensor_position_mm"], delta=1e-9)
            self.assertEqual([s["radius_mm"] for s in a["surfaces"]], [s["radius_mm"] for s in b["surfaces"]])

    def test_unknown_lens_names_the_nearest(self):
        self.assertIn("heliar", self.error_of("lens", "info", "helier", code=1))


class Ghosts(ProgramTest):
    def test_json(self):
        found = self.json_of("ghosts", "heliar", "-f", "16", "--light", "5,3")
        self.assertLessEqual({"lens", "light", "ghosts"}, set(found))
        self.assertEqual(len(found["ghosts"]), 13)
        self.assertAlmostEqual(found["light"]["azimuth_deg"], 5, delta=1e-9)
        for ghost in found["ghosts"]:
            self.assertLessEqual({"surfaces", "relative_flux", "peak_irradiance", "centroid_px", "size_px", "rgb",
                                  "paraxial_focus_mm"}, set(ghost))
        fluxes = [ghost["relative_flux"] for ghost in found["ghosts"]]
        self.assertEqual(fluxes, sorted(fluxes, reverse=True))
        self.assertGreater(fluxes[0], 1e-6)
        self.assertLess(fluxes[0], 1e-2)

    def test_all_pairs(self):
        self.assertEqual(len(self.json_of("ghosts", "heliar", "-f", "16", "--ghosts", "all")["ghosts"]), 28)

    def test_focus_is_where_near_axis_rays_meet(self):
        ghost = self.json_of("ghosts", "heliar", "-f", "16", "--light", "0,0")["ghosts"][0]
        pair = ",".join(map(str, ghost["surfaces"]))
        traced = self.json_of("lens", "trace", "heliar", "--ray", "0,1e-4,-10,0,0,1", "--ghost", pair)
        y, direction = traced["sensor_mm"][1], traced["steps"][-1]["direction"]
        self.assertAlmostEqual(-y * direction[2] / direction[1], ghost["paraxial_focus_mm"], delta=1e-3)


if __name__ == "__main__":
    unittest.main()
