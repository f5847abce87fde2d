# SPDX-License-Identifier: Apache-2.0
"""Packs the add-on and the Python package into the zip file that Blender installs.

    make_zip.py ADDON_FOLDER PACKAGE_FOLDER OUTPUT.zip
"""
import pathlib
import sys
import zipfile

SUFFIXES = {".py", ".pyi", ".typed", ".so", ".pyd", ".dylib"}
EPOCH = (2000, 1, 1, 0, 0, 0)  # the same files make the same zip


def add_folder(archive, folder, inside):
    for file in sorted(folder.rglob("*")):
        if not file.is_file() or "__pycache__" in file.parts or file.suffix not in SUFFIXES:
            continue
        entry = zipfile.ZipInfo(f"{inside}/{file.relative_to(folder).as_posix()}", EPOCH)
        entry.external_attr = 0o644 << 16
        archive.writestr(entry, file.read_bytes(), zipfile.ZIP_DEFLATED)


def main(addon, package, output):
    with zipfile.ZipFile(output, "w") as archive:
        add_folder(archive, pathlib.Path(addon), "contrejour_flare")
        add_folder(archive, pathlib.Path(package), "contrejour_flare/lib/contrejour")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
