#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""contrejour measure, and measured flares in render and apply."""
import csv
import json
import math
import pathlib
import re
import shutil
import statistics
import struct
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as xml
import zlib

import exr
import tiff
from program import PROGRAM, ProgramTest

FLARE = """name = "disc"
s_max = 0.5
{head}
[[ghosts]]
last = 0.5
centre = [-1]
half_width = [0.1]
half_height = [0.1]
inside_red = [1]
inside_green = [2]
inside_blue = [4]
"""
EXPOSURE = "half_field = [0.6, 0.4]\nexposure = { f_number = 2, iso = 100, time_s = 1 }"
SMALL = ["--size", "120x80"]


def table(path):
    with path.open() as file:
        return list(csv.DictReader(file))


def grey_png(path, width, height, values):
    """16 bits, no filter: the layout of the PNG specification."""
    rows = b"".join(
        b"\0" + struct.pack(f">{width}H", *values[y * width:(y + 1) * width]) for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 16, 0, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) +
                     chunk(b"IEND", b""))


def dng(path, width, height, values, time_s, black):
    """An uncompressed mosaic RGGB of 16 bits: tags of TIFF 6 and of DNG 1.4."""
    entries, extra = [], b""
    count = 24
    base = 8 + 2 + 12 * count + 4

    def tag(number, kind, items):
        nonlocal extra
        packed = struct.pack("<" + {1: "B", 2: "s", 3: "H", 4: "I", 5: "I", 10: "i"}[kind] * len(items), *items) \
            if kind != 2 else items
        size = {1: 1, 2: 1, 3: 2, 4: 4, 5: 8, 10: 8}[kind]
        number_of = len(packed) // size
        if len(packed) > 4:
            entries.append(struct.pack("<HHII", number, kind, number_of, base + len(extra)))
            extra += packed + b"\0" * (len(packed) % 2)
        else:
            entries.append(struct.pack("<HHI", number, kind, number_of) + packed.ljust(4, b"\0"))

    pixels = struct.pack(f"<{width * height}H", *values)
    tag(254, 4, [0])
    tag(256, 4, [width])
    tag(257, 4, [height])
    tag(258, 3, [16])
    tag(259, 3, [1])
    tag(262, 3, [32803])
    tag(271, 2, b"Maker\0")
    tag(272, 2, b"Camera\0")
    strip = len(entries)
    tag(273, 4, [0])
    tag(274, 3, [1])
    tag(277, 3, [1])
    tag(278, 4, [height])
    tag(279, 4, [len(pixels)])
    tag(284, 3, [1])
    tag(33421, 3, [2, 2])
    tag(33422, 1, [0, 1, 1, 2])
    tag(33434, 5, [round(time_s * 10000), 10000])
    tag(50706, 1, [1, 4, 0, 0])
    tag(50707, 1, [1, 1, 0, 0])
    tag(50708, 2, b"Maker Camera\0")
    tag(50714, 3, [black])
    tag(50717, 4, [16383])
    tag(50721, 10, [v for k in range(9) for v in ((1 if k % 4 == 0 else 0), 1)])
    tag(50778, 3, [21])
    assert len(entries) == count
    entries[strip] = struct.pack("<HHII", 273, 4, 1, base + len(extra))
    path.write_bytes(b"II*\0" + struct.pack("<I", 8) + struct.pack("<H", count) + b"".join(entries) + b"\0\0\0\0" +
                     extra + pixels)


