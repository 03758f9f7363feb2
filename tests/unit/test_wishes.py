"""What a user wants of a long computation: to begin anew, to go on, to stop."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from wrinklewave.errors import InputError
from wrinklewave.experiments.interruption import interruptible
from wrinklewave.experiments.run_folder import claim_folder
from wrinklewave.experiments.sweep import sweep

QUICK = Path(__file__).parents[2] / "examples" / "quick.toml"


def test_results_are_not_both_gone_on_with_and_replaced(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="--resume or --overwrite, not both"):
        claim_folder(tmp_path, "case.toml", "a run", resume=True, overwrite=True)
    with pytest.raises(InputError, match="--resume or --overwrite, not both"):
        sweep(QUICK, ["drive.velocity=2 m/s, 3 m/s"], out=tmp_path, resume=True, overwrite=True)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_is_answered_at_once(number: signal.Signals, capfd: pytest.CaptureFixture[str]) -> None:
    with interruptible() as wished:
        assert not wished()
        signal.raise_signal(number)
        assert wished()
        assert "stopping where it can go on later" in capfd.readouterr().err
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
