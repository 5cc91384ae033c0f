"""Writes random robots and problems. For tests only."""

import json
import math

import numpy as np

AXES = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, -1)]


def words(values):
    return " ".join(f"{v:.6g}" for v in values)


def _origin(rng, reach, tag="origin"):
    """An origin with xyz, with rpy, with both, or none."""
    xyz, rpy = rng.uniform(-reach, reach, 3), rng.uniform(-3, 3, 3)
    which = rng.integers(5)
    if which == 0:
        return ""
    return f"<{tag}" + (f' xyz="{words(xyz)}"' if which != 1 else "") + (f' rpy="{words(rpy)}"' if which != 2 else "") + "/>"


def _mesh(rng, file):
    """Writes a mesh of a tetrahedron or an octahedron with quadrilateral-free faces, and returns the element of a URDF."""
    if rng.integers(2):
        v, f = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[1, 3, 2], [1, 2, 4], [1, 4, 3], [2, 3, 4]]
    else:
        v = [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]
        f = [[1, 2, 5], [2, 3, 5], [3, 4, 5], [4, 1, 5], [2, 1, 6], [3, 2, 6], [4, 3, 6], [1, 4, 6]]
    v = np.array(v) * rng.uniform(0.05, 0.15, 3)
    file.write_text("".join(f"v {words(p)}\n" for p in v) + "".join("f " + " ".join(map(str, t)) + "\n" for t in f))
    scale = rng.choice(["", ' scale="1 1 1"', f' scale="{words(rng.uniform(0.5, 1.5, 3))}"', ' scale="-0.8 1.2 0.7"'])
    return f'<mesh filename="{rng.choice(["package://stuff/", ""]) + file.name}"{scale}/>'


def _geometry(rng, file):
    r, h = rng.uniform(0.03, 0.09), rng.uniform(0.05, 0.3)
    which = rng.integers(4)
    if which == 0:
        return f'<box size="{words(rng.uniform(0.04, 0.25, 3))}"/>'
    if which == 1:
        return f'<sphere radius="{r:.6g}"/>'
    return f'<cylinder radius="{r:.6g}" length="{h:.6g}"/>' if which == 2 else _mesh(rng, file)


def write_robot(rng, folder, name="robot", free=False):
    """Writes a URDF and an SRDF of 4 to 8 links. With `free`, the first joint is planar or floating. Returns its joints:
    (name, type, lower, upper) of those that can move by themselves, and all names of links."""
    count = int(rng.integers(4, 9))
    links, joints, leaders, moving = [], [], [], []
    for i in range(count):
        shapes = ""
        for k in range(rng.choice([0, 1, 1, 1, 2])):
            geometry = _geometry(rng, folder / f"{name}_{i}_{k}.obj")
            shapes += f"<collision>{_origin(rng, 0.1)}<geometry>{geometry}</geometry></collision>"
        links.append(f'<link name="link{i}">{shapes}</link>')
    for i in range(1, count):
        parent = i - 1 if rng.random() < 0.7 else int(rng.integers(i))
        kind = str(rng.choice(["revolute", "revolute", "revolute", "continuous", "prismatic", "fixed"]))
        if i == 1 and free:
            kind = str(rng.choice(["planar", "floating"]))
        parts = [f'<parent link="link{parent}"/>', f'<child link="link{i}"/>', _origin(rng, 0.3)]
        if kind not in ("fixed", "floating") and rng.random() < 0.85:
            axis = AXES[rng.integers(4)] if rng.random() < 0.4 else rng.normal(size=3) * 2
            parts.append(f'<axis xyz="{words(axis)}"/>')
        lower, upper = -math.inf, math.inf
        if kind in ("revolute", "prismatic"):
            ranges = ((-2.5, 0.2), (0.4, 2.5)) if kind == "revolute" else ((-0.2, -0.1), (0.1, 0.3))
            lower, upper = (rng.uniform(*r) for r in ranges)
            lower, upper = float(f"{lower:.6g}"), float(f"{upper:.6g}")
            parts.append(f'<limit lower="{lower!r}" upper="{upper!r}" effort="1" velocity="1"/>')
        same = [leader for leader, type_ in leaders if type_ == kind and kind in ("revolute", "prismatic")]
        if same and rng.random() < 0.4:
            numbers = rng.choice(["", ' multiplier="-0.7"', ' multiplier="0.5" offset="0.05"', ' offset="-0.02"'])
            parts.append(f'<mimic joint="{rng.choice(same)}"{numbers}/>')
        elif kind != "fixed":
            moving.append((f"joint{i}", kind, lower, upper))
        if kind in ("revolute", "prismatic"):
            leaders.append((f"joint{i}", kind))
        order = rng.permutation(len(parts))
        joints.append(f'<joint name="joint{i}" type="{kind}">{"".join(parts[k] for k in order)}</joint>')
    if not any(kind not in ("planar", "floating") for _, kind, _, _ in moving):
        return write_robot(rng, folder, name, free)
    elements = [*links, *joints]
    elements = [elements[k] for k in rng.permutation(len(elements))]
    (folder / f"{name}.urdf").write_text(f'<robot name="{name}">\n' + "\n".join(elements) + "\n</robot>\n")
    names = [f"link{i}" for i in range(count)]
    _write_srdf(rng, folder / f"{name}.srdf", name, names, moving)
    return moving, names


