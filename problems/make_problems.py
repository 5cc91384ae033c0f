#!/usr/bin/env python3
"""Makes the meshes of all problems and robots of this repository, in the folders where their YAML files stand.

    python3 problems/make_problems.py

Every run makes the same bytes. The YAML files beside the meshes are written by hand.
"""

import math
from pathlib import Path

from mesh_tools import (Mesh, box, carve, ellipsoid, plate_with_hole, prism, revolve, spline, tube, write)

ROOT = Path(__file__).resolve().parent.parent
ROBOTS, PROBLEMS = ROOT / 'robots', ROOT / 'problems'


# A piano through an apartment

def piano():
    """A small grand piano of 1.40 x 1.50 x 0.95 m with its lid closed. The keyboard is at -y."""
    rim = [(0.7, -0.30), (0.66, -0.06), (0.46, 0.13), (0.22, 0.30), (0.09, 0.52), (-0.10, 0.69), (-0.34, 0.75), (-0.58, 0.68), (-0.7, 0.45)]
    outline = [(-0.7, -0.50), (0.7, -0.50)] + spline(rim, 4)
    lid = [(x * 1.015, y * 1.015) for x, y in outline]
    mesh = prism(outline, 0.62, 0.91) + prism(lid, 0.915, 0.935)
    cheeks = [((-0.70, -0.75, 0.62), (-0.63, -0.505, 0.82)), ((0.63, -0.75, 0.62), (0.70, -0.505, 0.82))]
    mesh += carve([((-0.70, -0.75, 0.62), (0.70, -0.505, 0.70))] + cheeks)
    width = 1.25 / 35
    for key in range(35):  # five octaves
        left = -0.625 + key * width
        mesh += box((left, -0.74, 0.702), (left + width - 0.002, -0.51, 0.725))
        if key % 7 not in (2, 6):
            mesh += box((left + 0.7 * width, -0.65, 0.727), (left + 1.3 * width, -0.51, 0.740))
    leg = [(0, 0), (0.03, 0), (0.045, 0.04), (0.03, 0.09), (0.035, 0.3), (0.055, 0.5), (0.07, 0.56), (0.07, 0.615), (0, 0.615)]
    for x, y in ((-0.58, -0.55), (0.58, -0.55), (-0.36, 0.52)):
        mesh += revolve(leg, 12).moved((x, y, 0))
    mesh += carve([((-0.10, -0.44, 0.06), (0.10, -0.36, 0.10)), ((-0.07, -0.41, 0.10), (-0.04, -0.39, 0.615)), ((0.04, -0.41, 0.10), (0.07, -0.39, 0.615))])
    return mesh


def apartment():
    """Three rooms, 2.7 m high, and two doors, 1 m wide: narrower than the piano, however it is turned upright."""
    door = 2.1
    walls = carve(
        [((-0.2, -0.2, 0), (9.2, 6.2, 2.7))],
        [((0, 0, 0), (4.0, 6, 2.7)), ((4.12, 0, 0), (9, 2.8, 2.7)), ((4.12, 2.92, 0), (9, 6, 2.7)),
         ((4.0, 0.9, 0), (4.12, 1.9, door)), ((4.0, 4.0, 0), (4.12, 5.0, door)),
         ((-0.2, 1.0, 0.9), (0, 2.4, 2.2)), ((-0.2, 3.6, 0.9), (0, 5.0, 2.2)),  # windows
         ((6.0, 6, 0.9), (8.0, 6.2, 2.2))])
    floor = box((-0.2, -0.2, -0.1), (9.2, 6.2, 0))
    sofa = carve([((0, 0, 0.08), (0.85, 1.9, 0.42)), ((0, 0, 0.42), (0.22, 1.9, 0.80)), ((0, 0, 0.42), (0.85, 0.18, 0.58)), ((0, 1.72, 0.42), (0.85, 1.9, 0.58))])
    legs = [((x, y, 0), (x + 0.06, y + 0.06, 0.71)) for x in (0, 0.84) for y in (0, 0.54)]
    table = carve(legs + [((-0.05, -0.05, 0.71), (0.95, 0.65, 0.75))])
    chair = carve([((x, y, 0), (x + 0.04, y + 0.04, 0.43)) for x in (0, 0.38) for y in (0, 0.38)]
                  + [((0, 0, 0.43), (0.42, 0.42, 0.47)), ((0, 0.38, 0.47), (0.42, 0.42, 0.90))])
    bookshelf = carve([((0, 0, 0), (1.4, 0.32, 1.9))], [((0.03, 0.02, z), (1.37, 0.32, z + 0.34)) for z in (0.06, 0.43, 0.80, 1.17, 1.54)])
    pot = revolve([(0, 0), (0.14, 0), (0.19, 0.36), (0.16, 0.36), (0.13, 0.30), (0, 0.30)], 20)
    trunk = revolve([(0, 0.28), (0.02, 0.28), (0.015, 0.9), (0, 0.9)], 8)
    plant = pot + trunk + ellipsoid((0, 0, 1.15), (0.26, 0.24, 0.32), 16, 10)
    return {'walls.obj': walls, 'floor.obj': floor, 'sofa.obj': sofa, 'table.obj': table, 'chair.obj': chair,
            'bookshelf.ascii.stl': bookshelf, 'plant.ply': plant}


