"""The command line: lazy, quiet about its insides, honest in its exit codes."""

from __future__ import annotations

import errno
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from wrinklewave import __version__
from wrinklewave.cli import application, main
from wrinklewave.errors import InputError, RunError

ROOT = Path(__file__).parents[2]
PAPER = ROOT / "examples" / "paper_impact.toml"
HEAVY = ("numba", "numpy", "xarray", "matplotlib", "pint", "scipy", "pydantic", "rich", "h5py", "jinja2")


def run(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, *arguments: str
) -> tuple[int, str, str]:
    monkeypatch.setattr(sys, "argv", ["wrinklewave", *arguments])
    with pytest.raises(SystemExit) as left:
        main()
    out, err = capsys.readouterr()
    return int(left.value.code or 0), out, err


def python(*arguments: str) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"PYTHONPATH": str(ROOT / "src")}
    return subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, env=environment, check=False
    )


def test_help_imports_nothing_heavy() -> None:
    code = (
        "import sys, wrinklewave.cli as cli\n"
        "sys.argv = ['wrinklewave', '--help']\n"
        "try:\n    cli.main()\n"
        f"finally:\n    print('HEAVY', sorted(set({HEAVY}) & set(sys.modules)), file=sys.stderr)\n"
    )
    done = python("-c", code)
    assert done.returncode == 0
    assert "theory" in done.stdout
    assert done.stderr.strip() == "HEAVY []"


def test_every_verb_has_help_without_heavy_imports() -> None:
    from wrinklewave.cli import verbs

    names = [path.stem for path in Path(verbs.__path__[0]).glob("[a-z]*.py")]
    assert {"theory", "doctor", "cite"} <= set(names)
    code = (
        "import sys, wrinklewave.cli as cli\n"
        "sys.argv = ['wrinklewave', sys.argv[1], '--help']\n"
        "try:\n    cli.main()\n"
        f"finally:\n    print('HEAVY', sorted(set({HEAVY}) & set(sys.modules)), file=sys.stderr)\n"
    ).replace("'pydantic', ", "")  # typer itself imports pydantic once it looks at the parameters of a verb
    for name in names:
        done = python("-c", code, name.replace("_", "-"))
        assert done.returncode == 0
        assert "Usage: wrinklewave" in done.stdout
        assert done.stderr.strip() == "HEAVY []", name


def test_version(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    assert run(capsys, monkeypatch, "--version") == (0, f"wrinklewave {__version__}\n", "")


def test_module_runs() -> None:
    done = python("-m", "wrinklewave", "--version")
    assert (done.returncode, done.stdout) == (0, f"wrinklewave {__version__}\n")


def test_theory(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    file = tmp_path / "theory.json"
    code, out, err = run(capsys, monkeypatch, "theory", str(PAPER), "--json", str(file))
    assert (code, err) == (0, "")
    row = next(line for line in out.splitlines() if "plane-wave speed, instantaneous " in line)
    assert "423.5 m/s" in row
    assert "424 m/s" in row
    written = json.loads(file.read_text(encoding="utf-8"))
    assert written["case"] == "paper impact"
    values = {quantity["name"]: quantity for quantity in written["quantities"]}
    assert values["bar speed, long-term"]["value"] == pytest.approx(11.656571, rel=1e-7)
    assert values["bar speed, long-term"]["unit"] == "m/s"
    assert values["bar speed, long-term"]["paper"] == "11.7"


def test_theory_with_override(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    _, out, _ = run(capsys, monkeypatch, "theory", str(PAPER), "--set", "substrate.shear_modulus=176 kPa")
    row = next(line for line in out.splitlines() if "bar speed, long-term" in line)
    assert "23.31 m/s" in row  # four times the modulus, twice the speed


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["theory", "no.toml"], ["wrinklewave: no.toml: no such file", "to mend:"]),
        (["theory", str(PAPER), "--set", "drive.velocity=5"], ["--set: drive.velocity: 5 has no unit"]),
        (["theory"], ["Missing argument 'CASE'"]),
        (["teory"], ["No such command 'teory'"]),
        (["theory", str(PAPER), "--jsn", "x"], ["No such option"]),
    ],
)
def test_mistakes_exit_with_2(
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    arguments: list[str],
    words: list[str],
) -> None:
    code, out, err = run(capsys, monkeypatch, *arguments)
    assert (code, out) == (2, "")
    assert all(word in err for word in words)
    assert "Traceback" not in err