def value_in(rng, lower, upper):
    return float(rng.uniform(max(lower, -3), min(upper, 3)))


def _write_srdf(rng, file, name, links, moving):
    single = [joint for joint in moving if joint[1] not in ("planar", "floating")]
    tip = rng.choice(links[1:])
    lines = [f'<group name="all">{"".join(f"<joint name={chr(34)}{j[0]}{chr(34)}/>" for j in single)}</group>',
             f'<group name="some"><joint name="{single[0][0]}"/><link name="{tip}"/></group>',
             '<group name="both"><group name="some"/><joint name="joint1"/></group>',
             f'<group name="way"><chain base_link="{links[0]}" tip_link="{links[-1]}"/></group>']  # fmt: skip
    state = "".join(f'<joint name="{j[0]}" value="{value_in(rng, *j[2:]):.6g}"/>' for j in single)
    lines.append(f'<group_state name="ready" group="all">{state}</group_state>')
    for _ in range(rng.integers(4)):
        a, b = rng.choice(links, 2, False)
        lines.append(f'<disable_collisions link1="{a}" link2="{b}" reason="Never"/>')
    if rng.random() < 0.3:
        lines.append(f'<disable_default_collisions link="{links[1]}"/>')
        lines.append(f'<enable_collisions link1="{links[1]}" link2="{links[-1]}"/>')
    file.write_text(f'<robot name="{name}">\n' + "\n".join(lines) + "\n</robot>\n")


def rotation_keys(rng):
    which = rng.integers(4)
    if which == 0:
        return ""
    if which == 1:
        return f", rpy: [{', '.join(f'{v:.6g}' for v in rng.uniform(-3, 3, 3))}]"
    if which == 2:
        return f", rpy_deg: [{', '.join(f'{v:.6g}' for v in rng.uniform(-180, 180, 3))}]"
    q = rng.normal(size=4)
    return f", quat_xyzw: [{', '.join(repr(float(v)) for v in q / np.linalg.norm(q))}]"


def place(rng, reach):
    return f"at: [{', '.join(f'{v:.6g}' for v in rng.uniform(-reach, reach, 3))}]{rotation_keys(rng)}"


def obstacle(rng, folder, name):
    """One obstacle, as YAML."""
    at, which = place(rng, 0.8), rng.integers(8)
    r, h = rng.uniform(0.03, 0.15), rng.uniform(0.1, 0.5)
    size = ", ".join(f"{v:.6g}" for v in rng.uniform(0.05, 0.4, 3))
    if which == 0:
        return f"{{sphere: {r:.6g}, {at}}}"
    if which == 1:
        return f"{{sphere: {{radius: {r:.6g}}}, {at}}}"
    if which in (2, 3):
        kind = ("capsule", "cylinder")[which - 2]
        return f"{{{kind}: {{radius: {r:.6g}, length: {h:.6g}}}, {at}}}"
    if which == 4:
        _mesh(rng, folder / f"{name}.obj")
        unit, by = [("m", 1), ("cm", 100), ("mm", 1000), ("in", 1 / 0.0254)][rng.integers(4)]
        lines = (folder / f"{name}.obj").read_text().splitlines()
        for k, line in enumerate(lines):
            if line[0] == "v":
                lines[k] = "v " + " ".join(repr(float(w) * by * 2) for w in line.split()[1:])
        (folder / f"{name}.obj").write_text("\n".join(lines))
        return f"{{mesh: {name}.obj, unit: {unit}{rng.choice(['', ', up: x', ', up: y', ', up: z'])}, {at}}}"
    if which == 5:
        parts = [f"{{box: [{size}], at: [0.1, 0, 0]{rotation_keys(rng)}}}",
                 f"{{cylinder: {{radius: {r:.6g}, length: {h:.6g}}}, at: [0, 0.1, 0]}}"]  # fmt: skip
        return f"{{shapes: [{', '.join(parts)}], {at}}}"
    if which == 6:
        points = ", ".join(f"[{', '.join(f'{v:.6g}' for v in p)}]" for p in rng.uniform(-0.15, 0.15, (6, 3)))
        return f"{{convex: [{points}], {at}}}"
    return f"{{box: [{size}], {at}}}"


