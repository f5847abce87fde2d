#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Files: hostile ones are refused, places that cannot be written to fail at once, and nothing is left half-written."""
import json
import os
import signal
import struct
import subprocess
import threading
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


    @unittest.skipUnless(os.path.exists("/dev/zero"), "needs /dev/zero")
    def test_files_without_an_end(self):
        began = time.monotonic()
        self.assertIn("/dev/zero", self.error_of("compare", "/dev/zero", "/dev/zero", code=1))
        self.error_of("apply", "heliar", "/dev/zero", "-o", "o.exr", code=1)
        self.error_of("render", "/dev/zero", "-o", "o.exr", code=1)
        self.error_of("render", "heliar", "-o", "o.exr", "--iris-image", "/dev/zero", code=1)
        self.error_of("render", "heliar", "-o", "o.exr", "--colour", "/dev/zero", code=2)
        self.error_of("render", "--preset", "/dev/zero", "-o", "o.exr", code=1)
        self.assertLess(time.monotonic() - began, 20)
        self.assertEqual(self.files(), [])


class Terminal(ProgramTest):
    """Names in files and on the command line may hold what a terminal obeys; none of it is printed."""

    def check(self, text):
        for bad in (b"\x1b", b"\x07", b"\x9b", b"\x7f", "\u009b".encode(), "\u202e".encode()):
            self.assertNotIn(bad, text)

    def test_messages_and_results(self):
        wild = "a\x1b[31mb\u009b1mc\u202ed\x07\x7f"
        self.check(self.run_program("render", wild + ".toml", "-o", "o.exr", code=1).stderr)
        self.check(self.run_program("render", "heliar", "-o", "o.exr", "--" + wild, code=2).stderr)
        self.check(self.run_program("render", "heliar", "-o", "o.exr", "--value", wild, code=2).stderr)
        named = self.run_program("lens", "convert", "heliar", "l.toml") and (self.folder / "l.toml").read_text()
        name = next(line for line in named.splitlines() if line.startswith("name"))
        self.assertIn('"', name)
        evil = 'name = "\\u001b[31mred\\u009b\\u007f\\u202e"'
        (self.folder / "l.toml").write_text(named.replace(name, evil))
        self.check(self.run_program("lens", "info", "l.toml").stdout)
        shown = self.run_program("lens", "info", "l.toml", "--json").stdout
        self.check(shown)
        self.assertEqual(json.loads(shown)["name"], "\x1b[31mred\u009b\x7f\u202e")
        latin = os.fsdecode(b"caf\xe9\x9b31m.toml")
        done = subprocess.run([PROGRAM, "render", latin, "-o", "o.exr"], cwd=self.folder, capture_output=True)
        self.check(done.stderr)


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

    @unittest.skipUnless(POSIX, "symbolic links")
    def test_a_link_to_nothing_yet_stays_a_link(self):
        os.symlink("real.exr", self.folder / "link.exr")
        os.symlink("real.png", self.folder / "link.png")
        self.run_program("render", "heliar", "-o", "link.exr", "--preview", "link.png", *QUICK)
        for ending in ("exr", "png"):
            self.assertTrue((self.folder / f"link.{ending}").is_symlink())
            self.assertFalse((self.folder / f"real.{ending}").is_symlink())
        exr.Picture(self.folder / "real.exr")

    @unittest.skipUnless(POSIX, "pipes")
    def test_a_picture_goes_into_a_pipe(self):
        self.run_program("render", "heliar", "-o", "a.exr", "--preview", "a.png", *QUICK)
        for name in ("b.exr", "b.png"):
            os.mkfifo(self.folder / name)
        got = {}
        readers = [threading.Thread(target=lambda n=name: got.update({n: (self.folder / n).read_bytes()}), daemon=True)
                   for name in ("b.exr", "b.png")]
        for reader in readers:
            reader.start()
        self.run_program("render", "heliar", "-o", "b.exr", "--preview", "b.png", *QUICK)
        for reader in readers:
            reader.join(60)
        self.assertEqual(got["b.exr"], (self.folder / "a.exr").read_bytes())
        self.assertEqual(got["b.png"], (self.folder / "a.png").read_bytes())

    @unittest.skipUnless(POSIX, "limits")
    def test_a_limit_of_sizes_is_a_full_disk(self):
        import resource
        done = subprocess.run([PROGRAM, "render", "heliar", "-o", "a.exr", *QUICK], cwd=self.folder, capture_output=True,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)))
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn(b"a.exr", done.stderr)
        self.assertEqual(self.files(), [])

    @unittest.skipUnless(POSIX, "closed streams")
    def test_closed_streams(self):
        self.run_program("render", "heliar", "-o", "a.exr", *QUICK)
        whole = (self.folder / "a.exr").read_bytes()
        for closed in (">&-", "2>&-", ">&- 2>&-", "<&- >&- 2>&-"):
            with self.subTest(closed):
                script = f'"$0" render heliar -o b.exr --size 96x64 --grid 32 {closed}'
                done = subprocess.run(["sh", "-c", script, PROGRAM], cwd=self.folder, capture_output=True)
                self.assertEqual((done.returncode, done.stderr), (0, b""))
                self.assertEqual((self.folder / "b.exr").read_bytes(), whole)
        done = subprocess.run(["sh", "-c", '"$0" lens list >&-', PROGRAM], cwd=self.folder, capture_output=True)
        self.assertEqual(done.returncode, 1)
        with open("/dev/full", "wb") as full:
            done = subprocess.run([PROGRAM, "render", "heliar", "-o", "a.exr", *QUICK], cwd=self.folder, stdout=full)
        self.assertEqual(done.returncode, 0)

    def test_a_failed_command_leaves_the_old_file(self):
        (self.folder / "out.exr").write_bytes(b"old")
        (self.folder / "bad.exr").write_bytes(b"bad")
        self.error_of("apply", "heliar", "bad.exr", "-o", "out.exr", code=1)
        self.assertEqual((self.folder / "out.exr").read_bytes(), b"old")


@unittest.skipUnless(POSIX, "signals")
class Interrupt(ProgramTest):
    def test_killed_while_files_wait_for_each_other(self):
        """The picture is complete, and waits for a pipe that nobody reads: nothing of it is left."""
        os.mkfifo(self.folder / "stats.json")
        (self.folder / "a.exr").write_bytes(b"old")
        running = subprocess.Popen([PROGRAM, "render", "heliar", "-o", "a.exr", "--preview", "a.png", "--stats",
                                    "stats.json", *QUICK], cwd=self.folder, stdout=subprocess.PIPE)
        time.sleep(3.0)
        self.assertIsNone(running.poll())
        running.kill()
        running.communicate(timeout=60)
        self.assertEqual(self.files(), ["a.exr", "stats.json"])
        self.assertEqual((self.folder / "a.exr").read_bytes(), b"old")

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
