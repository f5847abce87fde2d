# SPDX-License-Identifier: Apache-2.0
"""Runs the program under test in a folder of its own."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = os.environ.get("CONTREJOUR", "contrejour")
QUICK = ["--size", "96x64", "--grid", "32"]  # as small as still shows what is asked


class ProgramTest(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def run_program(self, *arguments, code=0, folder=None):
        done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=folder or self.folder, capture_output=True, timeout=300)
        self.assertEqual(done.returncode, code, f"{arguments[:30]}: {done.stdout.decode()}{done.stderr.decode()}")
        return done

    def json_of(self, *arguments):
        done = self.run_program(*arguments, "--json")
        self.assertEqual(done.stderr, b"")
        return json.loads(done.stdout)

    def error_of(self, *arguments, code):
        """What the program says when it refuses: one line on the standard error, nothing on the output."""
        done = self.run_program(*arguments, code=code)
        self.assertEqual(done.stdout, b"")
        text = done.stderr.decode()
        self.assertTrue(text.startswith("contrejour: "), text)
        self.assertEqual(text.count("\n"), 1, text)
        return text

    def files(self):
        return sorted(p.name for p in self.folder.iterdir())