def make_piano():
    write(piano(), ROBOTS / 'piano/piano.obj', scale=100, up='y')  # like many downloaded models: centimetres, y up
    for name, mesh in apartment().items():
        write(mesh, PROBLEMS / 'piano' / name)


# A bug in a bottle whose neck points inward

def make_bug_trap():
    body = ellipsoid((0, 0, 0), (0.10, 0.10, 0.20), 20, 14) + ellipsoid((0, 0, 0.21), (0.06, 0.06, 0.06), 14, 8)
    for side in (-1, 1):
        for z, reach in ((0.08, 0.13), (0.0, 0.03), (-0.08, -0.09)):
            leg = [(side * 0.06, 0, z), (side * 0.12, -0.03, z + reach / 3), (side * 0.14, -0.08, z + reach / 1.5)]
            body += tube(spline(leg, 3), 0.009, 6, 2)
        body += tube(spline([(side * 0.02, 0.02, 0.25), (side * 0.05, 0.06, 0.31), (side * 0.09, 0.07, 0.34)], 3), 0.006, 6, 2)
    write(body, ROBOTS / 'bug/bug.stl', scale=1000)

    profile = [(0, -1.20), (0.50, -1.13), (0.87, -0.80), (1.00, -0.20), (0.95, 0.50), (0.76, 0.93), (0.56, 1.00), (0.39, 0.86), (0.29, 0.55),
               (0.26, 0.20), (0.25, 0.00), (0.28, -0.05), (0.31, 0.00), (0.32, 0.20), (0.36, 0.53), (0.46, 0.80), (0.57, 0.91), (0.71, 0.85),
               (0.86, 0.46), (0.91, -0.20), (0.79, -0.74), (0.45, -1.04), (0, -1.11)]
    curve = spline(profile, 3)
    curve = [(max(r, 0.0), z) for r, z in curve]
    write(revolve(curve, 40), PROBLEMS / 'bug_trap/bottle.obj')


# Two bent tubes, linked

def make_twisted_tubes():
    """A coil of 1.4 turns with short straight ends. Where the turns overlap, the gap between them is `pitch` - 2 `radius`.
    A tube that leaves the coil must slide through this gap, from one end of the overlap to the other."""
    radius, coil, pitch, turns, straight, steps = 0.08, 0.45, 0.43, 1.4, 0.2, 66
    path = []
    for k in range(steps + 1):
        angle = math.pi * turns * (2 * k / steps - 1)
        path.append((coil * math.cos(angle), coil * math.sin(angle), pitch * angle / (2 * math.pi)))
    for end, before in ((0, 1), (-1, -2)):
        tangent = [a - b for a, b in zip(path[end], path[before])]
        length = math.hypot(*tangent)
        points = [tuple(p + straight * k / 4 * t / length for p, t in zip(path[end], tangent)) for k in range(1, 5)]
        path = points[::-1] + path if end == 0 else path + points
    mesh = tube(path, radius, 14)
    write(mesh, ROBOTS / 'twisted_tube/tube.ply')
    write(mesh, PROBLEMS / 'twisted_tubes/tube.ply')


