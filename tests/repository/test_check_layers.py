#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The layer check must let allowed includes pass and name each forbidden one by file and line."""
import contextlib
import io
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
sys.dont_write_bytecode = True
import check_layers  # noqa: E402


class Planted(unittest.TestCase):
    def complaints(self, files):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                path = root / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            return check_layers.check_tree(root)[0]

    def forbidden(self, source, include, *others):
        """Plant `include` on line 3 of `source` beside existing `others`; return the only complaint."""
        files = {other: "#pragma once\n" for other in others}
        files[source] = f"#pragma once\n\n#include {include}\n"
        found = self.complaints(files)
        self.assertEqual(len(found), 1, found)
        self.assertTrue(found[0].startswith(f"{source}:3: "), found)
        return found[0]

    def allowed(self, source, include, *others):
        files = {other: "#pragma once\n" for other in others}
        files[source] = f"#include {include}\n"
        self.assertEqual(self.complaints(files), [])

    def test_lower_layers_are_implied(self):
        self.allowed("src/ghosts/a.cpp", '"base/tasks.h"', "src/base/tasks.h")
        self.allowed("src/render/bundle/a.cpp", '"optics/glass/g.h"', "src/optics/glass/g.h")
        self.allowed("src/render/session/a.cpp", '"render/bundle/bundle.h"', "src/render/bundle/bundle.h")
        self.allowed("src/render/bundle/a.cpp", "<contrejour/render.h>", "include/contrejour/render.h")

    def test_upwards_is_forbidden(self):
        self.assertIn("base may not include lens", self.forbidden("src/base/a.cpp", '"contrejour/lens.h"'))
        self.forbidden("src/optics/surface/a.h", '"optics/glass/g.h"', "src/optics/glass/g.h")
        self.forbidden("src/image/a.cpp", '"contrejour/lens.h"')
        self.forbidden("src/ghosts/a.cpp", "<contrejour/image.h>")
        self.forbidden("src/optics/trace/a.cpp", '"../../ghosts/b.h"', "src/ghosts/b.h")

    def test_no_renderer_includes_another(self):
        found = self.forbidden("src/render/tiled/a.cpp", '"render/bundle/bundle.h"', "src/render/bundle/bundle.h")
        self.assertIn("no renderer includes another", found)
        self.forbidden("src/render/tiled/a.cpp", '"render/session/d.h"', "src/render/session/d.h")

    def test_stages_of_a_renderer(self):
        self.allowed("src/render/adaptive/a.cpp", '"render/adaptive/tiles/t.h"', "src/render/adaptive/tiles/t.h")
        self.allowed("src/render/adaptive/choose/a.cpp", '"render/adaptive/budget/b.h"', "src/render/adaptive/budget/b.h")
        self.forbidden("src/render/adaptive/clip/a.cpp", '"render/adaptive/emit/e.h"', "src/render/adaptive/emit/e.h")
        self.allowed("src/render/adaptive/budget/a.cpp", '"render/stop_patterns/s.h"', "src/render/stop_patterns/s.h")
        self.forbidden("src/render/adaptive/tiles/a.cpp", '"render/adaptive/cells/c.h"', "src/render/adaptive/cells/c.h")
        self.allowed("src/render/polynomial/a.cpp", '"render/pupils/p.h"', "src/render/pupils/p.h")
        self.allowed("src/render/polynomial/a.cpp", '"render/ray_maps/m.h"', "src/render/ray_maps/m.h")
        self.forbidden("src/render/ray_maps/a.cpp", '"render/adaptive/a.h"', "src/render/adaptive/a.h")
        self.forbidden("src/render/bundle/a.cpp", '"render/adaptive/tiles/t.h"', "src/render/adaptive/tiles/t.h")

    def test_nobody_includes_vulkan(self):
        for source in ("src/render/bundle/a.cpp", "src/render/session/a.cpp", "src/measure/a.cpp"):
            self.forbidden(source, '"vulkan/device.h"', "src/vulkan/device.h")

    def test_a_missing_file_of_a_known_layer_counts(self):
        self.forbidden("src/base/a.cpp", '"render/bundle/generated.h"')

    def test_public_headers_include_public_headers(self):
        self.assertIn("users do not have", self.forbidden("include/contrejour/lens.h", '"base/units.h"', "src/base/units.h"))
        self.forbidden("include/contrejour/expert/vec.h", '"contrejour/render.h"')

    def test_apps_see_public_headers_and_their_own(self):
        self.allowed("apps/cli/main.cpp", '"contrejour/render.h"')
        self.allowed("apps/cli/main.cpp", '"command.h"', "apps/cli/command.h")
        self.forbidden("apps/cli/main.cpp", '"base/tasks.h"', "src/base/tasks.h")
        self.forbidden("apps/demo/main.cpp", '"../cli/command.h"', "apps/cli/command.h")
        self.forbidden("apps/cli/main.cpp", '"settings/photometry.h"', "src/settings/photometry.h")

    def test_settings_and_compositing_lie_above_the_renderers(self):
        self.allowed("src/settings/a.cpp", '"contrejour/render.h"')
        self.allowed("src/compositing/a.cpp", '"settings/photometry.h"', "src/settings/photometry.h")
        self.forbidden("src/settings/a.cpp", '"contrejour/expert/flare_plan.h"')
        self.forbidden("src/render/session/a.cpp", '"contrejour/expert/parameter_values.h"')

    def test_fenced_libraries(self):
        self.forbidden("src/render/bundle/a.cpp", "<shaderc/shaderc.h>")
        self.forbidden("src/image/a.cpp", "<GLFW/glfw3.h>")
        self.forbidden("src/render/bundle/a.cpp", "<oneapi/tbb/parallel_for.h>")
        self.allowed("src/vulkan/a.cpp", "<vulkan/vulkan.h>")
        self.allowed("src/base/a.cpp", "<oneapi/tbb/parallel_for.h>")

    def test_unknown_folders_and_headers_are_told(self):
        self.assertIn("belongs to no layer", self.complaints({"src/utils/a.cpp": "\n"})[0])
        self.assertIn("belongs to no layer", self.complaints({"include/contrejour/misc.h": "\n"})[0])

    def test_comments_do_not_count(self):
        text = '// #include "contrejour/lens.h"\n/*\n#include "contrejour/lens.h"\n*/\n'
        self.assertEqual(self.complaints({"src/base/a.cpp": text}), [])

    def test_other_libraries_do_not_count(self):
        self.allowed("src/base/a.cpp", "<vector>")
        self.allowed("src/optics/surface/a-inl.h", '"hwy/highway.h"')


class Table(unittest.TestCase):
    def test_the_order_has_no_circle(self):
        for layer in check_layers.MAY_INCLUDE:
            self.assertNotIn(layer, check_layers.closure(layer))

    def test_exit_codes(self):
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            with tempfile.TemporaryDirectory() as folder:
                self.assertEqual(check_layers.main([folder]), 2)  # an empty tree must not look clean
                path = pathlib.Path(folder) / "src/base/a.cpp"
                path.parent.mkdir(parents=True)
                path.write_text("#include <vector>\n")
                self.assertEqual(check_layers.main([folder]), 0)
                path.write_text('#include "contrejour/lens.h"\n')
                self.assertEqual(check_layers.main([folder]), 1)
            self.assertEqual(check_layers.main(["--what"]), 2)


if __name__ == "__main__":
    unittest.main()
