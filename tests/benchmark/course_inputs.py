"""The inputs of the commands in collision/COURSE.md, and the scenes of scenes.py and time_model.py."""
import math
import pathlib
import random
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build/release/corridor"
SCENES = {
    "piano among walls": ("problems/piano/walls.obj", "robots/piano/piano.obj"),
    "bug in a bottle": ("problems/bug_trap/bottle.obj", "robots/bug/bug.stl"),
    "cart at walls": ("problems/rover_door/walls.obj", "robots/rover/cart.stl"),
    "upper arm at a shelf": ("problems/arm_at_shelf/shelf.stl", "robots/arm6/upper_arm.stl"),
    "hook in a maze": ("problems/hook_maze/walls.obj", "robots/hook/hook.obj"),
    "two forearms": ("robots/arm6/forearm.stl", "robots/arm6/forearm.stl"),
    "two wrinkled tori": ("a.obj", "b.obj"),
}


def files_of(meshes, folder):
    """Returns the paths of the two meshes of a scene: made inputs are in `folder`."""
    return [str((ROOT if "/" in name else folder) / name) for name in meshes]


def write_mesh(file, vertices, faces):
    text = "".join(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in vertices)
    file.write_text(text + "".join("f " + " ".join(str(i + 1) for i in face) + "\n" for face in faces))


def torus(rings, sides, bend=0.0):
    """A torus with wrinkles; `bend` moves its vertices."""
    vertices, faces = [], []
    for i in range(rings):
        for k in range(sides):
            u, v = 2 * math.pi * i / rings, 2 * math.pi * k / sides
            r = 0.3 + 0.03 * math.sin(9 * u + 4 * v)
            vertices.append(((1 + r * math.cos(v)) * math.cos(u), (1 + r * math.cos(v)) * math.sin(u),
                             r * math.sin(v) + bend * math.cos(u)))
            a, b = i * sides + k, i * sides + (k + 1) % sides
            c, d = (i + 1) % rings * sides + k, (i + 1) % rings * sides + (k + 1) % sides
            faces += [(a, c, d), (a, d, b)]
    return vertices, faces


def sphere(rings, radius):
    """A sphere of rings of quadrilaterals, whose corners are on the surface."""
    vertices, faces = [], []
    for i in range(rings + 1):
        for k in range(2 * rings):
            u, v = math.pi * i / rings, math.pi * k / rings
            vertices.append((radius * math.sin(u) * math.cos(v), radius * math.sin(u) * math.sin(v), radius * math.cos(u)))
            if i < rings:
                a, b = i * 2 * rings + k, i * 2 * rings + (k + 1) % (2 * rings)
                faces += [(a, b, b + 2 * rings), (a, b + 2 * rings, a + 2 * rings)]
    return vertices, faces


def direction(source):
    while True:
        v = [source.gauss(0, 1) for _ in range(3)]
        size = math.hypot(*v)
        if size > 1e-3:
            return [x / size for x in v]


def rotation(source):
    w, x, y, z = (source.gauss(0, 1) for _ in range(4))
    size = math.sqrt(w * w + x * x + y * y + z * z)
    w, x, y, z = w / size, x / size, y / size, z / size
    return [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
            2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
            2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]


def line(numbers):
    return " ".join(f"{x:.17g}" for x in numbers) + "\n"


def poses(source, count, nearest, farthest):
    return [rotation(source) + [source.uniform(nearest, farthest) * x for x in direction(source)] for _ in range(count)]


def split_poses(folder):
    """Splits poses.txt by the program's answers: gaps.txt has the poses without contact, contacts.txt the others."""
    done = subprocess.run([PROGRAM, *"query a.obj b.obj --poses poses.txt".split()], cwd=folder, capture_output=True,
                          text=True, check=True)
    hits = [answer.split(",")[1] == "1" for answer in done.stdout.splitlines()[1:]]
    lines = (folder / "poses.txt").read_text().splitlines(keepends=True)
    for name, wanted in (("gaps", False), ("contacts", True)):
        chosen = [pose for pose, hit in zip(lines, hits, strict=True) if hit == wanted]
        (folder / f"{name}.txt").write_text("".join(chosen))


def make_inputs(folder: pathlib.Path):
    source = random.Random(1)
    write_mesh(folder / "a.obj", *torus(80, 30))
    write_mesh(folder / "b.obj", *torus(60, 40))
    for k in range(1, 4):
        write_mesh(folder / f"a{k}.obj", *torus(80, 30, 0.02 * k))
    (folder / "poses.txt").write_text("".join(map(line, poses(source, 300, 0, 2.7))))
    split_poses(folder)
    starts, ends = poses(source, 100, 3, 3.2), poses(source, 100, 0, 1)
    more = random.Random(2)  # passing by: many of these are free
    starts, ends = starts + poses(more, 50, 3, 3.2), ends + poses(more, 50, 2.4, 2.7)
    (folder / "motions.txt").write_text("".join(line(a + b) for a, b in zip(starts, ends)))
    for name, count in (("p", 1000), ("q", 1000), ("p100", 100), ("q100", 100), ("p5", 100_000), ("q5", 100_000)):
        points = [direction(source) for _ in range(count)]
        write_mesh(folder / f"{name}.obj", points, [(i, i + 1, i + 2) for i in range(count - 2)])
    (folder / "hulls.txt").write_text("".join(map(line, poses(source, 200, 1.6, 2.4))))
    (folder / "apart.txt").write_text("".join(map(line, poses(source, 100, 2.05, 2.05))))
    (folder / "overlap.txt").write_text("".join(map(line, poses(source, 100, 1.95, 1.95))))
    (folder / "overlap100.txt").write_text("".join(map(line, poses(random.Random(3), 100, 1.6, 1.6))))
    still = [1, 0, 0, 0, 1, 0, 0, 0, 1]
    (folder / "steps.txt").write_text("".join(line(still + [2.6 * math.cos(a), 2.6 * math.sin(a), 0.1])
                                              for a in (0.01 * i for i in range(300))))
    (folder / "planes.txt").write_text("".join(line(direction(source) + [source.uniform(-1.5, 1.5)]) for _ in range(100)))
    for name, shift in (("polygon_p", 0), ("polygon_q", 2.001), ("polygon_r", 1.9)):
        count = 100_000
        (folder / f"{name}.txt").write_text("".join(
            line([shift + math.cos(2 * math.pi * i / count), math.sin(2 * math.pi * i / count)]) for i in range(count)))
    for variables, count in ((6, 1000), (6, 10_000)):
        rows = [line([1] * variables)]
        for _ in range(count):
            normal = [source.gauss(0, 1) for _ in range(variables)]
            rows.append(line(normal + [math.hypot(*normal)]))
        (folder / f"program{variables}_{count}.txt").write_text("".join(rows))
    boxes = [[source.uniform(0, 20) for _ in range(3)] for _ in range(800)]
    text = "".join(line([0, i, *p, *(x + 1 for x in p)]) for i, p in enumerate(boxes))
    for step in range(1, 6):
        for i in range(0, 800, 8):
            boxes[i] = [x + 0.01 for x in boxes[i]]
            text += line([step, i, *boxes[i], *(x + 1 for x in boxes[i])])
    (folder / "boxes.txt").write_text(text)
