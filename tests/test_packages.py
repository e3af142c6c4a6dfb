"""Emitted C in the hands of CMake and Arduino: really built, installed, found and compiled."""

from __future__ import annotations

import re
import subprocess
from typing import TYPE_CHECKING

import codegen_samples as samples
import pytest
import targets

import codegen
from codegen import Options
from linegraph.errors import ModelError
from linegraph.files import write_all

if TYPE_CHECKING:
    from pathlib import Path

USER = """
#include <stdio.h>
#include <model.h>

int main(void)
{
    double q[MODEL_NQ] = {0.1, 0.2};
    double M[MODEL_NV * MODEL_NV];
    model_mass_matrix(&model_default_parameters, q, M);
    printf("%.17g\\n", M[0]);
    return 0;
}
"""

BY_FOLDER = "add_subdirectory(model)"
BY_PACKAGE = "find_package(model REQUIRED)"

STUB = """
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
static unsigned long micros(void) { return 0; }
static void delay(int time) { exit(time == 1000 ? 0 : 1); }
struct Port {
    void begin(long) {}
    void print(double x, int digits) { printf("%.*f", digits, x); }
    void print(const char *text) { printf("%s", text); }
    void print(int number) { printf("%d", number); }
    void print(unsigned long number) { printf("%lu", number); }
    void println(const char *text) { printf("%s\\n", text); }
    void println(int number) { printf("%d\\n", number); }
};
static Port Serial;
"""


def project(folder: Path, how: str) -> None:
    """A user's project that takes the library up in one of two ways."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "main.c").write_text(USER)
    (folder / "CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.13)\nproject(user C)\n{how}\nadd_executable(user main.c)\n"
        "target_link_libraries(user PRIVATE model::model)\n"
    )


@pytest.mark.parametrize("shared", ["OFF", "ON"])
def test_cmake_builds_installs_and_finds(shared: str, tmp_path: Path) -> None:
    lacking = targets.missing("cmake", "cc", "make")
    if lacking:
        pytest.skip(lacking)
    files = codegen.render(targets.module("double_pendulum"), "c", Options(cmake=True))
    assert list(files) == ["model.h", "model.c", "CMakeLists.txt"]
    write_all(tmp_path / "user" / "model", files)
    values = set()
    for how in (BY_FOLDER, BY_PACKAGE):
        build = f"build_{how[:3]}"
        if how == BY_PACKAGE:
            place = f"-DCMAKE_INSTALL_PREFIX={tmp_path / 'prefix'}"
            targets.run(
                ["cmake", "-S", "user/model", "-B", "own", place, f"-DBUILD_SHARED_LIBS={shared}"],
                tmp_path,
            )
            targets.run(["cmake", "--build", "own"], tmp_path)
            targets.run(["cmake", "--install", "own"], tmp_path)
            (tmp_path / "user" / "model").rename(tmp_path / "gone")
        project(tmp_path / "user", how)
        found = f"-DCMAKE_PREFIX_PATH={tmp_path / 'prefix'}"
        targets.run(["cmake", "-S", "user", "-B", build, found], tmp_path)
        targets.run(["cmake", "--build", build], tmp_path)
        values.add(targets.run([f"./{build}/user"], tmp_path))
    assert len(values) == 1
    assert float(values.pop()) > 0


@pytest.mark.parametrize("name", ["test", "install", "m"])
def test_a_target_of_cmake_is_refused(name: str) -> None:
    from dataclasses import replace

    module = replace(samples.arm(), name=name)
    with pytest.raises(ModelError, match="target of CMake's own"):
        codegen.render(module, "c", Options(cmake=True))


@pytest.mark.parametrize(
    "name", ["double_pendulum", "anymal_floating", "four_bar", "ring_modulator"]
)
def test_arduino_library_is_laid_out_as_specified(name: str) -> None:
    files = codegen.render(targets.module(name), "c", Options(arduino=True, real="float"))
    assert set(files) == {
        "model/library.properties",
        "model/keywords.txt",
        "model/src/model.h",
        "model/src/model.c",
        "model/examples/model/model.ino",
    }
    fields = dict(line.split("=", 1) for line in files["model/library.properties"].splitlines())
    required = "name version author maintainer sentence paragraph category url architectures"
    assert set(required.split()) <= set(fields)
    assert all(fields.values())
    assert re.fullmatch(r"[a-zA-Z0-9][\w .-]{0,62}", fields["name"], re.ASCII)
    assert re.fullmatch(r"\d+\.\d+\.\d+", fields["version"])
    assert fields["category"] in {
        *("Display", "Communication", "Signal Input/Output", "Sensors", "Device Control", "Timing"),
        *("Data Storage", "Data Processing", "Other"),
    }
    assert re.match(r"https?://", fields["url"])
    assert f"model/src/{fields['includes']}" in files
    words = [
        line.split("\t") for line in files["model/keywords.txt"].splitlines() if line[0] != "#"
    ]
    assert all(len(word) == 2 for word in words)
    assert {kind for _, kind in words} <= {"KEYWORD1", "KEYWORD2", "LITERAL1"}
    text = files["model/src/model.h"]
    assert all(re.search(rf"\b{word}\b", text) for word, _ in words)


@pytest.mark.parametrize("real", ["double", "float"])
@pytest.mark.parametrize(
    "name", ["double_pendulum", "anymal_floating", "four_bar", "ring_modulator"]
)
def test_arduino_example_compiles_and_runs(name: str, real: str, tmp_path: Path) -> None:
    """As the IDE does: the sketch is C++, with Arduino.h before it and the library's folder searched."""
    lacking = targets.missing("gcc", "g++")
    if lacking:
        pytest.skip(lacking)
    write_all(tmp_path, codegen.render(targets.module(name), "c", Options(arduino=True, real=real)))
    library = tmp_path / "model"
    (tmp_path / "Arduino.h").write_text(STUB)
    sketch = library / "examples" / "model" / "model.ino"
    (tmp_path / "sketch.cpp").write_text(
        f'#include "Arduino.h"\n{sketch.read_text()}\nint main() {{ setup(); for (;;) {{ loop(); }} }}\n'
    )
    targets.run(["gcc", "-std=gnu11", "-c", "model/src/model.c", "-o", "model.o"], tmp_path)
    command = ["g++", "-std=gnu++11", "-Wall", "-Wextra", "-Wno-unused-function", "-Werror"]
    targets.run(
        [*command, "-I", "model/src", "sketch.cpp", "model.o", "-lm", "-o", "sketch"], tmp_path
    )
    done = subprocess.run(["./sketch"], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.endswith("0 us\n")
    rows = done.stdout.splitlines()[:-1]
    assert rows
    assert "status" in done.stdout or all(re.fullmatch(r"[-\d. ]+", row) for row in rows)


def test_one_layout_at_a_time() -> None:
    with pytest.raises(ModelError, match="another folder"):
        Options(cmake=True, arduino=True)
    from dataclasses import replace

    with pytest.raises(ModelError, match="63 characters"):
        codegen.render(replace(samples.arm(), name="a" * 64), "c", Options(arduino=True))
