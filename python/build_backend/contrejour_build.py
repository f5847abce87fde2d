# SPDX-License-Identifier: Apache-2.0
"""The PEP 517 backend of pyproject.toml: builds the package with CMake, and packs what `cmake --install` gives as a wheel.

Settings (`pip install --config-settings NAME=VALUE`): build-dir, the build folder (default: build/wheel); one that is
configured already is used as it is. jobs: compilers at a time.
"""
import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAME = "contrejour"


def _version():
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(contrejour VERSION (\S+)", text).group(1)


def _metadata():
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    return (
        f"Metadata-Version: 2.1\nName: {NAME}\nVersion: {_version()}\nSummary: Physically based lens flare\n"
        "License: Apache-2.0\nRequires-Python: >=3.9\nRequires-Dist: numpy\n"
        f"Description-Content-Type: text/markdown\n\n{readme}"
    )


def _tag():
    version = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = re.sub(r"[-.]", "_", sysconfig.get_platform())
    return f"{version}-{version}-{platform}"


def _run(*command):
    print(" ".join(map(str, command)), flush=True)
    try:
        subprocess.run(list(map(str, command)), cwd=ROOT, check=True)
    except FileNotFoundError:
        raise SystemExit("contrejour is built with CMake, which is not here: install cmake, ninja-build and g++") from None
    except subprocess.CalledProcessError as failed:
        raise SystemExit(f"{command[0]} failed ({failed.returncode}); its message is above, and ./dev python installs "
                         "what a build needs") from None


def _built(folder, jobs):
    """The module that CMake built in this folder, for this Python."""
    if not (folder / "CMakeCache.txt").is_file():
        _run("cmake", "-S", ROOT, "-B", folder, "-DCMAKE_BUILD_TYPE=Release", "-DCONTREJOUR_PYTHON=ON",
             "-DCONTREJOUR_TESTS=OFF", "-DCONTREJOUR_OPENFX=OFF", f"-DPython3_EXECUTABLE={sys.executable}")
    _run("cmake", "--build", folder, "--target", "contrejour_python", "--parallel", jobs)
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    module = folder / "python" / NAME / f"_native{suffix}"
    if not module.is_file():
        raise SystemExit(f"{folder} is the build folder of another Python: it has no _native{suffix}; name another one "
                         "with --config-settings build-dir=FOLDER")


class _Wheel:
    """A wheel that is being written."""

    def __init__(self, file):
        self._zip = zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED)
        self._record = []

    def add(self, name, data):
        self._zip.writestr(zipfile.ZipInfo(name), data, zipfile.ZIP_DEFLATED)
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        self._record.append(f"{name},sha256={digest},{len(data)}\n")

    def close(self, record):
        self._record.append(f"{record},,\n")
        self._zip.writestr(zipfile.ZipInfo(record), "".join(self._record))
        self._zip.close()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    settings = config_settings or {}
    folder = ROOT / settings.get("build-dir", "build/wheel")
    _built(folder, settings.get("jobs", os.cpu_count() or 1))
    file = f"{NAME}-{_version()}-{_tag()}.whl"
    information = f"{NAME}-{_version()}.dist-info"
    with tempfile.TemporaryDirectory() as prefix:
        _run("cmake", "--install", folder, "--component", "python", "--prefix", prefix)
        package = next(pathlib.Path(prefix).rglob(f"{NAME}/__init__.py")).parent
        wheel = _Wheel(pathlib.Path(wheel_directory, file))
        for path in sorted(package.iterdir()):
            wheel.add(f"{NAME}/{path.name}", path.read_bytes())
    wheel.add(f"{information}/METADATA", _metadata().encode())
    wheel.add(f"{information}/WHEEL",
              f"Wheel-Version: 1.0\nGenerator: contrejour\nRoot-Is-Purelib: false\nTag: {_tag()}\n".encode())
    wheel.add(f"{information}/licenses/LICENSE", (ROOT / "LICENSE").read_bytes())
    wheel.close(f"{information}/RECORD")
    return file


def build_sdist(sdist_directory, config_settings=None):
    raise SystemExit("there is no source archive of contrejour for pip; install from a clone: pip install .")
