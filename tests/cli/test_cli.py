"""The command line as a user meets it: real processes, real files."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PANDA = ROOT / "examples" / "panda" / "panda.urdf"
ANYMAL = ROOT / "examples" / "anymal_c" / "anymal.urdf"


def linegraph(*arguments: object, cwd: Path = ROOT) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "linegraph", *map(str, arguments)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    return subprocess.run(
        command, cwd=cwd, env=environment, capture_output=True, text=True, timeout=60, check=False
    )


def refused(done: subprocess.CompletedProcess[str], *parts: str) -> None:
    """Exit status 2 and one message, no traceback."""
    assert done.returncode == 2, done.stderr
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
    for part in parts:
        assert part in done.stderr


def test_help_teaches() -> None:
    text = linegraph("--help").stdout
    assert "M(q) v' + h(q, v) = Q(u)" in text
    assert "linegraph emit panda.urdf --out build" in text
    assert "Exit status" in text
    emit = linegraph("emit", "--help").stdout
    for option in ("--out", "--name", "--lang", "--base", "--lock", "--parameters", "--snap"):
        assert option in emit
    assert "forward_dynamics" in emit
    assert linegraph("show", "-h").returncode == 0


def test_version() -> None:
    from linegraph import __version__

    assert linegraph("--version").stdout == f"linegraph {__version__}\n"


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_prints_a_script(shell: str) -> None:
    done = linegraph("completion", shell)
    assert done.returncode == 0
    assert "_LINEGRAPH_COMPLETE" in done.stdout


def test_help_imports_nothing_heavy() -> None:
    script = (
        "import sys; from linegraph.cli.main import main\n"
        "try: main(['--help'])\nexcept SystemExit: pass\n"
        "heavy = {'sympy', 'numpy', 'networkx', 'jinja2', 'lxml'} & set(sys.modules)\n"
        "sys.exit(f'imported: {heavy}' if heavy else 0)"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=ROOT, capture_output=True, check=False
    )
    assert done.returncode == 0, done.stderr


def test_emitting_a_robot_imports_neither_sympy_nor_numpy_nor_networkx(tmp_path: Path) -> None:
    script = (
        "import sys; from linegraph.cli.main import main\n"
        "try: main(sys.argv[1:])\nexcept SystemExit: pass\n"
        "heavy = {'sympy', 'numpy', 'networkx'} & set(sys.modules)\n"
        "sys.exit(f'imported: {heavy}' if heavy else 0)"
    )
    command = [sys.executable, "-c", script, "emit", str(PANDA), "--out", str(tmp_path)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "panda.c").exists()


def test_emit_prints_a_line_per_file(tmp_path: Path) -> None:
    done = linegraph("emit", PANDA, "--out", tmp_path / "new" / "folder")
    assert done.returncode == 0
    written = [Path(line) for line in done.stdout.splitlines()]
    assert [path.name for path in written] == ["panda.h", "panda.c", "panda.py"]
    assert all(path.exists() for path in written)
    assert "\x1b" not in done.stdout + done.stderr
    assert {path.name for path in (tmp_path / "new" / "folder").iterdir()} == {
        path.name for path in written
    }


def test_emit_takes_name_language_base_and_locks(tmp_path: Path) -> None:
    done = linegraph(
        "emit", ANYMAL, "--out", tmp_path, "--name", "quad", "--lang", "python",
        "--base", "floating", "--lock", "LF_HAA=0.1", "--lock", "RH_KFE",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    text = (tmp_path / "quad.py").read_text()
    assert "\nNQ = 17\nNV = 16\nNU = 10\n" in text
    assert '"root_qw"' in text
    assert '"LF_HAA"' not in text
    assert [path.name for path in tmp_path.iterdir()] == ["quad.py"]


def test_emit_keeps_parameters_on_request(tmp_path: Path) -> None:
    done = linegraph("emit", PANDA, "--out", tmp_path, "--parameters", "symbolic")
    assert done.returncode == 0, done.stderr
    header = (tmp_path / "panda.h").read_text()
    assert "double m_panda_link1; /* kg" in header
    assert "panda_default_parameters" in header


def test_emit_overwrites_and_leaves_other_files_alone(tmp_path: Path) -> None:
    (tmp_path / "panda.c").write_text("old")
    (tmp_path / "mine.txt").write_text("mine")
    assert linegraph("emit", PANDA, "--out", tmp_path).returncode == 0
    assert (tmp_path / "panda.c").read_text().startswith("/*")
    assert (tmp_path / "mine.txt").read_text() == "mine"


def test_show_prints_every_section() -> None:
    done = linegraph("show", PANDA)
    assert done.returncode == 0
    for heading in (
        "bodies",
        "joints",
        "domains",
        "graph",
        "tree",
        "coordinates",
        "cutset",
        "circuit",
    ):
        assert f"\n{heading}" in done.stdout
    assert "panda_finger_joint2" in done.stdout
    assert "= 1 panda_finger_joint1 + 0" in done.stdout
    assert "\x1b" not in done.stdout


def test_a_missing_file(tmp_path: Path) -> None:
    out = tmp_path / "out"
    refused(linegraph("emit", tmp_path / "none.urdf", "--out", out), "none.urdf")
    assert not out.exists()


def test_a_broken_file_is_named_with_its_line_and_nothing_is_written(tmp_path: Path) -> None:
    broken = tmp_path / "broken.urdf"
    broken.write_text(
        PANDA.read_text().replace('<mass value="0.629769"/>', '<mass value="heavy"/>')
    )
    done = linegraph("emit", broken, "--out", tmp_path / "out")
    line = next(i for i, text in enumerate(broken.read_text().splitlines(), 1) if "heavy" in text)
    refused(done, f"broken.urdf:{line}:", "heavy")
    assert done.stderr.startswith("error: ")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (["emit"], "MODEL"),
        (["emit", PANDA, "--lang", "cobol"], "cobol"),
        (["emit", PANDA, "--base", "flying"], "flying"),
        (["emit", PANDA, "--lock", "panda_joint9"], "panda_joint9"),
        (["emit", PANDA, "--lock", "panda_joint1=much"], "much"),
        (["emit", PANDA, "--lock", "panda_joint1=nan"], "nan"),
        (["emit", PANDA, "--name", "while"], "while"),
        (["emit", PANDA, "--name", "../up"], "../up"),
        (["emit", PANDA, "--name", ""], "letter"),
        (["emit", PANDA, "--snap", "7"], "7"),
        (["emit", PANDA, "--out", PANDA], "panda.urdf"),
        (["emit", PANDA, "--out", "/proc/nowhere"], "/proc/nowhere"),
        (["frobnicate"], "frobnicate"),
        (["show", ROOT], "main" if ROOT.name == "main" else ROOT.name),
    ],
)
def test_a_wrong_call_is_refused(arguments: list[object], part: str, tmp_path: Path) -> None:
    refused(linegraph(*arguments, cwd=tmp_path), part)
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_joint_to_lock_hints_at_the_nearest() -> None:
    refused(linegraph("show", PANDA, "--lock", "panda_joint_1"), 'did you mean "panda_joint1"?')


def test_everything_locked_is_refused(tmp_path: Path) -> None:
    locks = [f"--lock=panda_joint{i}" for i in range(1, 8)] + ["--lock=panda_finger_joint1"]
    refused(linegraph("emit", PANDA, "--out", tmp_path, *locks), "no joint can move")
    assert list(tmp_path.iterdir()) == []


def test_new_check_and_emit_a_model_file(tmp_path: Path) -> None:
    assert linegraph("new", "cart", "--out", "cart.toml", cwd=tmp_path).returncode == 0
    checked = linegraph("check", "cart.toml", cwd=tmp_path)
    assert checked.returncode == 0, checked.stderr
    assert "2 degrees of freedom" in checked.stdout
    assert checked.stdout.endswith("good\n")
    emitted = linegraph("emit", "cart.toml", "--out", "out", cwd=tmp_path)
    assert [Path(line).name for line in emitted.stdout.splitlines()] == [
        "cart.h",
        "cart.c",
        "cart.py",
    ]
    header = (tmp_path / "out" / "cart.h").read_text()
    assert "double m; /* kg: mass of the pendulum */" in header
    folded = linegraph(
        "emit", "cart.toml", "--out", "folded", "--parameters", "folded", cwd=tmp_path
    )
    assert folded.returncode == 0
    assert "parameters" not in (tmp_path / "folded" / "cart.c").read_text()


def test_new_does_not_overwrite(tmp_path: Path) -> None:
    (tmp_path / "cart.toml").write_text("mine")
    refused(linegraph("new", "cart", "--out", "cart.toml", cwd=tmp_path), "cart.toml")
    assert (tmp_path / "cart.toml").read_text() == "mine"


def test_all_mistakes_of_a_model_file_at_once(tmp_path: Path) -> None:
    broken = tmp_path / "broken.toml"
    broken.write_text(
        'name = "broken"\n[body.rod]\nmas = 1.0\n\n[revolute.hinge]\nbetween = ["ground", "rot"]\n'
        "axis = [0, 0, 1]\n"
    )
    done = linegraph("emit", broken, "--out", tmp_path / "out")
    refused(done, "broken.toml:3:", "mass", "broken.toml:6:", '"rod"')
    assert done.stderr.count("error:") == 2
    assert not (tmp_path / "out").exists()


def test_check_takes_a_robot() -> None:
    done = linegraph("check", ANYMAL, "--base", "floating")
    assert done.returncode == 0
    assert "18 degrees of freedom, 12 inputs" in done.stdout
    assert done.stdout.endswith("good\n")
