# SPDX-License-Identifier: Apache-2.0
"""Builds the wheel of the Python package with CMake: a PEP 517 build backend that needs nothing but Python.

A backend of our own because Debian 12 has no scikit-build-core, and because setuptools would have to be bent around
CMake in more lines than these.

Settings (`pip install . --config-settings KEY=VALUE`):
  build-dir    a CMake build folder to build in and to keep; else a temporary one
  cmake-args   further arguments of cmake, separated by blanks
  libraries    "bundle": a wheel for other systems, which holds the libraries that the module needs (but glibc and
               libstdc++, which must be at least as new there) and, where `./dev models` fetched them, the detector's
               networks
"""
import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAME = "bodyloom"


def version():
    return re.search(r"^project\(bodyloom VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"), re.M)[1]


def project():
    """Keys of [project] in this wheel's metadata; parsed by hand, as Python has tomllib only from 3.11 on."""
    table = (ROOT / "pyproject.toml").read_text(encoding="utf-8").split("[project]")[1].split("\n[")[0]
    return dict(re.findall(r'^([\w-]+) = "(.*)"$', table, re.M)), re.findall(r'"([^"]+ :: [^"]+)"', table)


def metadata():
    keys, classifiers = project()
    lines = ["Metadata-Version: 2.1", f"Name: {NAME}", f"Version: {version()}", f"Summary: {keys['description']}",
             "License: Apache-2.0", f"Requires-Python: {keys['requires-python']}", "Requires-Dist: numpy"]
    lines += [f"Classifier: {classifier}" for classifier in classifiers]
    readme = (ROOT / keys["readme"]).read_text(encoding="utf-8")
    return "\n".join(lines) + "\nDescription-Content-Type: text/markdown\n\n" + readme


def tag(bundled):
    interpreter = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = re.sub("[-.]", "_", sysconfig.get_platform())
    if bundled:  # PEP 600: any Linux whose glibc is as new as this one.
        glibc = os.confstr("CS_GNU_LIBC_VERSION").split()[1].replace(".", "_")
        platform = platform.replace("linux", f"manylinux_{glibc}", 1)
    return f"{interpreter}-{interpreter}-{platform}"


def run(*words):
    # What CMake and the compiler say goes to stderr, where pip looks for it when something fails.
    subprocess.run(list(map(str, words)), check=True, stdout=sys.stderr)


def build(build_dir, stage, arguments):
    """Files of the package below `stage`."""
    cache = build_dir / "CMakeCache.txt"
    if not cache.exists():
        generator = ["-G", "Ninja"] if sysconfig.os.name == "posix" and has_program("ninja") else []
        run("cmake", "-S", ROOT, "-B", build_dir, *generator, "-D", "CMAKE_BUILD_TYPE=Release", "-D", "CMAKE_UNITY_BUILD=ON",
            "-D", "BODYLOOM_WITH_TORCH=OFF", "-D", "BODYLOOM_BUILD_APPS=OFF", "-D", "BODYLOOM_BUILD_TESTS=OFF",
            "-D", "BODYLOOM_BUILD_BENCHMARKS=OFF", "-D", "BODYLOOM_BUILD_EXAMPLES=OFF",
            "-D", f"Python_EXECUTABLE={sys.executable}", *arguments)
    jobs = os.environ.get("BODYLOOM_JOBS") or str(os.cpu_count())
    run("cmake", "--build", build_dir, "--target", "bodyloom_python", "-j", jobs)
    run("cmake", "--install", build_dir, "--component", "python", "--strip", "--prefix", stage)


def bundle(package):
    """Puts into the package's folder, and beside it, what the module needs; returns the packages, a line each."""
    sys.path.insert(0, str(ROOT / "cmake"))
    import bundle_libraries
    module = next(package.glob("_bodyloom*.so"))
    packages = bundle_libraries.bundle(module, package.parent / f"{NAME}.libs", bundle_libraries.COMPILER, unique_names=True)
    listed = (ROOT / "cmake" / "models.txt").read_text(encoding="utf-8")
    for name in re.findall(r"^file +(\S+)", listed, re.M):
        if (ROOT / "build" / "models" / name).is_file():
            (package / "models").mkdir(exist_ok=True)
            shutil.copy(ROOT / "build" / "models" / name, package / "models")
    return packages


def has_program(name):
    return any(os.access(pathlib.Path(folder, name), os.X_OK) for folder in os.get_exec_path())


def record_line(name, data):
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(data)}\n"


# --- the functions that PEP 517 names ----------------------------------------------------------------------------------
def get_requires_for_build_wheel(config_settings=None):
    return []


def get_requires_for_build_sdist(config_settings=None):
    return []


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    settings = config_settings or {}
    libraries = settings.get("libraries", "")
    if libraries not in ("", "bundle"):
        raise ValueError(f'libraries={libraries}: expected "bundle" or nothing')
    info = f"{NAME}-{version()}.dist-info"
    name = f"{NAME}-{version()}-{tag(libraries)}.whl"
    with tempfile.TemporaryDirectory() as scratch:
        stage = pathlib.Path(scratch, "stage")
        build_dir = pathlib.Path(settings.get("build-dir") or pathlib.Path(scratch, "build")).resolve()
        build(build_dir, stage, settings.get("cmake-args", "").split())
        package = next(stage.rglob(NAME))
        packages = bundle(package) if libraries else []
        folders = [package, package.parent / f"{NAME}.libs"]
        files = {str(path.relative_to(package.parent)): path.read_bytes() for folder in folders
                 for path in sorted(folder.rglob("*")) if path.is_file()}
    if packages:
        files[f"{info}/libraries.txt"] = ("\n".join(packages) + "\n").encode()
    files[f"{info}/METADATA"] = metadata().encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: {NAME}\nRoot-Is-Purelib: false\nTag: {tag(libraries)}\n".encode()
    files[f"{info}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    files[f"{info}/RECORD"] = ("".join(record_line(file, data) for file, data in files.items()) + f"{info}/RECORD,,\n").encode()
    unfinished = pathlib.Path(wheel_directory, name + ".part")
    with zipfile.ZipFile(unfinished, "w", zipfile.ZIP_DEFLATED) as wheel:
        for file, data in files.items():
            wheel.writestr(zipfile.ZipInfo(file, (2020, 1, 1, 0, 0, 0)), data, zipfile.ZIP_DEFLATED)
    unfinished.rename(pathlib.Path(wheel_directory, name))
    return name


def build_sdist(sdist_directory, config_settings=None):
    """Builds the source distribution from the files that git tracks."""
    name = f"{NAME}-{version()}"
    subprocess.run(["git", "-C", str(ROOT), "archive", "--format=tar.gz", f"--prefix={name}/", "-o",
                    str(pathlib.Path(sdist_directory, name + ".tar.gz").resolve()), "HEAD"], check=True)
    return name + ".tar.gz"