def state(rng, moving, chosen):
    """Values of the chosen joints, as YAML. Revolute joints are written in degrees or radians."""
    found = []
    for name, kind, lower, upper in moving:
        if name not in chosen:
            continue
        if kind == "planar":
            found.append(f"{name}: {{at: [{rng.uniform(-0.3, 0.3):.6g}, 0.1], yaw_deg: {rng.uniform(-170, 170):.6g}}}")
        elif kind == "floating":
            found.append(f"{name}: {{{place(rng, 0.3)}}}")
        elif kind == "prismatic" or rng.integers(2):
            found.append(f"{name}: {value_in(rng, lower, upper):.6g}")
        else:
            found.append(f"{name}_deg: {math.degrees(value_in(rng, lower * 0.99, upper * 0.99)):.6g}")
    return "{" + ", ".join(found) + "}"


def _message_pose(rng, reach):
    """A pose of a message, as maps or as lists. Quaternions of messages may have any norm."""
    p, q = rng.uniform(-reach, reach, 3).tolist(), (rng.normal(size=4)).tolist()
    q = [v / math.sqrt(sum(w * w for w in q)) for v in q]
    if rng.integers(2):
        return {"position": p, "orientation": q}
    return {"position": dict(zip("xyz", p)), "orientation": dict(zip("xyzw", q))}


def _write_scene(rng, file, links):
    objects = []
    for i in range(int(rng.integers(1, 4))):
        thing = {"id": f"object {i}", "primitives": [], "primitive_poses": []}
        if rng.integers(2):
            thing["header"] = {"frame_id": str(rng.choice(["world", "link0"]))}
        if rng.integers(2):
            thing["pose"] = _message_pose(rng, 0.4)
        for _ in range(int(rng.integers(1, 3))):
            r, h = float(rng.uniform(0.03, 0.12)), float(rng.uniform(0.1, 0.4))
            kinds = [("box", 1, rng.uniform(0.05, 0.3, 3).tolist()), ("sphere", 2, [r]), ("cylinder", 3, [h, r])]
            name, number, size = kinds[rng.integers(3)]
            thing["primitives"].append({"type": name if rng.integers(2) else number, "dimensions": size})
            thing["primitive_poses"].append(_message_pose(rng, 0.4))
        if rng.integers(2):
            corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) * rng.uniform(0.1, 0.3, 3)
            vertices = [dict(zip("xyz", corner)) for corner in corners.tolist()]
            faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
            thing["meshes"] = [{"vertices": vertices, "triangles": [{"vertex_indices": face} for face in faces]}]
            thing["mesh_poses"] = [_message_pose(rng, 0.4)]
        objects.append(thing)
    names = [str(n) for n in rng.permutation([*links, *(thing["id"] for thing in objects)])]
    names = names[: int(rng.integers(len(names)))]
    allowed = np.triu(rng.random((len(names), len(names))) < 0.2, 1)
    allowed |= allowed.T
    rows = [{"enabled": row} if rng.integers(2) else row for row in allowed.tolist()]
    scene = {"world": {"collision_objects": objects}, "allowed_collision_matrix": {"entry_names": names, "entry_values": rows}}
    if rng.integers(2):
        scene["link_padding"] = [{"link_name": links[-1], "padding": 0.015}]
    file.write_text(json.dumps(scene))


def _write_request(rng, file, moving):
    def values():
        return {name: round(value_in(rng, lower, upper), 5) for name, _, lower, upper in moving}

    start = values()
    goals = [[{"joint_name": name, "position": value} for name, value in values().items()]
             for _ in range(int(rng.integers(1, 3)))]  # fmt: skip
    file.write_text(json.dumps({
        "group_name": "all", "start_state": {"joint_state": {"name": list(start), "position": list(start.values())}},
        "goal_constraints": [{"joint_constraints": goal} for goal in goals]}))  # fmt: skip


