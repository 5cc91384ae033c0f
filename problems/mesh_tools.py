"""Makes closed triangle meshes from a few constructions, and writes them as OBJ, STL or PLY.

Lengths are in metres, z is up. Every construction returns a closed surface whose triangles turn counter-clockwise
seen from outside; `Mesh.check` proves it edge by edge. Only the standard library is used, and coordinates are written
with a fixed number of decimals, so that every machine makes the same bytes.
"""

import math
import struct
from bisect import bisect_left

# A step of 1e-7 m is far below any clearance in these scenes, and far above the last bits of sines, which differ between
# machines.
DECIMALS = 7


class Mesh:
    def __init__(self, vertices=(), triangles=()):
        self.vertices = list(vertices)
        self.triangles = list(triangles)

    def __add__(self, other):
        """Returns the triangles of both meshes. Overlaps are not removed: a surface may intersect itself."""
        shift = len(self.vertices)
        return Mesh(self.vertices + other.vertices, self.triangles + [tuple(i + shift for i in t) for t in other.triangles])

    def moved(self, by):
        return self.mapped(lambda p: tuple(a + b for a, b in zip(p, by)))

    def mapped(self, function):
        """Applies `function` to every vertex. It must keep the orientation."""
        return Mesh([function(p) for p in self.vertices], self.triangles)

    def quad(self, a, b, c, d):
        self.triangles += [(a, b, c), (a, c, d)]

    def check(self):
        """Asserts that the mesh is closed, oriented (each edge is used as often forwards as backwards) and not inside out."""
        balance = {}
        for t in self.triangles:
            assert len(set(t)) == 3
            for a, b in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0])):
                key, sign = ((a, b), 1) if a < b else ((b, a), -1)
                balance[key] = balance.get(key, 0) + sign
        assert not any(balance.values()), 'the mesh has a hole, or a triangle faces the wrong way'
        assert self.volume() > 0, 'the mesh is inside out'

    def volume(self):
        total = 0
        for t in self.triangles:
            (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (self.vertices[i] for i in t)
            total += ax * (by * cz - bz * cy) - ay * (bx * cz - bz * cx) + az * (bx * cy - by * cx)
        return total / 6


# Constructions

def carve(solids, openings=()):
    """The union of the boxes `solids` minus the boxes `openings`, each ((x0, y0, z0), (x1, y1, z1)): walls with doors,
    floors with holes, furniture, mazes. Returns one watertight surface, on the grid of all faces of the boxes."""
    boxes = list(solids) + list(openings)
    grid = [sorted({corner[axis] for box in boxes for corner in box}) for axis in range(3)]
    cells = set()
    for fill, group in ((True, solids), (False, openings)):
        for lower, upper in group:
            spans = [range(bisect_left(grid[a], lower[a]), bisect_left(grid[a], upper[a])) for a in range(3)]
            block = {(i, j, k) for i in spans[0] for j in spans[1] for k in spans[2]}
            cells = cells | block if fill else cells - block

    mesh, index = Mesh(), {}

    def vertex(i, j, k):
        if (i, j, k) not in index:
            index[i, j, k] = len(mesh.vertices)
            mesh.vertices.append((grid[0][i], grid[1][j], grid[2][k]))
        return index[i, j, k]

    for cell in sorted(cells):
        for axis in range(3):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            for side in (0, 1):
                beside = list(cell)
                beside[axis] += 2 * side - 1
                if tuple(beside) in cells:
                    continue
                corners = []
                for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    corner = list(cell)
                    corner[axis] += side
                    corner[u] += du
                    corner[v] += dv
                    corners.append(vertex(*corner))
                mesh.quad(*(corners if side else reversed(corners)))
    return mesh


def box(lower, upper):
    return carve([(lower, upper)])


def revolve(profile, sides):
    """The surface of revolution of `profile`: points (radius, z) from one point of the z-axis to another. Drawn with the
    radius to the right and z up, the profile has the inside on its left: an outer wall goes up."""
    mesh, rings = Mesh(), []
    for radius, z in profile:
        ring = []
        for k in range(sides if radius else 1):
            angle = 2 * math.pi * k / sides
            ring.append(len(mesh.vertices))
            mesh.vertices.append((radius * math.cos(angle), radius * math.sin(angle), z))
        rings.append(ring)
    for low, high in zip(rings, rings[1:]):
        for k in range(sides):
            a, b = low[k % len(low)], low[(k + 1) % len(low)]
            c, d = high[(k + 1) % len(high)], high[k % len(high)]
            if len(low) == 1:
                mesh.triangles.append((a, c, d))
            elif len(high) == 1:
                mesh.triangles.append((a, b, d))
            else:
                mesh.quad(a, b, c, d)
    return mesh


def ellipsoid(center, radii, sides, rings):
    profile = [(math.sin(math.pi * k / rings) if 0 < k < rings else 0, -math.cos(math.pi * k / rings)) for k in range(rings + 1)]
    return revolve(profile, sides).mapped(lambda p: tuple(c + r * x for c, r, x in zip(center, radii, p)))


def tube(path, radius, sides, cap_rings=3):
    """A round tube along the points `path`, with round ends. The frame is carried along without twist."""
    count = len(path)
    tangents = [_unit(_sub(path[min(i + 1, count - 1)], path[max(i - 1, 0)])) for i in range(count)]
    normal = _unit(_cross(tangents[0], (0.0, 0.0, 1.0) if abs(tangents[0][2]) < 0.9 else (1.0, 0.0, 0.0)))
    stations = []  # (centre, radius, normal, binormal)
    for i, (p, t) in enumerate(zip(path, tangents)):
        normal = _unit(_sub(normal, tuple(_dot(normal, t) * x for x in t)))
        binormal = _cross(t, normal)
        bends = [math.pi / 2 * k / cap_rings for k in range(1, cap_rings)]
        ends = {0: [-b for b in reversed(bends)], count - 1: bends}.get(i, [])
        for bend in sorted([0.0] + ends):
            center = tuple(x + radius * math.sin(bend) * y for x, y in zip(p, t))
            stations.append((center, radius * math.cos(bend), normal, binormal))
    mesh = Mesh([tuple(x - radius * t for x, t in zip(path[0], tangents[0]))])
    for center, r, n, b in stations:
        for k in range(sides):
            c, s = r * math.cos(2 * math.pi * k / sides), r * math.sin(2 * math.pi * k / sides)
            mesh.vertices.append(tuple(x + c * y + s * z for x, y, z in zip(center, n, b)))
    mesh.vertices.append(tuple(x + radius * t for x, t in zip(path[-1], tangents[-1])))
    last = len(mesh.vertices) - 1
    for k in range(sides):
        n = (k + 1) % sides
        mesh.triangles.append((0, 1 + n, 1 + k))
        mesh.triangles.append((last, last - sides + k, last - sides + n))
        for row in range(len(stations) - 1):
            low, high = 1 + row * sides, 1 + (row + 1) * sides
            mesh.quad(low + k, low + n, high + n, high + k)
    return mesh


def prism(polygon, z0, z1):
    """The simple polygon `polygon`, counter-clockwise points (x, y), from z0 up to z1."""
    n = len(polygon)
    mesh = Mesh([(x, y, z) for z in (z0, z1) for x, y in polygon])
    for a, b, c in _ears(polygon):
        mesh.triangles += [(a + n, b + n, c + n), (c, b, a)]
    for k in range(n):
        mesh.quad(k, (k + 1) % n, (k + 1) % n + n, k + n)
    return mesh


def plate_with_hole(half_width, hole_radius, sides, z0, z1):
    """A square plate with a round hole in its middle. The hole has `sides` corners, a multiple of 8, all at
    `hole_radius`."""
    mesh = Mesh()
    for z in (z0, z1):
        for outer in (False, True):
            for k in range(sides):
                c, s = math.cos(2 * math.pi * k / sides), math.sin(2 * math.pi * k / sides)
                r = half_width / max(abs(c), abs(s)) if outer else hole_radius
                mesh.vertices.append((r * c, r * s, z))
    for k in range(sides):
        n = (k + 1) % sides
        hole0, edge0, hole1, edge1 = ((row * sides + k, row * sides + n) for row in range(4))
        mesh.quad(hole1[0], edge1[0], edge1[1], hole1[1])  # top
        mesh.quad(hole0[0], hole0[1], edge0[1], edge0[0])  # bottom
        mesh.quad(edge0[0], edge0[1], edge1[1], edge1[0])
        mesh.quad(hole0[0], hole1[0], hole1[1], hole0[1])
    return mesh


def spline(points, steps):
    """A smooth curve through `points` (Catmull-Rom), with `steps` pieces between two of them; ends included."""
    curve = []
    for i in range(len(points) - 1):
        p0, p1, p2, p3 = points[max(i - 1, 0)], points[i], points[i + 1], points[min(i + 2, len(points) - 1)]
        for k in range(steps):
            t = k / steps
            curve.append(tuple(
                0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t * t * t)
                for a, b, c, d in zip(p0, p1, p2, p3)))
    return curve + [tuple(points[-1])]


