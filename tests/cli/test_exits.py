"""How the process ends and where its output goes: real processes, devices, pipes and signals."""

from __future__ import annotations

import os
import signal
import stat
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from support.modelfile_text import SMALL

from linegraph import LinegraphError
from linegraph.errors import DeviceFailed
from linegraph.exits import BROKEN, INTERRUPTED, IO_FAILED, WRONG
from linegraph.files import STAGED, is_stream, write_all, write_file

ROOT = Path(__file__).parents[2]
MODULE = [sys.executable, "-m", "linegraph"]
SCRIPT = [sys.executable, "-c", "from linegraph.__main__ import main; main()"]
"""What the console script does."""

pytestmark = pytest.mark.skipif(os.name != "posix", reason="devices, FIFOs and signals of POSIX")

FULL = pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")


@pytest.fixture
def model(tmp_path: Path) -> Path:
    path = tmp_path / "small.toml"
    path.write_text(SMALL, encoding="utf-8")
    return path


def run(
    *arguments: object,
    command: list[str] = MODULE,
    path: Path | None = None,
    stdout: int | None = subprocess.PIPE,
    cwd: Path = ROOT,
) -> subprocess.CompletedProcess[str]:
    """A process; modules in `path` come before all others."""
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join([*([str(path)] if path else []), str(ROOT)]),
    }
    return subprocess.run(
        [*command, *map(str, arguments)],
        cwd=cwd,
        env=environment,
        stdout=stdout,
        stderr=subprocess.PIPE,
        text=True,
        timeout=60,
        check=False,
    )


def shadowing(folder: Path, module: str, line: str) -> Path:
    """A folder with a module that runs a line when it is imported, in place of the real one."""
    folder.mkdir()
    (folder / f"{module}.py").write_text(f"import os, signal, time\n{line}\n", encoding="utf-8")
    return folder


# ---- interrupts


@pytest.mark.parametrize(
    ("command", "module"),
    [(MODULE, "click"), (SCRIPT, "click"), (MODULE, "jinja2"), (SCRIPT, "lxml"), (MODULE, "sympy")],
)
def test_an_interrupt_during_imports_is_no_failed_check(
    command: list[str], module: str, model: Path, tmp_path: Path
) -> None:
    """Ctrl-C reaches Python inside an import: of the command line itself, or of what a command needs."""
    urdf = ROOT / "examples" / "panda" / "panda.urdf"
    path = shadowing(
        tmp_path / "first", module, "os.kill(os.getpid(), signal.SIGINT); time.sleep(5)"
    )
    source = urdf if module == "lxml" else model
    action = ("derive",) if module == "sympy" else ("emit", "--out", tmp_path / "out")
    done = run(*action, source, command=command, path=path)
    assert done.returncode == INTERRUPTED == 130
    assert "Traceback" not in done.stderr
    assert done.stdout == ""


