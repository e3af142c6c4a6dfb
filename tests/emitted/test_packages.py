"""Emitted C in the hands of CMake and Arduino: really built, installed, found and compiled."""

from __future__ import annotations

import re
import subprocess
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest
from support import codegen_samples as samples
from support import targets

import codegen
from codegen import Options
from linegraph.emission.emit import module_for
from linegraph.errors import ModelError, NameRefused
from linegraph.files import write_all
from linegraph.ir.program import Quantity

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
BY_PACKAGE = "find_package(model 1.0 REQUIRED)"

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
        asked = f"-DMODEL_INSTALL={shared}"
        targets.run(["cmake", "-S", "user", "-B", build, found, asked], tmp_path)
        if how == BY_FOLDER:
            rules = (tmp_path / build / "model" / "cmake_install.cmake").read_text()
            assert ("model.h" in rules) == (shared == "ON")
        targets.run(["cmake", "--build", build], tmp_path)
        values.add(targets.run([f"./{build}/user"], tmp_path))
    assert len(values) == 1
    assert float(values.pop()) > 0


@pytest.mark.parametrize("where", ["here", "here, unwanted", "on bare metal"])
def test_cmake_makes_position_independent_code_where_it_is_of_use(
    where: str, tmp_path: Path
) -> None:
    bare_metal = where == "on bare metal"
    lacking = targets.missing("cmake", "make", "arm-none-eabi-gcc" if bare_metal else "cc")
    if lacking:
        pytest.skip(lacking)
    write_all(tmp_path, codegen.render(samples.arm(), "c", Options(cmake=True)))
    command = ["cmake", "-S", ".", "-B", "build", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON"]
    if bare_metal:
        command += ["-DCMAKE_SYSTEM_NAME=Generic", "-DCMAKE_C_COMPILER=arm-none-eabi-gcc"]
        command += ["-DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY"]
    if where == "here, unwanted":
        command.append("-DCMAKE_POSITION_INDEPENDENT_CODE=OFF")
    targets.run(command, tmp_path)
    said = (tmp_path / "build" / "compile_commands.json").read_text()
    assert "arm.c" in said
    assert ("-fPIC" in said) == (where == "here")


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        *((name, "target of CMake's own") for name in ("test", "install", "m", "PACKAGE")),
        *((name, "capitals alone") for name in ("EXPORT", "TARGETS", "FILE", "ALIAS", "STATIC")),
    ],
)
def test_a_word_of_cmake_is_refused(name: str, problem: str) -> None:
    module = replace(samples.arm(), name=name)
    with pytest.raises(ModelError, match=f'name "{name}": .*{problem}'):
        codegen.render(module, "c", Options(cmake=True))
    assert f"{name}.h" in codegen.render(module, "c")


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


@pytest.mark.one_in(3)
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


def test_the_sketch_times_a_call_that_is_made(tmp_path: Path) -> None:
    """With optimisation at link time, too, the function is there as it is, for any arguments."""
    lacking = targets.missing("gcc", "g++", "nm")
    if lacking:
        pytest.skip(lacking)
    module = targets.module("double_pendulum")
    write_all(tmp_path, codegen.render(module, "c", Options(arduino=True)))
    sketch = (tmp_path / "model" / "examples" / "model" / "model.ino").read_text()
    main = "int main() { setup(); for (;;) { loop(); } }"
    (tmp_path / "sketch.cpp").write_text(f"{STUB}\n{sketch}\n{main}\n")
    flags = ["-O3", "-flto", "-fwhole-program", "-I", "model/src"]
    targets.run(["gcc", *flags[:2], "-c", "model/src/model.c", "-o", "model.o"], tmp_path)
    targets.run(["g++", *flags, "sketch.cpp", "model.o", "-lm", "-o", "sketch"], tmp_path)
    symbols = targets.run(["nm", "sketch"], tmp_path).split()
    assert "model_forward_dynamics" in symbols


