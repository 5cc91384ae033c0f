#!/usr/bin/env python3
"""Writes PAPER.md: the experiments of the paper on OBBTrees, repeated, beside its figures.

    tests/benchmark/paper.py              runs the programs, stores their CSV in paper/, and writes PAPER.md
    tests/benchmark/paper.py --write      writes PAPER.md from the CSV that is there
    tests/benchmark/paper.py --only fits  runs one program (overlap, fits, interlocked or proximity), then writes PAPER.md

The programs must be built: ninja -C build/release benchmarks. All numbers of PAPER.md come from the CSV; the figures of
the original are those in ORIGINAL.
"""
import argparse
import csv
import io
import math
import os
import pathlib
import statistics
import subprocess
import sys

sys.dont_write_bytecode = True
import verdicts  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PROGRAMS = {
    "overlap": ["overlap_benchmark"],
    "fits": ["fit_benchmark", "--most", "1000000", "--out", str(HERE / "plots")],
    "interlocked": ["interlocked_benchmark"],
    "proximity": ["proximity_benchmark", "--frequency", "71"],
}
# Microseconds of 1996, on the slide "one overlap test".
ORIGINAL = {"SAT": (5, 7), "GJK": (45, 105), "LP": (180, 230)}


def blocks(name):
    """Returns the CSV blocks of a program's output: lists of dictionaries. Other text is skipped."""
    found = []
    for part in (HERE / "paper" / f"{name}.csv").read_text().split("\n\n"):
        lines = [line for line in part.splitlines() if line]
        if len(lines) > 1 and all("," in line and "|" not in line for line in lines):
            found.append(list(csv.DictReader(io.StringIO("\n".join(lines)))))
    return found


def number(text, digits=3):
    """Returns a number with so many significant digits, without an exponent up to a million."""
    value = float(text)
    if value == 0:
        return "0"
    places = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:,.{places}f}" if abs(value) < 1e6 or places else f"{value:,.0f}"


def table(header, rows, left=1):
    lines = ["| " + " | ".join(header) + " |",
             "|" + "|".join(["---"] * left + ["--:"] * (len(header) - left)) + "|"]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def overlap_section():
    costs, operations = blocks("overlap")[-2:]
    ns = {row["test"]: float(row["ns"]) for row in costs}
    names = {"SAT": "separating axes", "GJK": "closest features (ours: GJK)", "LP": "linear programming"}
    rows = []
    for key, name in names.items():
        low, high = ORIGINAL[key]
        then = "1" if key == "SAT" else f"{low / ORIGINAL['SAT'][1]:.0f} to {high / ORIGINAL['SAT'][0]:.0f}"
        rows.append([name, f"{low} to {high}", then, number(ns[key]), number(ns[key] / ns["SAT"])])
    rows.append(["closest features (V-Clip, cold; also gives the distance)", "", "", number(ns["V-Clip"]),
                 number(ns["V-Clip"] / ns["SAT"])])
    rows.append(["144 edges against faces", "", "", number(ns["edges, faces"]),
                 number(ns["edges, faces"] / ns["SAT"])])
    rows.append(["the kernel of the 4-wide tree, a pair", "", "", number(ns["wide"]),
                 number(ns["wide"] / ns["SAT"])])
    count = operations[0]
    text = "## One overlap test\n\n    overlap_benchmark\n\n"
    text += table(["test", "1996, µs", "as multiples of separating axes", "now, ns", "as multiples"], rows)
    text += (f"\nA test by separating axes takes {count['operations_least']} to {count['most']} arithmetic operations, "
             f"{number(count['mean'])} in the mean: {number(count['sums'])} sums,\n{number(count['products'])} products, "
             f"{number(count['comparisons'])} comparisons and {number(count['absolutes'])} absolute values. This includes "
             "computing the relative pose\nof the boxes, and the margins for all rounding.\n")
    return text, ns, count


