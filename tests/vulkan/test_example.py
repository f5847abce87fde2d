# SPDX-License-Identifier: Apache-2.0
"""Runs the Vulkan example, and compares the picture that it writes with that of the command line."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

EXAMPLE, PROGRAM = sys.argv[1:3]
# The light of the example, whose angles are 0.15 and 0.1 rad.
FRAME = ["-f", "8", "--light", "8.594366926962349,5.729577951308232", "--value", "1000,900,800", "--size", "320x180"]


def run(*command):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, timeout=300)


class ExampleTest(unittest.TestCase):
    def test_writes_the_same_flare_as_the_command_line(self):
        if not any(device["usable"] for device in json.loads(run(PROGRAM, "devices", "--json").stdout)):
            self.skipTest("no device is usable")
        with tempfile.TemporaryDirectory() as folder:
            picture, expected = pathlib.Path(folder) / "flare.exr", pathlib.Path(folder) / "expected.exr"
            done = run(EXAMPLE, picture)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("drawn by", done.stdout)
            self.assertNotIn("cpu", done.stdout)
            # On a machine with several devices, the command line may choose another one.
            done = run(PROGRAM, "render", "heliar", *FRAME, "--device", "vulkan", "-o", expected)
            self.assertEqual(done.returncode, 0, done.stderr)
            difference = json.loads(run(PROGRAM, "compare", picture, expected, "--json").stdout)
            self.assertGreater(difference["peak"], 0.0)
            self.assertLess(difference["max_abs_error"], 1e-3 * difference["peak"])

    def test_says_what_is_wrong(self):
        done = run(EXAMPLE)
        self.assertEqual(done.returncode, 1)
        self.assertIn("usage", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