def test_the_sketch_calls_what_is_asked_for() -> None:
    model = targets.everything()["double_pendulum"]()
    module = module_for(model, "model", only=("bias",))
    assert [x.name for x in module.programs] == ["prepare", "bias", "bias_prepared"]
    files = codegen.render(module, "c", Options(arduino=True))
    assert "called = &model_bias;" in files["model/examples/model/model.ino"]


def test_the_sketch_begins_at_rest() -> None:
    """Only the last number of a quaternion is 1, whatever joints are called."""
    names = ("elbow_qw", "ball_qx", "ball_qy", "ball_qz", "ball_qw", "qw")
    units = ("rad", "1", "1", "1", "1", "rad")
    positions = tuple(map(Quantity, names, units))
    programs = targets.module("double_pendulum").programs
    called = next(x for x in programs if x.name == "mass_matrix")
    arguments = tuple(replace(x, size=6) if x.name == "q" else x for x in called.arguments)
    module = replace(
        targets.module("double_pendulum"),
        positions=positions,
        programs=(replace(called, arguments=arguments, handed="", calls=()),),
    )
    files = codegen.render(module, "c", Options(arduino=True))
    assert "q[MODEL_NQ] = {0, 0, 0, 0, 1, 0};" in files["model/examples/model/model.ino"]


MACROS = """
    B0 B1 B01 B11111111 PI TWO_PI HALF_PI DEG_TO_RAD RAD_TO_DEG EULER HIGH LOW INPUT OUTPUT
    INPUT_PULLUP DEFAULT INTERNAL EXTERNAL A0 A7 A15 LSBFIRST MSBFIRST CHANGE FALLING RISING SERIAL
    DISPLAY NOT_A_PIN SP SREG PORTB DDRB PB5 ADC TCNT1 OCR0A UDR0 CS00 F_CPU LED_BUILTIN DT1AH0
"""


def test_macros_of_arduino_are_refused() -> None:
    def made(name: str, options: Options) -> dict[str, str]:
        module = replace(samples.constant(), parameters=(Quantity(name, "", "", 1.0),))
        return codegen.render(module, "c", options)

    for name in MACROS.split():
        with pytest.raises(NameRefused, match=rf"parameter '{name}' .*rename it; x_{name} would"):
            made(name, Options(arduino=True))
        assert made(name, Options())
        assert made(f"x_{name}", Options(arduino=True))
    for name in ("B", "A", "J", "M1", "R12", "C2", "RA", "KT", "Ixx", "A16", "B2", "k_P", "Low"):
        assert made(name, Options(arduino=True))


@pytest.mark.parametrize("name", ["Arduino", "Servo", "Wire", "SPI", "EEPROM", "servo", "Stream"])
def test_headers_of_arduino_are_not_hidden(name: str) -> None:
    module = replace(samples.arm(), name=name)
    with pytest.raises(ModelError, match=f'name "{name}": would hide a header of Arduino'):
        codegen.render(module, "c", Options(arduino=True))


@pytest.mark.parametrize(("real", "size", "right"), [("double", 4, False), ("float", 4, True)])
def test_doubles_of_four_bytes_are_refused(
    real: str, size: int, right: bool, tmp_path: Path
) -> None:
    lacking = targets.missing("gcc")
    if lacking:
        pytest.skip(lacking)
    write_all(tmp_path, codegen.render(samples.arm(), "c", Options(real=real)))
    flags = ["-U__SIZEOF_DOUBLE__", f"-D__SIZEOF_DOUBLE__={size}", "-w", "-fsyntax-only"]
    done = subprocess.run(
        ["gcc", *flags, "arm.c"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert (done.returncode == 0) == right, done.stderr
    assert right or "double has 4 bytes here: emit with --real float" in done.stderr


def test_one_layout_at_a_time() -> None:
    with pytest.raises(ModelError, match="another folder"):
        Options(cmake=True, arduino=True)
    with pytest.raises(ModelError, match="63 characters"):
        codegen.render(replace(samples.arm(), name="a" * 64), "c", Options(arduino=True))
