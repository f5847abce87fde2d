#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""contrejour apply: a photograph in, the same photograph with flare out."""
import math
import struct
import unittest

import exr
from program import ProgramTest

WIDTH, HEIGHT = 90, 60
QUICK = ["--grid", "32", "--threads", "2"]


def dark(lights=(), level=0.01, width=WIDTH, height=HEIGHT):
    values = [level] * (width * height)
    for x, y, value in lights:
        values[y * width + x] = value
    return values


class Apply(ProgramTest):
    def write(self, name, values, kind=exr.FLOAT, **more):
        exr.write(self.folder / name, {c: (kind, values) for c in "RGB"}, WIDTH, HEIGHT, **more)

    def test_report_and_flare(self):
        self.write("in.exr", dark([(60, 20, 5000.0), (20, 40, 900.0)]))
        report = self.json_of("apply", "heliar", "in.exr", "-o", "out.exr", "--flare-only", "flare.exr",
                              "--preview", "out.png", *QUICK)
        self.assertEqual([light["centroid_px"] for light in report["lights"]], [[60.5, 20.5], [20.5, 40.5]])
        self.assertAlmostEqual(report["lights"][0]["flux"][1], 5000, delta=1)
        before, after = exr.Picture(self.folder / "in.exr"), exr.Picture(self.folder / "out.exr")
        flare = exr.Picture(self.folder / "flare.exr")
        self.assertGreater(flare.total(), 0)
        for a, b, f in zip(before.channels["G"], after.channels["G"], flare.channels["G"]):
            self.assertEqual(struct.pack("<f", a + f), struct.pack("<f", b))
        self.assertEqual(self.files(), ["flare.exr", "in.exr", "out.exr", "out.png"])

    def test_a_layer_of_several(self):
        """The flare goes into the layer that is named; every other channel keeps its bits."""
        street, sky = dark([(60, 20, 5000.0)]), dark([(20, 40, 900.0)], level=0.02)
        channels = {f"key.{c}": (exr.HALF, street) for c in "RGB"} | {f"fill.{c}": (exr.FLOAT, sky) for c in "RGB"}
        channels["Z"] = (exr.FLOAT, sky)
        exr.write(self.folder / "in.exr", channels, WIDTH, HEIGHT)
        for layer, centroid in (("key", [60.5, 20.5]), ("fill", [20.5, 40.5])):
            report = self.json_of("apply", "heliar", "in.exr", "-o", "out.exr", "--layer", layer, "--gain", "1000", *QUICK)
            self.assertEqual([light["centroid_px"] for light in report["lights"]], [centroid])
            before, after = exr.Picture(self.folder / "in.exr"), exr.Picture(self.folder / "out.exr")
            for name in channels:
                changed = before.channels[name] != after.channels[name]
                self.assertEqual(changed, name.startswith(layer + "."), name)
        error = self.error_of("apply", "heliar", "in.exr", "-o", "no.exr", "--layer", "rim", code=1)
        self.assertIn("layers with colour are fill, key", error)
        self.assertIn("one part", self.error_of("apply", "heliar", "in.exr", "-o", "no.exr", "--part", "beauty", code=1))
        self.assertNotIn("no.exr", self.files())
        exr.write(self.folder / "flat.exr", {c: (exr.HALF, street) for c in "RGB"}, WIDTH, HEIGHT)
        compare = ["compare", "in.exr", "flat.exr", "--layer", "key", "--layer", ""]
        self.assertIsNone(self.json_of(*compare)["psnr_db"])
        self.assertIn("more than twice", self.error_of(*compare, "--layer", "fill", code=2))

    def test_up_right_is_up_right(self):
        self.write("in.exr", dark([(75, 10, 5000.0)]))
        light = self.json_of("apply", "heliar", "in.exr", "-o", "out.exr", *QUICK)["lights"][0]
        self.assertGreater(light["azimuth_deg"], 0)
        self.assertGreater(light["elevation_deg"], 0)
        # The chief ray of that direction lands on the pixel: camera images are upside down on the sensor.
        az, el = math.radians(light["azimuth_deg"]), math.radians(light["elevation_deg"])
        ray = [-math.sin(az) * math.cos(el), -math.sin(el), math.cos(az) * math.cos(el)]
        info = self.json_of("lens", "info", "heliar")
        pupil = info["entrance_pupil_position_mm"]
        start = [-ray[0] / ray[2] * (pupil + 50), -ray[1] / ray[2] * (pupil + 50), -50]
        text = ",".join(repr(v) for v in start + ray)
        x_mm, y_mm = self.json_of("lens", "trace", "heliar", "--ray", text)["sensor_mm"]
        pitch = min(info["sensor_width_mm"] / WIDTH, info["sensor_height_mm"] / HEIGHT)
        self.assertAlmostEqual(WIDTH / 2 - x_mm / pitch, 75.5, delta=0.5)
        self.assertAlmostEqual(HEIGHT / 2 + y_mm / pitch, 10.5, delta=0.5)

    def test_flare_matches_render(self):
        """The same light put there by hand makes the same flare."""
        self.write("in.exr", dark([(75, 10, 5000.0)], level=0.0))
        self.run_program("apply", "heliar", "in.exr", "-o", "out.exr", "--flare-only", "flare.exr", "--softness", "0", *QUICK)
        self.run_program("render", "heliar", "-o", "r.exr", "--size", f"{WIDTH}x{HEIGHT}", "--value", "5000,5000,5000",
                         "--light-at", f"{75.5 / WIDTH!r},{10.5 / HEIGHT!r}", *QUICK)
        result = self.json_of("compare", "r.exr", "flare.exr")
        self.assertTrue(result["psnr_db"] is None or result["psnr_db"] > 100, result)

    def test_starburst_leaves_the_light_itself_alone(self):
        """The photograph holds the light's own image: its pixels get no starburst, those around it do."""
        self.write("in.exr", dark([(60, 20, 5000.0)]))
        arguments = ["apply", "heliar", "-f", "16", "in.exr", "--softness", "0", *QUICK]
        self.run_program(*arguments, "-o", "off.exr")
        self.run_program(*arguments, "-o", "on.exr", "--starburst", "--glare", "0.01")
        off, on = exr.Picture(self.folder / "off.exr"), exr.Picture(self.folder / "on.exr")
        light = 20 * WIDTH + 60
        for channel in "RGB":
            a, b = off.channels[channel], on.channels[channel]
            self.assertEqual(a[light], b[light])
            for beside in (light - 1, light + 1, light - WIDTH, light + WIDTH):
                self.assertGreater(b[beside], 2 * a[beside])
        self.write("dark.exr", dark())
        self.run_program("apply", "heliar", "dark.exr", "-o", "same.exr", "--starburst", "--threshold", "10")
        self.assertEqual((self.folder / "dark.exr").read_bytes(), (self.folder / "same.exr").read_bytes())

    def test_gain_and_hfov(self):
        self.write("in.exr", dark([(60, 20, 5000.0)]))
        self.run_program("apply", "heliar", "in.exr", "-o", "o.exr", "--flare-only", "a.exr", *QUICK)
        self.run_program("apply", "heliar", "in.exr", "-o", "o.exr", "--flare-only", "b.exr", "--gain", "2", *QUICK)
        a, b = exr.Picture(self.folder / "a.exr"), exr.Picture(self.folder / "b.exr")
        self.assertEqual([2 * v for v in a.channels["R"]], b.channels["R"])
        light = self.json_of("apply", "heliar", "in.exr", "-o", "o.exr", "--hfov", "10", *QUICK)["lights"][0]
        right = math.degrees(math.atan(math.tan(math.radians(5)) * (60.5 - WIDTH / 2) / (WIDTH / 2)))
        self.assertAlmostEqual(light["azimuth_deg"], right, delta=0.01)

    def test_a_png_is_exposed(self):
        """As --exposure says, with and without lights; nothing else of what is written is."""
        self.write("in.exr", dark([(60, 20, 5000.0)], level=0.2))
        for more in ([], ["--threshold", "1e6"]):
            arguments = ["apply", "heliar", "in.exr", *more, *QUICK]
            self.run_program(*arguments, "-o", "as-it-is.png")
            self.run_program(*arguments, "-o", "darker.png", "--exposure", "-1", "--flare-only", "b.exr")
            for ratio in self.json_of("compare", "as-it-is.png", "darker.png")["flux_ratio"]:
                self.assertAlmostEqual(ratio, 0.5, delta=0.01)
            self.run_program(*arguments, "-o", "o.exr", "--flare-only", "a.exr")
            self.run_program(*arguments, "-o", "p.exr", "--exposure", "-1")
            self.assertEqual((self.folder / "o.exr").read_bytes(), (self.folder / "p.exr").read_bytes())
            self.assertEqual(exr.Picture(self.folder / "a.exr").channels, exr.Picture(self.folder / "b.exr").channels)

    def test_no_lights_is_bit_identical(self):
        """Half floats, an extra channel, NaN, an odd attribute: nothing changes, not even how it is packed."""
        values = [0.1 + 0.001 * (k % 7) for k in range(WIDTH * HEIGHT)]
        values[5] = math.nan
        channels = {c: (exr.HALF, values) for c in "RGBA"}
        channels["depth.Z"] = (exr.FLOAT, [1e9] * (WIDTH * HEIGHT))
        exr.write(self.folder / "in.exr", channels, WIDTH, HEIGHT, origin=(-3, 7), display=(0, 0, 100, 80),
                  extra=[("note", "string", b"kept")])
        report = self.json_of("apply", "heliar", "in.exr", "-o", "out.exr", "--flare-only", "f.exr", *QUICK)
        self.assertEqual(report["lights"], [])
        self.assertEqual((self.folder / "in.exr").read_bytes(), (self.folder / "out.exr").read_bytes())
        self.assertEqual(exr.Picture(self.folder / "f.exr").total(), 0)

    def test_compression(self):
        """--compression changes the file, not the picture; a plate keeps its own."""
        def codec(name):
            return exr.Picture(self.folder / name).attributes["compression"][1][0]
        render = ["render", "heliar", "--size", "64x36", "--threads", "2"]
        self.run_program(*render, "-o", "zip.exr")
        self.run_program(*render, "-o", "none.exr", "--compression", "none")
        self.assertEqual([codec("zip.exr"), codec("none.exr")], [3, 0])
        self.assertEqual(exr.Picture(self.folder / "zip.exr").channels, exr.Picture(self.folder / "none.exr").channels)
        self.write("lit.exr", dark([(60, 20, 5000.0)]))
        self.write("dark.exr", [0.1] * (WIDTH * HEIGHT))
        for plate in ("lit.exr", "dark.exr"):
            self.run_program("apply", "heliar", plate, "-o", "kept.exr", *QUICK)
            self.run_program("apply", "heliar", plate, "-o", "packed.exr", "--flare-only", "flare.exr", "--compression",
                             "zips", *QUICK)
            self.assertEqual([codec("kept.exr"), codec("packed.exr"), codec("flare.exr")], [0, 2, 2])
            kept, packed = exr.Picture(self.folder / "kept.exr"), exr.Picture(self.folder / "packed.exr")
            self.assertEqual(kept.channels, packed.channels)
        self.assertIn("rle", self.error_of(*render, "-o", "no.exr", "--compression", "b44", code=2))

    def test_everything_else_is_kept(self):
        values = dark([(60, 20, 5000.0)])
        values[5] = math.nan
        channels = {c: (exr.HALF, values) for c in "RGB"}
        channels["A"] = (exr.HALF, [0.5] * (WIDTH * HEIGHT))
        channels["depth.Z"] = (exr.FLOAT, [float(k) for k in range(WIDTH * HEIGHT)])
        exr.write(self.folder / "in.exr", channels, WIDTH, HEIGHT, origin=(-3, 7), display=(0, 0, 100, 80),
                  extra=[("note", "string", b"kept")])
        self.run_program("apply", "heliar", "in.exr", "-o", "out.exr", *QUICK)
        before, after = exr.Picture(self.folder / "in.exr"), exr.Picture(self.folder / "out.exr")
        self.assertEqual((after.origin, after.display), ((-3, 7), (0, 0, 100, 80)))
        self.assertEqual(after.attributes["note"], ("string", b"kept"))
        for name in ("A", "depth.Z"):
            self.assertEqual(before.channels[name], after.channels[name])
        self.assertTrue(math.isnan(after.channels["R"][5]))
        self.assertNotEqual(before.channels["G"][6:], after.channels["G"][6:])

    def test_data_window_sits_in_the_display_window(self):
        """The same light in a cropped file has the same direction as in the whole one."""
        self.write("whole.exr", dark([(60, 20, 5000.0)]))
        whole = self.json_of("apply", "heliar", "whole.exr", "-o", "o.exr", *QUICK)["lights"][0]
        exr.write(self.folder / "crop.exr", {c: (exr.FLOAT, dark([(20, 10, 5000.0)], width=40, height=30)) for c in "RGB"},
                  40, 30, origin=(40, 10), display=(0, 0, WIDTH, HEIGHT))
        crop = self.json_of("apply", "heliar", "crop.exr", "-o", "o.exr", *QUICK)["lights"][0]
        self.assertAlmostEqual(whole["azimuth_deg"], crop["azimuth_deg"], delta=1e-9)
        self.assertAlmostEqual(whole["elevation_deg"], crop["elevation_deg"], delta=1e-9)

    def test_pixels_that_are_not_square(self):
        """A plate of half as many columns, twice as wide each: the same lights, and each pixel has what two had."""
        self.write("square.exr", dark([(60, 20, 2500.0), (61, 20, 2500.0)], level=0.0))
        square = self.json_of("apply", "heliar", "square.exr", "-o", "o.exr", "--flare-only", "fine.exr", *QUICK)
        wide = {c: (exr.FLOAT, dark([(30, 20, 5000.0)], level=0.0, width=WIDTH // 2)) for c in "RGB"}
        exr.write(self.folder / "wide.exr", wide, WIDTH // 2, HEIGHT, aspect=2)
        exr.write(self.folder / "silent.exr", wide, WIDTH // 2, HEIGHT)
        for name, more in (("wide.exr", []), ("silent.exr", ["--pixel-aspect", "2"])):
            report = self.json_of("apply", "heliar", name, "-o", "o.exr", "--flare-only", "coarse.exr", *more, *QUICK)
            for key in ("azimuth_deg", "elevation_deg"):
                self.assertAlmostEqual(report["lights"][0][key], square["lights"][0][key], delta=1e-9)
            fine, coarse = exr.Picture(self.folder / "fine.exr"), exr.Picture(self.folder / "coarse.exr")
            self.assertEqual((coarse.width, coarse.height, coarse.aspect), (WIDTH // 2, HEIGHT, 2))
            peak = max(coarse.channels["G"])
            for k, value in enumerate(coarse.channels["G"]):
                self.assertAlmostEqual(value, fine.channels["G"][2 * k] + fine.channels["G"][2 * k + 1], delta=1e-4 * peak)
        # Higher than wide; a crop; an aspect that no pixel has counts as none.
        self.json_of("apply", "heliar", "silent.exr", "-o", "o.exr", "--pixel-aspect", "0.7", "--starburst", *QUICK)
        exr.write(self.folder / "odd.exr", wide, WIDTH // 2, HEIGHT, aspect=1000)
        odd = self.json_of("apply", "heliar", "odd.exr", "-o", "o.exr", *QUICK)
        silent = self.json_of("apply", "heliar", "silent.exr", "-o", "o.exr", *QUICK)
        self.assertEqual(odd["lights"], silent["lights"])

    def test_pixels_of_an_anamorphic_plate(self):
        """What such a lens squeezes its pixels stretch: they are square on the sensor."""
        info = self.json_of("lens", "info", "schneider-anamorphic-31")
        squeeze = info["focal_length_mm"] / info["focal_length_x_mm"]
        exr.write(self.folder / "in.exr", {c: (exr.FLOAT, dark([(75, 10, 5000.0)], level=0.0)) for c in "RGB"}, WIDTH,
                  HEIGHT, aspect=squeeze)
        self.run_program("apply", "schneider-anamorphic-31", "-f", "8", "in.exr", "-o", "o.exr", "--flare-only",
                         "flare.exr", "--softness", "0", *QUICK)
        self.run_program("render", "schneider-anamorphic-31", "-f", "8", "-o", "r.exr", "--size", f"{WIDTH}x{HEIGHT}",
                         "--value", "5000,5000,5000", "--light-at", f"{75.5 / WIDTH!r},{10.5 / HEIGHT!r}", *QUICK)
        self.assertAlmostEqual(exr.Picture(self.folder / "r.exr").aspect, squeeze, delta=1e-6)
        result = self.json_of("compare", "r.exr", "flare.exr")
        self.assertTrue(result["psnr_db"] is None or result["psnr_db"] > 80, result)

    def test_what_is_finite_stays_finite(self):
        """Pixels near a float's end count as 1e10; --max-value says of less."""
        values = dark([(x, y, 3e38) for x in range(50, 55) for y in range(20, 25)])
        self.write("in.exr", values)
        done = self.run_program("apply", "heliar", "in.exr", "-o", "out.exr", "--starburst", "--glare", "0.1", *QUICK)
        self.assertIn(b"the picture has 25 of them", done.stderr)
        for channel in exr.Picture(self.folder / "out.exr").channels.values():
            self.assertTrue(all(math.isfinite(v) for v in channel))
        arguments = ["apply", "heliar", "in.exr", "-o", "out.exr", "--softness", "0", *QUICK]
        report = self.json_of(*arguments, "--max-value", "40")
        self.assertAlmostEqual(report["lights"][0]["flux"][1], 25 * 40, delta=1e-3)
        self.assertEqual(report["capped_pixels"], 25)
        self.write("tinted.exr", values)
        exr.write(self.folder / "tinted.exr", {"R": (exr.FLOAT, dark([(60, 20, 100.0)])),
                                               "G": (exr.FLOAT, dark([(60, 20, 50.0)])),
                                               "B": (exr.FLOAT, dark([(60, 20, 25.0)]))}, WIDTH, HEIGHT)
        arguments[2] = "tinted.exr"
        flux = self.json_of(*arguments, "--max-value", "10")["lights"][0]["flux"]
        for got, want in zip(flux, (10, 5, 2.5)):
            self.assertAlmostEqual(got, want, delta=1e-6)

    def test_nothing_found_says_what_was_seen(self):
        """No light: the picture's brightest pixel, and what to try; the suggestions work."""
        self.write("in.exr", dark([(30, 10, 0.9)], level=0.2))
        said = self.run_program("apply", "heliar", "in.exr", "-o", "out.exr", *QUICK).stdout.decode()
        for words in ("no lights", "the brightest pixel has 0.9, at 30.5, 10.5 px", "--threshold 0.45", "--region", "--light-at 0.339,0.175:"):
            self.assertIn(words, said)
        report = self.json_of("apply", "heliar", "in.exr", "-o", "out.exr", *QUICK)
        self.assertEqual((report["threshold_source"], report["lights"]), ("none", []))
        self.assertAlmostEqual(report["brightest"]["value"], 0.9, delta=1e-6)
        for more in (["--threshold", "0.45"], ["--region", "0.3,0.1,0.4,0.3"]):
            report = self.json_of("apply", "heliar", "in.exr", "-o", "out.exr", *more, *QUICK)
            self.assertEqual([light["centroid_px"] for light in report["lights"]], [[30.5, 10.5]])
        self.write("black.exr", dark(level=0.0))
        self.assertIn(b"the picture is black", self.run_program("apply", "heliar", "black.exr", "-o", "out.exr", *QUICK).stdout)

    def test_a_window_without_a_gap(self):
        """Ten stops that fall evenly: the two brightest of them are the light."""
        self.write("in.exr", [100.0 * 2.0 ** (-x / 9) for _ in range(HEIGHT) for x in range(WIDTH)])
        report = self.json_of("apply", "heliar", "in.exr", "-o", "out.exr", *QUICK)
        self.assertEqual(report["threshold_source"], "brightest")
        self.assertEqual(len(report["lights"]), 1)
        self.assertAlmostEqual(report["lights"][0]["bounds_px"][2], 18, delta=1)

    def test_regions(self):
        self.write("in.exr", dark([(60, 20, 5000.0), (20, 40, 900.0)]))
        arguments = ["apply", "heliar", "in.exr", "-o", "out.exr", *QUICK]
        left = self.json_of(*arguments, "--region", "0,0,0.5,1")
        self.assertEqual([light["centroid_px"] for light in left["lights"]], [[20.5, 40.5]])
        both = self.json_of(*arguments, "--region", "0,0.5,0.5,1", "--region", "0.5,0,1,0.5")
        self.assertEqual(both["lights"], self.json_of(*arguments)["lights"])
        self.assertIn("left,top,right,bottom", self.error_of(*arguments, "--region", "0.5,0,0.5,1", code=2))

    def test_lights_by_hand(self):
        """Besides those found or alone, also outside the picture; as bright as render makes them."""
        self.write("in.exr", dark([(75, 10, 5000.0)]))
        self.write("black.exr", dark(level=0.0))
        place, value = "1.1,-0.1", "9000,8000,7000"
        arguments = ["-o", "o.exr", "--flare-only", "flare.exr", "--light-at", f"{place}:{value}", *QUICK]
        report = self.json_of("apply", "heliar", "in.exr", "--no-detect", *arguments)
        self.assertEqual((report["lights"], report["threshold"]), ([], None))
        self.assertEqual(report["given_lights"][0]["flux"], [9000, 8000, 7000])
        self.run_program("render", "heliar", "-o", "r.exr", "--size", f"{WIDTH}x{HEIGHT}", "--light-at", f"{place}:{value}",
                         *QUICK)
        result = self.json_of("compare", "r.exr", "flare.exr")
        self.assertTrue(result["psnr_db"] is None or result["psnr_db"] > 100, result)
        alone = exr.Picture(self.folder / "flare.exr").total()
        report = self.json_of("apply", "heliar", "in.exr", *arguments)
        self.assertEqual((len(report["lights"]), len(report["given_lights"])), (1, 1))
        self.assertGreater(exr.Picture(self.folder / "flare.exr").total(), 1.01 * alone)
        self.run_program("apply", "heliar", "black.exr", *arguments, "--starburst", "--stops", "1")
        error = self.error_of("apply", "heliar", "in.exr", "-o", "o.exr", "--light-at", "0.5,0.5", code=1)
        self.assertIn("how bright", error)
        self.run_program("apply", "heliar", "in.exr", "-o", "o.exr", "--light-at", "0.5,0.5", "--value", "100", *QUICK)

    def test_pictures_of_what_was_detected(self):
        self.write("in.exr", dark([(60, 20, 5000.0), (20, 40, 900.0)], level=0.2))
        arguments = ["apply", "heliar", "in.exr", "-o", "out.exr", "--softness", "0", *QUICK]
        self.run_program(*arguments, "--detected", "lights.exr", "--max-value", "1000")
        values = exr.Picture(self.folder / "lights.exr").channels["G"]
        self.assertEqual({k: v for k, v in enumerate(values) if v}, {20 * WIDTH + 60: 1000, 40 * WIDTH + 20: 900})
        self.run_program(*arguments, "--detected", "lights.png")
        self.assertTrue((self.folder / "lights.png").read_bytes().startswith(b"\x89PNG"))
        self.run_program(*arguments, "--no-detect", "--detected", "lights.exr")
        self.assertEqual(exr.Picture(self.folder / "lights.exr").total(), 0)

    def test_how_plainly_the_flare_shows(self):
        """The reported number of stops makes the flare obvious, and then no more are reported."""
        self.write("in.exr", dark([(60, 20, 5000.0)], level=0.2))
        arguments = ["apply", "heliar", "in.exr", "-o", "out.exr", *QUICK]
        stops = self.json_of(*arguments)["flare"]["stops_to_plain"]
        self.assertGreater(stops, 1)
        self.assertIn(f"it would be obvious with {stops:.1f} more stops (--stops)".encode(), self.run_program(*arguments).stdout)
        plain = self.json_of(*arguments, "--stops", repr(stops))["flare"]
        self.assertAlmostEqual(plain["stops_to_plain"], 0, delta=0.01)
        self.assertAlmostEqual(plain["over_picture"], 0.25, delta=0.01)
        double = self.json_of(*arguments, "--gain", "2")["flare"]
        self.assertEqual(double, self.json_of(*arguments, "--stops", "1")["flare"])

    def test_output_may_be_the_input(self):
        self.write("in.exr", dark([(60, 20, 5000.0)]))
        self.run_program("apply", "heliar", "in.exr", "-o", "other.exr", *QUICK)
        self.run_program("apply", "heliar", "in.exr", "-o", "in.exr", *QUICK)
        self.assertIsNone(self.json_of("compare", "in.exr", "other.exr")["psnr_db"])

    def test_many_lights_are_merged_without_losing_flux(self):
        spots = [(x, y, 1000.0) for x in range(1, 89, 4) for y in range(1, 59, 4)]
        self.write("in.exr", dark(spots, level=0.0))
        report = self.json_of("apply", "heliar", "in.exr", "-o", "o.exr", "--max-lights", "5", "--softness", "0",
                              "--select", "brightest:2", *QUICK)
        self.assertEqual((len(report["lights"]), report["areas_found"]), (5, len(spots)))
        self.assertAlmostEqual(sum(light["flux"][0] for light in report["lights"]), 1000.0 * len(spots), delta=1)


if __name__ == "__main__":
    unittest.main()