class MeasuredFlare(ProgramTest):
    def write_flare(self, head=EXPOSURE):
        (self.folder / "a.flare.toml").write_text(FLARE.format(head=head))

    def picture(self, *arguments):
        self.run_program("render", "a.flare.toml", "-o", "a.exr", *arguments)
        return exr.Picture(self.folder / "a.exr")

    def test_render_puts_the_ghost_opposite_the_light(self):
        self.write_flare()
        picture = self.picture("--light", "12,6:1000", *SMALL)
        x, y = picture.centroid("G")
        self.assertAlmostEqual(x, 60 - 100 * math.tan(math.radians(12)), delta=0.1)
        self.assertAlmostEqual(y, 40 + 100 * math.tan(math.radians(6)) / math.cos(math.radians(12)), delta=0.1)
        for name, level in (("R", 1), ("G", 2), ("B", 4)):
            self.assertAlmostEqual(picture.total(name), 1000 * level * math.pi * 0.01, delta=0.3 * level)

    def test_light_at_is_where_the_image_is(self):
        self.write_flare()
        x, y = self.picture("--light-at", "0.7,0.3:10", *SMALL).centroid("G")
        self.assertAlmostEqual(x, 0.3 * 120, delta=0.1)
        self.assertAlmostEqual(y, 0.7 * 80, delta=0.1)

    def test_brightness_by_the_exposure(self):
        self.write_flare()
        light = ["--light", "5,0:100", *SMALL]
        plain = self.picture(*light).total()
        self.assertAlmostEqual(self.picture("-f", "4", "--iso", "800", *light).total() / plain, 2.0, places=4)
        self.assertAlmostEqual(self.picture("--shutter", "1/2", *light).total() / plain, 0.5, places=4)
        self.write_flare("half_field = [0.6, 0.4]")
        self.assertIn("exposure", self.error_of("render", "a.flare.toml", "-o", "b.exr", "--iso", "200", code=1))

    def test_field(self):
        self.write_flare("")
        self.assertIn("--hfov", self.error_of("render", "a.flare.toml", "-o", "a.exr", *SMALL, code=1))
        wide = self.picture("--hfov", str(2 * math.degrees(math.atan(1.2))), "--light", "5,0", *SMALL)
        self.assertAlmostEqual(wide.total(), 2 * math.pi * 0.01, delta=1e-3)
        self.assertAlmostEqual(wide.centroid()[0], 60 - 50 * math.tan(math.radians(5)), delta=0.1)

    def test_beyond_the_measured_angles(self):
        self.write_flare()
        done = self.run_program("render", "a.flare.toml", "-o", "a.exr", "--light", "29,0", *SMALL)
        self.assertIn("beyond the measured 26.57 degrees", done.stderr.decode())

    def test_options_without_a_meaning(self):
        self.write_flare()
        for options in (["--blades", "6"], ["--coating", "none"], ["--method", "tiled"], ["--starburst"],
                        ["--light-size", "1"], ["--focal", "50"], ["--select", "list:1-2"], ["--dust", "3"]):
            text = self.error_of("render", "a.flare.toml", "-o", "a.exr", *options, code=1)
            self.assertIn("measured flare", text)
            self.assertIn(options[0], text)
        self.assertIn("without a unit",
                      self.error_of("render", "a.flare.toml", "-o", "a.exr", "--light", "1,1:100lx", code=1))
        self.assertIn("no size", self.error_of("render", "a.flare.toml", "-o", "a.exr", "--light", "1,1:1::2", code=1))
        self.assertIn("exposure already", self.error_of("apply", "a.flare.toml", "a.exr", "-o", "b.exr", "--iso", "200",
                                                        code=1))
        self.assertEqual(self.files(), ["a.flare.toml"])

    def test_apply(self):
        self.write_flare()
        values = [0.1] * (120 * 80)
        for x, y in ((90, 20), (91, 20), (90, 21), (91, 21)):
            values[y * 120 + x] = 500.0
        exr.write(self.folder / "in.exr", {name: (exr.FLOAT, values) for name in "RGB"}, 120, 80)
        report = self.json_of("apply", "a.flare.toml", "in.exr", "-o", "out.exr", "--flare-only", "flare.exr")
        self.assertEqual(report["lens"], "disc")
        self.assertEqual(len(report["lights"]), 1)
        flare = exr.Picture(self.folder / "flare.exr")
        x, y = flare.centroid("G")
        self.assertAlmostEqual(x, 120 - 91, delta=0.1)
        self.assertAlmostEqual(y, 80 - 21, delta=0.1)
        self.assertAlmostEqual(flare.total("G"), 2000 * 2 * math.pi * 0.01, delta=0.5)
        out = exr.Picture(self.folder / "out.exr")
        self.assertAlmostEqual(out.value(29, 59), 0.1 + flare.value(29, 59), places=4)

    def test_a_sequence(self):
        self.write_flare()
        for frame in (1, 2):
            values = [0.1] * (60 * 40)
            values[600 + frame] = 500.0
            exr.write(self.folder / f"in.{frame:04}.exr", {name: (exr.FLOAT, values) for name in "RGB"}, 60, 40)
        self.run_program("apply", "a.flare.toml", "in.####.exr", "-o", "out.####.exr", "--frames", "1-2")
        for frame in (1, 2):
            self.run_program("apply", "a.flare.toml", f"in.{frame:04}.exr", "-o", "still.exr")
            self.assertEqual(exr.Picture(self.folder / f"out.{frame:04}.exr").channels,
                             exr.Picture(self.folder / "still.exr").channels)

    def test_other_commands_need_a_lens(self):
        self.write_flare()
        for command in (["ghosts"], ["lens", "info"]):
            self.assertIn("measured flare", self.error_of(*command, "a.flare.toml", code=1))

    def test_same_for_any_number_of_threads(self):
        self.write_flare()
        self.picture("--light", "12,6", "--threads", "1", *SMALL)
        one = (self.folder / "a.exr").read_bytes()
        self.picture("--light", "12,6", "--threads", "3", *SMALL)
        self.assertEqual(one, (self.folder / "a.exr").read_bytes())


