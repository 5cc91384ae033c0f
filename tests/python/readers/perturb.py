"""Changes messages in one field at a time. For tests only."""

import copy
import re


def fields(value, path=()):
    """All fields of a message without fields of their own: pairs of path and value. Empty lists count as such fields."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from fields(inner, (*path, key))
    elif isinstance(value, list) and value:
        for i, inner in enumerate(value):
            yield from fields(inner, (*path, i))
    else:
        yield path, value


def maps(value, path=()):
    """The paths of all maps in a message."""
    if isinstance(value, dict):
        yield path
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, each in inner:
        yield from maps(each, (*path, key))


def pattern(path):
    """A path as text; an index is written as *: points.*.positions.*"""
    return ".".join("*" if isinstance(key, int) else key for key in path)


def says_nothing(name):
    """Whether nothing in a map can matter, so that unknown keys in it can't, either."""
    inert = ("header", "stamp", "goal_id", "goal_time_tolerance", "workspace_parameters", "min_corner", "max_corner",
             "error_code", "collision_objects.*.type", "vertices.*")  # fmt: skip
    return any(matches(name, rule) for rule in inert)


def at(value, path):
    for key in path:
        value = value[key]
    return value


def changed(message, path, value):
    """A copy of the message in which one field has another value."""
    message = copy.deepcopy(message)
    at(message, path[:-1])[path[-1]] = value
    return message


def matches(name, rule):
    """Whether a path's pattern ends with a rule. A rule that begins with ^ must match the whole pattern."""
    if rule.startswith("^"):
        return name == rule[1:]
    return re.search(r"(^|\.)" + re.escape(rule) + "$", name) is not None


def other_value(name, value, fill):
    """A value that differs much from the given one: 1 (rad, m, s) more, another name, the other truth value. `fill` maps
    rules of patterns to functions that return values for empty lists, and for other fields that need a special value."""
    for rule, make in fill.items():
        if matches(name, rule):
            return make()
    if isinstance(value, bool):
        return not value
    if isinstance(value, (int, float)):
        return value + (500_000_000 if name.endswith(("nsecs", "nanosec")) else 1)
    if isinstance(value, str):
        return "something_else"
    raise AssertionError(f"no value to change {name} to: add it to the table `fill`")
