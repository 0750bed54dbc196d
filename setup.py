"""Builds the shared library by CMake and puts it into the Python package. DETP_LIBRARY may name one that is built already."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py
from wheel.bdist_wheel import bdist_wheel

root = Path(__file__).parent
python = root / "validate" / "python"
scratch = root / "build" / "python-package"


def version() -> str:
    found = re.search(r"project\(detp VERSION ([0-9.]+)", (root / "CMakeLists.txt").read_text(encoding="utf-8"))
    if found is None:
        raise SystemExit("CMakeLists.txt has no version")
    return found[1]


def library() -> Path:
    given = os.environ.get("DETP_LIBRARY")
    if given:
        return Path(given)
    subprocess.run(["cmake", "--preset", "release"], cwd=root, check=True)
    subprocess.run(["cmake", "--build", "build", "--target", "detp_c"], cwd=root, check=True)
    return root / "build" / "validate" / "libdetp.so.0"


class BuildWithLibrary(build_py):
    def run(self) -> None:
        super().run()
        package = Path(self.build_lib) / "detp"
        subprocess.run([sys.executable, python / "declarations.py", root / "validate" / "c" / "detp.h", package], check=True)
        shutil.copyfile(library(), package / "libdetp.so.0")


class WheelForAnyPython(bdist_wheel):
    """The package has a library of this machine, but nothing that depends on the version of Python."""

    def finalize_options(self) -> None:
        super().finalize_options()
        self.root_is_pure = False

    def get_tag(self) -> tuple:
        return ("py3", "none", super().get_tag()[2])


scratch.mkdir(parents=True, exist_ok=True)
setup(
    version=version(),
    packages=["detp"],
    package_dir={"": "validate/python"},
    package_data={"detp": ["py.typed"]},
    cmdclass={"build_py": BuildWithLibrary, "bdist_wheel": WheelForAnyPython},
    options={"build": {"build_base": str(scratch)}, "egg_info": {"egg_base": str(scratch)}},
)
