"""Processes that solve several problems at once."""

from __future__ import annotations

import multiprocessing
import multiprocessing.connection
import multiprocessing.resource_tracker
import os
import pickle
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from ._arguments import _whole

_MAIN_GUARD = 'a script must be a file, and must call solve_many under `if __name__ == "__main__":`'


class _Worker:
    """A process that calls a function for each argument that it gets, one after the other."""

    def __init__(self, function: Callable[[Any], Any]):
        if getattr(multiprocessing.current_process(), "_inheriting", False):
            sys.exit(f"corridor: {_MAIN_GUARD}: each of its processes reads the script")
        context = multiprocessing.get_context("spawn")
        self.pipe, other = context.Pipe()
        self.process = context.Process(target=_serve, args=(function, other), daemon=True)
        # Only the parent handles Ctrl-C: it kills its processes, which inherit a mask that blocks SIGINT. The resource
        # tracker must be started before SIGINT is blocked, because its start unblocks SIGINT.
        multiprocessing.resource_tracker.ensure_running()
        before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
        try:
            self.process.start()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
        other.close()
        self.is_lost = False  # becomes True if a call finds that the process has ended

    def await_begin(self) -> None:
        """Waits until the process takes arguments. Raises RuntimeError if it ended instead."""
        try:
            self.pipe.recv()
        except (EOFError, OSError):
            raise RuntimeError(f"a process of solve_many {self._end()} before it began: {_MAIN_GUARD}") from None

    def call(self, index: int, argument: Any) -> tuple[Any, BaseException | None]:
        """Returns the result for an argument, or an exception. `index` is for messages."""
        try:
            data = pickle.dumps(argument)
        except Exception as failure:
            return None, failure
        try:
            self.pipe.send_bytes(data)
            data = self.pipe.recv_bytes()
        except (EOFError, OSError):
            self.is_lost = True
            return None, RuntimeError(f"a process of solve_many {self._end()} while it solved problems[{index}]")
        try:
            result, error = pickle.loads(data)
        except Exception as failure:
            return None, failure
        return result, error

    def _end(self) -> str:
        self.process.join()
        status = self.process.exitcode or 0
        return f"was ended by signal {-status}" if status < 0 else f"ended with status {status}"


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        multiprocessing.connection.wait([parent.sentinel])
        os._exit(1)


def _serve(function: Callable[[Any], Any], pipe: multiprocessing.connection.Connection) -> None:
    """The main function of a process: sends None when ready, then a result and an exception for each argument."""
    threading.Thread(target=_end_with_parent, daemon=True).start()
    pipe.send(None)
    while True:
        try:
            data = pipe.recv_bytes()
        except (EOFError, OSError):
            return  # the parent has closed the pipe
        try:
            answer = pickle.dumps((function(pickle.loads(data)), None))
        except Exception as error:
            answer = _pickled(error)
        pipe.send_bytes(answer)


def _pickled(error: Exception) -> bytes:
    """Returns the pickled answer for an exception. If it can't be pickled, a RuntimeError with its text replaces it."""
    try:
        data = pickle.dumps((None, error))
        pickle.loads(data)
    except Exception:
        data = pickle.dumps((None, RuntimeError(repr(error))))
    return data


class _Answers:
    """The answers that threads have received from their processes, by the index of the argument."""

    def __init__(self, arguments: Sequence[Any]):
        self.arguments = arguments
        self.changed = threading.Condition()
        self.answers: dict[int, tuple[Any, BaseException | None]] = {}
        self.begun = 0

    def serve(self, worker: _Worker) -> None:
        """The main function of a thread: passes arguments to a process, until none is left or the process has ended."""
        while not worker.is_lost:
            with self.changed:
                index = self.begun
                if index == len(self.arguments):
                    return
                self.begun += 1
            answer = worker.call(index, self.arguments[index])
            with self.changed:
                self.answers[index] = answer
                self.changed.notify()

    def take(self, index: int) -> Any:
        with self.changed:
            self.changed.wait_for(lambda: index in self.answers)
            result, error = self.answers.pop(index)
        if error is not None:
            raise error
        return result


def in_order(function: Callable[[Any], Any], arguments: Sequence[Any], processes: int | None) -> Iterator[Any]:
    """Yields function(argument) for each argument, in this order, computed by several processes.

    processes: the number of processes; None: the number of cores. If the function raises an exception for an argument,
    the iterator raises this exception instead of yielding a result. The processes go on while the caller works. When
    the iterator ends, it kills the processes, even if it ends early (as by Ctrl-C).
    """
    if processes is None:
        processes = os.cpu_count() or 1
    processes = _whole("processes", processes, 1)
    answers, workers, owner = _Answers(arguments), list[_Worker](), os.getpid()
    try:
        for _ in range(min(len(arguments), processes)):
            workers.append(_Worker(function))
            if len(workers) == 1:
                workers[0].await_begin()  # if the first process can't begin, no other is started
        for worker in workers[1:]:
            worker.await_begin()
        for worker in workers:
            threading.Thread(target=answers.serve, args=(worker,), daemon=True).start()
        for index in range(len(arguments)):
            yield answers.take(index)
    finally:
        if os.getpid() == owner:  # not in a forked child, which has a copy of the iterator
            for worker in workers:
                worker.process.kill()
            for worker in workers:
                worker.process.join()
