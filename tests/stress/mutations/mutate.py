#!/usr/bin/env python3
"""Seeds faults into the numerics, one at a time, and reports which test catches each (see README.md beside this file).

Works on a copy of HEAD in build/mutations/, and never writes to the user's tree. Every result is stored at once, so
that an interrupted run can be resumed.
"""

import argparse
import dataclasses
import fnmatch
import hashlib
import io
import json
import pathlib
import re
import signal
import subprocess
import sys
import tarfile
import time
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
WORK = ROOT / "build" / "mutations"
TREE, RESULTS = WORK / "tree", WORK / "results.json"
BUILD = TREE / "build" / "release"  # the preset's folder

NAMED_LIMIT = 300  # seconds for one program with a filter; a longer run counts as a hang, and the mutation as caught
WHOLE_LIMIT = 900  # seconds for one whole program


class Failure(Exception):
    """A fault that makes the results of all mutations meaningless."""


@dataclasses.dataclass(frozen=True)
class Mutation:
    name: str
    file: str
    old: str
    new: str
    tests: tuple[str, ...]     # "program filter", those that are likely to fail first
    programs: tuple[str, ...]  # run as a whole if none of `tests` fails

    def key(self, text):
        """Identifies a result: by the mutation and the text of the file that it changes."""
        return hashlib.sha256(repr((dataclasses.astuple(self), text)).encode()).hexdigest()[:16]


def readMutations():
    mutations = []
    for path in sorted(HERE.glob("*.toml")):
        for entry in tomllib.loads(path.read_text())["mutation"]:
            try:
                mutations.append(Mutation(entry.pop("name"), entry.pop("file"), entry.pop("old"), entry.pop("new"),
                                          tuple(entry.pop("tests")), tuple(entry.pop("programs"))))
            except KeyError as error:
                raise Failure(f"{path.name}: a mutation has no {error}") from None
            if entry:
                raise Failure(f'{path.name}: mutation "{mutations[-1].name}" has unknown keys: {", ".join(entry)}')
    names = [m.name for m in mutations]
    for name in {n for n in names if names.count(n) > 1}:
        raise Failure(f'two mutations have the name "{name}"')
    return mutations


def git(*arguments):
    return subprocess.run(["git", "-C", ROOT, *arguments], check=True, capture_output=True).stdout


def copyTree():
    """Makes TREE equal to HEAD. An unchanged file keeps its modification time, so only changed code is built again."""
    archive = tarfile.open(fileobj=io.BytesIO(git("archive", "HEAD")))
    kept = set()
    for member in archive.getmembers():
        if not member.isfile():
            continue
        path = TREE / member.name
        kept.add(path)
        content = archive.extractfile(member).read()
        if not path.exists() or path.read_bytes() != content:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
            path.chmod(member.mode)
    for path in list(TREE.rglob("*")):
        if path.is_file() and path not in kept and not path.is_relative_to(TREE / "build"):
            path.unlink()


def configure():
    done = subprocess.run(["cmake", "--preset", "test"], cwd=TREE, capture_output=True, text=True)
    if done.returncode:
        raise Failure(f"cmake failed:\n{done.stdout}{done.stderr}")


