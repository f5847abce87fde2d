# SPDX-License-Identifier: Apache-2.0
"""The wheel that `pip install .` makes: unpacked, it is the package."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python" / "build_backend"))

import contrejour_build  # noqa: E402


class WheelTest(unittest.TestCase):
    def test_wheel(self):
        with tempfile.TemporaryDirectory() as folder:
            name = contrejour_build.build_wheel(folder, {"build-dir": os.environ["CONTREJOUR_BUILD"], "jobs": "1"})
            unpacked = pathlib.Path(folder, "site")
            with zipfile.ZipFile(pathlib.Path(folder, name)) as wheel:
                self.assertIsNone(wheel.testzip())
                names = set(wheel.namelist())
                wheel.extractall(unpacked)
            information = next(unpacked.glob("*.dist-info"))
            listed = {line.split(",")[0] for line in (information / "RECORD").read_text().splitlines()}
            self.assertEqual(listed, names)
            for file in ("__init__.py", "_native.pyi", "py.typed"):
                self.assertIn(f"contrejour/{file}", names)
            code = "import contrejour, sys; print(contrejour.__file__, contrejour.__version__, len(contrejour.bundled_lenses()))"
            done = subprocess.run([sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": str(unpacked)},
                                  capture_output=True, text=True, timeout=100)
            self.assertEqual(done.returncode, 0, done.stderr)
            file, version, lenses = done.stdout.split()
            self.assertTrue(file.startswith(str(unpacked)), file)
            self.assertIn(f"-{version}-", name)
            self.assertGreater(int(lenses), 10)


if __name__ == "__main__":
    unittest.main()
