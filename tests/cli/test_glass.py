#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""contrejour glass ..., and glasses of the user's own."""
import json
import os
import subprocess
import unittest

from program import PROGRAM, ProgramTest

AGF = "NM MINE-1 1 650500 1.65 50 0 0\nCD 2.7225\nLD 0.38 0.8\nIT 0.4 0.9 10\nIT 0.7 0.99 10\n"
LENS = """name = "x"
source = "x"
f_number = 4
sensor_mm = [36, 24]
surfaces = [
  { radius_mm = 60, thickness_mm = 5, semi_diameter_mm = 10, glass = "MINE-1" },
  { radius_mm = -60, thickness_mm = 2, semi_diameter_mm = 10 },
  { stop = true, semi_diameter_mm = 8 },
]
"""


class Glass(ProgramTest):
    def test_list(self):
        glasses = self.json_of("glass", "list")["glasses"]
        self.assertGreater(len(glasses), 2000)
        self.assertLessEqual({"name", "maker", "status", "code", "n_d", "v_d"}, set(glasses[0]))
        self.assertEqual({g["maker"] for g in glasses}, {"SCHOTT", "OHARA", "HOYA", "HIKARI", "SUMITA", "CDGM", "MISC"})
        ohara = self.json_of("glass", "list", "--maker", "ohara")["glasses"]
        self.assertEqual({g["maker"] for g in ohara}, {"OHARA"})
        self.assertIn("N-BK7", self.run_program("glass", "list", "--maker", "SCHOTT").stdout.decode())
        self.assertIn("SCHOTT", self.error_of("glass", "list", "--maker", "nobody", code=1))

    def test_show(self):
        """Figures of SCHOTT's data sheet of N-BK7."""
        shown = self.json_of("glass", "show", "n-bk7")
        self.assertEqual((shown["name"], shown["maker"]), ("N-BK7", "SCHOTT"))
        for key, value, delta in (("n_d", 1.51680, 1e-5), ("v_d", 64.17, 0.01), ("v_e", 63.96, 0.01), ("p_gf", 0.5349, 1e-4),
                                  ("d_pgf", -0.0009, 1e-4)):
            self.assertAlmostEqual(shown[key], value, delta=delta)
        lines = {line["line"]: line for line in shown["lines"]}
        self.assertEqual(list(lines), ["i", "h", "g", "F'", "F", "e", "d", "C'", "C", "r"])
        self.assertAlmostEqual(lines["g"]["n"], 1.52668, delta=1e-5)
        self.assertAlmostEqual(lines["i"]["transmittance"], 0.988, delta=0.002)
        text = self.run_program("glass", "show", "N-BK7").stdout.decode()
        self.assertIn("sellmeier-1", text)
        self.assertIn("1.516800", text)

    def test_show_code_and_makers(self):
        self.assertAlmostEqual(self.json_of("glass", "show", "517642")["v_d"], 64.2, delta=1e-9)
        self.assertEqual(self.json_of("glass", "show", "SF4", "--maker", "HIKARI")["maker"], "HIKARI")
        self.assertIn("N-BK7", self.error_of("glass", "show", "N-BK77X", code=1))

    def test_closest(self):
        close = self.json_of("glass", "closest", "1.62004", "36.37", "--maker", "SCHOTT")["glasses"]
        self.assertEqual(len(close), 5)
        self.assertIn("F2", close[0]["name"])
        self.assertLess(close[0]["distance"], 0.01)
        self.assertEqual([g["distance"] for g in close], sorted(g["distance"] for g in close))
        self.error_of("glass", "closest", "0.5", "36", code=2)

    def test_own_catalogue_by_option_and_environment(self):
        (self.folder / "own.agf").write_text(AGF)
        (self.folder / "lens.toml").write_text(LENS)
        shown = self.json_of("glass", "show", "mine1", "--catalogue", "own.agf")
        self.assertEqual(shown["maker"], "OWN")
        self.assertAlmostEqual(shown["n_d"], 1.65, delta=1e-12)
        self.assertIn("MINE-1", self.error_of("lens", "info", "lens.toml", code=1))
        environment = {**os.environ, "CONTREJOUR_GLASS_PATH": str(self.folder / "own.agf")}
        done = subprocess.run([PROGRAM, "lens", "info", "lens.toml", "--json"], cwd=self.folder, env=environment,
                              capture_output=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertAlmostEqual(json.loads(done.stdout)["surfaces"][0]["n_d"], 1.65, delta=1e-12)
        self.assertIn("no such file", self.error_of("glass", "list", "--catalogue", "absent.agf", code=1))


if __name__ == "__main__":
    unittest.main()