def build(ninja, programs):
    """Builds programs. Returns the error messages as text, or None if the build succeeds."""
    done = subprocess.run([*ninja, "-C", BUILD, *programs], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode == 0:
        return None
    errors = [line for line in done.stdout.splitlines() if "error" in line or "FAILED" in line]
    return "\n".join(errors[:5] or done.stdout.splitlines()[-5:])


def run(program, testFilter, limit):
    """Runs tests until one fails. Returns (number of passed tests, None), or (0, the failure) if a test failed."""
    command = [BUILD / "tests" / program, f"--gtest_filter={testFilter}", "--gtest_fail_fast", "--gtest_brief=0",
               "--gtest_color=no"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                          cwd=BUILD / "tests") as process:
        try:
            output, _ = process.communicate(timeout=limit)
            timedOut = False
        except subprocess.TimeoutExpired:
            process.kill()
            output, _ = process.communicate()
            timedOut = True
    if process.returncode == 0:
        return len(re.findall(r"^\[       OK \]", output, re.M)), None
    failed = re.search(r"^\[  FAILED  \] (\S+?)(?:,| |$)", output, re.M)
    if failed:
        return 0, failed[1]
    begun = re.findall(r"^\[ RUN      \] (\S+)", output, re.M)
    where = begun[-1] if begun else program
    if timedOut:
        return 0, f"{where} (no end after {limit} s)"
    if process.returncode < 0:
        return 0, f"{where} (crash: {signal.Signals(-process.returncode).name})"
    return 0, f"{where} (exit status {process.returncode})"


def checkTestsPass(mutations, ninja, results):
    """Requires that every named test exists and passes on the unchanged tree. Otherwise it could not catch a mutation."""
    tree = git("rev-parse", "HEAD^{tree}").decode().strip()
    passed = results.setdefault("passed", {})
    if passed.get("tree") != tree:
        passed.clear()
        passed["tree"] = tree
    tests = [t for t in dict.fromkeys(t for m in mutations for t in m.tests) if t not in passed]
    if not tests:
        return
    print(f"{len(tests)} named tests on the unchanged tree", flush=True)
    if errors := build(ninja, sorted({t.split()[0] for t in tests})):
        raise Failure(f"the unchanged tree can't be built:\n{errors}")
    for test in tests:
        start = time.monotonic()
        count, failed = run(*test.split(), NAMED_LIMIT)
        if failed:
            raise Failure(f'without any mutation, "{test}" fails: {failed}')
        if count == 0:
            raise Failure(f'"{test}" runs no test here, or skips all')
        passed[test] = round(time.monotonic() - start, 1)
        store(results)


def catch(mutation, ninja, quick):
    """Builds and runs the tests of a seeded mutation. Returns (outcome, the test that caught it or a reason)."""
    tried = set()
    tests = [(*t.split(), NAMED_LIMIT) for t in mutation.tests]
    if not quick:
        tests += [(p, "*", WHOLE_LIMIT) for p in mutation.programs]
    for program, testFilter, limit in tests:
        if program not in tried and (errors := build(ninja, [program])):
            return "invalid", f"does not compile: {errors}"
        tried.add(program)
        _, failed = run(program, testFilter, limit)
        if failed:
            return "caught", f"{program} {failed}"
    return ("open", "by none of the named tests") if quick else ("uncaught", "")


def seed(mutation, ninja, quick):
    path = TREE / mutation.file
    text = path.read_text() if path.exists() else ""
    start = time.monotonic()
    if text.count(mutation.old) != 1 or mutation.old == mutation.new:
        outcome, by = "stale", f"the old text occurs {text.count(mutation.old)} times"
    else:
        try:
            path.write_text(text.replace(mutation.old, mutation.new))
            outcome, by = catch(mutation, ninja, quick)
        finally:
            path.write_text(text)
    return {"key": mutation.key(text), "outcome": outcome, "by": by, "seconds": round(time.monotonic() - start)}


def store(results):
    temporary = RESULTS.with_suffix(".new")
    temporary.write_text(json.dumps(results, indent=1, ensure_ascii=False) + "\n")
    temporary.replace(RESULTS)


def table(mutations, results):
    print("\n| mutation | file | caught by | s |\n|---|---|---|--:|")
    for m in mutations:
        r = results["mutations"].get(m.name)
        by = "not run" if not r else r["by"] if r["outcome"] == "caught" else f"**{r['outcome']}** {r['by']}".strip()
        print(f"| {m.name} | {m.file} | {by} | {r['seconds'] if r else ''} |".replace("\n", " "))
    outcomes = [results["mutations"].get(m.name, {"outcome": "not run"})["outcome"] for m in mutations]
    print("\n" + ", ".join(f"{outcomes.count(o)} {o}" for o in dict.fromkeys(["caught", *outcomes])))
    return all(o == "caught" for o in outcomes)


def main():
    parser = argparse.ArgumentParser(description="Seed faults into the numerics and report which test catches each.")
    parser.add_argument("--list", action="store_true", help="print the mutations and their results, run none")
    parser.add_argument("--only", metavar="PATTERN", default="*", help="run only the mutations whose name or file matches; * and ? are wildcards")
    parser.add_argument("--again", metavar="NAME", action="append", default=[], help="run this mutation again; may be repeated")
    parser.add_argument("--fresh", action="store_true", help="discard all results; otherwise a run resumes")
    parser.add_argument("--quick", action="store_true", help="run only the named tests, no whole programs; a mutation that they don't catch stays open")
    parser.add_argument("--count", metavar="N", type=int, help="stop after N mutations")
    parser.add_argument("--ninja", default="ninja", help="the build command, which may have arguments (default: ninja)")
    options = parser.parse_args()

    mutations = readMutations()
    if unknown := set(options.again) - {m.name for m in mutations}:
        raise Failure(f'--again: no mutation has the name "{unknown.pop()}"; --list prints all names')
    pattern = options.only if set(options.only) & set("*?") else f"*{options.only}*"
    chosen = [m for m in mutations if fnmatch.fnmatch(m.name, pattern) or fnmatch.fnmatch(m.file, pattern)]
    if not chosen:
        raise Failure(f'--only: no mutation\'s name or file matches "{options.only}"; --list prints them')
    WORK.mkdir(parents=True, exist_ok=True)
    results = {} if options.fresh or not RESULTS.exists() else json.loads(RESULTS.read_text())
    done = results.setdefault("mutations", {})
    if not options.list:
        ninja = options.ninja.split()
        copyTree()
        configure()
        texts = {f: (TREE / f).read_text() if (TREE / f).exists() else "" for f in {m.file for m in chosen}}
        pending = [m for m in chosen if m.name in options.again or
                   done.get(m.name, {}).get("outcome") != "caught" or done[m.name]["key"] != m.key(texts[m.file])]
        pending = pending[:options.count]
        checkTestsPass(pending, ninja, results)
        for number, mutation in enumerate(pending, 1):
            print(f"[{number}/{len(pending)}] {mutation.name}: ", end="", flush=True)
            done[mutation.name] = result = seed(mutation, ninja, options.quick)
            store(results)
            print(f"{result['outcome']} ({result['by']}), {result['seconds']} s", flush=True)
    return 0 if table(chosen, results) else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Failure as failure:
        sys.exit(f"mutate.py: {failure}")
    except KeyboardInterrupt:
        sys.exit(130)
