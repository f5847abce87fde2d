#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""contrejour lens ... and ghosts."""
import base64
import csv
import math
import os
import re
import resource
import struct
import unittest
import xml.etree.ElementTree

import design_rows
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

    def test_sensor_by_name_and_by_size(self):
        named = self.json_of("lens", "info", "heliar", "--sensor", "super35")
        self.assertEqual((named["sensor_width_mm"], named["sensor_height_mm"]), (24.89, 18.66))
        # The same pixels on half of the sensor see half of it: ghosts are twice as large in them, in mm as before.
        whole = self.json_of("ghosts", "heliar", "-f", "8", "--light", "10,5", "--sensor", "36x24", "--size", "360x240")
        half = self.json_of("ghosts", "heliar", "-f", "8", "--light", "10,5", "--sensor", "18x12", "--size", "360x240")
        self.assertAlmostEqual(half["frame"]["pixel_pitch_mm"], 0.05, delta=1e-12)
        for one, other in zip(sorted(whole["ghosts"], key=lambda g: g["surfaces"]),
                              sorted(half["ghosts"], key=lambda g: g["surfaces"])):
            self.assertAlmostEqual(other["size_px"][0], 2 * one["size_px"][0], delta=1e-6)
            self.assertAlmostEqual(other["size_mm"][0], one["size_mm"][0], delta=1e-9)
        for wrong in ("super36", "24.9", "0x24", "36x-24", "nanx24", "1e9x1"):
            self.assertIn("alexa-lf", self.error_of("lens", "info", "heliar", "--sensor", wrong, code=2))

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

    def test_a_ghost_by_any_name(self):
        """2-5 is what is written; the other ways to say it are understood wherever a ghost is asked for."""
        lines = {self.run_program("lens", "trace", "heliar", "--ray", "0,1,-10,0,0,1", "--ghost", name).stdout
                 for name in ("2-5", "5-2", "2,5", "5,2")}
        self.assertEqual(len(lines), 1)
        for name in ("2-2", "0-3", "2-", "a-b", "2-5-3", "2.5"):
            self.error_of("lens", "trace", "heliar", "--ray", "0,1,-10,0,0,1", "--ghost", name, code=2)

    def test_coating_of_one_surface(self):
        """It replaces that surface's, whatever --coating does to all; what is no glass has none."""
        def coatings(*options):
            return [s["coating"] for s in self.json_of("lens", "info", "heliar", *options)["surfaces"]]

        own, one = coatings(), coatings("--coating-at", "4:v-coat:520", "--coating-at", "1:none")
        changed = [k + 1 for k, (a, b) in enumerate(zip(own, one)) if a != b]
        self.assertEqual(set(changed) - {1}, {4})
        self.assertIn("v-coat", one[3])
        all_but_one = coatings("--coating", "quarter-wave:500", "--coating-at", "4:none")
        self.assertEqual(all_but_one[3], "none")
        self.assertIn("500", all_but_one[0])
        stop = self.json_of("lens", "info", "heliar")["stop_index"]
        for wrong in (f"{stop}:none", "99:none"):
            self.assertIn("coating for surface", self.error_of("lens", "info", "heliar", "--coating-at", wrong, code=1))
        for wrong in ("none", "4", "x:none", "4:varnish", "0:none"):
            self.error_of("lens", "info", "heliar", "--coating-at", wrong, code=2)

    def test_draw_several_ghosts(self):
        self.run_program("lens", "draw", "heliar", "-o", "two.svg", "--ghost", "2-5,3-4", "--ghost", "8,7")
        root = xml.etree.ElementTree.parse(self.folder / "two.svg").getroot()
        texts = [element.text for element in root.iter("{http://www.w3.org/2000/svg}text")]
        for name in ("ghost 2-5", "ghost 3-4", "ghost 7-8"):
            self.assertTrue(any(text.startswith(name) for text in texts), name)
        inks = {element.get("stroke") for element in root.iter("{http://www.w3.org/2000/svg}polyline")}
        self.assertGreaterEqual(len(inks), 5)

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
        self.assertEqual(len(found["ghosts"]), 28)
        self.assertAlmostEqual(found["light"]["azimuth_deg"], 5, delta=1e-9)
        pitch = found["frame"]["pixel_pitch_mm"]
        for ghost in found["ghosts"]:
            self.assertLessEqual({"surfaces", "relative_flux", "peak_irradiance", "centroid_px", "size_px", "rgb",
                                  "paraxial_focus_mm"}, set(ghost))
            for axis in (0, 1):
                self.assertAlmostEqual(ghost["size_mm"][axis], ghost["size_px"][axis] * pitch, delta=1e-9)
            if ghost["relative_flux"] > 0:  # right in the picture is -x on the sensor, down is +y
                self.assertAlmostEqual(ghost["centroid_px"][0], 960 - ghost["centroid_mm"][0] / pitch, delta=1e-6)
                self.assertAlmostEqual(ghost["centroid_px"][1], 540 + ghost["centroid_mm"][1] / pitch, delta=1e-6)
        fluxes = [ghost["relative_flux"] for ghost in found["ghosts"]]
        self.assertEqual(fluxes, sorted(fluxes, reverse=True))
        self.assertGreater(fluxes[0], 1e-6)
        self.assertLess(fluxes[0], 1e-2)

    def test_all_pairs_unless_told_otherwise(self):
        self.assertEqual(len(self.json_of("ghosts", "heliar", "-f", "16")["ghosts"]), 28)
        self.assertEqual(len(self.json_of("ghosts", "heliar", "-f", "16", "--ghosts", "one-side")["ghosts"]), 13)

    def test_sorted_and_as_comma_separated_values(self):
        keys = {"flux": lambda g: -float(g["relative_flux"]), "peak": lambda g: -float(g["peak_irradiance"]),
                "size": lambda g: float(g["width_mm"]) * float(g["height_mm"]) or math.inf,
                "focus": lambda g: abs(float(g["paraxial_focus_mm"] or "inf"))}
        seen = set()
        for sort, key in keys.items():
            table = self.run_program("ghosts", "heliar", "-f", "8", "--sort", sort, "--csv").stdout.decode()
            rows = list(csv.DictReader(table.splitlines()))
            self.assertEqual(len(rows), 28)
            self.assertEqual([r["ghost"] for r in rows], [r["ghost"] for r in sorted(rows, key=key)])
            seen.add(rows[0]["ghost"])
        self.assertGreater(len(seen), 1)
        self.error_of("ghosts", "heliar", "--csv", "--json", code=2)
        self.error_of("ghosts", "heliar", "--sort", "colour", code=2)

    def test_product_of_reflectances(self):
        """Fresnel's at normal incidence, from the indices that `lens info` has."""
        surfaces = self.json_of("lens", "info", "heliar", "--wavelength", "550")["surfaces"]
        n = [1.0] + [s["n"] for s in surfaces]

        def reflectance(k):
            return ((n[k] - n[k - 1]) / (n[k] + n[k - 1])) ** 2

        for ghost in self.json_of("ghosts", "heliar", "--coating", "none", "--wavelength", "550")["ghosts"]:
            i, j = ghost["surfaces"]
            self.assertAlmostEqual(ghost["reflectance"] / (reflectance(i) * reflectance(j)), 1, delta=1e-9)

    def test_pupil_ghosts_stay_and_ghosts_in_focus_are_small(self):
        """Flags are of the first order; rays near the axis must bear them out."""
        def figures(angle):
            found = self.json_of("ghosts", "nikon-80-200", "-f", "22", "--light", f"{angle},0", "--hfov", "30")
            return {tuple(g["surfaces"]): g for g in found["ghosts"] if g["relative_flux"] > 0}

        near, far = figures(1), figures(2)
        focal = self.json_of("lens", "info", "nikon-80-200")["focal_length_mm"]
        still = sharp = 0
        for pair in near.keys() & far.keys():
            moved = abs(far[pair]["centroid_mm"][0] - near[pair]["centroid_mm"][0])
            light_moved = focal * (math.tan(math.radians(2)) - math.tan(math.radians(1)))
            if near[pair]["pupil_ghost"]:
                still += 1
                self.assertLess(moved, 0.15 * light_moved, pair)
            if near[pair]["in_focus"]:
                sharp += 1
                self.assertLess(max(near[pair]["size_mm"]), 1.0, pair)
        self.assertGreater(still, 0)
        self.assertGreater(sharp, 0)

    def test_long_zoom_takes_little(self):
        """528 ghosts at three wavelengths, 3 s of a processor."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.run_program("ghosts", "canon-70-200", "--focal", "135")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        if "SANITIZED" not in os.environ:
            self.assertLess(seconds, 8)

    def test_sweep(self):
        swept = self.json_of("ghosts", "heliar", "-f", "8", "--sweep", "field:0:30", "--steps", "4", "-o", "map.svg")
        self.assertEqual(swept["values"], [0, 10, 20, 30])
        one = {tuple(g["surfaces"]): g for g in self.json_of("ghosts", "heliar", "-f", "8", "--light", "20,0")["ghosts"]}
        across = self.json_of("ghosts", "heliar", "-f", "8", "--light", "20,0", "--sweep", "field:0:20", "--steps", "2")
        for ghost in across["ghosts"]:
            alone = one[tuple(ghost["surfaces"])]
            self.assertAlmostEqual(ghost["relative_flux"][1], alone["relative_flux"], delta=1e-9)
            self.assertAlmostEqual(ghost["peak_irradiance"][1], alone["peak_irradiance"], delta=1e-9)
        for ghost in swept["ghosts"]:
            self.assertEqual(ghost["worst_flux"]["relative_flux"], max(ghost["relative_flux"]))
            self.assertEqual(ghost["worst_peak"]["peak_irradiance"], max(ghost["peak_irradiance"]))
        worst = [g["worst_flux"]["relative_flux"] for g in swept["ghosts"]]
        self.assertEqual(worst, sorted(worst, reverse=True))
        root = xml.etree.ElementTree.parse(self.folder / "map.svg").getroot()
        texts = [element.text for element in root.iter("{http://www.w3.org/2000/svg}text")]
        self.assertLessEqual({"2-5", "field deg", "30"}, set(texts))
        self.assertGreater(len(list(root.iter("{http://www.w3.org/2000/svg}rect"))), 28 * 4)

    def test_sweeps_of_zoom_and_stop(self):
        focal = self.json_of("ghosts", "nikon-80-200", "-f", "16", "--sweep", "focal", "--steps", "3", "--ghosts", "one-side")
        zoom = self.json_of("lens", "info", "nikon-80-200")["zoom"]
        self.assertEqual((focal["values"][0], focal["values"][-1]), (zoom[0], zoom[-1]))
        stop = self.run_program("ghosts", "heliar", "--sweep", "fnumber:5.6:11", "--steps", "3", "--csv").stdout.decode()
        rows = list(csv.DictReader(stop.splitlines()))
        self.assertEqual(sorted({float(r["f_number"]) for r in rows})[0], 5.6)
        self.assertEqual(len(rows), 28 * 3)
        self.assertIn("zoom", self.error_of("ghosts", "heliar", "--sweep", "focal", code=1))
        for wrong in (["--sweep", "blades"], ["--sweep", "field:9:3"], ["-o", "map.svg"],
                      ["--sweep", "fnumber", "-f", "8"], ["--sweep", "field", "--sort", "size"],
                      ["--sweep", "field", "-o", "map.zmx"], ["--path", "2-5"], ["--path", "2-5", "-o", "a.svg"]):
            self.error_of("ghosts", "heliar", *wrong, code=2)

    def test_path_for_design_programs(self):
        """A tracer of its own reads the rows and lands where `lens trace` does."""
        cases = [("heliar", [], "2-5", (1.5, -2.0)), ("heliar", [], "1-8", (0.5, 1.0)),
                 ("tessar", [], "1-3-2-6", (0.7, 0.4)), ("canon-70-200", ["--focal", "135"], "3-14", (-4.0, 1.0))]
        for lens, options, ghost, (x, y) in cases:
            info = self.json_of("lens", "info", lens, *options)
            for name in ("path.zmx", "path.seq"):
                self.run_program("ghosts", lens, *options, "--path", ghost, "-o", name)
                rows = (design_rows.zemax_rows if name.endswith("zmx") else design_rows.codev_rows)(
                    (self.folder / name).read_text(encoding="utf-8"))
                media = [s["n"] for s in info["surfaces"]]
                traced = self.json_of("lens", "trace", lens, *options, "--ghost", ghost, "--wavelength", "587.5618",
                                      "--ray", f"{x},{y},-1,0.02,-0.01,1")
                order = [step["surface"] for step in traced["steps"]]
                self.assertEqual(len(rows), len(order) + 1)  # and the image
                landing = design_rows.trace(rows, design_rows.media_along(order, media), (x, y, -1), (0.02, -0.01, 1))
                self.assertAlmostEqual(landing[0], traced["sensor_mm"][0], delta=1e-7)
                self.assertAlmostEqual(landing[1], traced["sensor_mm"][1], delta=1e-7)
        self.assertIn("no ghost 2-4", self.error_of("ghosts", "tessar", "--path", "2-5", "-o", "p.zmx", code=1)
                      .replace("2-5", "2-4"))

    def test_focus_is_where_near_axis_rays_meet(self):
        ghost = self.json_of("ghosts", "heliar", "-f", "16", "--light", "0,0")["ghosts"][0]
        pair = "-".join(map(str, ghost["surfaces"]))
        traced = self.json_of("lens", "trace", "heliar", "--ray", "0,1e-4,-10,0,0,1", "--ghost", pair)
        y, direction = traced["sensor_mm"][1], traced["steps"][-1]["direction"]
        self.assertAlmostEqual(-y * direction[2] / direction[1], ghost["paraxial_focus_mm"], delta=1e-3)


if __name__ == "__main__":
    unittest.main()
