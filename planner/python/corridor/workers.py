"""Processes that solve several problems at once."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from multiprocessing.connection import Connection, wait
from typing import Any

_MAIN_GUARD = 'a script calls solve_many under `if __name__ == "__main__":`'


class _Worker:
    """A process that calls a function for each argument that it gets, one after the other."""

    def __init__(self, function: Callable[[Any], Any]):
        if getattr(multiprocessing.current_process(), "_inheriting", False):
            sys.exit(f"corridor: {_MAIN_GUARD}, because each of its processes reads the script")
        context = multiprocessing.get_context("spawn")
        self.pipe, other = context.Pipe()
        self.process = context.Process(target=_serve, args=(function, other), daemon=True)
        # A Ctrl-C is for the parent, which then ends its processes. They inherit the mask.
        before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
        try:
            self.process.start()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
        other.close()
        self.task: int | None = None

    def receive(self) -> Any:
        """Returns what the process sends. Raises RuntimeError if it ended instead."""
        try:
            return self.pipe.recv()
        except (EOFError, OSError):
            self.process.join()
            status = self.process.exitcode or 0
            how = f"was ended by signal {-status}" if status < 0 else f"ended with status {status}"
            if self.task is None:
                why = f"before it began: {_MAIN_GUARD}, and is a file"
            else:
                why = f"while it solved problem {self.task}"
            raise RuntimeError(f"a process of solve_many {how} {why}") from None

    def end(self) -> None:
        """Waits for the end of the killed process."""
        self.process.join()
        self.pipe.close()


def _serve(function: Callable[[Any], Any], pipe: Connection) -> None:
    """What a process does: it sends None when it is ready, and a result and an exception for each argument."""
    pipe.send(None)
    with contextlib.suppress(EOFError, OSError):  # the parent has ended
        while True:
            argument = pipe.recv()
            answer: tuple[Any, Exception | None]
            try:
                answer = function(argument), None
            except Exception as error:
                answer = None, error
            pipe.send(answer)


def in_order(function: Callable[[Any], Any], arguments: Sequence[Any], processes: int | None) -> Iterator[Any]:
    """Yields function(argument) for each argument, in this order, computed by several processes.

    processes: None, as many as there are cores. If the function raises an exception, so does the iterator, at the place of
    that argument. If the iterator ends early, as by Ctrl-C, it kills its processes.
    """
    workers: list[_Worker] = []
    answers: dict[int, tuple[Any, BaseException | None]] = {}
    begun = 0
    try:
        for _ in range(min(len(arguments), processes or os.cpu_count() or 1)):
            workers.append(_Worker(function))
            if len(workers) == 1:
                workers[0].receive()  # if the first one can't begin, there are no others
        for worker in workers[1:]:
            worker.receive()
        for wanted in range(len(arguments)):
            while wanted not in answers:
                for worker in workers:
                    if worker.task is None and begun < len(arguments):
                        worker.task = begun
                        worker.pipe.send(arguments[begun])
                        begun += 1
                busy = {worker.pipe: worker for worker in workers if worker.task is not None}
                for pipe in wait(list(busy)):
                    worker = busy[pipe]  # type: ignore[index]
                    answer = worker.receive()
                    assert worker.task is not None
                    answers[worker.task], worker.task = answer, None
            result, error = answers.pop(wanted)
            if error:
                raise error
            yield result
    finally:
        for worker in workers:
            worker.process.kill()
        for worker in workers:
            worker.end()
