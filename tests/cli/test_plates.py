#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plates in other formats and colour spaces. The files are written and read here by their published layouts."""
import json
import pathlib
import random
import resource
import struct
import subprocess
import unittest

import exr
import tiff
from program import PROGRAM, ProgramTest

WIDTH, HEIGHT = 96, 64
LENS = ["heliar", "-f", "8", "--error", "0.003"]
MODULES = pathlib.Path(PROGRAM).parent
CORPUS = pathlib.Path(__file__).resolve().parents[2] / "fuzz/corpus/plate"
HAS_FORMATS = (MODULES / "contrejour-openimageio.so").exists()
HAS_SPACES = (MODULES / "contrejour-opencolorio.so").exists()
LOG, VIDEO = 3, 6  # transfer characteristics of SMPTE 268M: logarithmic, ITU-R 709


def plate_codes(light=1023):
    """10-bit codes: a dim ramp, with a light of 2 x 2 pixels."""
    codes = [[[90 + x + y, 95 + x, 100 + y] for x in range(WIDTH)] for y in range(HEIGHT)]
    for x, y in ((30, 20), (31, 20), (30, 21), (31, 21)):
        codes[y][x] = [light] * 3
    return codes


def write_dpx(path, codes, transfer=LOG, width=WIDTH, height=HEIGHT):
    """SMPTE 268M-2003, RGB of 10 bits in words of 32 (packing A)."""
    header = bytearray(b"\xff" * 2048)
    struct.pack_into(">4sI8sI", header, 0, b"SDPX", 2048, b"V1.0\0\0\0\0", 2048 + 4 * width * height)
    struct.pack_into(">HHII", header, 768, 0, 1, width, height)
    struct.pack_into(">IIfIfBBBBHHIII", header, 780, 0, 0, 0.0, 1023, 2.0, 50, transfer, transfer, 10, 1, 0, 2048, 0, 0)
    words = [r << 22 | g << 12 | b << 2 for row in codes for r, g, b in row]
    path.write_bytes(bytes(header) + struct.pack(f">{len(words)}I", *words))


def read_dpx(path):
    data = path.read_bytes()
    order = ">" if data[:4] == b"SDPX" else "<"
    offset, = struct.unpack_from(order + "I", data, 4)
    width, height = struct.unpack_from(order + "II", data, 772)
    assert data[803] == 10, "not 10 bits"
    words = struct.unpack_from(f"{order}{width * height}I", data, offset)
    return [[[w >> 22, w >> 12 & 1023, w >> 2 & 1023] for w in words[y * width:(y + 1) * width]] for y in range(height)]


def write_tiff(path, values, **more):
    tiff.write(path, values, WIDTH, HEIGHT, **more)


