"""Where the peers live: a virtual environment and compiled programs of their own, under `build/peers`.

Only the standard library is imported here: this runs before anything is installed.
"""

from __future__ import annotations

import hashlib
import os
import platform
import shutil
import subprocess
import sys
import venv
from importlib import metadata
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
BUILD = ROOT / "build" / "peers"
VENV = BUILD / "venv"
PACKAGES = (
    "casadi",
    "cmeel-urdfdom-headers",  # what the headers of pin include, and pin does not bring
    "example-robot-data",
    "matplotlib",
    "mujoco",
    "pin",
    "sympy",
)
VERSIONS = ("casadi", "pin", "mujoco", "sympy", "numpy", "example-robot-data")
OPTIMISED = ("gcc", "-std=c99", "-O3", "-march=native")
VALGRIND = ("-mno-avx512f",)
"""Added where instructions are counted: valgrind knows no AVX-512."""


def enter(script: Path = HERE) -> None:
    """Go on as the interpreter of the virtual environment; make it first if need be."""
    python = VENV / "bin" / "python"
    if Path(sys.prefix).resolve() == VENV.resolve():
        return
    for tool in ("gcc", "g++"):
        if shutil.which(tool) is None:
            raise SystemExit(f"the benchmark compiles what it times, and finds no {tool}")
    wanted = "\n".join((*PACKAGES, (ROOT / "pyproject.toml").read_text()))
    mark = VENV / "installed"
    if not mark.exists() or mark.read_text() != wanted:
        say(f"installing {', '.join(PACKAGES)} in {VENV.relative_to(ROOT)}")
        venv.create(VENV, with_pip=True, clear=True)
        install = [str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        subprocess.run([*install, *PACKAGES, "--editable", str(ROOT)], check=True)
        mark.write_text(wanted)
    os.environ["OMP_NUM_THREADS"] = "1"
    os.execv(python, [str(python), str(script), *sys.argv[1:]])


def say(text: str) -> None:
    """Tell what is going on, apart from the tables."""
    print(text, file=sys.stderr, flush=True)


def site_packages() -> Path:
    """Of the virtual environment."""
    found = next((VENV / "lib").glob("python*")) / "site-packages"
    return found


def built(target: str, command: list[str], sources: list[Path]) -> Path:
    """A compiled file, made anew where command, sources or versions have changed."""
    state = [*command, *(f"{name} {metadata.version(name)}" for name in VERSIONS)]
    state += [source.read_text() for source in sources]
    digest = hashlib.sha256("\n".join(state).encode()).hexdigest()
    path, mark = BUILD / target, BUILD / f"{target}.sha256"
    if not path.exists() or not mark.exists() or mark.read_text() != digest:
        say(f"compiling {target}")
        run([*command, *map(str, sources), "-o", str(path), *_libraries(target)])
        mark.write_text(digest)
    return path


def run(command: list[str], folder: Path | None = None) -> str:
    """What a command prints; what it complains of ends the benchmark."""
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder)
    if done.returncode:
        raise SystemExit(f"failed: {' '.join(command)}\n{done.stderr[-4000:]}")
    return done.stdout


def harness() -> Path:
    """The program that times, counts and measures processes."""
    return built("harness", ["gcc", "-std=c11", "-O2"], [HERE / "harness.c"])


def casadi_generator() -> Path:
    """Pinocchio's algorithms over CasADi's symbols; takes minutes to compile, once."""
    return built("casadi_generator", [*_cxx(), "-O2"], [HERE / "casadi_generator.cpp"])


def pinocchio_library(extra: tuple[str, ...] = ()) -> Path:
    """Pinocchio's algorithms over doubles, all of them from its headers."""
    command = [*_cxx(), "-O3", "-march=native", *extra, "-fPIC", "-shared"]
    return built(f"pinocchio{''.join(extra)}.so", command, [HERE / "pinocchio_calls.cpp"])


def mujoco_library() -> Path:
    """MuJoCo's stages; the library itself is the wheel's."""
    command = ["gcc", "-std=c11", "-O3", f"-I{site_packages() / 'mujoco' / 'include'}"]
    return built("mujoco.so", [*command, "-fPIC", "-shared"], [HERE / "mujoco_calls.c"])


def _cxx() -> list[str]:
    site = site_packages()
    include = site / "cmeel.prefix" / "include"
    folders = (
        site / "casadi" / "include",
        site / "casadi" / "include" / "eigen3",
        include,
        include / "urdfdom_headers",
    )
    # what Pinocchio's own build tells its users to define
    limits = (
        "BOOST_MPL_LIMIT_LIST_SIZE=30",
        "BOOST_MPL_LIMIT_VECTOR_SIZE=30",
        "BOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
        "BOOST_FUSION_INVOKE_MAX_ARITY=12",
        "PINOCCHIO_WITH_URDFDOM",
        "NDEBUG",
    )
    command = ["g++", "-std=c++17", "-w", *(f"-I{folder}" for folder in folders)]
    return [*command, *(f"-D{limit}" for limit in limits)]


def _libraries(target: str) -> list[str]:
    site = site_packages()
    cmeel = site / "cmeel.prefix" / "lib"
    here = [f"-L{cmeel}", f"-Wl,-rpath,{cmeel}"]
    parsers = ["-lpinocchio_parsers", "-lpinocchio_default"]
    if target == "harness":
        return ["-ldl"]
    if target == "mujoco.so":
        library = next((site / "mujoco").glob("libmujoco.so*"))
        return [str(library), f"-Wl,-rpath,{library.parent}"]
    if target == "casadi_generator":
        library = next((site / "casadi").glob("libcasadi.so.*"))
        return [str(library), f"-Wl,-rpath,{library.parent}", *here, *parsers]
    return [*here, "-lboost_serialization"]


def described() -> dict[str, str]:
    """The machine, the compiler and the versions of the peers."""
    found = {"processor": _processor(), "system": platform.platform()}
    found["compiler"] = run(["gcc", "--version"]).splitlines()[0]
    found["flags"] = " ".join(OPTIMISED[2:])
    found["python"] = platform.python_version()
    found["linegraph"] = metadata.version("linegraph-dynamics")
    if shutil.which("git") and (ROOT / ".git").exists():
        commit = subprocess.run(
            ["git", "-C", str(ROOT), "describe", "--always", "--dirty"],
            capture_output=True,
            text=True,
            check=False,
        )
        found["commit"] = commit.stdout.strip()
    return found | {name: metadata.version(name) for name in VERSIONS}


def _processor() -> str:
    information = Path("/proc/cpuinfo")
    lines = information.read_text().splitlines() if information.exists() else []
    named = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return named[0] if named else platform.processor()