def interlocked_section():
    rows = blocks("interlocked")[0]
    text = "## Whole queries along a path\n\n    interlocked_benchmark\n\n"
    text += (f"A wrinkled torus of 100,000 triangles moves through eight rings of 18,496 triangles, {rows[0]['steps']} "
             f"steps, in close\nproximity; the models touch at {rows[0]['contacts']} of them. *Predicted* is "
             "N_v·(C_v + traversal) + N_p·C_p at the odd steps, with\ncosts measured at the even ones.\n\n")
    us = {row["volume"]: float(row["us"]) for row in rows}
    text += table(
        ["volume", "N_v", "N_p", "µs a step", "C_v ns", "traversal ns", "C_p ns", "predicted µs", "measured µs", "MB",
         "build ms"],
        [[row["volume"], number(row["bv_tests"]), number(row["triangle_tests"]), number(row["us"])]
         + [number(row[key]) if row[key] else "–" for key in
            ("bv_test_ns", "traversal_ns", "triangle_test_ns", "predicted_us", "measured_us")]
         + [number(float(row["bytes"]) / 1e6), number(row["build_ms"])] for row in rows])
    return text, us, rows


def proximity_section():
    found = blocks("proximity")
    curve, slopes = found[0], found[1]
    size = slopes[0]["triangles"]
    names = [row["volume"] for row in slopes]
    text = "## Parallel close proximity\n\n    proximity_benchmark --frequency 71\n\n"
    text += (f"Two concentric spheres of {int(size):,} triangles. The slope of log N_v over log 1/gap; *unsaturated*: only "
             "gaps at which\nfewer than one test in 100 is of triangles. A slope of 1 means that N_v grows like 1/gap, of "
             "2 that it grows like\n1/gap². The [plot](plots/proximity_tests_994580.svg) is of spheres of 994,580 "
             "triangles.\n\n")
    text += table(["", *names], [["all gaps", *(number(row["slope_all_gaps"]) for row in slopes)],
                                 ["unsaturated", *(number(row["slope_unsaturated"]) for row in slopes)]])
    gaps = sorted({float(row["gap"]) for row in curve}, reverse=True)
    text += "\nN_v at each gap (radius 1):\n\n"
    text += table(["gap", *names], [[f"{gap:.3g}"] + [
        number(next(row["bv_tests"] for row in curve if row["volume"] == name and float(row["gap"]) == gap))
        for name in names] for gap in gaps])
    return text, {row["volume"]: float(row["slope_unsaturated"]) for row in slopes}


def fits_section():
    queries, levels, growth = blocks("fits")
    text = "## The three fits\n\n    fit_benchmark --most 1000000 --out plots\n\n"
    text += ("Models: a tessellated sphere; an ellipsoid with one finely tessellated end (*uneven*); an ellipsoid with "
             "small spheres\nburied in one part of it (*buried*). Queries against a torus of 5,000 triangles at 500 random "
             "poses.\nEach cell: N_v, N_p, µs a query, ms to build.\n\n")
    fits = ["vertices", "triangles", "hull"]
    rows = []
    for model in dict.fromkeys(row["model"] for row in queries):
        for tree in dict.fromkeys(row["tree"] for row in queries):
            cells = []
            for fit in fits:
                row = next(r for r in queries if (r["model"], r["tree"], r["fit"]) == (model, tree, fit))
                cells.append(", ".join(number(row[key]) for key in ("bv_tests", "triangle_tests", "us", "build_ms")))
            rows.append([model, tree, *cells])
    text += table(["model", "tree", *fits], rows, left=2)
    text += ("\nThe sum of the volumes of the boxes at a level of the binary OBB tree, as a share of the root's volume with "
             "the fit\nto triangles:\n\n")
    depths = sorted({int(row["level"]) for row in levels})
    rows = []
    for model in dict.fromkeys(row["model"] for row in levels):
        for fit in fits:
            cells = [next((number(r["volume"]) for r in levels
                           if (r["model"], r["fit"], int(r["level"])) == (model, fit, depth)), "") for depth in depths]
            rows.append([model, fit, *cells])
    text += table(["model", "fit", *(f"level {depth}" for depth in depths)], rows, left=2)
    text += ("\nBuilding a binary OBB tree over tori, ms. The curves through the first point: n·log n for *triangles*, "
             "n·log² n for\n*hull*.\n\n![time of building over n](plots/fit_building.svg)\n\n")
    sizes = list(dict.fromkeys(row["triangles"] for row in growth))
    rows = []
    for size in sizes:
        cells = [f"{int(float(size)):,}"]
        for fit in fits:
            row = next((r for r in growth if r["fit"] == fit and r["triangles"] == size), None)
            cells.append(number(row["build_ms"]) if row else "")
            if fit != "vertices":
                cells.append(number(row["n_log_n" if fit == "triangles" else "n_log2_n"]) if row else "")
        rows.append(cells)
    text += table(["triangles", "vertices", "triangles", "n·log n", "hull", "n·log² n"], rows, left=0)
    return text, queries, growth


