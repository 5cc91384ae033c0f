"""The rules by which PAPER.md says that a claim of the paper holds. They were written when some of the figures were
known; none was moved to let a claim hold.

Times of one run differ by up to 15 % from those of the next (`NOISE`), so no time decides a claim whose bound is nearer
than that. `tests/repository/verdicts_test.py` gives each rule figures for which it must fail.
"""
import math

NOISE = 0.15
HOLDS, LESS, OPEN, DEPENDS, FAILS = ("holds", "faster, by less than claimed", "not decided: within the noise of its bound", "depends",
                                     "does not hold here")


def at_least(ratio, bound):
    """A ratio of times against the least ratio of the claim."""
    if ratio >= bound * (1 + NOISE):
        return HOLDS
    if ratio > bound * (1 - NOISE):
        return OPEN
    return LESS if ratio > 1 + NOISE else OPEN if ratio > 1 - NOISE else FAILS


def all_at_least(ratios, bound):
    """Ratios of several workloads against the least ratio of the claim."""
    found = {at_least(ratio, bound) for ratio in ratios}
    if len(found) == 1:
        return found.pop()
    if found == {HOLDS, OPEN}:
        return OPEN
    return DEPENDS if max(ratios) > 1 + NOISE else FAILS


def below(least, mean, most, bound):
    """Counts, which have no noise."""
    return HOLDS if most < bound else DEPENDS if mean < bound else FAILS


def predicts(ratio):
    """A predicted time over the measured one."""
    return 0.8 <= ratio <= 1.25


def model(ratios):
    """Predicted times over measured ones: right up to the noise; *depends* needs half of them right."""
    good = [predicts(ratio) for ratio in ratios]
    return HOLDS if all(good) else DEPENDS if 2 * sum(good) >= len(good) else FAILS


def flatter(slope, others):
    """A slope against those of other volumes; slopes of counts differ by less than 0.1 between models."""
    if all(slope < other - 0.1 for other in others):
        return HOLDS
    return DEPENDS if any(slope < other - 0.1 for other in others) else FAILS


def exponent(points):
    """Returns the exponent a of the curve c·n^a that fits points (n, time) best, by least squares of logarithms."""
    xs, ys = [math.log(n) for n, _ in points], [math.log(t) for _, t in points]
    x, y = sum(xs) / len(xs), sum(ys) / len(ys)
    return sum((a - x) * (b - y) for a, b in zip(xs, ys)) / sum((a - x) ** 2 for a in xs)


def n_log_n(points):
    """Times over n, against the exponents of n·log n and n·log² n over the same n: nearer to the first holds."""
    first, second = (exponent([(n, n * math.log(n) ** power) for n, _ in points]) for power in (1, 2))
    found = exponent(points)
    return HOLDS if found <= (first + second) / 2 else OPEN if found <= second + 0.1 else FAILS


def log_factor(points, others):
    """Whether times grow by a factor log n more than others over the same n."""
    found = exponent(points) - exponent(others)
    wanted = exponent([(n, math.log(n)) for n, _ in points])
    if found < 0.5 * wanted:
        return f"not seen up to n = {max(n for n, _ in points):,.0f}"
    return HOLDS if found <= 1.5 * wanted else FAILS


def misleads(volume, tests):
    """How much larger boxes of one fit are than those of another, and how many more tests queries take with them, by
    the kind of tree."""
    if volume >= 1.25 and min(tests) >= 1.25:
        return HOLDS
    return DEPENDS if volume >= 1.25 or max(tests) >= 1.25 else FAILS