def _ears(polygon):
    """Triangles of a simple polygon by ear clipping. The roundest ear is cut first, so that few slivers are left."""
    def turn(a, b, c):
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])

    left, triangles = list(range(len(polygon))), []
    while len(left) > 3:
        best = None
        for k in range(len(left)):
            ear = left[k - 1], left[k], left[(k + 1) % len(left)]
            a, b, c = (polygon[i] for i in ear)
            if turn(a, b, c) <= 0 or any(
                    min(turn(a, b, polygon[i]), turn(b, c, polygon[i]), turn(c, a, polygon[i])) >= 0
                    for i in left if i not in ear):
                continue
            roundness = turn(a, b, c) / max(math.dist(a, b), math.dist(b, c), math.dist(c, a)) ** 2
            if best is None or roundness > best[0]:
                best = roundness, k, ear
        assert best, 'not a simple counter-clockwise polygon'
        triangles.append(best[2])
        del left[best[1]]
    return triangles + [tuple(left)]


def _sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def _dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def _cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _unit(a):
    length = math.sqrt(_dot(a, a))
    return tuple(x / length for x in a)


# Files

def write(mesh, path, scale=1, up='z'):
    """Checks and writes `mesh`. The name decides the format: .obj, .ply (ASCII), .stl (binary), .ascii.stl. `scale`:
    units of the file per metre; `up`: the file's up-axis."""
    mesh.check()
    turn = {'z': lambda p: p, 'y': lambda p: (p[0], p[2], -p[1])}[up]
    decimals = DECIMALS - round(math.log10(scale))
    vertices = [tuple(round(scale * x, decimals) + 0.0 for x in turn(p)) for p in mesh.vertices]  # + 0.0: no -0
    path.parent.mkdir(parents=True, exist_ok=True)

    def text(p):
        return ' '.join(f'{x:.{decimals}f}'.rstrip('0').rstrip('.') for x in p)

    if path.name.endswith('.obj'):
        lines = ['# made by problems/make_problems.py']
        lines += ['v ' + text(p) for p in vertices]
        lines += ['f ' + ' '.join(str(i + 1) for i in t) for t in mesh.triangles]
    elif path.name.endswith('.ply'):
        lines = ['ply', 'format ascii 1.0', 'comment made by problems/make_problems.py', f'element vertex {len(vertices)}',
                 'property double x', 'property double y', 'property double z',
                 f'element face {len(mesh.triangles)}', 'property list uchar int vertex_indices', 'end_header']
        lines += [text(p) for p in vertices] + ['3 ' + ' '.join(map(str, t)) for t in mesh.triangles]
    elif path.name.endswith('.ascii.stl'):
        lines = ['solid made_by_make_problems']
        for t in mesh.triangles:
            lines += ['facet normal 0 0 0', ' outer loop'] + ['  vertex ' + text(vertices[i]) for i in t] + [' endloop', 'endfacet']
        lines += ['endsolid made_by_make_problems']
    else:
        data = b'made by problems/make_problems.py'.ljust(80) + struct.pack('<I', len(mesh.triangles))
        for t in mesh.triangles:
            data += struct.pack('<12fH', 0, 0, 0, *(x for i in t for x in vertices[i]), 0)
        path.write_bytes(data)
        return
    path.write_text('\n'.join(lines) + '\n', encoding='ascii', newline='\n')
