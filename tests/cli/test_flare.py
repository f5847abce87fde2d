#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""contrejour render, compare and bench tables."""
import json
import math
import struct
import unittest

import exr
from program import QUICK, ProgramTest


class Render(ProgramTest):
    def render(self, name, *arguments, lens="heliar"):
        self.run_program("render", lens, "-f", "16", "-o", name, *QUICK, *arguments)
        return exr.Picture(self.folder / name)

    def test_a_near_disc_far_outside_a_tiny_frame(self):
        """Its ghosts in focus are divided as finely as any: a division by zero ended the program."""
        self.run_program("render", "planar-50", "-o", "a.exr", "--size", "48x32", "--hfov", "39.5978",
                         "--light-at=1.242094,-0.870385:10680:D65:1.326989:8611.819")
        self.assertGreater(exr.Picture(self.folder / "a.exr").total(), 0)

    def test_outputs_and_statistics(self):
        picture = self.render("a.exr", "--preview", "a.png", "--stats", "a.json")
        self.assertEqual((picture.width, picture.height), (96, 64))
        self.assertEqual(set(picture.channels), {"R", "G", "B"})
        self.assertGreater(picture.total(), 0)
        header = (self.folder / "a.png").read_bytes()[:24]
        self.assertEqual(header[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(struct.unpack(">2I", header[16:]), (96, 64))
        stats = json.loads((self.folder / "a.json").read_text())
        self.assertLessEqual({"method", "device", "time_ms", "rays", "surface_hits", "primitives", "ghosts_rendered",
                              "ghosts_skipped_flux", "peak_memory_bytes"}, set(stats))
        self.assertIn("total", stats["time_ms"])
        self.assertEqual((stats["method"], stats["ghosts_rendered"]), ("adaptive", 28))
        self.assertEqual(self.files(), ["a.exr", "a.json", "a.png"])

    def test_the_brightest_lights(self):
        """What is drawn of a light is in proportion to its value, as far as values go."""
        for more in ([], ["--starburst", "--glare", "0.1"], ["--ringing", "fresnel"], ["--light-size", "0.5"],
                     *(["--method", method] for method in ("bundle", "tiled"))):
            with self.subTest(more):
                self.render("one.exr", *more)
                most = self.render("most.exr", "--value", "1e15", *more)
                one = exr.Picture(self.folder / "one.exr")
                peak = max(one.channels["G"])
                for a, b in zip(one.channels["G"], most.channels["G"]):
                    self.assertAlmostEqual(a, b * 1e-15, delta=1e-3 * peak)

    def test_starburst(self):
        """Off it changes no bit; on, the picture holds the light's own image beside the ghosts."""
        def bytes_of(name, *arguments):
            self.render(name, "--value", "30", "--blades", "7", *arguments)
            return (self.folder / name).read_bytes()

        self.assertEqual(bytes_of("a.exr"), bytes_of("b.exr", "--starburst-gain", "5", "--glare-width", "3"))
        bytes_of("s.exr", "--starburst", "--stats", "s.json")
        self.assertIn("starburst", json.loads((self.folder / "s.json").read_text())["time_ms"])
        bytes_of("h.exr", "--starburst", "--starburst-gain", "0.5")
        bytes_of("g.exr", "--glare", "0.1", "--glare-width", "0.5")
        off, on, half, glare = (exr.Picture(self.folder / f"{name}.exr") for name in "ashg")
        for channel in "RGB":
            own = on.total(channel) - off.total(channel)
            self.assertAlmostEqual(own, 30, delta=0.3)
            self.assertAlmostEqual(half.total(channel) - off.total(channel), 0.5 * own, delta=1e-3 * own)
            self.assertAlmostEqual(glare.total(channel) - off.total(channel), 3, delta=0.6)
        brightest = max(range(96 * 64), key=lambda k: on.channels["G"][k])
        self.assertEqual((brightest % 96, brightest // 96), (int(0.70 * 96), int(0.33 * 64)))
        for wrong in (["--starburst-gain", "-1"], ["--glare", "1.5"], ["--glare-width", "0"], ["--glare", "nan"]):
            self.error_of("render", "heliar", "-o", "w.exr", *wrong, code=2)

    def test_near_lights_lamps_and_lenses_with_errors(self):
        """Each changes the flare, said at their defaults they do not, and nonsense is a wrong usage."""
        def bytes_of(name, *arguments):
            self.render(name, *arguments)
            return (self.folder / name).read_bytes()

        (self.folder / "lamp.csv").write_text("nm,power\n500,1\n520,1\n")
        plain = bytes_of("a.exr")
        self.assertEqual(plain, bytes_of("b.exr", "--light-distance", "inf", "--tilt", "0", "--build-seed", "3"))
        for k, options in enumerate((["--light-distance", "500"], ["--colour", "sodium"], ["--colour", "lamp.csv"],
                                     ["--tilt", "0.2", "--decentre", "0.1"])):
            self.assertNotEqual(plain, bytes_of(f"{k}.exr", *options))
        green = exr.Picture(self.folder / "2.exr")
        self.assertGreater(green.total("G"), abs(green.total("R")) + abs(green.total("B")))
        (self.folder / "bad.csv").write_text("400,1\n500 nm,1\n")
        self.assertIn("bad.csv:2: ", self.error_of("render", "heliar", "-o", "w.exr", "--colour", "bad.csv", code=2))
        self.error_of("render", "heliar", "-o", "w.exr", "--light-distance", "0.01mm", code=1)
        for wrong in (["--light-distance", "0"], ["--light-distance", "nan"], ["--colour", "no-lamp"],
                      ["--tilt", "90"], ["--decentre", "-1"]):
            self.error_of("render", "heliar", "-o", "w.exr", *wrong, code=2)

    def test_ghosts_bent_to_taste(self):
        def picture(name, *arguments):
            return self.render(name, "--select", "list:1-2,2-3", *arguments)

        plain, twice = picture("a.exr"), picture("b.exr", "--ghost-gain", "2")
        red = picture("c.exr", "--ghost", "1-2:gain=1,colour=1,0,0", "--ghost", "2-3:colour=1,0,0")
        for name in "RGB":
            self.assertAlmostEqual(twice.total(name), 2 * plain.total(name), delta=0.02 * abs(plain.total(name)))
        self.assertAlmostEqual(red.total("R"), plain.total("R"), delta=0.02 * plain.total("R"))
        self.assertEqual(red.total("G"), 0)
        ramped = picture("d.exr", "--ghost-ramp=-9:0,0,1/9:0,0,1")
        self.assertEqual(ramped.total("R"), 0)
        self.assertGreater(ramped.total("B"), 0)
        picture("e.exr", "--ghost-jitter", "0.1", "--ghost-seed", "4")
        for wrong in (["--ghost", "2-5:gain"], ["--ghost", "5-5:gain=1"], ["--ghost", "2-5:gain=-1"],
                      ["--ghost", "2-5:shape=1"], ["--ghost", "2-5:offset=1"], ["--ghost-ramp", "0:1,1,1/0:1,1,1"],
                      ["--ghost-ramp", "1,1,1"], ["--ghost-gain", "-1"]):
            self.error_of("render", "heliar", "-o", "w.exr", *wrong, code=2)
        self.error_of("render", "heliar", "-o", "w.exr", "--ghost", "2-99:gain=1", code=1)

    def test_doubling_the_light_doubles_the_flare(self):
        one, two = self.render("1.exr", "--value", "3"), self.render("2.exr", "--value", "6")
        for name in "RGB":
            self.assertEqual([2 * v for v in one.channels[name]], two.channels[name])

    def test_a_light_mirrored_mirrors_the_flare(self):
        """A light on the other side of both axes: the picture turned by half a turn."""
        a, b = self.render("a.exr", "--light", "6,4"), self.render("b.exr", "--light", "-6,-4")
        peak = max(a.channels["G"])
        for k, value in enumerate(a.channels["G"]):
            self.assertAlmostEqual(value, b.channels["G"][-1 - k], delta=0.02 * peak)

    def test_a_quarter_turn_of_the_light_turns_the_flare(self):
        def square(name, u, v):
            self.run_program("render", "heliar", "-f", "16", "-o", name, "--size", "72x72", "--grid", "64",
                             "--light-at", f"{u},{v}")
            return exr.Picture(self.folder / name)

        a, b = square("a.exr", 0.75, 0.5), square("b.exr", 0.5, 0.25)  # right, then up
        (ax, ay), (bx, by) = a.centroid(), b.centroid()
        self.assertGreater(abs(ax - 36), 2)  # it is off the middle, or nothing is tested
        self.assertAlmostEqual(bx, ay, delta=0.05)
        self.assertAlmostEqual(by, 72 - ax, delta=0.05)
        self.assertAlmostEqual(a.total(), b.total(), delta=2e-3 * a.total())

    def test_a_light_lands_where_it_is_put(self):
        """--light-at and --light agree: the direction found for a place makes the same flare."""
        report = self.json_of("ghosts", "heliar", "-f", "16", "--light-at", "0.7,0.3", "--size", "96x64")["light"]
        self.assertGreater(report["azimuth_deg"], 0)
        self.assertGreater(report["elevation_deg"], 0)
        a = self.render("a.exr", "--light-at", "0.7,0.3")
        b = self.render("b.exr", "--light", f"{report['azimuth_deg']!r},{report['elevation_deg']!r}")
        peak = max(a.channels["G"])
        for p, q in zip(a.channels["G"], b.channels["G"]):
            self.assertAlmostEqual(p, q, delta=1e-3 * peak)

    def test_lights_add_and_carry_their_own_values(self):
        both = self.render("c.exr", "--light", "5,2:3", "4,-3:5:A", "--method", "bundle")
        a = self.render("a.exr", "--light", "5,2:3", "--method", "bundle")
        b = self.render("b.exr", "--light=4,-3:5", "--colour", "A", "--method", "bundle")
        for name in "RGB":
            peak = max(both.channels[name])
            for p, q, r in zip(a.channels[name], b.channels[name], both.channels[name]):
                self.assertAlmostEqual(p + q, r, delta=1e-5 * peak)

    def test_brightness_in_other_terms(self):
        """Stops over white, lux, candela and nits, against what they mean for a thin pupil without losses."""
        def flux(value, *arguments):
            return self.render("a.exr", "--light-at", "0.5,0.5", "--value", value, *arguments).total("G")

        info = self.json_of("lens", "info", "heliar", "-f", "16")
        pitch = min(info["sensor_width_mm"] / 96, info["sensor_height_mm"] / 64)
        disc = ("--light-size", "2")
        pixels = math.pi * (info["focal_length_mm"] * math.tan(math.radians(1)) / pitch) ** 2
        of_disc = flux("1", *disc)
        self.assertAlmostEqual(flux("5stops", *disc) / of_disc, 32 * pixels, delta=1e-3 * 32 * pixels)
        one = flux("1")
        lux = flux("2000lx", "--iso", "400", "--shutter", "1/100") / one
        without_losses = 2000 * math.pi / 4 * info["entrance_pupil_diameter_mm"] ** 2 / pitch ** 2 * 0.01 * 400 * 0.18 / 10
        self.assertLess(lux, without_losses)
        self.assertGreater(lux, 0.6 * without_losses)
        self.assertAlmostEqual(flux("2000lx") / one, lux / 4 * 2, delta=1e-3 * lux)  # ISO 100, 1/50 s
        nits = flux("1e6nits", *disc) / of_disc
        self.assertAlmostEqual(nits, lux / 4 * 2 * 500 * math.pi * math.sin(math.radians(1)) ** 2, delta=1e-3 * nits)
        near = ("--light-distance", "5m")
        self.assertAlmostEqual(flux("50cd", *near), flux("2lx", *near), delta=1e-5 * one)
        for value, word in (("5stops", "--light-size"), ("7nits", "--light-size"), ("7cd", "--light-distance")):
            self.assertIn(word, self.error_of("render", "heliar", "-o", "a.exr", "--value", value, code=1))
        for value in ("50stops", "-1lx", "3parsecs", "stops"):
            self.error_of("render", "heliar", "-o", "a.exr", "--value", value, code=2)
        self.error_of("render", "heliar", "-o", "a.exr", "--shutter", "1/0", code=2)

    def test_colour(self):
        warm = self.render("w.exr", "--colour", "2800K", "--coating", "none")
        white = self.render("d.exr", "--coating", "none")
        self.assertGreater(warm.total("R") / warm.total("B"), 2 * white.total("R") / white.total("B"))
        green = self.render("g.exr", "--value", "0,1,0")
        self.assertEqual((green.total("R"), green.total("B")), (0, 0))

    def test_irises(self):
        square = [1.0 if 2 <= x < 6 and 3 <= y < 6 else 0.0 for y in range(8) for x in range(8)]
        exr.write(self.folder / "mask.exr", {name: (exr.FLOAT, square) for name in "RGB"}, 8, 8)
        totals = {self.render(f"{k}.exr", *arguments).total() for k, arguments in enumerate((
            [], ["--blades", "6"], ["--blades", "6", "--blade-curvature", "0.5"],
            ["--blades", "6", "--blade-asymmetry", "0.2"], ["--blades", "6", "--blade-asymmetry", "0.2", "--blade-seed", "1"],
            ["--blades", "6", "--blade-closing", "mechanism"], ["--iris-image", "mask.exr"]))}
        self.assertEqual(len(totals), 7)
        round_iris = (self.folder / "0.exr").read_bytes()
        self.render("round.exr", "--blades", "6", "--blade-curvature", "1")
        self.assertEqual((self.folder / "round.exr").read_bytes(), round_iris)

    def test_pictures_that_are_no_iris(self):
        def refused(name, *more):
            text = self.error_of("render", "heliar", "-o", "a.exr", *QUICK, "--iris-image", name, *more, code=1)
            self.assertNotIn("a.exr", self.files())
            return text

        grey = {"one.exr": [1.0], "black.exr": [0.0], "nan.exr": [math.nan], "inf.exr": [math.inf], "minus.exr": [-1.0]}
        for name, values in grey.items():
            exr.write(self.folder / name, {c: (exr.FLOAT, values) for c in "RGB"}, 1, 1)
        (self.folder / "text.png").write_text("not a picture")
        for name in ("missing.png", "text.png", "black.exr", "nan.exr", "inf.exr", "minus.exr"):
            with self.subTest(name):
                self.assertIn(name, refused(name))
        self.assertIn("black", refused("black.exr"))
        self.assertIn("either", refused("one.exr", "--blades", "5"))
        self.render("a.exr", "--iris-image", "one.exr")  # all white

    def test_selection(self):
        whole, one = self.render("a.exr"), self.render("b.exr", "--select", "list:3-4")
        self.assertLess(one.total(), whole.total())
        self.render("c.exr", "--select", "brightest:2", "--stats", "c.json")
        self.assertEqual(json.loads((self.folder / "c.json").read_text())["ghosts_rendered"], 2)
        self.error_of("render", "heliar", "-o", "d.exr", *QUICK, "--select", "list:1-99", code=1)

    def test_same_file_for_any_number_of_threads(self):
        self.render("a.exr", "--threads", "1")
        self.render("b.exr", "--threads", "3")
        self.assertEqual((self.folder / "a.exr").read_bytes(), (self.folder / "b.exr").read_bytes())

    def test_tiles_do_not_show(self):
        """`tiled` gives the same file for any tiles, and nearly bundle's flare."""
        a = self.render("a.exr", "--method", "tiled", "--stats", "a.json")
        self.render("b.exr", "--method", "tiled", "--tile", "16", "--coarse-tile", "0")
        self.assertEqual((self.folder / "a.exr").read_bytes(), (self.folder / "b.exr").read_bytes())
        bundle = self.render("c.exr")
        self.assertAlmostEqual(a.total(), bundle.total(), delta=0.03 * bundle.total())
        stats = json.loads((self.folder / "a.json").read_text())
        self.assertEqual(stats["method"], "tiled")
        self.assertGreater(stats["primitives"], stats["primitives_merged"])
        self.assertGreater(stats["tile_list_bytes"], 4 * stats["tile_indices"])
        self.render("d.exr", "--method", "tiled", "--interpolation", "mean-value", "--merge-steps", "0")
        text = self.error_of("render", "heliar", "-o", "e.exr", *QUICK, "--method", "tiled", "--tile", "48", code=1)
        self.assertIn("48", text)

    def test_many_lights(self):
        lights = [f"{0.2 + 0.015 * k:.6f},0.4:0.001" for k in range(40)]
        self.run_program("render", "heliar", "-f", "16", "-o", "a.exr", "--size", "8x8", "--grid", "16",
                         "--wavelengths", "1", "--light-at", *lights)
        self.assertGreater(exr.Picture(self.folder / "a.exr").total(), 0)

    def test_ten_thousand_lights_are_read(self):
        """Far enough to see that the chosen ghost does not exist; all of them would take minutes."""
        lights = [f"{0.2 + 0.00006 * k:.6f},0.4:0.001" for k in range(10000)]
        text = self.error_of("render", "heliar", "-o", "a.exr", "--size", "8x8", "--select", "list:8-99", "--light-at",
                             *lights, code=1)
        self.assertIn("8-99", text)


class Compare(ProgramTest):
    def picture(self, name, values):
        exr.write(self.folder / name, {c: (exr.FLOAT, values) for c in "RGB"}, 8, 4)

    def test_equal(self):
        self.picture("a.exr", list(range(32)))
        result = self.json_of("compare", "a.exr", "a.exr")
        self.assertLessEqual({"psnr_db", "peak", "max_abs_error", "flux_ratio"}, set(result))
        self.assertIsNone(result["psnr_db"])
        self.assertEqual((result["max_abs_error"], result["flux_ratio"]), (0, [1, 1, 1]))

    def test_known_error(self):
        self.picture("a.exr", [10.0] * 32)
        self.picture("b.exr", [9.0] * 32)
        result = self.json_of("compare", "a.exr", "b.exr")
        self.assertAlmostEqual(result["psnr_db"], 20, delta=1e-9)  # 10 log10(10^2 / 1^2)
        self.assertEqual((result["peak"], result["max_abs_error"]), (10, 1))
        self.assertAlmostEqual(result["flux_ratio"][1], 0.9, delta=1e-7)
        self.assertIn("20.000 dB", self.run_program("compare", "a.exr", "b.exr").stdout.decode())

    def test_sizes_differ(self):
        self.picture("a.exr", [1.0] * 32)
        exr.write(self.folder / "b.exr", {c: (exr.FLOAT, [1.0]) for c in "RGB"}, 1, 1)
        self.error_of("compare", "a.exr", "b.exr", code=1)


class LensesBench(ProgramTest):
    def test_figures_of_files(self):
        (self.folder / "list.txt").write_text("# lenses\nbad.lens\n\ntessar.toml\n")
        self.run_program("lens", "convert", "tessar", "tessar.toml")
        (self.folder / "bad.lens").write_text("no lens")
        done = self.run_program("bench", "lenses", "heliar", "--list", "list.txt", "--json", "l.json", "--runs", 1,
                                "--error", "0.1", "--wavelengths", 1, code=1)
        text = done.stdout.decode()
        self.assertIn("left out: bad.lens:1: not a lens file", text)
        self.assertIn("90th percentile", text)
        bench = json.loads((self.folder / "l.json").read_text())
        self.assertEqual([lens["lens"] for lens in bench["lenses"]], ["heliar", "tessar.toml"])
        self.assertEqual(len(bench["left_out"]), 1)
        for lens in [bench["yardstick"], *bench["lenses"]]:
            self.assertEqual([frame["frame"] for frame in lens["frames"]],
                             ["f/8 320x180", "f/8 1920x1080", "wide open 320x180", "wide open 1920x1080"])
            for frame, yard in zip(lens["frames"], bench["yardstick"]["frames"]):
                ghost, canon_ghost = (f["first_ms"] / f["ghosts"] for f in (frame, yard))
                self.assertAlmostEqual(frame["ghost_ratio"], ghost / canon_ghost, 9)
                self.assertGreater(frame["warm_ms"], 0)
        self.assertEqual(bench["yardstick"]["frames"][1]["f_number"], 8)
        ratios = sorted(lens["frames"][1]["ghost_ratio"] for lens in bench["lenses"])
        summary = bench["summary"]["f8"]["ghost_ratio_large"]
        self.assertAlmostEqual(summary["median"], sum(ratios) / 2, 9)
        self.assertAlmostEqual(summary["ninetieth_percentile"], 0.1 * ratios[0] + 0.9 * ratios[1], 9)
        self.assertEqual(summary["worst"], ratios[1])
        self.error_of("bench", "lenses", code=1)


class PolynomialBench(ProgramTest):
    """The published polynomial fits on the thesis's own rays."""

    def test_sparse_fits_and_zones(self):
        done = self.run_program("bench", "polynomial", "--tables", "algorithms,zones", "--json", "p.json", "--csv",
                                "p.csv", "--plots", "plots")
        self.assertIn("thesis error", done.stdout.decode())
        rows = json.loads((self.folder / "p.json").read_text())["rows"]
        by_name = {row["fit"]: row for row in rows}
        dense = by_name["dense, which the others start from"]
        self.assertEqual(dense["terms"], 1001)
        self.assertLess(abs(dense["error"] / dense["thesis_error"] - 1), 0.15)  # other random rays
        for name in ("omp", "omp with replacement", "annealing"):
            row = by_name[name]
            self.assertLess(row["error"], row["thesis_error"])
            self.assertLess(row["seconds"], row["thesis_seconds"])
            self.assertLess(row["unseen_error"], 1.2 * row["error"])
        self.assertGreater(by_name["omp, published"]["error"], 1)  # no better than the thesis has it
        self.assertTrue(any(row["table"] == "zones" and row["terms"] == 5 for row in rows))
        self.assertEqual(len((self.folder / "p.csv").read_text().splitlines()), 1 + len(rows))
        plots = sorted(p.name for p in (self.folder / "plots").iterdir())
        self.assertEqual(plots, ["convergence.svg", "times.svg", "zones.svg"])

    def test_whole_field_fits_of_a_lens(self):
        # Pictures of `adaptive` in place of the reference's, which take half a minute.
        (self.folder / "references").mkdir()
        for name, stop in (("heliar-1-64x36-3nm-1", ["-f", 16]), ("heliar-1-64x36-3nm-1-full-aperture", [])):
            self.run_program("render", "heliar", *stop, "--light-at", "0.70,0.33", "--ghosts", "one-side",
                             "--wavelengths", 3, "--size", "64x36", "-o", f"references/{name}.exr")
        done = self.run_program("bench", "polynomial", "--tables", "lenses,lens-pictures", "--systems", "heliar",
                                "--size", "64x36", "--cache", "references", "--json", "l.json")
        self.assertIn("Whole-field fits", done.stdout.decode())
        lenses = json.loads((self.folder / "l.json").read_text())["lenses"]
        self.assertEqual([row["f_number"] for row in lenses["fits"]], [16, 3.5])
        for row in lenses["fits"]:
            self.assertEqual(row["ghosts"], 13)
            self.assertGreater(row["rays"], 2000)
            self.assertLess(row["median_position_p95_px"], 0.02)
            self.assertLess(row["weighted_position_p95_px"], 0.25)
            self.assertLess(row["weighted_transmittance_p95"], 2e-3)
            self.assertLess(row["traced_flux_fraction"], 0.15)
            self.assertLess(row["bytes"], 2e6)
        self.assertEqual(len(lenses["pictures"]), 2)
        for row in lenses["pictures"]:
            self.assertGreater(row["adaptive_psnr_db"] or 100, 60)  # null: equal
            self.assertGreater(row["polynomial_psnr_db"], 50)
            self.assertLess(abs(row["polynomial_flux_ratio"] - 1), 0.005)
        self.assertEqual(len(list((self.folder / "references").iterdir())), 2)

    def test_wrong_tables(self):
        self.error_of("bench", "polynomial", "--tables", "9", code=2)
        self.error_of("bench", "polynomial", "--tables", "lenses", "--systems", "leica", code=2)
        self.error_of("bench", "polynomial", "--tables", "zones", "--lens", "nothing", code=1)


class PolynomialRange(ProgramTest):
    """One fit for a range of focus: it draws each of its states as that state's own file does."""

    def test_fit_at_and_render(self):
        lens = ("cooke-triplet", "--ghosts", "one-side")
        self.run_program("polynomial", "fit", *lens, "--focus-range", "2000,inf", "--max-order", "11", "-o", "a.poly")
        info = json.loads(self.run_program("polynomial", "info", "a.poly", "--json").stdout)
        self.assertEqual(info["range"], "objects from 2000 to inf mm")
        self.assertEqual(len(info["ghosts"]), 7)
        self.run_program("polynomial", "at", "a.poly", "cooke-triplet", "--focus", "3m", "-o", "b.poly")
        frame = ("--size", "48x32", "--light", "9,5", "--method", "polynomial", "--focus", "3m")
        for fit in ("a", "b"):
            self.run_program("render", *lens, *frame, "--fit", f"{fit}.poly", "-o", f"{fit}.exr")
        compared = json.loads(self.run_program("compare", "a.exr", "b.exr", "--json").stdout)
        self.assertEqual(compared["max_abs_error"], 0)
        self.assertIn("one of", self.error_of("polynomial", "at", "b.poly", "cooke-triplet", "-o", "c.poly", code=1))
        self.error_of("polynomial", "at", "a.poly", "cooke-triplet", "--focus", "1m", "-o", "c.poly", code=1)
        self.assertIn("polynomial at", self.error_of("polynomial", "export", "a.poly", "-o", "c.py", code=1))


class DirectImage(ProgramTest):
    """Camera rays as polynomials: fitted, described, exported."""

    def text_in(self, name):
        return (self.folder / name).read_text()

    def test_direct_image(self):
        lens = ("cooke-triplet", "--focus", "2m")
        self.run_program("polynomial", "fit", *lens, "--direct", "-o", "a.poly")
        info = json.loads(self.run_program("polynomial", "info", "a.poly", "--json").stdout)
        self.assertEqual(info["kind"], "direct")
        self.assertLess(info["sensor_p95_px"], 0.05)
        self.assertIn(b"the direct image, order", self.run_program("polynomial", "info", "a.poly").stdout)
        for ending, text in (("c", "int lens_ray("), ("glsl", "bool lens_ray("), ("hlsl", "bool lens_sensor("),
                             ("py", "def lens_ray(")):
            self.run_program("polynomial", "export", "a.poly", "-o", f"all.{ending}")
            self.run_program("polynomial", "export", "a.poly", "--wavelength", "550", "-o", f"one.{ending}")
            self.assertIn(text, self.text_in(f"one.{ending}"))
            self.assertLess(len(self.text_in(f"one.{ending}")), len(self.text_in(f"all.{ending}")))
        self.assertIn("no ghosts", self.error_of("polynomial", "export", "a.poly", "--ghost", "1-2", "-o", "b.c", code=1))
        self.assertIn("not a file of polynomials", self.error_of("polynomial", "at", "a.poly", *lens, "-o", "b.poly", code=1))
        self.error_of("polynomial", "fit", *lens, "--direct", "--focus-range", "2000,inf", "-o", "b.poly", code=2)
        self.assertIn("symmetry", self.error_of("polynomial", "fit", "schneider-anamorphic-31", "--direct", "-o", "b.poly",
                                                code=1))


class HullinBench(ProgramTest):
    """hullin2011's figures, as small as they still show what they are about."""

    def figure(self, key, lens, *arguments):
        done = self.run_program("bench", "hullin", "--figures", key, "--lenses", lens, "--size", "96x54", "--json",
                                "h.json", *arguments)
        rows = json.loads((self.folder / "h.json").read_text())["rows"]
        self.assertTrue(all(row["figure"] == key and row["lens"] == lens and row["time_ms"] > 0 for row in rows))
        return done.stdout.decode(), rows

    def test_wide_open_and_closed(self):
        text, rows = self.figure("15", "tessar", "--pictures", "pictures")
        self.assertIn("Figure 15", text)
        self.assertEqual([(round(row["f_number"] / 4.5), row["rendered"]) for row in rows],
                         [(1, "high quality"), (1, "normal quality"), (4, "high quality"), (4, "normal quality")])
        self.assertEqual([row["ghosts_rendered"] for row in rows], [9, 6, 9, 6])  # without 40 per cent of nine
        self.assertGreater(rows[1]["psnr_db"], 20)
        pictures = sorted(p.name for p in (self.folder / "pictures").iterdir())
        self.assertEqual(len(pictures), 8)
        self.assertIn("15-tessar-f18-high-quality.png", pictures)

    def test_qualities(self):
        text, rows = self.figure("17", "nikon-80-200", "--grid", "16")
        self.assertEqual([row["ghosts_rendered"] for row in rows], [142, 142, 114, 86])
        self.assertEqual([row["paper_ms"] and round(1e3 / row["paper_ms"], 1) for row in rows], [6.1, None, None, 20.6])
        self.assertIn("faster than all ghosts", text)

    def test_dense_rays_and_bundles(self):
        _, rows = self.figure("19", "heliar", "--grid", "32", "--density", "0.1")
        self.assertEqual([row["rendered"] for row in rows], ["dense rays", "ray bundles", "adaptive"])
        self.assertEqual([row["ghosts_rendered"] for row in rows], [13] * 3)
        self.assertGreater(rows[1]["psnr_db"], 20)
        self.assertGreater(rows[2]["psnr_db"], 20)

    def test_coarse_grids(self):
        _, rows = self.figure("grids", "tessar")
        decibels = [row["psnr_db"] for row in rows]
        self.assertEqual(decibels, sorted(decibels))
        good = [int(row["note"].split("; ")[1].split()[0]) for row in rows]
        self.assertEqual(good, sorted(good))
        self.assertGreater(good[-1], 6)


class Bench(ProgramTest):
    QUICK_SYSTEM = ["--systems", "heliar", "--size", "48x27", "--grid", "16"]

    def tables(self, *arguments):
        """What is printed, and the rows."""
        done = self.run_program("bench", "tables", *self.QUICK_SYSTEM, "--json", "t.json", *arguments)
        tables = json.loads((self.folder / "t.json").read_text())
        self.assertLessEqual({"machine", "rows"}, set(tables))
        for row in tables["rows"]:
            self.assertLessEqual({"system", "f_number", "lights", "method", "device", "settings", "time_ms", "psnr_db",
                                  "paper_ms"}, set(row))
        return done.stdout.decode(), tables["rows"]

    def targets(self):
        """Those of the last run."""
        return json.loads((self.folder / "t.json").read_text())["targets"]

    def test_against_the_reference(self):
        text, rows = self.tables("--tables", "overview", "--methods", "bundle,tiled", "--reference", "--density", "0.1",
                                 "--cache", "cache")
        self.assertIn("Heliar", text)
        self.assertEqual([(row["lights"], row["method"]) for row in rows],
                         [(1, "bundle"), (1, "tiled"), (2, "bundle"), (2, "tiled")])
        for row in rows:
            self.assertGreater(row["psnr_db"], 10)
        self.assertEqual(rows[0]["paper_ms"]["total"], 1.1)  # bodonyi2023 table 2, previous method
        self.assertEqual(len(list((self.folder / "cache").iterdir())), 2)

    def test_all_tables(self):
        text, rows = self.tables()
        for number in range(2, 9):
            self.assertIn(f"Table {number}", text)
        for figure in ("0.72", "50.27", "3.86", "122129", "332133", "1.12", "0.49"):  # one of each table's
            self.assertIn(figure, text)
        merged = {row["settings"]["merge_steps"] for row in rows if row["method"] == "tiled"}
        self.assertEqual(merged, {0, 4})
        kinds = {row["settings"]["interpolation"] for row in rows if row["method"] == "tiled"}
        self.assertEqual(len(kinds), 5)
        for row in rows:
            if row["method"] == "tiled":
                self.assertGreaterEqual(row["primitives"], row["primitives_merged"])
                self.assertGreater(row["psnr_bundle_db"], 10)

    def test_the_papers_ghosts_films_and_grids(self):
        def rows(*arguments):
            self.run_program("bench", "tables", "--tables", "3", "--size", "48x27", "--grid", "16", "--wavelengths", "1",
                             "--json", "t.json", *arguments)
            return json.loads((self.folder / "t.json").read_text())["rows"]

        ghosts = {row["settings"]["lens"]: row["ghosts_rendered"] for row in rows("--paper-ghosts")}
        self.assertEqual(ghosts, {"heliar": 11, "itoh-zoom": 64, "nikon-80-200": 139, "canon-70-200": 304})  # 6
        one = ["--systems", "heliar", "--paper-ghosts"]
        plain = rows(*one)
        for option in (["--coating", "quarter-wave:620:1.38"], ["--scale-grid-sigma", "0.01"],
                       ["--scale-grid-phi", "0"]):
            with self.subTest(option):
                self.assertNotEqual([row["psnr_bundle_db"] for row in rows(*one, *option)],
                                    [row["psnr_bundle_db"] for row in plain])
        self.error_of("bench", "tables", "--coating", "quarter-wave:0", code=2)

    def test_chosen_tables_measure_no_more_than_they_need(self):
        text, rows = self.tables("--tables", "4")
        self.assertNotIn("Table 2", text)
        self.assertEqual([(row["lights"], row["method"]) for row in rows], [(1, "tiled")] * 4)
        self.assertEqual(self.targets(), [])
        self.error_of("bench", "tables", "--tables", "9", code=2)

    def test_targets(self):
        text, rows = self.tables("--tables", "targets", "--reference", "--density", "0.1")
        targets = {(t["name"], t["lights"]): t for t in self.targets()}
        self.assertEqual(list(targets), [
            ("bundle / adaptive", 1), ("bundle / adaptive", 2), ("tiled / adaptive", 1), ("tiled / adaptive", 2),
            ("PSNR of adaptive", 1), ("PSNR of adaptive", 2), ("adaptive / floor", 1), ("adaptive / floor", 2),
            ("16 wavelengths / 3", 1), ("100 lights / 1, per light", 100), ("96x54 / 48x27", 1),
            ("preparing a new lens", 1), ("peak memory", 2)])
        for target in targets.values():
            self.assertEqual(target["system"], "Heliar Tronnier")
            self.assertGreater(target["value"], 0)
            self.assertIn(target["name"], text)
        self.check_holds(targets.values())
        # Measured before other methods ran: no later picture had less.
        self.assertLessEqual(targets["peak memory", 2]["value"] * 1e6, min(r["peak_memory_bytes"] for r in rows))
        ms = {(r["method"], r["lights"]): r["time_ms"]["total"] for r in reversed(rows)}
        ratio = targets["bundle / adaptive", 1]["value"]
        self.assertAlmostEqual(ratio, ms["bundle", 1] / ms["adaptive", 1], delta=1e-9 * ratio)
        for row in rows:  # the paper has figures for its own scenes only
            is_papers = row["lights"] <= 2 and row["settings"]["wavelengths"] == 3 and row["settings"]["width"] == 48
            self.assertEqual(row["paper_psnr_db"] is not None, is_papers)
            self.assertEqual(row["psnr_db"] is not None, is_papers)

    def check_holds(self, targets):
        for target in targets:
            sign = 1 if target["more_is_better"] else -1
            reached = [sign * target["value"] >= sign * target[goal] for goal in ("must", "aim")]
            holds = "aim" if all(reached) else "yes" if reached[0] else "no"
            self.assertEqual(target["holds"], holds, target)

    def test_targets_at_full_aperture(self):
        _, rows = self.tables("--tables", "full-aperture", "--runs", "2")
        self.assertEqual([(t["name"], t["must"], t["aim"]) for t in self.targets()],
                         [("bundle / adaptive at f/3.5", 5, 20), ("tiled / adaptive at f/3.5", 5, 20)])
        self.check_holds(self.targets())
        self.assertEqual({(r["method"], r["f_number"]) for r in rows},
                         {("bundle", 3.5), ("tiled", 3.5), ("adaptive", 3.5)})
        for row in rows:  # adaptive's few milliseconds are repeated, more than twice but on a very busy machine
            runs = row["settings"]["runs"]
            self.assertTrue(runs >= 2 if row["method"] == "adaptive" else runs == 1, row)


if __name__ == "__main__":
    unittest.main()
