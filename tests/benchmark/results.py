#!/usr/bin/env python3
"""Writes RESULTS.md: the tables of results/*.csv, with their dates, machines and commands.

    tests/benchmark/results.py                     writes RESULTS.md
    tests/benchmark/results.py --check             fails if RESULTS.md is not what the CSV files give
    PROGRAM … | tests/benchmark/results.py --store NAME --command "PROGRAM …" [--machine TEXT] [--table N]
                                                   first stores table N (from 1) of a program's output in NAME.csv

A CSV file begins with comments `# key: text`: section, caption, command, date, machine and plot. A key may be repeated:
a caption is one text, each command and each plot is one of several. Numbers are stored without separators of thousands.
"""
import argparse
import csv
import datetime
import io
import pathlib
import re
import sys
import textwrap

HERE = pathlib.Path(__file__).resolve().parent
FOLDER = HERE / "results"
KEYS = ("section", "caption", "command", "date", "machine", "plot")

# The sections of the page, in order, and the tables of each.
SECTIONS = {
    "Shared workloads": ["workloads", "workloads_apart"],
    "Two meshes": ["two_meshes", "trees_bytes"],
    "The tolerance query": ["tolerance"],
    "Convex polytopes": ["polytopes", "polytopes_ninety", "polytopes_built"],
    "Convex polytopes in small steps": ["polytopes_steps", "polytopes_rounds"],
    "Boxes that move": ["moving_boxes"],
    "Fronts of meshes in small steps": ["fronts"],
    "Bounding volumes under one traversal": ["volume_trees_bunny_torus", "volume_trees_link_box"],
    "Bounding volumes in seven scenes": ["scenes", "scenes_ratios"],
    "What a query costs": ["inspect_cost", "time_model"],
    "Parallel close proximity": ["proximity_slopes", "proximity_smallest_gap", "proximity_placements", "thickness"],
    "Scaling": ["scaling", "scaling_growth"],
    "Refitting": ["refit"],
    "Run time against error": ["edge_error_closed_forms", "edge_error_cubicles", "edge_error_twisted_tubes"],
    "What a certified edge costs": ["edge_cost"],
    "Many bodies": ["many_bodies", "many_bodies_plans", "many_movers"],
    "Clouds and maps": ["clouds", "clouds_plans"],
    "Equal meshes": ["equal_meshes", "equal_meshes_plans"],
    "What sampling does on the same problems": ["sampling", "sampling_resolutions"],
    "Whole plans": ["whole_plans"],
    "OMPL.app's problems": ["omplapp"],
    "Real arms": ["real_arms"],
    "Simplifying": ["simplifying"],
    "Clearance": ["clearance", "clearance_runs"],
    "Against sampling with OMPL's simplifier": ["ompl_simplifier"],
    "Verifying": ["verifying"],
    "Restarts": ["restarts"],
    "Time laws": ["time_laws", "time_laws_jerk"],
    "Trajectories": ["trajectories", "trajectories_limits", "trajectories_variants"],
    "Python": ["python"],
    "Campaigns of many runs": ["campaigns", "campaigns_whole", "campaigns_page"],
    "Handing out runs": ["ranks"],
}


def read(path):
    """Returns the comments of a CSV file, as lists by key, and its rows, the header first."""
    comments, lines = {key: [] for key in KEYS}, path.read_text().splitlines()
    while lines and lines[0].startswith("#"):
        found = re.fullmatch(r"# (\w+): (.+)", lines.pop(0))
        if not found or found[1] not in KEYS:
            sys.exit(f"{path}: a comment is `# key: text`; the keys are {', '.join(KEYS)}")
        comments[found[1]].append(found[2])
    rows = list(csv.reader(lines))
    if len(rows) < 2 or any(len(row) != len(rows[0]) for row in rows):
        sys.exit(f"{path}: it has no rows, or rows of different lengths")
    for key in ("section", "caption", "command", "date", "machine"):
        if not comments[key] or (len(comments[key]) > 1 and key not in ("caption", "command")):
            sys.exit(f"{path}: one `# {key}:` is needed")
    return comments, rows


def shown(cell):
    """Returns a cell for people: numbers from 1,000 on get separators."""
    if not re.fullmatch(r"-?\d{4,}(\.\d+)?", cell):
        return cell.replace("|", "\\|")
    whole, point, rest = cell.partition(".")
    return f"{int(whole):,}{point}{rest}"


def is_number(cell):
    return re.fullmatch(r"-?[\d.,]*(e-?\d+)?", cell) is not None


def wrapped(text):
    return "\n".join(textwrap.wrap(text, 120, break_long_words=False, break_on_hyphens=False))


