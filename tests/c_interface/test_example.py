# SPDX-License-Identifier: Apache-2.0
"""Runs the C example: what it prints, the picture it writes, what it says when something is wrong."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

EXAMPLE = sys.argv[1]
QUICK = ["size=48x32", "light=9,5:1000", "wavelengths=3", "error=0.02", "fnumber=8"]


class ExampleTest(unittest.TestCase):
    def run_example(self, *arguments):
        return subprocess.run([EXAMPLE, *map(str, arguments)], capture_output=True, text=True, timeout=300)

    def test_renders_and_lists_ghosts(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = pathlib.Path(folder) / "flare.pfm"
            done = self.run_example("cooke-triplet", picture, *QUICK)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("15 ghosts, the brightest:", done.stdout)
            self.assertIn("curvature", done.stdout)
            content = picture.read_bytes()
            self.assertTrue(content.startswith(b"PF\n48 32\n-1.0\n"))
            self.assertEqual(len(content), len(b"PF\n48 32\n-1.0\n") + 48 * 32 * 3 * 4)

    def test_says_what_is_wrong(self):
        done = self.run_example("heliaar", "out.pfm")
        self.assertEqual(done.returncode, 1)
        self.assertIn("heliar", done.stderr)
        self.assertIn("(invalid argument)", done.stderr)
        done = self.run_example("heliar", "out.pfm", "blades=2")
        self.assertEqual(done.returncode, 1)
        self.assertIn("blades: 2 blades cannot enclose an opening", done.stderr)
        self.assertEqual(self.run_example("heliar").returncode, 2)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