# A house of cubicles

def make_cubicles():
    """Six cells on each of two floors, 12 x 9 m; openings are doors, hatches above the floor, and a hole in the ceiling."""
    t = 0.05  # half a wall
    walls, openings = [], []
    for low, high in ((0, 2.8), (3.0, 5.8)):
        walls += [((x - t, -t, low), (x + t, 9 + t, high)) for x in (0, 4, 8, 12)]
        walls += [((-t, y - t, low), (12 + t, y + t, high)) for y in (0, 4.5, 9)]
    door = lambda axis, at, begin, low, high: openings.append(
        ((at - t, begin, low), (at + t, begin + 1.2, high)) if axis == 'x' else ((begin, at - t, low), (begin + 1.2, at + t, high)))
    door('x', 4, 2.8, 0, 2.1)       # lower floor: front left to front middle
    door('y', 4.5, 6.4, 0, 2.1)     # front middle to back middle
    door('x', 4, 5.0, 0, 2.1)       # back middle to back left, a dead end
    door('x', 8, 7.0, 0.9, 2.1)     # back middle to back right, a hatch
    door('y', 4.5, 8.5, 0, 2.1)     # back right to front right, a dead end
    door('y', 4.5, 10.3, 3.0, 5.1)  # upper floor: back right to front right
    door('x', 8, 0.8, 3.9, 5.1)     # front right to front middle, a hatch
    door('x', 4, 2.5, 3.0, 5.1)     # front middle to front left
    door('y', 4.5, 1.0, 3.0, 5.1)   # front left to back left
    door('x', 4, 7.0, 3.9, 5.1)     # back left to back middle, a hatch and a dead end
    hole = ((9.3, 5.2, 2.8), (10.7, 6.6, 3.0))
    folder = PROBLEMS / 'cubicles'
    write(carve(walls, openings), folder / 'walls.obj')
    write(box((-0.3, -0.3, -0.2), (12.3, 9.3, 0)), folder / 'ground.obj')
    write(carve([((-t, -t, 2.8), (12 + t, 9 + t, 3.0))], [hole]), folder / 'ceiling.obj')
    write(carve([((-0.8, -0.4, 0.70), (0.8, 0.4, 0.74)), ((-0.8, -0.4, 0), (-0.74, 0.4, 0.70)), ((0.74, -0.4, 0), (0.8, 0.4, 0.70)),
                 ((-0.74, 0.34, 0.3), (0.74, 0.4, 0.70)), ((-0.3, 0.0, 0.76), (0.3, 0.04, 1.12)), ((-0.05, 0.0, 0.74), (0.05, 0.04, 0.76))]),
          folder / 'desk.obj')
    write(carve([((0, 0, 0), (1.1, 0.2, 0.2)), ((0, 0, 0), (0.2, 0.8, 0.2))]), ROBOTS / 'l_shape/l_shape.obj')


# A plate of 0.1 mm

def make_thin_plate():
    write(carve([((0, -5.3, -5.3), (0.0001, 5.3, 5.3))], [((0, 2.8, -0.3), (0.0001, 4.2, 0.3))]), PROBLEMS / 'thin_plate/plate.ascii.stl')
    wings = prism([(0.09, 0), (-0.07, 0.06), (-0.05, 0), (-0.07, -0.06)], 0, 0.001)
    keel = prism([(0.085, -0.0005), (-0.055, -0.025), (-0.05, -0.0005)][::-1], -0.0005, 0.0005).mapped(lambda p: (p[0], -p[2], p[1]))
    write(wings + keel, ROBOTS / 'paper_plane/paper_plane.obj')


# A rod through a hole with 1 % play

def make_rod_hole():
    """The rod's corners are at `radius`, the middles of the hole's sides at 1.01 times that: the play is nowhere below 1 %."""
    radius, sides = 0.02, 48
    write(revolve([(0, -0.1), (radius, -0.1), (radius, 0.1), (0, 0.1)], sides), ROBOTS / 'rod/rod.obj')
    plate = plate_with_hole(0.16, 1.01 * radius / math.cos(math.pi / sides), sides, -0.0025, 0.0025)
    write(plate, PROBLEMS / 'rod_hole/plate.stl', scale=1000)


