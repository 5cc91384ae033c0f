#!/usr/bin/env python3
"""Writes collision/COURSE.md: the topics of the course, each with its code, a command, a claim, a rule, and the verdict.

    tests/benchmark/course.py                   runs every command, stores the figures, and writes the page
    tests/benchmark/course.py --only "bottom-up" runs the rows whose topic contains this text, and prints their outputs;
                                                 the page is written if all other rows have figures
    tests/benchmark/course.py --write           writes the page from the stored figures
    tests/benchmark/course.py --check           fails if the page is not what rows and figures give, or a topic is missing
    tests/benchmark/course.py --inputs FOLDER   makes the inputs of the commands, to run them by hand

Rows are in course/rows.toml, which explains them; figures are stored in course/figures.json. Needs the program, the
tests and nothing else: ./corridor test, or ninja -C build/release.
"""
import argparse
import csv
import json
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import tomllib

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
ROWS, FIGURES, PAGE = HERE / "course/rows.toml", HERE / "course/figures.json", ROOT / "collision/COURSE.md"
HOLDS, OPEN, FAILS = "holds", "not decided", "does not hold"
TOPICS = [f"A{i}" for i in range(1, 60)] + [f"B{i}" for i in range(1, 34)] + [f"C{i}" for i in range(1, 7)]
KEY = re.compile(r"^([a-z_0-9]+)=(-?[0-9.e+-]+)$", re.MULTILINE)


def table_figure(name, where, column):
    """Returns the first number of a cell of results/NAME.csv: `where` is the text of the first cells, with commas."""
    lines = [line for line in (HERE / "results" / f"{name}.csv").read_text().splitlines() if not line.startswith("#")]
    header, *rows = csv.reader(lines)
    for row in rows:
        if ",".join(row).startswith(where.strip('"') + ","):
            return float(re.match(r"[0-9.,]+", row[header.index(column)]).group().replace(",", ""))
    raise KeyError(f"{name}.csv: no row {where}")


def output_of(command, folder):
    """Runs a command of a row, and returns what it prints."""
    if command.startswith("tests: "):
        program, gtest = command.removeprefix("tests: ").split(" ", 1)
        words = [str(ROOT / "build/release/tests" / program), f"--gtest_filter={gtest}"]
    else:
        words = [str(PROGRAM), *command.replace("problems/", f"{ROOT}/problems/").split()[1:]]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
    return done.stdout + done.stderr + f"exit={done.returncode}\n"


def matched(pattern, output):
    """Returns the figure that a pattern of rows.toml finds in an output, None if no line matches."""
    over = {"median": statistics.median, "least": min, "largest": max, "count": len}
    word, _, rest = pattern.partition(" ")
    hits = re.findall(rest if word in over else pattern, output, re.MULTILINE)
    if not hits:
        return None
    if word in over:
        return over[word]([float(hit) for hit in hits])
    return float(hits[-1]) if re.fullmatch(r"-?[0-9.]+(e[+-]?\d+)?", hits[-1]) else len(hits)


def figures_of(row, folder, show=False):
    """Runs the commands of a row, and returns its figures, by name."""
    found = {}
    for prefix, command in row["run"].items():
        if command.startswith("table: "):
            output = ""
        else:
            output = output_of(command, folder)
            if show:
                print(f"$ {command}\n{output}")
        for key, value in KEY.findall(output):
            found[f"{prefix}.{key}"] = float(value)
        for key, pattern in row.get("figures", {}).get(prefix, {}).items():
            if command.startswith("table: "):
                where, _, column = pattern.rpartition(" / ")
                found[f"{prefix}.{key}"] = table_figure(command.removeprefix("table: "), where, column)
                continue
            value = matched(pattern, output)
            if value is None:
                sys.exit(f"{row['topic']}: {command}: its output has no {pattern}:\n{output[-1500:]}")
            found[f"{prefix}.{key}"] = value
    return {name: found[name] for name in sorted(names_of(row))}


def names_of(row):
    """Returns the names of the figures in the rule of a row."""
    return set(re.findall(r"\b[a-z]\.[a-z_0-9]+", row["rule"]))


def holds(row, figures):
    """Evaluates the rule of a row, an expression of numbers and names of figures. @throws KeyError for the name of a figure
    that is not there, ValueError for other text."""
    expression = re.sub(r"\b[a-z]\.[a-z_0-9]+", lambda name: repr(figures[name.group()]), row["rule"])
    words = set(re.findall(r"\b[A-Za-z_]\w*", expression))
    if not re.fullmatch(r"[\w.+\-*/()<>=!, ]+", expression) or words - {"and", "or", "not", "max", "min"}:
        raise ValueError(f"{row['topic']}: {expression} is no rule")
    return bool(eval(expression, {"__builtins__": {}}, {"max": max, "min": min}))  # pylint: disable=eval-used


