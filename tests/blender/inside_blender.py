# SPDX-License-Identifier: Apache-2.0
"""Runs the tests whose modules are named behind --, in Blender with the add-on registered."""
import pathlib
import sys
import unittest

HERE = pathlib.Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "plugins" / "blender")]

import contrejour_flare  # noqa: E402

contrejour_flare.register()
tests = unittest.defaultTestLoader.loadTestsFromNames(sys.argv[sys.argv.index("--") + 1 :])
result = unittest.TextTestRunner(verbosity=2).run(tests)
contrejour_flare.unregister()
sys.exit(0 if result.wasSuccessful() else 1)