# A hook in a maze

MAZE = '''
+--+--+--+--+--+--+--+--+
|        |              |
+  +--+  +  +--+--+--+  +
|  |     |  |        |  |
+  +  +--+  +  +--+  +  +
|  |  |     |  |     |  |
+  +  +  +--+  +  +--+  +
|  |        |  |        |
+  +--+--+  +  +--+--+--+
|           |           |
+--+--+--+--+--+--+--+--+
'''


def make_hook_maze():
    rows, t = MAZE.split('\n')[1:-1], 0.06
    walls = []
    for r, row in enumerate(rows):
        y = (len(rows) - 1 - r) / 2
        for c in range(0, len(row), 3):
            x = c / 3
            if row[c] == '|':
                walls.append(((x - t, y - 0.5 - t, 0), (x + t, y + 0.5 + t, 0.3)))
            if row[c:c + 2] == '+-':
                walls.append(((x - t, y - t, 0), (x + 1 + t, y + t, 0.3)))
    write(carve(walls), PROBLEMS / 'hook_maze/walls.obj')
    write(box((-0.1, -0.1, -0.05), (8.1, 5.1, -0.01)), PROBLEMS / 'hook_maze/floor.obj')

    w, bend = 0.05, 0.2  # half the hook's width; the radius of its bend
    arc = [math.pi * k / 16 for k in range(17)]
    outer = [(-bend * math.cos(a) - w * math.cos(a), 0.15 + (bend + w) * math.sin(a)) for a in arc]
    inner = [(-(bend - w) * math.cos(a), 0.15 + (bend - w) * math.sin(a)) for a in arc]
    outline = [(-bend - w, -0.48)] + outer + [(bend + w, -0.1), (bend - w, -0.1)] + inner[::-1] + [(-bend + w, -0.48)]
    write(prism(outline[::-1], 0.05, 0.25), ROBOTS / 'hook/hook.obj')


# Worlds for the robots with joints (robots/make_robots.py makes these robots)

def make_robot_worlds():
    boards = [((0, -0.52, z), (0.34, 0.52, z + 0.02)) for z in (0.40, 0.78, 1.13, 1.48)]
    sides = [((0, y, 0), (0.34, y + 0.02, 1.50)) for y in (-0.52, -0.01, 0.50)]
    back = [((0.33, -0.52, 0.40), (0.34, 0.52, 1.50))]
    write(carve(boards + sides + back), PROBLEMS / 'arm_at_shelf/shelf.stl', scale=1000)

    size, wall, height = (0.30, 0.22), 0.008, 0.09
    x, y = size[0] / 2, size[1] / 2
    write(carve([((-x, -y, 0), (x, y, height))], [((-x + wall, -y + wall, wall), (x - wall, y - wall, height))]), PROBLEMS / 'two_arms/bin.obj')

    door, high = 0.45, 1.1
    walls = [((-3.1, -2.1, 0), (-3, 2.1, high)), ((3, -2.1, 0), (3.1, 2.1, high)), ((-3.1, -2.1, 0), (3.1, -2, high)), ((-3.1, 2, 0), (3.1, 2.1, high)),
             ((-0.05, -2, 0), (0.05, 2, high))]
    write(carve(walls, [((-0.05, -0.3 - door, 0), (0.05, -0.3 + door, high))]), PROBLEMS / 'rover_door/walls.obj')
    legs = [((sx * 0.45 - 0.03, sy * 0.7 - 0.03, 0), (sx * 0.45 + 0.03, sy * 0.7 + 0.03, 0.55)) for sx in (-1, 1) for sy in (-1, 1)]
    write(carve(legs + [((-0.5, -0.75, 0.55), (0.5, 0.75, 0.59))]), PROBLEMS / 'rover_door/table.obj')


if __name__ == '__main__':
    make_piano()
    make_bug_trap()
    make_twisted_tubes()
    make_cubicles()
    make_thin_plate()
    make_rod_hole()
    make_hook_maze()
    make_robot_worlds()