def result(name):
    """Returns the rows of a table in results/, without its comments."""
    lines = [line for line in (HERE / "results" / f"{name}.csv").read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def speed_up(name):
    """Returns how much faster whole queries are with OBBs than with AABBs, in a table of bounding volumes."""
    us = {row["volume"]: float(row["interference_us"]) for row in result(name) if row["building"] == "top-down"}
    return us["aabb"] / us["obb"]


def speed_ups_of_scenes():
    """Returns how much faster whole queries are with OBBs than with AABBs, in the scenes of results/scenes.csv."""
    us = {(row["scene"], row["volume"]): float(row["us"]) for row in result("scenes") if row["building"] == "top-down"}
    return [us[scene, "aabb"] / us[scene, "obb-binary"] for scene, volume in us if volume == "aabb"]


def page():
    overlap, ns, count = overlap_section()
    interlocked, us, steps = interlocked_section()
    proximity, slopes = proximity_section()
    fits, queries, growth = fits_section()
    gjk, lp = ns["GJK"] / ns["SAT"], ns["LP"] / ns["SAT"]
    aabb = [us["aabb"] / us["obb-binary"], speed_up("volume_trees_bunny_torus"), speed_up("volume_trees_link_box"),
            *speed_ups_of_scenes()]
    least, most, mean = (float(count[key]) - float(count["posing"]) for key in ("operations_least", "most", "mean"))
    priced = [r for r in steps if r["bv_test_ns"]]
    fitted = [float(r["predicted_us"]) / float(r["measured_us"]) for r in priced]
    # Without the term for the traversal, which is what is left of the time at the even steps.
    alone = [(float(r["bv_tests"]) * float(r["bv_test_ns"])
              + float(r["triangle_tests"]) * float(r["triangle_test_ns"] or 0)) / 1000 / float(r["measured_us"])
             for r in priced]
    models = result("time_model")
    alone += [float(r["alone"]) for r in models]
    elsewhere = [float(r["elsewhere"]) for r in models if r["elsewhere"]]
    touching = len({r["scene"] for r in models if int(r["contacts"]) > 0})

    def right(ratios):
        return f"{sum(map(verdicts.predicts, ratios))} of {len(ratios)} within the rule"

    def times(fit):
        return [(float(r["triangles"]), float(r["build_ms"])) for r in growth if r["fit"] == fit]

    def counted(model, fit, tree="obb-binary"):
        return float(next(r["bv_tests"] for r in queries if (r["model"], r["tree"], r["fit"]) == (model, tree, fit)))

    def volume(model, fit):
        levels = blocks("fits")[1]
        return float(next(r["volume"] for r in levels if (r["model"], r["fit"], r["level"]) == (model, fit, "6")))

    def compared(model, worse, better):
        volumes = volume(model, worse) / volume(model, better)
        trees = [counted(model, worse, tree) / counted(model, better, tree) for tree in ("obb", "obb-binary", "rss")]
        return volumes, trees, (f"boxes at level 6: {number(volumes)} times as large by {worse} as by {better}; N_v: "
                                f"{number(min(trees))} to {number(max(trees))} times as many tests")

    uneven, uneven_trees, uneven_text = compared("uneven", "vertices", "triangles")
    buried, buried_trees, buried_text = compared("buried", "triangles", "hull")
    hull = min(n for n, _ in times("hull")), max(n for n, _ in times("hull"))
    triangles = [(n, t) for n, t in times("triangles") if hull[0] <= n <= hull[1]]
    others = [slope for name, slope in slopes.items() if name in ("aabb", "sphere", "kdop14", "kdop18", "kdop26")]
    bound = verdicts.exponent([(n, n * math.log(n)) for n, _ in times("triangles")])
    rows = [
        ["separating axes are faster than closest features", "6 to 21 times", f"{number(gjk)} times",
         f"at least 6 ± {verdicts.NOISE:.0%}", verdicts.at_least(gjk, 6), "`overlap_benchmark`"],
        ["… by V-Clip", "6 to 21 times", f"{number(ns['V-Clip'] / ns['SAT'])} times",
         f"at least 6 ± {verdicts.NOISE:.0%}", verdicts.at_least(ns["V-Clip"] / ns["SAT"], 6), "`overlap_benchmark`"],
        ["… and than linear programming", "26 to 46 times", f"{number(lp)} times",
         f"at least 26 ± {verdicts.NOISE:.0%}", verdicts.at_least(lp, 26), "`overlap_benchmark`"],
        ["an overlap test takes fewer than 200 operations", "< 200",
         f"{least:.0f} to {most:.0f}, mean {number(mean)}, for a given relative pose; margins for rounding included",
         "all tests; *depends*: the mean", verdicts.below(least, mean, most, 200), "`overlap_benchmark`"],
        ["whole queries: OBBs against AABBs", "3.6 to 15 times faster (see below)",
         f"{number(min(aabb))} to {number(max(aabb))} times, median {number(sorted(aabb)[len(aabb) // 2])}, in {len(aabb)} "
         "scenes",
         f"at least 3.6 ± {verdicts.NOISE:.0%} in all", verdicts.all_at_least(aabb, 3.6),
         "`interlocked_benchmark`, `volume_tree_benchmark`, `scenes.py`"],
        ["T = N_v·C_v + N_p·C_p", "the model",
         f"predicted/measured {min(alone):.2f} to {max(alone):.2f}, median {statistics.median(alone):.2f}; {right(alone)}; "
         f"{touching} of the {len({r['scene'] for r in models}) + 1} scenes have contacts, "
         "one is parallel close proximity",
         "0.8 to 1.25 for all volumes in all scenes; *depends*: half of them", verdicts.model(alone),
         "`interlocked_benchmark`, `time_model.py`"],
        ["… with the fixed cost of a query, and a traversal term fitted in another scene", "",
         f"predicted/measured {min(elsewhere):.2f} to {max(elsewhere):.2f}, median {statistics.median(elsewhere):.2f}; "
         f"{right(elsewhere)}",
         "the same", verdicts.model(elsewhere), "`time_model.py`"],
        ["parallel close proximity: N_v grows more slowly for OBBs than for AABBs and spheres", "a smaller slope",
         f"{number(slopes['obb'])} against {number(slopes['aabb'])} and {number(slopes['sphere'])}",
         "smaller by 0.1 than all slopes of fixed directions", verdicts.flatter(slopes["obb"], others),
         "`proximity_benchmark`"],
        ["building takes O(n log n)", "n log n",
         f"n^{verdicts.exponent(times('triangles')):.2f}; n·log n has n^{bound:.2f} here",
         "nearer to n·log n than to n·log² n", verdicts.n_log_n(times("triangles")), "`fit_benchmark`"],
        ["… with hulls a factor log n more", "n log² n",
         f"n^{verdicts.exponent(times('hull')):.2f}; by triangles n^{verdicts.exponent(triangles):.2f}",
         "at least half of the exponent of log n more", verdicts.log_factor(times("hull"), triangles), "`fit_benchmark`"],
        ["points alone mislead where tessellation is uneven", "a claim", uneven_text,
         "both 1.25 times as large, N_v in all trees; *depends*: one of them", verdicts.misleads(uneven, uneven_trees),
         "`fit_benchmark`"],
        ["buried points mislead; a fit to the hull does not see them", "a claim", buried_text,
         "both 1.25 times as large, N_v in all trees; *depends*: one of them", verdicts.misleads(buried, buried_trees),
         "`fit_benchmark`"],
    ]
    return f"""# The paper, thirty years on

S. Gottschalk, M. Lin, D. Manocha: OBBTree: A Hierarchical Structure for Rapid Interference Detection, SIGGRAPH 1996.
This page repeats its experiments in kind, with models made here, and puts our figures beside those of the paper's
slides. `tests/benchmark/paper.py` runs the programs and writes this page from their [CSV](paper); don't edit it. The
programs are built by `ninja -C build/release benchmarks`. Times are of one core of a busy shared machine.

{table(["claim", "then", "now", "rule", "verdict", "program"], rows, left=6)}
The rules are in [verdicts.py](verdicts.py); a test gives each of them figures for which it must fail. C_v and C_p are
measured alone, outside of a query ([table](RESULTS.md#what-a-query-costs)). So the equation leaves out what a query
costs besides its tests: the traversal of the trees, and a fixed cost. k-DOPs have a large fixed cost, because they
prepare each query for one to three microseconds. The second row of the equation has both terms; the traversal was
fitted in another scene, so it could fail. If the traversal is fitted to the even steps of the path of
`interlocked_benchmark`, it predicts the odd ones to {min(fitted):.2f} to {max(fitted):.2f}: such a term cannot fail.

The slide with whole queries gives 1/7 to 1/5 s for OBBs and 1/25 to 1/75 s for AABBs. These two rows look swapped. The
table above has the ratio of the swapped rows.

The formulas for mean and covariance by triangles are printed with a slip: the mean divides by the triangles' areas
where the covariance multiplies by them. Both multiply (`collision/volumes/moments.h`).

{overlap}
{interlocked}
{proximity}
{fits}
## Not repeated

RAPID and PQP are not packages of Debian, so they are not measured. The paper's models are not public. The figures of
the paper that are not in the table are not at hand.
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="run no program")
    parser.add_argument("--check", action="store_true", help="fail if PAPER.md is not what the CSV gives")
    parser.add_argument("--only", choices=sorted(PROGRAMS), help="run only this program")
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build/release/tests", metavar="FOLDER",
                        help="the folder of the programs (build/release/tests)")
    arguments = parser.parse_args()
    if not (arguments.write or arguments.check):
        for name, (program, *options) in PROGRAMS.items():
            if arguments.only in (None, name):
                if not (arguments.programs / program).exists():
                    sys.exit(f"{arguments.programs / program}: no such program; build it first: "
                             "ninja -C build/release benchmarks")
                # Without shared data, every machine measures the same models.
                own = {key: value for key, value in os.environ.items() if key != "CORRIDOR_DATA"}
                output = subprocess.run([arguments.programs / program, *options], check=True, capture_output=True,
                                        text=True, env=own).stdout
                (HERE / "paper" / f"{name}.csv").write_text(output)
    text = page()
    if arguments.check:
        sys.exit(0 if (HERE / "PAPER.md").read_text() == text else
                 "PAPER.md is not what its CSV gives; run tests/benchmark/paper.py --write")
    (HERE / "PAPER.md").write_text(text)


if __name__ == "__main__":
    main()
