"""The wheel: the Python package with the programs and their data, built by CMake.

ROPEWALK_BUILD names a build folder whose files are taken as they are; without it, all is built in build/wheel.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


class BuildByCMake(build_ext):
    def run(self):
        given = os.environ.get("ROPEWALK_BUILD")
        build = pathlib.Path(given or ROOT / "build" / "wheel").resolve()
        if not given:
            subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                            "-DROPEWALK_TESTS=OFF", "-DROPEWALK_LAMMPS=OFF", "-DROPEWALK_PYTHON=ON",
                            f"-DPython3_EXECUTABLE={sys.executable}"], check=True)
            subprocess.run(["cmake", "--build", build, "--parallel", str(os.cpu_count())], check=True)
        package = (ROOT / "mdem" / "python" if self.inplace else pathlib.Path(self.build_lib)) / "ropewalk"
        package.mkdir(parents=True, exist_ok=True)
        modules = list((build / "mdem" / "python" / "ropewalk").glob("_core*.so"))
        if not modules:
            sys.exit(f"{build} holds no Python module: build it with -DROPEWALK_PYTHON=ON")
        shutil.copy2(modules[0], package)
        programs = package / "bin"
        programs.mkdir(exist_ok=True)
        for program in ("mdem/ropewalk", "calibrate/ropewalk-calibrate", "validate/ropewalk-validate"):
            if (build / program).exists():
                shutil.copy2(build / program, programs)
        shutil.copytree(ROOT / "data", package / "share" / "ropewalk", dirs_exist_ok=True)


version = re.search(r"project\(ropewalk VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
work = ROOT / "build" / "wheel-files"
shutil.rmtree(work, ignore_errors=True)  # what an earlier version left
work.mkdir(parents=True)
setup(
    version=version,
    ext_modules=[Extension("ropewalk._core", sources=[])],
    cmdclass={"build_ext": BuildByCMake},
    options={"egg_info": {"egg_base": str(work)}, "build": {"build_base": str(work)}},
)