def table_text(name):
    comments, rows = read(FOLDER / f"{name}.csv")
    columns = list(zip(*rows[1:]))
    marks = ["--:" if all(map(is_number, column)) else "---" for column in columns]
    lines = [wrapped(" ".join(comments["caption"])), "", *(f"    {command}" for command in comments["command"]), "",
             "| " + " | ".join(cell.replace("|", "\\|") for cell in rows[0]) + " |", "|" + "|".join(marks) + "|",
             *("| " + " | ".join(map(shown, row)) + " |" for row in rows[1:]), "",
             wrapped(f"Date: {comments['date'][0]}. Machine: {comments['machine'][0]}. "
                     f"[{name}.csv](results/{name}.csv)")]
    for plot in comments["plot"]:
        file, _, title = plot.partition(" ")
        lines += ["", f"![{title}]({file})"]
    return "\n".join(lines) + "\n"


def page():
    named = [name for names in SECTIONS.values() for name in names]
    if sorted(named) != sorted(path.stem for path in FOLDER.glob("*.csv")):
        sys.exit(f"{FOLDER} and SECTIONS have different tables: "
                 f"{sorted(set(named) ^ {path.stem for path in FOLDER.glob('*.csv')})}")
    text = "# Results\n\n" + wrapped(
        "The figures of this project. `tests/benchmark/results.py` writes this page from the CSV files in "
        "[results/](results); don't edit it. [README.md](README.md) lists the programs, and says how to run them and "
        "what the figures show. The figures of the paper on OBBTrees are in [PAPER.md](PAPER.md). "
        "N_v is the number of tests of bounding volumes, N_p that of triangles: they are exact, and the same in every "
        "run. Times of a busy machine are meaningful only as ratios. *Wide*: our 4-wide OBB tree. *Reference*: our "
        "binary tree of OBBs. FCL is Debian's, version 0.7.") + "\n"
    for section, names in SECTIONS.items():
        text += f"\n## {section}\n"
        for name in names:
            if read(FOLDER / f"{name}.csv")[0]["section"] != [section]:
                sys.exit(f"{name}.csv names another section than SECTIONS")
            text += "\n" + table_text(name)
    return text


def tables_of(output):
    """Returns the tables in a program's output, Markdown or CSV, as lists of rows."""
    found, last = [], None
    for line in output.splitlines():
        kind = "|" if line.startswith("|") else "," if "," in line and not line.startswith("#") else None
        if kind and kind != last:
            found.append([])
        if kind == "|" and not re.fullmatch(r"[|:\- ]+", line):
            found[-1].append([cell.strip() for cell in line.strip().strip("|").split("|")])
        elif kind == ",":
            found[-1].append(next(csv.reader([line])))
        last = kind
    return [rows for rows in found if len(rows) > 1 and len({len(row) for row in rows}) == 1]


def machine():
    processor = re.search(r"model name\s*: (.+)", pathlib.Path("/proc/cpuinfo").read_text())
    load = pathlib.Path("/proc/loadavg").read_text().split()[0]
    return f"{processor[1] if processor else 'unknown processor'}, load {load}"


def store(name, arguments):
    tables = tables_of(sys.stdin.read())
    if not 1 <= arguments.table <= len(tables):
        sys.exit(f"--table {arguments.table}: the input has {len(tables)} tables")
    path = FOLDER / f"{name}.csv"
    section = next((section for section, names in SECTIONS.items() if name in names), None)
    if section is None:
        sys.exit(f"--store {name}: add the name to SECTIONS first")
    old = read(path)[0] if path.exists() else {"caption": ["(to be written)"], "plot": []}
    text = io.StringIO()
    text.write(f"# section: {section}\n")
    for line in old["caption"]:
        text.write(f"# caption: {line}\n")
    text.write(f"# command: {arguments.command}\n# date: {datetime.date.today()}\n"
               f"# machine: {arguments.machine or machine()}\n")
    for plot in old["plot"]:
        text.write(f"# plot: {plot}\n")
    writer = csv.writer(text, lineterminator="\n")
    for row in tables[arguments.table - 1]:
        writer.writerow(re.sub(r"(?<=\d),(?=\d{3}\b)", "", cell) if is_number(cell) else cell for cell in row)
    path.write_text(text.getvalue())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="fail if RESULTS.md is not what the CSV files give")
    parser.add_argument("--store", metavar="NAME", help="store a table from stdin in results/NAME.csv")
    parser.add_argument("--command", help="the command that printed the table")
    parser.add_argument("--machine", help="the machine, and what else it did (default: processor and load)")
    parser.add_argument("--table", type=int, default=1, help="which of the tables in the input (default 1)")
    arguments = parser.parse_args()
    if arguments.store:
        if not arguments.command:
            parser.error("--command is required with --store")
        store(arguments.store, arguments)
    text = page()
    if arguments.check:
        sys.exit(0 if (HERE / "RESULTS.md").read_text() == text else
                 "RESULTS.md is not what the CSV files give; run tests/benchmark/results.py")
    (HERE / "RESULTS.md").write_text(text)


if __name__ == "__main__":
    main()