def verdict(row, figures):
    """Says whether the claim holds. Times of one run differ by 15 % from those of the next: a rule that another time
    within this noise would turn is not decided."""
    found = holds(row, figures)
    for name in (n for n in figures if re.search(r"ns$|_ms|ms_", n)):
        for factor in (1 + NOISE, 1 / (1 + NOISE)):
            if holds(row, {**figures, name: factor * figures[name]}) != found:
                return OPEN
    return HOLDS if found else FAILS


def number(value):
    return f"{value:,.0f}" if abs(value) >= 1000 or value == int(value) else f"{value:.3g}"


def page(rows, stored):
    text = (HERE / "course/head.txt").read_text()
    for section in dict.fromkeys(row["section"] for row in rows):
        text += f"\n## {section}\n\n| topic | code | command | claim | rule | figures | verdict |\n|---|---|---|---|---|---|---|\n"
        for row in (r for r in rows if r["section"] == section):
            names = list(row["run"])
            commands = "; ".join((f"{name}: " if len(names) > 1 else "") + shown(command)
                                 for name, command in row["run"].items())
            figures = stored[row["topic"]]

            def short(words, single=len(names) == 1):
                return re.sub(r"\b[a-z]\.", "", words) if single else words

            listed = ", ".join(f"{short(name)} = {number(value)}" for name, value in figures.items())
            cells = [f"{row['topic']} ({', '.join(row['topics'])})", row["code"], commands, row["claim"],
                     f"`{short(row['rule'])}`", listed, verdict(row, figures)]
            text += "| " + " | ".join(cells) + " |\n"
    return text + "\n" + (HERE / "course/tail.txt").read_text()


def shown(command):
    if command.startswith("table: "):
        name = command.removeprefix("table: ")
        return f"[{name}.csv](../tests/benchmark/results/{name}.csv)"
    return f"`{command}`"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", metavar="TEXT")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--inputs", type=pathlib.Path, metavar="FOLDER")
    arguments = parser.parse_args()
    rows = tomllib.loads(ROWS.read_text())["row"]
    missing = set(TOPICS) - {topic for row in rows for topic in row["topics"]} - set(
        re.findall(r"\b[ABC]\d+\b", (HERE / "course/tail.txt").read_text()))
    if missing:
        sys.exit(f"{ROWS}: no row has the topics {', '.join(sorted(missing))}")
    if arguments.inputs:
        arguments.inputs.mkdir(parents=True, exist_ok=True)
        return make_inputs(arguments.inputs)
    stored = json.loads(FIGURES.read_text()) if FIGURES.exists() else {}
    if not (arguments.write or arguments.check):
        if arguments.only and not any(arguments.only in row["topic"] for row in rows):
            sys.exit(f"--only: no topic contains {arguments.only}")
        with tempfile.TemporaryDirectory() as folder:
            make_inputs(pathlib.Path(folder))
            for row in rows:
                if arguments.only and arguments.only not in row["topic"]:
                    continue
                stored[row["topic"]] = figures_of(row, folder, bool(arguments.only))
                print(f"{verdict(row, stored[row['topic']])}: {row['topic']}: {row['rule']}: "
                      f"{stored[row['topic']]}", flush=True)
        stored = {row["topic"]: stored[row["topic"]] for row in rows if row["topic"] in stored}
        FIGURES.write_text(json.dumps(stored, indent=1, ensure_ascii=False) + "\n")
    unknown = [row["topic"] for row in rows if names_of(row) - stored.get(row["topic"], {}).keys()]
    if unknown:
        message = f"{PAGE.name} is not written: figures are missing for the rows {'; '.join(unknown)}"
        return print(message) if arguments.only else sys.exit(f"{message}; run tests/benchmark/course.py --only TEXT")
    text = page(rows, stored)
    if arguments.check:
        sys.exit(0 if PAGE.read_text() == text else f"{PAGE.name} is not what its rows and figures give; run "
                 "tests/benchmark/course.py --write")
    PAGE.write_text(text)


# pylint: disable=wrong-import-position
from course_inputs import PROGRAM, make_inputs  # noqa: E402
from verdicts import NOISE  # noqa: E402

if __name__ == "__main__":
    main()