class Protocol(ProgramTest):
    def test_page_and_list(self):
        self.run_program("measure", "protocol", "-o", "p.html", "--list", "s.csv", "--stations", "5", "--to", "20",
                         "--times", "0.5,2", "--background-every", "4", "--ending", "png")
        page = (self.folder / "p.html").read_text()
        for word in ("Stations", "+10.00&deg;", "What to watch", "0.5 s, 2 s"):
            self.assertIn(word, page)
        rows = table(self.folder / "s.csv")
        self.assertEqual(sorted({float(row["angle_deg"]) for row in rows}), [-20, -10, 0, 10, 20])
        self.assertEqual(sum(row["kind"] == "exposure" for row in rows), 10)
        self.assertEqual({row["station"] for row in rows if row["kind"] == "background"}, {"1", "5"})
        self.assertEqual(len({row["file"] for row in rows}), len(rows))

    def test_wrong_numbers(self):
        self.assertIn("times", self.error_of("measure", "protocol", "-o", "p.html", "--times", "0", code=1))
        self.error_of("measure", "protocol", "-o", "p.html", "--stations", "0", code=2)
        self.assertEqual(self.files(), [])


WIDTH, HEIGHT, BLACK = 32, 24, 100


def level(x, y):
    """DN per second: a ramp that differs by colour, brighter than a second can hold on the right."""
    colour = (0, 1, 1, 2)[2 * (y % 2) + x % 2]
    return (200 + 1500 * (x // 2)) * (1 + 0.25 * colour)


def mosaic(time_s, room=0.0):
    return [min(round(BLACK + (level(x, y) + room) * time_s), 16383) for y in range(HEIGHT) for x in range(WIDTH)]


class Merge(ProgramTest):
    FORMAT = ["--black", BLACK, "--white", 16383]

    def write_sweep(self, stations=2, writer=grey_png, ending="png"):
        rows = ["station,angle_deg,kind,time_s,file"]
        for station in range(1, stations + 1):
            for time_s in (0.25, 1.0, 4.0):
                name = f"e{station}-{time_s}.{ending}"
                if writer is grey_png:
                    grey_png(self.folder / name, WIDTH, HEIGHT, mosaic(time_s))
                else:
                    writer(self.folder / name, WIDTH, HEIGHT, mosaic(time_s), time_s, BLACK)
                rows.append(f"{station},{station - 1.5},exposure,{time_s},{name}")
        (self.folder / "s.csv").write_text("\n".join(rows) + "\n")

    def check_rates(self, picture):
        for x, y in ((0, 0), (3, 2), (8, 5)):
            for name, raw in (("R", (0, 0)), ("G", (1, 0)), ("B", (1, 1))):
                self.assertEqual(picture.value(x, y, "valid." + name), 1)
                rate = picture.value(x, y, name)
                self.assertAlmostEqual(rate / level(2 * x + raw[0], 2 * y + raw[1]), 1.0, delta=0.003)
                self.assertGreater(picture.value(x, y, "variance." + name), 0)

    def test_rates_variance_and_validity(self):
        self.write_sweep()
        done = self.run_program("measure", "merge", "s.csv", "-o", "out", *self.FORMAT)
        self.assertIn(b"2 stations merged, 0 kept", done.stdout)
        picture = exr.Picture(self.folder / "out" / "station-0001.exr")
        self.assertEqual((picture.width, picture.height), (WIDTH // 2, HEIGHT // 2))
        self.check_rates(picture)
        self.assertEqual(picture.attributes["headAngleDegrees"][1], b"-0.5")
        rows = table(self.folder / "out" / "stations.csv")
        self.assertEqual([row["angle_deg"] for row in rows], ["-0.5", "0.5"])

    @unittest.skipUnless((pathlib.Path(PROGRAM).parent / "contrejour-openimageio.so").exists(), "built without OpenImageIO")
    def test_mosaics_in_tiff(self):
        self.write_sweep(stations=1, writer=lambda path, width, height, values, *_: tiff.write(path, values, width, height, 1),
                         ending="tif")
        self.run_program("measure", "merge", "s.csv", "-o", "out", *self.FORMAT)
        self.check_rates(exr.Picture(self.folder / "out" / "station-0001.exr"))

    def test_an_interrupted_merge_continues(self):
        self.write_sweep()
        self.run_program("measure", "merge", "s.csv", "-o", "out", *self.FORMAT)
        first = self.folder / "out" / "station-0001.exr"
        before = first.stat().st_mtime_ns
        (self.folder / "out" / "station-0002.exr").unlink()
        done = self.run_program("measure", "merge", "s.csv", "-o", "out", *self.FORMAT)
        self.assertIn(b"1 stations merged, 1 kept", done.stdout)
        self.assertEqual(first.stat().st_mtime_ns, before)
        self.assertTrue((self.folder / "out" / "station-0002.exr").exists())

    def test_a_broken_file_leaves_its_station_out(self):
        self.write_sweep(stations=3)
        (self.folder / "e2-1.0.png").write_bytes(b"\x89PNG\r\n\x1a\nbroken")
        done = self.run_program("measure", "merge", "s.csv", "-o", "out", *self.FORMAT, code=1)
        self.assertIn("station 2 is left out", done.stderr.decode())
        self.assertIn("e2-1.0.png", done.stderr.decode())
        self.assertEqual(sorted(p.name for p in (self.folder / "out").iterdir()),
                         ["station-0001.exr", "station-0003.exr", "stations.csv"])

    def test_the_direct_image(self):
        self.write_sweep()
        values = [BLACK] * (WIDTH * HEIGHT)
        for y in range(6, 10):
            for x in range(10, 14):
                values[y * WIDTH + x] = BLACK + 8000
        grey_png(self.folder / "d.png", WIDTH, HEIGHT, values)
        with (self.folder / "s.csv").open("a") as file:
            file.write("1,-0.5,direct,0.001,d.png\n")
        self.run_program("measure", "merge", "s.csv", "-o", "out", *self.FORMAT)
        row = table(self.folder / "out" / "stations.csv")[0]
        self.assertAlmostEqual(float(row["direct_x_px"]), 6, places=2)
        self.assertAlmostEqual(float(row["direct_y_px"]), 4, places=2)
        self.assertAlmostEqual(float(row["direct_green"]), 4 * 8000 / 0.001, delta=1)

    def test_raw_files(self):
        self.write_sweep(stations=1, writer=dng, ending="dng")
        done = subprocess.run([PROGRAM, "measure", "merge", "s.csv", "-o", "out"], cwd=self.folder, capture_output=True)
        if b"built without LibRaw" in done.stderr:
            self.skipTest("the program is built without LibRaw")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.check_rates(exr.Picture(self.folder / "out" / "station-0001.exr"))
        text = (self.folder / "s.csv").read_text().replace("exposure,4.0", "exposure,8.0")
        (self.folder / "s.csv").write_text(text)
        done = self.run_program("measure", "merge", "s.csv", "-o", "again", code=1)
        self.assertIn("the list says 8 s, the file 4 s", done.stderr.decode())

    def test_wrong_lists(self):
        (self.folder / "s.csv").write_text("station,angle_deg,kind,time_s,file\n1,0,exposure,-1,a.png\n")
        self.assertIn("s.csv:2:", self.error_of("measure", "merge", "s.csv", "-o", "out", code=1))
        (self.folder / "s.csv").write_text("a,b\n")
        self.assertIn("s.csv:1:", self.error_of("measure", "merge", "s.csv", "-o", "out", code=1))
        self.assertIn("cannot be read", self.error_of("measure", "merge", "none.csv", "-o", "out", code=1))
        self.assertEqual(self.files(), ["s.csv"])


class Fit(ProgramTest):
    @classmethod
    def setUpClass(cls):
        """One small demo serves all tests: it simulates the photographs, which takes longest."""
        cls.holder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.holder.cleanup)
        cls.demo = pathlib.Path(cls.holder.name) / "demo"
        done = subprocess.run([PROGRAM, "measure", "demo", "-o", cls.demo, "--size", "160", "--stations", "11",
                               "--max-ghosts", "1", "--max-small-ghosts", "0", "--no-comparison", "--json"],
                              capture_output=True, timeout=300)
        assert done.returncode == 0, done.stderr.decode()
        cls.found = json.loads(done.stdout)

    def test_demo_finds_the_optical_centre_and_the_brightest_ghost(self):
        self.assertLess(math.hypot(*self.found["centre_off_px"]), 0.5)
        self.assertEqual(self.found["ghosts_found"], 1)
        ghost = self.found["ghosts"][1]  # after the veil
        self.assertAlmostEqual(ghost["speed"], -1.09, delta=0.03)  # of the Tessar's, by first-order optics
        self.assertLess(self.found["held_out_nrmse"], 0.3)
        self.assertEqual([s["held_out"] for s in self.found["stations"]].count(True), 2)

    def test_demo_writes_all_pages_and_pictures(self):
        names = {p.name for p in self.demo.iterdir()}
        self.assertEqual(names, {"merged", "pictures", "report.html", "demo.flare.toml", "stations.csv",
                                 "safe-lens.svg", "safe-flare.svg"})
        self.assertEqual(len(list((self.demo / "merged").iterdir())), 11)
        pictures = {p.name for p in (self.demo / "pictures").iterdir()}
        self.assertLessEqual({"drawn-lens.png", "drawn-flare.png", "station-0002-captured.png",
                              "station-0002-fitted.png", "station-0002-residual.png"}, pictures)
        report = (self.demo / "report.html").read_text()
        charts = re.findall("<svg.*?</svg>", report, re.S)
        self.assertEqual(len(charts), 7)
        for chart in [*charts, (self.demo / "safe-flare.svg").read_text()]:
            xml.fromstring(chart)
        self.assertEqual(report.count("data:image/png;base64,"), 3 * 7)

    def test_demo_does_not_write_over_another(self):
        self.assertIn("a demo is here already", self.error_of("measure", "demo", "-o", self.demo, code=1))

    def test_fit_is_the_same_for_any_number_of_threads_and_is_drawn(self):
        fit = ["measure", "fit", self.demo / "merged", "--max-ghosts", "1", "--max-small-ghosts", "1", "--name", "mine"]
        self.run_program(*fit, "-o", "a.flare.toml", "--threads", "1", "--csv", "a.csv", "--f-number", "4.5", "--iso",
                         "100", "--time", "1")
        self.run_program(*fit, "-o", "b.flare.toml", "--threads", "3", "--csv", "b.csv", "--f-number", "4.5", "--iso",
                         "100", "--time", "1")
        flare = (self.folder / "a.flare.toml").read_text()
        self.assertEqual(flare, (self.folder / "b.flare.toml").read_text())
        self.assertIn("f_number = 4.5", flare)
        self.assertEqual(table(self.folder / "a.csv"), table(self.folder / "b.csv"))
        self.run_program("render", "a.flare.toml", "-o", "a.exr", "--light-at", "0.75,0.5:1000", *SMALL)
        picture = exr.Picture(self.folder / "a.exr")
        # The ghost's half: about the light is what the pictures show beside the ghosts that were allowed.
        values = {(x, y): picture.value(x, y, "G") for x in range(60) for y in range(80)}
        inside = [at for at, value in values.items() if value > 0.5 * max(values.values())]
        self.assertAlmostEqual(statistics.mean(x + 0.5 for x, _ in inside), 60 - 1.09 * 30, delta=1)
        self.assertAlmostEqual(statistics.mean(y + 0.5 for _, y in inside), 40, delta=1)

    def test_fit_leaves_out_a_broken_station(self):
        merged = self.folder / "merged"
        shutil.copytree(self.demo / "merged", merged)
        (merged / "station-0003.exr").write_bytes(b"v/1\1 broken")
        done = self.run_program("measure", "fit", merged, "-o", "a.flare.toml", "--max-ghosts", "1", "--max-small-ghosts",
                                "0", "--json")
        self.assertIn("station-0003.exr", done.stderr.decode())
        self.assertEqual(len(json.loads(done.stdout)["stations"]), 10)

    def test_fit_starts_from_the_ghosts_of_a_lens(self):
        fit = ["measure", "fit", self.demo / "merged", "--max-ghosts", "1", "--max-small-ghosts", "0", "--json"]
        found = json.loads(self.run_program(*fit, "-o", "a.flare.toml", "--lens", "tessar").stdout)
        self.assertAlmostEqual(found["ghosts"][1]["speed"], -1.09, delta=0.02)
        self.assertIn("no lens", self.error_of(*fit, "-o", "b.flare.toml", "--lens", "no-such-lens", code=1))
        self.assertEqual(self.files(), ["a.flare.toml"])

    def test_fit_refuses(self):
        fit = ["measure", "fit", self.demo / "merged"]
        self.assertIn("together", self.error_of(*fit, "-o", "a.flare.toml", "--iso", "100", code=1))
        self.assertIn(".flare.toml", self.error_of(*fit, "-o", "a.toml", code=2))
        (self.folder / "none").mkdir()
        self.assertIn("0 merged stations", self.error_of("measure", "fit", "none", "-o", "a.flare.toml", code=1))
        self.assertIn("measure merge", self.error_of("measure", "fit", "absent", "-o", "a.flare.toml", code=1))
        self.assertEqual(self.files(), ["none"])


    def test_coatings_and_adjust_write_lenses(self):
        merged = self.demo / "merged"
        done = self.run_program("measure", "coatings", "tessar", merged, "-o", "learnt.toml", "--rounds", "1", "--width",
                                "80", "--max-ghosts", "4", "--json")
        self.assertIn("reflectances of surfaces", done.stderr.decode())  # four ghosts do not determine six reflectances
        done = json.loads(done.stdout)
        self.assertEqual([s["surface"] for s in done["surfaces"]], [1, 2, 3, 4, 6, 8])
        self.assertEqual(len(done["ghosts"]), 4)
        self.assertTrue(done["warnings"])
        self.assertIn("measured_nm", (self.folder / "learnt.toml").read_text())
        self.run_program("lens", "info", "learnt.toml")
        kept = [f"--{name}-tolerance=0" for name in ("gap", "tilt", "decentre", "stop-shift")]
        done = self.run_program("measure", "adjust", "tessar", merged, "-o", "adjusted.toml", "--width", "80", *kept,
                                "--max-ghosts", "2", "--iterations", "1", "--json")
        self.assertEqual([n["name"] for n in json.loads(done.stdout)["numbers"]], ["distance of the sensor", "radius of the stop"])
        self.run_program("lens", "info", "adjusted.toml")
        self.error_of("measure", "coatings", "nolens", merged, "-o", "a.toml", code=1)
        self.assertIn("measure merge", self.error_of("measure", "adjust", "tessar", "absent", "-o", "a.toml", code=1))
        self.assertEqual(self.files(), ["adjusted.toml", "learnt.toml"])


class Predict(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "a.flare.toml").write_text(FLARE.format(head=EXPOSURE))

    def test_chart_and_list_of_a_measured_flare(self):
        done = self.run_program("measure", "predict", "a.flare.toml", "-o", "c.svg", "--csv", "c.csv", "--estimator",
                                "sum", "--angles", "13", "--directions", "3", "--light", "0,0:1", "--light", "30.9,0:1",
                                "--json", *SMALL)
        self.assertIn("beyond the measured", done.stderr.decode())
        predicted = json.loads(done.stdout)
        self.assertEqual([row["subject"] for row in predicted["rows"]], ["light 1", "light 2", "all"])
        weights = 0.2126 * 1 + 0.7152 * 2 + 0.0722 * 4
        self.assertAlmostEqual(predicted["rows"][0]["sum"], weights * math.pi * 0.01, delta=1e-3)
        self.assertLess(predicted["rows"][1]["rating"], 0.05)
        self.assertEqual(predicted["map"]["positions"], 1 + 3 * 12)
        rows = table(self.folder / "c.csv")
        self.assertEqual(len(rows), 37)
        self.assertAlmostEqual(float(rows[0]["rating"]), 1.0, delta=0.02)
        self.assertAlmostEqual(float(rows[12]["rating"]), 0.0, delta=1e-6)
        drawing = xml.parse(self.folder / "c.svg").getroot()
        self.assertEqual(sum(e.tag.endswith("path") for e in drawing.iter()), 4 * 36)

    def test_a_lens(self):
        text = self.run_program("measure", "predict", "cooke-triplet", "--angles", "4", "--directions", "2", "--csv",
                                "c.csv", "--wavelengths", "3", "--size", "72x48").stdout.decode()
        self.assertIn("mean_transmission: worst", text)
        rows = table(self.folder / "c.csv")
        self.assertEqual(len(rows), 7)
        self.assertGreater(float(rows[0]["sum"]), 0)
        self.assertAlmostEqual(float(rows[0]["mean_transmission"]) * float(rows[0]["mean_attenuation"]), 1, places=4)

    def test_panorama(self):
        width, height = 180, 90
        values = [0.05] * (width * height)
        for y in (40, 41):
            for x in (90, 91):  # just right of the middle
                values[y * width + x] = 1000.0
        exr.write(self.folder / "p.exr", {name: (exr.FLOAT, values) for name in "RGB"}, width, height)
        rows = self.json_of("measure", "predict", "a.flare.toml", "--panorama", "p.exr", "--view", "0,0", "--view",
                            "180,0", "--view", "-20,10", "--estimator", "sum", *SMALL)["rows"]
        self.assertEqual([row["lights"] for row in rows], [1, 0, 1])
        self.assertEqual(rows[1]["sum"], 0)
        self.assertEqual(rows[1]["rating"], 0)
        self.assertGreater(rows[0]["sum"], 0)
        self.assertLess(rows[0]["contrast_kept"], 1.0001)
        self.assertGreater(rows[0]["brightening"], 1)
        self.assertIsNone(rows[1]["mean_attenuation"])
        exr.write(self.folder / "p.exr", {name: (exr.FLOAT, values[:8100]) for name in "RGB"}, 90, 90)
        self.assertIn("twice as wide as high",
                      self.error_of("measure", "predict", "a.flare.toml", "--panorama", "p.exr", code=1))

    def test_frames(self):
        for frame, light in enumerate((50.0, 400.0)):
            values = [0.1] * (60 * 40)
            for k in (615, 616):
                values[k] = light
            exr.write(self.folder / f"{frame}.exr", {name: (exr.FLOAT, values) for name in "RGB"}, 60, 40)
        self.run_program("measure", "predict", "a.flare.toml", "--frame", "0.exr", "--frame", "1.exr", "--estimator",
                         "sum", "--csv", "f.csv")
        rows = table(self.folder / "f.csv")
        self.assertEqual([row["subject"] for row in rows], ["0.exr", "1.exr"])
        self.assertAlmostEqual(float(rows[1]["sum"]) / float(rows[0]["sum"]), 8, delta=0.01)
        self.assertEqual([float(row["rating"]) for row in rows], [0, 1])

    def test_wrong_usage(self):
        self.assertIn("--view", self.error_of("measure", "predict", "a.flare.toml", "--view", "1,2", code=2))
        self.error_of("measure", "predict", "a.flare.toml", "--estimator", "beauty", code=2)
        self.assertIn("none.flare.toml", self.error_of("measure", "predict", "none.flare.toml", code=1))
        self.assertEqual(self.files(), ["a.flare.toml"])


if __name__ == "__main__":
    unittest.main()