def test_unwritable_file(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    code, _, err = run(capsys, monkeypatch, "theory", str(PAPER), "--json", str(tmp_path / "none" / "x.json"))
    assert code == 2
    assert "none/x.json: no such file or directory" in err
    assert "to mend" in err
    assert "Traceback" not in err


def test_full_disk_is_a_failure_not_a_mistake(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail() -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "surface.nc")

    app = application()
    app.command("fail")(fail)
    monkeypatch.setattr("wrinklewave.cli.application", lambda: app)
    code, _, err = run(capsys, monkeypatch, "fail")
    assert code == 1
    assert err.startswith("wrinklewave: surface.nc: no space left on device\n  to mend:  free some")


def test_too_little_memory_is_told(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail() -> None:
        raise MemoryError("Unable to allocate 75 GiB")

    app = application()
    app.command("fail")(fail)
    monkeypatch.setattr("wrinklewave.cli.application", lambda: app)
    code, _, err = run(capsys, monkeypatch, "fail")
    assert (code, "75 GiB" in err, "a coarser mesh" in err) == (1, True, True)


@pytest.mark.parametrize(
    ("error", "code"), [(InputError("bad"), 2), (RunError("inverted"), 1), (KeyboardInterrupt(), 130)]
)
def test_exit_codes(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, error: BaseException, code: int
) -> None:
    def fail() -> None:
        raise error

    app = application()
    app.command("fail")(fail)
    monkeypatch.setattr("wrinklewave.cli.application", lambda: app)
    found, _, err = run(capsys, monkeypatch, "fail")
    assert found == code
    assert "Traceback" not in err
    assert str(error) in err


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_ctrl_c_ends_without_traceback() -> None:
    code = (
        "import time, wrinklewave.cli as cli, sys\n"
        "app = cli.application()\n"
        "def wait():\n    print('ready', flush=True)\n    time.sleep(60)\n"
        "app.command('wait')(wait)\n"
        "cli.application = lambda: app\n"
        "sys.argv = ['wrinklewave', 'wait']\n"
        "cli.main()\n"
    )
    environment = os.environ | {"PYTHONPATH": str(ROOT / "src")}
    with subprocess.Popen(
        [sys.executable, "-c", code],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=30)
    assert process.returncode == 130
    assert "Traceback" not in err


def test_ctrl_c_is_told(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("wrinklewave.environment.versions", interrupted)
    code, _, err = run(capsys, monkeypatch, "doctor")
    assert (code, err.strip()) == (130, "wrinklewave: stopped")


def test_what_takes_long_to_begin_says_why(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from wrinklewave.cli import progress

    class Half:
        share = 0.5

        def __str__(self) -> str:
            return "half done"

    monkeypatch.setattr(progress, "PATIENCE", 0.05)
    with progress.shown_progress("slow", "compiling"):
        time.sleep(0.3)
    with progress.shown_progress("quick", "compiling") as show:
        show(Half())
        time.sleep(0.3)
    assert capsys.readouterr().err == "slow: compiling\nquick: half done\n"


def test_values_of_a_sweep_are_printed_as_they_are(capsys: pytest.CaptureFixture[str]) -> None:
    from wrinklewave.cli.verbs.sweep import _say
    from wrinklewave.experiments.sweep import SweepProgress

    _say(SweepProgress(1, 2, "case.name=[/red]", {"outcome": "finished"}, 12.0), lambda: None)
    assert capsys.readouterr().out == "1 of 2, 12 runs per minute: case.name=[/red]: finished\n"


def test_doctor(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    code, out, _ = run(capsys, monkeypatch, "doctor")
    assert code == 0
    for word in (f"wrinklewave    {__version__}", "numpy", "[video]", "cores", "threads", "GPU", "simulate"):
        assert word in out


def test_cite(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    _, everything, _ = run(capsys, monkeypatch, "cite")
    code, papers, _ = run(capsys, monkeypatch, "cite", str(PAPER))
    assert code == 0
    assert "Hughes1980" in everything
    assert "Hughes1980" not in papers  # the paper case has one-point elements
    assert "Flanagan1981" in papers


def test_every_reference_is_used_and_every_use_has_a_reference() -> None:
    from wrinklewave.citations import USES, references

    assert {use.key for use in USES} == set(references())
