# SPDX-License-Identifier: Apache-2.0
"""The zip file of the add-on: Blender installs it, enables it, and it renders with the package inside, the example too.

    test_zip.py BUILD/python
"""
import os
import pathlib
import subprocess
import sys
import tempfile

from run_in_blender import SKIPPED, blender_command

ROOT = pathlib.Path(__file__).parents[2]
SCRIPT = """
import bpy, sys
bpy.ops.preferences.addon_install(filepath={zip!r})
bpy.ops.preferences.addon_enable(module="contrejour_flare")
import contrejour
assert "contrejour_flare" in contrejour.__file__, contrejour.__file__
scene = bpy.context.scene
scene.render.resolution_x, scene.render.resolution_y = 48, 32
scene.contrejour.output = {output!r}
assert bpy.ops.contrejour.render_flare() == {{"FINISHED"}}
bpy.ops.preferences.addon_disable(module="contrejour_flare")
assert not hasattr(bpy.types.Scene, "contrejour")
"""


def main(package_folder):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        zip_file, output = folder / "contrejour_flare.zip", folder / "flare_0001.exr"
        plugin = ROOT / "plugins" / "blender"
        package = pathlib.Path(package_folder) / "contrejour"
        pack = [sys.executable, plugin / "make_zip.py", plugin / "contrejour_flare", package, zip_file]
        subprocess.run(pack, check=True)
        command, reason = blender_command({"PYTHONPATH": package_folder})
        if command is None:
            print(reason)
            return SKIPPED
        script = SCRIPT.format(zip=str(zip_file), output=str(folder / "flare_####.exr"))
        (folder / "scripts").mkdir()
        environment = {**os.environ, "BLENDER_USER_SCRIPTS": str(folder / "scripts")}
        done = subprocess.run([*command, "--python-expr", script], capture_output=True, text=True, env=environment)
        print(done.stdout, done.stderr)
        assert done.returncode == 0 and output.exists()
        street = str(ROOT / "examples" / "blender" / "street.py")
        arguments = ["--python", street, "--", str(folder), "sixties-normal", "64", "1"]
        done = subprocess.run([*command, *arguments], capture_output=True, text=True, env=environment)
        print(done.stdout, done.stderr)
        assert done.returncode == 0 and (folder / "street.png").exists()
        assert "Headlight: at" in done.stdout
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
