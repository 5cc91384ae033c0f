"""Reads triangle meshes: STL, OBJ and PLY. For tests only; written from the definitions of the formats."""

import pathlib
import struct

import numpy as np

_PLY_TYPES = {
    "char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d",
    "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I", "float32": "f", "float64": "d",
}  # fmt: skip


def read_mesh(file):
    """Returns the vertices (N×3, as stored) and the triangles (M×3, indices) of a mesh file."""
    data = pathlib.Path(file).read_bytes()
    return {".stl": _stl, ".obj": _obj, ".ply": _ply}[pathlib.Path(file).suffix.lower()](data)


def _stl(data):
    count = struct.unpack_from("<I", data, 80)[0] if len(data) >= 84 else -1
    if len(data) == 84 + 50 * count:
        facets = np.frombuffer(data, np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]), count, 84)
        points = facets["v"].reshape(-1, 3).astype(float)
    else:
        lines = (line.split() for line in data.decode().splitlines())
        points = np.array([[float(word) for word in line[1:]] for line in lines if line[:1] == ["vertex"]])
    return points, np.arange(len(points)).reshape(-1, 3)


def _obj(data):
    vertices, triangles = [], []
    for line in data.decode().splitlines():
        words = line.split("#")[0].split()
        if words[:1] == ["v"]:
            vertices.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) for word in words[1:]]
            corners = [c - 1 if c > 0 else len(vertices) + c for c in corners]
            triangles += [[corners[0], corners[i], corners[i + 1]] for i in range(1, len(corners) - 1)]
    return np.array(vertices), np.array(triangles)


def _ply(data):
    head, _, body = data.partition(b"end_header\n")
    elements, form = [], ""
    for words in (line.split() for line in head.decode().splitlines()):
        if words[:1] == ["format"]:
            form = words[1]
        elif words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            elements[-1][2].append(words[1:])
    words = iter(body.split()) if form == "ascii" else None
    order, offset = ("<" if form == "binary_little_endian" else ">"), 0

    def number(kind):
        nonlocal offset
        if words is not None:
            return float(next(words))
        code = order + _PLY_TYPES[kind]
        offset += struct.calcsize(code)
        return struct.unpack_from(code, body, offset - struct.calcsize(code))[0]

    vertices, triangles = [], []
    for name, count, properties in elements:
        for _ in range(count):
            values = {}
            for p in properties:
                values[p[-1]] = [number(p[2]) for _ in range(int(number(p[1])))] if p[0] == "list" else number(p[0])
            if name == "vertex":
                vertices.append([values["x"], values["y"], values["z"]])
            elif name == "face":
                c = [int(v) for v in next(v for v in values.values() if isinstance(v, list))]
                triangles += [[c[0], c[i], c[i + 1]] for i in range(1, len(c) - 1)]
    return np.array(vertices), np.array(triangles)