def test_an_interrupt_at_any_time_leaves_no_traceback(model: Path, tmp_path: Path) -> None:
    """A signal from outside, after different times; a process that is not yet Python's dies of it."""
    ended = set()
    for delay in (0.15, 0.3, 0.45, 0.6):
        process = subprocess.Popen(
            [*MODULE, "derive", "examples/stewart_platform/stewart_platform.toml"],
            cwd=ROOT,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        time.sleep(delay)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        if "linegraph" in errors or "Traceback" not in errors:
            assert "Traceback" not in errors
            ended.add(process.returncode)
    assert ended <= {INTERRUPTED, -signal.SIGINT}
    assert INTERRUPTED in ended


def test_an_error_of_the_program_is_no_failed_check(model: Path, tmp_path: Path) -> None:
    path = shadowing(tmp_path / "first", "jinja2", "raise RuntimeError('a bug')")
    done = run("emit", model, "--out", tmp_path / "out", path=path)
    assert done.returncode == BROKEN == 70
    assert "RuntimeError: a bug" in done.stderr
    assert "please report" in done.stderr


# ---- output that cannot be written


@FULL
@pytest.mark.parametrize(
    "arguments",
    [("show",), ("derive",), ("graph",), ("check",), ("trees",), ("emit", "--out", "OUT")],
)
def test_a_full_device_is_no_failed_check(
    arguments: tuple[str, ...], model: Path, tmp_path: Path
) -> None:
    command = SCRIPT if arguments == ("show",) else MODULE
    given = [a.replace("OUT", str(tmp_path / "out")) for a in arguments]
    with open("/dev/full", "w", encoding="utf-8") as full:
        done = run(*given, model, command=command, stdout=full.fileno())
    assert done.returncode == IO_FAILED == 74
    assert done.stderr == "error: cannot write to standard output: No space left on device\n"


@FULL
def test_help_and_schema_on_a_full_device() -> None:
    for arguments in (("--help",), ("--version",), ("schema",), ("completion", "bash")):
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = run(*arguments, stdout=full.fileno())
        assert done.returncode == IO_FAILED, arguments
        assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("closed", [">&-", ">&- 2>&-", "<&- >&- 2>&-", "2>&-", "<&-"])
def test_closed_standard_streams_are_no_failed_check(
    closed: str, model: Path, tmp_path: Path
) -> None:
    """What is written to files is whole; what was to be printed could not be."""
    out = tmp_path / "graph.svg"
    line = f'"$@" {closed}'
    command = ["sh", "-c", line, "sh", *MODULE, "graph", str(model), "--output", str(out)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == (0 if closed in ("2>&-", "<&-") else IO_FAILED)
    told = "error: cannot write to standard output: it is closed\n"
    assert done.stderr == (told if closed == ">&-" else "")
    text = out.read_text("utf-8")
    assert text.startswith("<svg")
    assert text.rstrip().endswith("</svg>")
    wrong = ["sh", "-c", line, "sh", *MODULE, "show", "nofile.toml"]
    done = subprocess.run(wrong, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == WRONG


@FULL
@pytest.mark.parametrize("command", ["derive", "graph"])
def test_a_full_device_as_the_file(command: str, model: Path) -> None:
    done = run(command, model, "--output", "/dev/full")
    assert done.returncode == IO_FAILED
    assert done.stderr == "error: cannot write to /dev/full: No space left on device\n"
    assert stat.S_ISCHR(os.stat("/dev/full").st_mode)


def test_a_reader_that_leaves_ends_the_process_as_it_ends_others(model: Path) -> None:
    process = subprocess.Popen(
        [*MODULE, "derive", str(model)], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    assert process.stdout is not None
    assert process.stderr is not None
    process.stdout.close()
    with process.stderr as told:
        errors = told.read()
    assert process.wait(timeout=60) == -signal.SIGPIPE
    assert errors == b""


def test_a_place_that_cannot_be_written_is_a_mistake_of_the_call(
    model: Path, tmp_path: Path
) -> None:
    done = run("derive", model, "--output", tmp_path / "small.toml" / "x.html")
    assert done.returncode == 2
    assert done.stderr.startswith("error: cannot write to ")


def test_unwritable_messages_do_not_change_the_status(tmp_path: Path) -> None:
    command = [*MODULE, "show", str(tmp_path / "nothing.toml")]
    with open(os.devnull if not Path("/dev/full").exists() else "/dev/full", "w") as full:
        done = subprocess.run(command, cwd=ROOT, stderr=full, check=False, timeout=60)
    assert done.returncode in (2, IO_FAILED)


# ---- devices and pipes as files


@pytest.mark.parametrize(
    ("command", "start"),
    [("derive", "Equations of motion of small"), ("graph", "<"), ("new", "# A terminal graph")],
)
def test_a_named_pipe_is_written_into(
    command: str, start: str, model: Path, tmp_path: Path
) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    read: list[str] = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_text(encoding="utf-8")))
    reader.start()
    source = ["fresh", "--out"] if command == "new" else [str(model), "--output"]
    done = run(command, *source, pipe)
    reader.join(timeout=30)
    assert done.returncode == 0, done.stderr
    assert read[0].startswith(start)
    assert stat.S_ISFIFO(pipe.stat().st_mode)


@pytest.mark.parametrize("device", ["/dev/null", "/dev/stdout", "/dev/fd/1"])
def test_a_device_is_written_into(device: str, model: Path) -> None:
    before = os.stat("/dev/null")
    done = run("derive", model, "--output", device)
    assert done.returncode == 0, done.stderr
    plain = "" if device == "/dev/null" else run("derive", model).stdout
    assert done.stdout == plain
    assert os.stat("/dev/null").st_rdev == before.st_rdev


def test_standard_output_goes_on_where_it_is(model: Path, tmp_path: Path) -> None:
    """A file that standard output is redirected to keeps what is in it."""
    target = tmp_path / "all.txt"
    target.write_text("first\n", encoding="utf-8")
    with target.open("a", encoding="utf-8") as end:
        done = run("derive", model, "--output", "/dev/stdout", stdout=end.fileno())
    assert done.returncode == 0, done.stderr
    assert target.read_text(encoding="utf-8") == "first\n" + run("derive", model).stdout


def test_process_substitution(model: Path, tmp_path: Path) -> None:
    """`--output >(command)` of bash."""
    script = (
        f"{' '.join(MODULE)} graph {model} --output >(cat > {tmp_path}/copy.svg); wait; sleep 0.3"
    )
    done = subprocess.run(
        ["bash", "-c", script], cwd=ROOT, capture_output=True, text=True, check=False, timeout=60
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "copy.svg").read_text("utf-8") == run("graph", model).stdout


def test_an_ending_still_says_the_format_of_a_pipe(model: Path, tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.html"
    os.mkfifo(pipe)
    read: list[str] = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_text(encoding="utf-8")))
    reader.start()
    assert run("derive", model, "--output", pipe).returncode == 0
    reader.join(timeout=30)
    assert read[0].startswith("<!DOCTYPE html>")


# ---- regular files


def test_a_regular_file_is_replaced_and_a_link_stays(tmp_path: Path) -> None:
    (tmp_path / "real.txt").write_text("old", encoding="utf-8")
    (tmp_path / "link.txt").symlink_to("real.txt")
    before = (tmp_path / "real.txt").stat().st_ino
    write_file(tmp_path / "link.txt", "new")
    assert (tmp_path / "link.txt").is_symlink()
    assert (tmp_path / "real.txt").read_text(encoding="utf-8") == "new"
    assert (tmp_path / "real.txt").stat().st_ino != before
    assert not is_stream(tmp_path / "link.txt")


def test_emitted_files_go_into_pipes_of_their_names(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "b")
    read: list[str] = []
    reader = threading.Thread(target=lambda: read.append((tmp_path / "b").read_text("utf-8")))
    reader.start()
    paths = write_all(tmp_path, {"a": "1", "b": "2"})
    reader.join(timeout=30)
    assert [path.name for path in paths] == ["a", "b"]
    assert read == ["2"]
    assert (tmp_path / "a").read_text(encoding="utf-8") == "1"


@pytest.mark.parametrize("error", [KeyboardInterrupt, OSError(28, "No space left on device")])
def test_what_is_broken_off_leaves_nothing_behind(
    error: BaseException, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a").write_text("old", encoding="utf-8")

    def fails(*_: object) -> None:
        raise error

    monkeypatch.setattr("os.replace", fails)
    with pytest.raises((KeyboardInterrupt, DeviceFailed)):
        write_all(tmp_path, {"a": "new", "b": "new"})
    assert [path.name for path in tmp_path.iterdir()] == ["a"]
    assert (tmp_path / "a").read_text(encoding="utf-8") == "old"
    assert not list(tmp_path.glob(f"{STAGED}*"))


@FULL
def test_a_full_device_is_an_error_of_its_own_kind() -> None:
    with pytest.raises(DeviceFailed, match="cannot write to /dev/full: No space left") as caught:
        write_file("/dev/full", "x" * 10)
    assert isinstance(caught.value, LinegraphError)
