# SPDX-License-Identifier: Apache-2.0
"""A test case with a folder that goes with it."""
import pathlib
import tempfile
import unittest


class TemporaryFolderTest(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)