def write_problem(rng, folder):
    """Writes problem.yaml, with one robot or two, and everything that it names."""
    two = rng.random() < 0.25
    robots, names = [], []
    for name in ("left", "right") if two else ("robot",):
        free = rng.random() < 0.3
        moving, links = write_robot(rng, folder, name, free)
        single = [j[0] for j in moving if j[1] not in ("planar", "floating")]
        chosen, lines = [j[0] for j in moving], [f"format: corridor-robot-1\nname: {name}bot\nurdf: {name}.urdf"]
        request = not two and len(single) == len(moving) and rng.random() < 0.3
        if request or rng.random() < 0.6:
            lines.append(f"srdf: {name}.srdf")
        which = 3 if request else rng.integers(4)
        if which == 0:  # some joints, in another order; the others are held by a state of the file, or by default
            chosen = list(rng.permutation(chosen)[: max(1, len(chosen) - 2)])
            lines.append(f"joints: [{', '.join(chosen)}]")
        elif which == 1 and len(lines) > 1:
            chosen = single
            lines.append("group: all")
        elif which == 2 and len(chosen) > 1:
            held = chosen.pop(int(rng.integers(len(chosen))))
            lines.append(f"hold: {state(rng, moving, [held])}")
        if rng.integers(2):
            lines.append("packages: {stuff: .}")
        else:
            (folder / "stuff").mkdir(exist_ok=True)
            for file in folder.glob(f"{name}_*.obj"):
                (folder / "stuff" / file.name).write_bytes(file.read_bytes())
        if rng.integers(2):
            lines.append(f"allow: [[{', '.join(rng.choice(links, 2, False))}]]")
        (folder / f"{name}.yaml").write_text("\n".join(lines) + "\n")
        robots.append((name, moving, chosen))
        names += [f"{name}/{link}" if two else link for link in links]
    obstacles = {f"thing {i}": obstacle(rng, folder, f"thing_{i}") for i in range(rng.integers(3, 7))}
    text = "format: corridor-problem-1\n"
    if two:
        text += "robots:\n"
        text += "".join(f"  {name}: {{file: {name}.yaml, base: {{{place(rng, 0.5)}}}}}\n" for name, _, _ in robots)
    else:
        text += f"robot: robot.yaml\nbase: {{{place(rng, 0.3)}}}\n"
    text += "world:\n" + "".join(f"  {name}: {shape}\n" for name, shape in obstacles.items())
    messages = []
    if not two and rng.integers(2):
        _write_scene(rng, folder / "scene.yaml", names)
        messages.append("scene: scene.yaml")
    if request:
        _write_request(rng, folder / "request.yaml", robots[0][1])
        messages.append("request: request.yaml")
    if messages:
        text += f"moveit: {{{', '.join(messages)}}}\n"
    # A start that names a state of the SRDF also gives the values of held joints.
    named = not two and not request and "srdf" in (folder / "robot.yaml").read_text() and all(
        kind not in ("planar", "floating") for _, kind, _, _ in robots[0][1])  # fmt: skip
    if named:
        text += "start: ready\n"
    for key in () if request else ("goal",) if named else ("start", "goal"):
        parts = {name: state(rng, moving, chosen) for name, moving, chosen in robots}
        text += f"{key}: " + ("{" + ", ".join(f"{n}: {s}" for n, s in parts.items()) + "}" if two else parts["robot"]) + "\n"
    text += _bounds(robots, two)
    if rng.integers(2):
        text += f"margin: {rng.uniform(0.005, 0.05):.6g}\n"
    if rng.integers(2):
        text += f"allow: [[{rng.choice(names)}, {rng.choice(list(obstacles))}]]\n"
    if rng.integers(3) == 0:
        text += f"padding: {{bodies: {{thing 0: 0.15, {names[-1]}: 0.1}}, pairs: [[{names[1]}, thing 1, 0.2]]}}\n"
    (folder / "problem.yaml").write_text(text)
    return folder / "problem.yaml"


def _bounds(robots, two):
    found = {}
    for name, moving, chosen in robots:
        corners = {"planar": "[-0.5, -0.5], [0.5, 0.5]", "floating": "[-0.5, -0.5, -0.5], [0.5, 0.5, 0.5]"}
        parts = [f"{joint}: {{at: [{corners[kind]}]}}" for joint, kind, _, _ in moving if joint in chosen and kind in corners]
        if parts:
            found[name] = "{" + ", ".join(parts) + "}"
    if not found:
        return ""
    return "bounds: " + ("{" + ", ".join(f"{n}: {b}" for n, b in found.items()) + "}" if two else found["robot"]) + "\n"
