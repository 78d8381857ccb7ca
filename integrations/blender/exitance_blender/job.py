"""Runs programs one after the other in the background. Needs no Blender."""
from __future__ import annotations

import signal
import subprocess
import threading
from dataclasses import dataclass, field

from .commands import LIMITED, REACHED, Progress, messages, parse_progress

REMAINING_AFTER_PHASE = 0.85  # share of a step that a phase leaves; how many phases follow is not known


@dataclass
class Step:
    """A command, the share of the whole work that it takes, and after its end what it printed."""

    title: str
    command: list[str]
    share: float
    output: str = ""
    errors: str = ""
    status: int | None = None


@dataclass
class Job:
    """Steps that run one after the other; poll() starts the next one. A step that fails ends the job."""

    steps: list[Step]
    failure: str = ""
    cancelled: bool = False
    _current: int = -1
    _process: subprocess.Popen[str] | None = None
    _readers: list[threading.Thread] = field(default_factory=list)
    _progress: Progress = Progress("", 0)
    _finished_phases: int = 0

    def poll(self) -> bool:
        """Moves on; returns True while a step runs. Does not wait."""
        if self._process is not None:
            if self._process.poll() is None:
                return True
            self._finish_step()
        if self.failure or self.cancelled or self._current + 1 >= len(self.steps):
            return False
        self._start_next()
        return not self.failure

    def wait(self) -> None:
        """Runs all steps to their end."""
        while self.poll():
            if self._process is not None:
                self._process.wait()

    def cancel(self) -> None:
        """Stops the running program by SIGTERM, which ends it at its next safe point; the second time at once."""
        if self._process is not None and self._process.poll() is None:
            if self.cancelled:
                self._process.kill()
            else:
                self._process.send_signal(signal.SIGTERM)
        self.cancelled = True

    def words(self) -> str:
        """Returns the running step and its phase for people."""
        if not 0 <= self._current < len(self.steps):
            return ""
        return ": ".join(word for word in (self.steps[self._current].title, self._progress.phase) if word)

    def fraction(self) -> float:
        """Returns the finished share of the job in [0, 1], which never falls: each phase takes a part of the rest of its step."""
        total = sum(step.share for step in self.steps)
        done = sum(step.share for step in self.steps[:max(0, self._current)])
        if 0 <= self._current < len(self.steps):
            phases = self._finished_phases + self._progress.fraction
            done += self.steps[self._current].share * (1 - REMAINING_AFTER_PHASE**phases)
        return done / total if total > 0 else 0

    def _start_next(self) -> None:
        """Starts the next command and two threads that read what it prints."""
        self._current += 1
        self._progress, self._finished_phases = Progress("", 0), 0
        step = self.steps[self._current]
        try:
            self._process = subprocess.Popen(step.command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                             stderr=subprocess.PIPE, text=True, encoding="utf-8", errors="replace")
        except OSError as error:
            self.failure = f"{step.command[0]} cannot be started: {error.strerror}"
            return
        self._readers = [threading.Thread(target=self._read_output, args=(step, self._process), daemon=True),
                         threading.Thread(target=self._read_errors, args=(step, self._process), daemon=True)]
        for reader in self._readers:
            reader.start()

    def _finish_step(self) -> None:
        """Keeps the exit status of the ended command, and its last messages if it failed."""
        for reader in self._readers:
            reader.join()
        step, process = self.steps[self._current], self._process
        assert process is not None
        step.status, self._process = process.returncode, None
        if step.status not in (REACHED, LIMITED) and not self.cancelled:
            lines = messages(step.errors)
            self.failure = "\n".join(lines[-6:]) or f"{step.title} ended with status {step.status}"

    def _read_output(self, step: Step, process: subprocess.Popen[str]) -> None:
        assert process.stdout is not None
        with process.stdout:
            step.output = process.stdout.read()

    def _read_errors(self, step: Step, process: subprocess.Popen[str]) -> None:
        assert process.stderr is not None
        with process.stderr:
            for line in process.stderr:
                progress = parse_progress(line)
                if progress is None:
                    step.errors += line
                else:
                    if self._progress.phase not in ("", progress.phase):
                        self._finished_phases += 1
                    self._progress = progress
