#!/usr/bin/env python3
"""Files: hostile ones are refused, places that cannot be written to fail at once, and nothing is left half-written."""
import os
import signal
import struct
import subprocess
import time
import unittest

import exr
from program import PROGRAM, QUICK, ProgramTest

POSIX = os.name == "posix"


class Hostile(ProgramTest):
    def test_pictures(self):
        exr.write(self.folder / "good.exr", {c: (exr.FLOAT, [1.0] * 64) for c in "RGB"}, 8, 8)
        good = (self.folder / "good.exr").read_bytes()
        window = good.index(b"dataWindow\0box2i\0") + len(b"dataWindow\0box2i\0") + 4
        huge = good[:window] + struct.pack("<4i", 0, 0, 2**30, 2**30) + good[window + 16:]
        for name, data in (("empty.exr", b""), ("text.exr", b"hello\n" * 50), ("cut.exr", good[:-100]),
                           ("head.exr", good[:60]), ("noise.exr", bytes(range(256)) * 40), ("huge.exr", huge),
                           ("cut.png", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR")):
            with self.subTest(name):
                (self.folder / name).write_bytes(data)
                before = self.files()
                text = self.error_of("apply", "heliar", name, "-o", "out.exr", *QUICK[2:], code=1)
                self.assertIn(name, text)
                self.error_of("compare", name, "good.exr", code=1)
                self.assertEqual(self.files(), before)

    def test_lenses(self):
        for name, data in (("empty.toml", b""), ("noise.toml", bytes(range(256)) * 40),
                           ("cut.toml", b"name = \"x\"\nsurfaces = [ {"), ("deep.toml", b"a = " + b"[" * 100000)):
            with self.subTest(name):
                (self.folder / name).write_bytes(data)
                before = self.files()
                self.assertIn(name, self.error_of("render", name, "-o", "out.exr", *QUICK, code=1))
                self.assertEqual(self.files(), before)

    def test_missing(self):
        self.assertIn("none.exr", self.error_of("apply", "heliar", "none.exr", "-o", "o.exr", code=1))
        self.error_of("lens", "info", "none.toml", code=1)
        self.error_of("apply", "heliar", ".", "-o", "o.exr", code=1)
        self.assertEqual(self.files(), [])


class Outputs(ProgramTest):
    def test_places_that_cannot_be_written_fail_before_the_work(self):
        began = time.monotonic()
        slow = ["render", "canon-70-200", "--method", "reference", "--size", "1920x1080"]
        self.assertIn("nowhere/a.exr", self.error_of(*slow, "-o", "nowhere/a.exr", code=1))
        (self.folder / "folder.exr").mkdir()
        self.error_of(*slow, "-o", "folder.exr", code=1)
        self.error_of(*slow, "-o", "a.exr", "--preview", "nowhere/a.png", code=1)
        self.error_of(*slow, "-o", "a.png", "--preview", "a.png", code=1)
        self.assertLess(time.monotonic() - began, 20)
        self.assertEqual(self.files(), ["folder.exr"])

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs /dev/full")
    def test_a_full_disk(self):
        for name in ("a.exr", "a.svg", "a.png", "a.json"):
            os.symlink("/dev/full", self.folder / name)
        self.error_of("render", "heliar", "-o", "a.exr", *QUICK, code=1)
        self.error_of("render", "heliar", "-o", "a.png", *QUICK, code=1)
        self.error_of("render", "heliar", "-o", "b.exr", "--stats", "a.json", *QUICK, code=1)
        self.error_of("lens", "draw", "heliar", "-o", "a.svg", code=1)
        self.assertEqual(self.files(), ["a.exr", "a.json", "a.png", "a.svg"])
        with open("/dev/full", "wb") as full:
            done = subprocess.run([PROGRAM, "lens", "list"], stdout=full, stderr=subprocess.PIPE)
        self.assertEqual(done.returncode, 1)
        self.assertIn(b"standard output", done.stderr)

    @unittest.skipUnless(POSIX, "symbolic links")
    def test_a_link_stays_a_link(self):
        (self.folder / "real.exr").write_bytes(b"old")
        os.symlink("real.exr", self.folder / "link.exr")
        self.run_program("render", "heliar", "-o", "link.exr", *QUICK)
        self.assertTrue((self.folder / "link.exr").is_symlink())
        exr.Picture(self.folder / "real.exr")

    def test_a_failed_command_leaves_the_old_file(self):
        (self.folder / "out.exr").write_bytes(b"old")
        (self.folder / "bad.exr").write_bytes(b"bad")
        self.error_of("apply", "heliar", "bad.exr", "-o", "out.exr", code=1)
        self.assertEqual((self.folder / "out.exr").read_bytes(), b"old")


@unittest.skipUnless(POSIX, "signals")
class Interrupt(ProgramTest):
    def interrupt(self, number, *arguments):
        running = subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        time.sleep(1.0)
        self.assertIsNone(running.poll(), "it was to take longer")
        running.send_signal(number)
        began = time.monotonic()
        _, errors = running.communicate(timeout=60)
        self.assertLess(time.monotonic() - began, 20)
        self.assertEqual((running.returncode, errors), (130, b"contrejour: interrupted\n"))

    def test_render_leaves_no_file(self):
        self.interrupt(signal.SIGINT, "render", "canon-70-200", "--method", "reference", "--size", "960x540",
                       "-o", "a.exr", "--preview", "a.png", "--stats", "a.json")
        self.interrupt(signal.SIGTERM, "render", "canon-70-200", "--size", "1920x1080", "--wavelengths", "64",
                       "--grid", "512", "-o", "a.exr")
        self.assertEqual(self.files(), [])

    def test_apply_leaves_the_old_file(self):
        values = [0.01] * (300 * 200)
        for k in range(20):
            values[3000 * k + 14 * k] = 1000.0
        exr.write(self.folder / "in.exr", {c: (exr.FLOAT, values) for c in "RGB"}, 300, 200)
        before = (self.folder / "in.exr").read_bytes()
        self.interrupt(signal.SIGINT, "apply", "canon-70-200", "in.exr", "-o", "in.exr", "--grid", "512")
        self.assertEqual(self.files(), ["in.exr"])
        self.assertEqual((self.folder / "in.exr").read_bytes(), before)


if __name__ == "__main__":
    unittest.main()