@unittest.skipUnless(HAS_FORMATS, "built without OpenImageIO")
class Formats(ProgramTest):
    def linear(self, name, *arguments):
        self.run_program("apply", *LENS, name, "-o", "linear.exr", "--no-detect", *arguments)
        return exr.Picture(self.folder / "linear.exr")

    def test_tiff_keeps_its_codes(self):
        noise = random.Random(2)
        values = [noise.randrange(65536) for _ in range(WIDTH * HEIGHT * 3)]
        write_tiff(self.folder / "in.tif", values)
        before = self.linear("in.tif")
        for value, linear in list(zip(values[1::3], before.channels["G"]))[:50]:
            coded = value / 65535
            expected = coded / 12.92 if coded <= 0.04045 else ((coded + 0.055) / 1.055) ** 2.4
            self.assertAlmostEqual(linear, expected, delta=1e-6)
        self.run_program("apply", *LENS, "in.tif", "-o", "out.tif", "--no-detect")
        self.assertEqual(self.linear("out.tif").channels, before.channels)

    def test_other_formats_are_written_and_read(self):
        write_tiff(self.folder / "in.tiff", [12000] * (WIDTH * HEIGHT * 3))
        for name, delta in (("a.jpg", 0.01), ("a.hdr", 0.001), ("a.png", 1e-4)):
            self.run_program("apply", *LENS, "in.tiff", "-o", name, "--no-detect")
            self.assertAlmostEqual(self.linear(name).value(5, 5), 0.0281, delta=delta, msg=name)

    def test_a_flare_alone_is_written_and_compared(self):
        frame = ["render", *LENS, "--size", "48x32", "--wavelengths", "3", "--value", "100"]
        for name in ("a.exr", "a.hdr", "a.tif"):
            self.run_program(*frame, "-o", name)
        report = json.loads(self.run_program("compare", "a.exr", "a.hdr", "--json").stdout)
        self.assertGreater(report["psnr_db"], 45.0)  # 8 bits of mantissa
        self.assertAlmostEqual(report["flux_ratio"][1], 1.0, delta=0.03)  # which RGBE truncates
        self.assertEqual((self.folder / "a.tif").read_bytes()[:2], b"II")
        self.assertIn("layers need an EXR", self.error_of(*frame, "-o", "b.tif", "--layers", "part", code=1))

    def test_claims_of_memory_are_refused_before_it_is_allocated(self):
        """A few bytes that claim gigabytes, or padding that a writer would trust; the program has 3 GB at most."""
        def run(name, output):
            return subprocess.run([PROGRAM, "apply", *LENS, CORPUS / name, "-o", output, "--no-detect"], cwd=self.folder,
                                  capture_output=True, timeout=60,
                                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30)))
        for name, words in (("claims.jpg", "65280 x 65280"), ("user_data.dpx", "user data")):
            done = run(name, "out.exr")
            self.assertEqual(done.returncode, 1, name)
            self.assertIn(words, done.stderr.decode())
        self.assertEqual(run("padding.dpx", "out.dpx").returncode, 0)
        self.assertLess((self.folder / "out.dpx").stat().st_size, 1 << 20)

    def test_damaged_files_are_refused(self):
        write_dpx(self.folder / "whole.dpx", plate_codes(), VIDEO)
        (self.folder / "cut.dpx").write_bytes((self.folder / "whole.dpx").read_bytes()[:9000])
        write_tiff(self.folder / "huge.tif", [0] * 300, claimed=(1 << 20, 1 << 20))
        write_tiff(self.folder / "cut.tif", [0] * 300, claimed=(8000, 8000))
        (self.folder / "empty.tif").write_bytes(b"II*\0")
        for name in ("cut.dpx", "huge.tif", "cut.tif", "empty.tif"):
            self.assertIn(name, self.error_of("apply", *LENS, name, "-o", "out.exr", "--input-space", "logc3", code=1))
        self.assertEqual([f for f in self.files() if f.startswith("out")], [])

    def test_film_needs_a_space(self):
        write_dpx(self.folder / "in.dpx", plate_codes(), LOG)
        self.assertIn("--input-space", self.error_of("apply", *LENS, "in.dpx", "-o", "out.exr", code=1))
        write_tiff(self.folder / "in.tif", [500] * (WIDTH * HEIGHT * 3))
        self.assertIn("--output-space", self.error_of("apply", *LENS, "in.tif", "-o", "out.dpx", code=1))


