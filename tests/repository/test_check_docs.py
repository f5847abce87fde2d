#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The document check must find a dead link, a dead anchor and a header that no page mentions."""
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import check_docs  # noqa: E402


class CheckDocs(unittest.TestCase):
    def faults(self, files):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                path = root / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            return check_docs.check_tree(root)[0]

    def test_good_links_pass(self):
        files = {
            "README.md": "# A\n[docs](docs/a.md#the-one-way), [web](https://example.org), [here](#a)\n",
            "docs/a.md": "## The `one` way\n[back](../README.md)\n",
        }
        self.assertEqual(self.faults(files), [])

    def test_dead_links_are_told(self):
        self.assertEqual(self.faults({"README.md": "\n[x](docs/none.md)\n"}), ["README.md:2: docs/none.md is not there"])
        self.assertEqual(self.faults({"README.md": "![p](docs/p.png)\n"}), ["README.md:1: docs/p.png is not there"])

    def test_dead_anchors_are_told(self):
        self.assertIn("no heading #b", self.faults({"README.md": "# A\n[x](#b)\n"})[0])

    def test_code_is_not_prose(self):
        self.assertEqual(self.faults({"README.md": "```\n[x](none.md)\n```\n\n    [y](none.md)\n"}), [])

    def test_headers_must_be_mentioned(self):
        files = {"README.md": "`contrejour/lens.h`\n", "include/contrejour/lens.h": "", "include/contrejour/ens.h": ""}
        faults = self.faults(files)
        self.assertEqual(len(faults), 1)
        self.assertTrue(faults[0].startswith("include/contrejour/ens.h:1: "))


if __name__ == "__main__":
    unittest.main()
