#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The bundle as hosts look for it: its folders, its property list, and what the binary exports.

    test_bundle.py Contrejour.ofx.bundle
"""
import pathlib
import plistlib
import subprocess
import sys
import unittest

BUNDLE = pathlib.Path(sys.argv.pop(1))


class BundleTest(unittest.TestCase):
    def binary(self):
        found = list(BUNDLE.glob("Contents/*/Contrejour.ofx"))
        self.assertEqual(len(found), 1, found)
        return found[0]

    def test_binary_has_the_name_of_the_bundle(self):
        self.assertEqual(self.binary().stem, BUNDLE.name.split(".")[0])

    def test_property_list_names_the_binary(self):
        with open(BUNDLE / "Contents" / "Info.plist", "rb") as file:
            properties = plistlib.load(file)
        self.assertEqual(properties["CFBundleExecutable"], self.binary().name)
        self.assertEqual(properties["CFBundlePackageType"], "BNDL")

    @unittest.skipUnless(sys.platform == "linux", "nm's options differ elsewhere")
    def test_exports_are_the_standards_and_no_more(self):
        listed = subprocess.run(["nm", "-D", "--defined-only", self.binary()], capture_output=True, check=True, text=True)
        names = {line.split()[-1] for line in listed.stdout.splitlines() if line.strip()}
        self.assertEqual(names, {"OfxGetNumberOfPlugins", "OfxGetPlugin", "OfxSetHost"})


if __name__ == "__main__":
    unittest.main()
