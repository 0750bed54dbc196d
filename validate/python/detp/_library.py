"""The shared library: how it is found, called and interrupted."""

from __future__ import annotations

import os
import threading
from pathlib import Path
from queue import SimpleQueue
from typing import Any, Callable, List, Optional

from ._declarations import ffi

#: Called at least ten times a second with what is being done and with the share of the work, 0 to 1, from any thread.
#: The work stops if it raises; the caller gets its exception.
Progress = Callable[[str, float], object]


class Stopped(Exception):
    """The work was stopped."""


def _open() -> Any:
    beside = Path(__file__).with_name("libdetp.so.0")
    name = os.environ.get("DETP_LIBRARY") or (str(beside) if beside.exists() else "libdetp.so.0")
    try:
        return ffi.dlopen(name)
    except OSError as error:
        raise ImportError(f"detp: cannot load the library {name}: {error}; DETP_LIBRARY may name it") from error


lib = _open()


def make(struct: str) -> Any:
    """A struct of the C interface, with its size set."""
    made = ffi.new(struct + " *")
    made.size = ffi.sizeof(struct)
    return made


def owned(handle: str) -> Any:
    """A variable for a handle, which is freed with it."""
    return ffi.gc(ffi.new(handle + " **"), getattr(lib, handle + "_free"))


_exceptions = {
    "DETP_INVALID": ValueError,
    "DETP_NO_MEMORY": MemoryError,
    "DETP_STOPPED": Stopped,
    "DETP_FILE": OSError,
    "DETP_INTERNAL": RuntimeError,
}


def call(function: Any, *arguments: Any) -> None:
    """Calls a short function of the library. Raises what its status says."""
    error = ffi.new("detp_error *")
    _check(function(*arguments, error), error)


def _check(status: int, error: Any) -> None:
    if status != lib.DETP_OK:
        text = ffi.string(error.text).decode("utf-8", "replace")
        raise next(kind for name, kind in _exceptions.items() if status == getattr(lib, name))(text)


class LongCall:
    """A call that may take long: it reports progress, and Ctrl-C stops it at once.

    Calls of the main thread run on a second one, because Python handles signals on the main thread only, and not during a
    call. Other threads go on meanwhile, as the library does not hold the interpreter's lock.
    """

    def __init__(self, progress: Optional[Progress]) -> None:
        self._progress = progress
        self._raised: Optional[BaseException] = None
        self._stop = False
        self.callback = ffi.callback("int(void *, const char *, double)", self._show, error=1)

    def _show(self, _: Any, what: Any, share: float) -> int:
        if self._stop:
            return 1
        return self.guarded(1, self._report, ffi.string(what).decode(), share)

    def _report(self, what: str, share: float) -> int:
        if self._progress is not None:
            self._progress(what, share)
        return 0

    def guarded(self, failed: int, function: Callable[..., int], *arguments: Any) -> int:
        """Calls Python from a callback. What it raises is raised by `run`."""
        try:
            return function(*arguments)
        except BaseException as raised:  # also KeyboardInterrupt
            self._raised = raised
            return failed

    def run(self, function: Any, *arguments: Any) -> None:
        error = ffi.new("detp_error *")
        if threading.current_thread() is threading.main_thread():
            status = self._on_worker(lambda: int(function(*arguments, error)))
        else:
            status = int(function(*arguments, error))
        if self._raised is not None:
            raise self._raised
        _check(status, error)

    def _on_worker(self, function: Callable[[], int]) -> int:
        answers: List[int] = []
        done = threading.Event()

        def job() -> None:
            answers.append(self.guarded(-1, function))
            done.set()

        _worker.give(job)
        # Until the library has let go of the arrays. A signal can take the message that ends a wait, so waits have a limit.
        while not answers:
            try:
                done.wait(1)
            except BaseException as interrupted:  # KeyboardInterrupt
                self._stop = True
                self._raised = interrupted
        return answers[0]


class _Worker:
    """A thread that does one job after another. It is never ended: it waits when the program ends."""

    def __init__(self) -> None:
        self._jobs: Optional[SimpleQueue[Callable[[], object]]] = None

    def give(self, job: Callable[[], object]) -> None:
        if self._jobs is None:
            self._jobs = SimpleQueue()
            threading.Thread(target=self._work, args=(self._jobs,), name="detp", daemon=True).start()
        self._jobs.put(job)

    def forget(self) -> None:
        """A child process has no such thread."""
        self._jobs = None

    @staticmethod
    def _work(jobs: SimpleQueue[Callable[[], object]]) -> None:
        while True:
            jobs.get()()


_worker = _Worker()
os.register_at_fork(after_in_child=_worker.forget)