@unittest.skipUnless(HAS_FORMATS and HAS_SPACES, "built without OpenImageIO or OpenColorIO")
class Spaces(ProgramTest):
    def test_camera_log_comes_back(self):
        """Without new light every code is as it was; with it none is lower, and many are higher."""
        codes = plate_codes()
        write_dpx(self.folder / "in.dpx", codes)
        spaces = ["--input-space", "logc3"]
        self.run_program("apply", *LENS, "in.dpx", "-o", "same.dpx", "--no-detect", *spaces)
        self.assertEqual(read_dpx(self.folder / "same.dpx"), codes)
        self.run_program("apply", *LENS, "in.dpx", "-o", "out.dpx", "--flare-only", "flare.exr", "--stops", "6", *spaces)
        flare = exr.Picture(self.folder / "flare.exr").channels
        changes = []
        for k, (before, after) in enumerate(zip(sum(codes, []), sum(read_dpx(self.folder / "out.dpx"), []))):
            change = max(a - b for a, b in zip(after, before))
            changes.append(change)
            if not any(flare[c][k] for c in "RGB"):
                self.assertEqual(after, before)
            self.assertGreaterEqual(min(a - b for a, b in zip(after, before)), -1)
        self.assertGreater(max(changes), 20)

    def test_log_is_decoded_as_published(self):
        """ARRI LogC at EI 800: 18 per cent grey is 0.3910."""
        codes = [[[400] * 3 for _ in range(WIDTH)] for _ in range(HEIGHT)]
        write_dpx(self.folder / "in.dpx", codes)
        self.run_program("apply", *LENS, "in.dpx", "-o", "out.exr", "--no-detect", "--input-space", "ARRI_ALEXA-LOGC-EI800-AWG")
        picture = exr.Picture(self.folder / "out.exr")
        for c in "RGB":
            self.assertAlmostEqual(picture.value(7, 9, c), 0.18, delta=0.001)
        self.assertIn("chromaticities", picture.attributes)

    def test_halves_come_back(self):
        noise = random.Random(3)
        values = {c: (exr.HALF, [noise.uniform(-0.1, 2) for _ in range(WIDTH * HEIGHT)]) for c in "RGB"}
        exr.write(self.folder / "in.exr", values, WIDTH, HEIGHT)
        before = exr.Picture(self.folder / "in.exr").channels
        for space in ("ACES2065-1", "ACEScct", "logc3"):
            self.run_program("apply", *LENS, "in.exr", "-o", "out.exr", "--no-detect", "--input-space", space)
            self.assertEqual(exr.Picture(self.folder / "out.exr").channels, before, space)

    def test_a_plate_becomes_another_space(self):
        """sRGB from a PNG to the same codes through ACEScg and out of it in another format."""
        write_tiff(self.folder / "in.tif", [9000, 30000, 50000] * (WIDTH * HEIGHT))
        self.run_program("apply", *LENS, "in.tif", "-o", "cct.exr", "--no-detect", "--input-space", "sRGB", "--output-space", "ACEScct")
        self.run_program("apply", *LENS, "cct.exr", "-o", "back.dpx", "--no-detect", "--input-space", "ACEScct", "--output-space", "sRGB")
        for got, wanted in zip(read_dpx(self.folder / "back.dpx")[3][4], (9000, 30000, 50000)):
            self.assertAlmostEqual(got, wanted / 64, delta=1.0)

    def test_a_flare_alone_takes_a_space(self):
        frame = ["render", *LENS, "--size", "48x32", "--wavelengths", "3", "--value", "100"]
        self.run_program(*frame, "-o", "linear.exr")
        self.run_program(*frame, "-o", "cct.exr", "--output-space", "ACEScct")
        self.run_program("apply", *LENS, "cct.exr", "-o", "back.exr", "--no-detect", "--input-space", "ACEScct",
                         "--output-space", "Linear Rec.709")
        report = json.loads(self.run_program("compare", "linear.exr", "back.exr", "--json").stdout)
        self.assertGreater(report["psnr_db"], 50.0)
        self.assertIn("--output-space", self.error_of(*frame, "-o", "c.exr", "--layers", "part", "--output-space", "ACEScct", code=1))

    def test_errors_say_what_there_is(self):
        write_dpx(self.folder / "in.dpx", plate_codes())
        error = self.error_of("apply", *LENS, "in.dpx", "-o", "out.exr", "--input-space", "logd", code=1)
        self.assertIn("in.dpx", error)
        self.assertIn("ACEScct", error)
        for config in ("missing.ocio", "ocio://cg-config-v1.0.0_aces-v1.3_ocio-v2.1"):
            error = self.error_of("apply", *LENS, "in.dpx", "-o", "out.exr", "--input-space", "logc3", "--ocio-config", config, code=1)
            self.assertIn(config, error)

    def test_a_configuration_of_the_user(self):
        """A space of one's own: values are the square root of the light."""
        (self.folder / "own.ocio").write_text("""ocio_profile_version: 1
search_path: luts
strictparsing: true
roles: {default: raw, scene_linear: lin_rec709}
displays: {d: [!<View> {name: v, colorspace: raw}]}
active_displays: []
active_views: []
colorspaces:
  - !<ColorSpace> {name: raw, isdata: true}
  - !<ColorSpace> {name: lin_rec709}
  - !<ColorSpace> {name: root, to_reference: !<ExponentTransform> {value: [2, 2, 2, 1]}}
""")
        write_tiff(self.folder / "in.tif", [32768] * (WIDTH * HEIGHT * 3))
        self.run_program("apply", *LENS, "in.tif", "-o", "out.exr", "--no-detect", "--input-space", "root", "--ocio-config", "own.ocio")
        self.assertAlmostEqual(exr.Picture(self.folder / "out.exr").value(3, 3), 0.25, delta=1e-4)


if __name__ == "__main__":
    unittest.main()
