#!/usr/bin/env python3
"""Makes the robots with joints: the meshes of their links, and their URDF and SRDF files.

    python3 robots/make_robots.py

Every run makes the same bytes. The robot.yaml files beside them are written by hand; the rigid robots' meshes are made
by problems/make_problems.py.
"""

import math
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT.parent / 'problems'))
from mesh_tools import Mesh, box, carve, revolve, spline, write  # noqa: E402

HALF = math.pi / 2


# Parts of links: round housings with rounded edges, as castings have

def housing(radius, low, high, sides=36, edge=0.25, waist=1.0):
    """A round housing along z, from `low` to `high`. `edge`: the radius of its rounded edges; `waist`: the radius in its
    middle; both as shares of `radius`."""
    e = min(edge * radius, 0.45 * (high - low))
    profile = [(0, low)]
    for k in range(5):
        a = HALF * k / 4
        profile.append((radius - e + e * math.sin(a), low + e - e * math.cos(a)))
    for k in range(1, 8):
        s = k / 8
        shape = 1 - (1 - waist) * math.sin(math.pi * s) ** 2
        profile.append((radius * shape, low + e + s * (high - low - 2 * e)))
    for k in range(5):
        a = HALF * k / 4
        profile.append((radius - e + e * math.cos(a), high - e + e * math.sin(a)))
    return revolve(profile + [(0, high)], sides)


def along_y(mesh):
    """A part along z, laid along y."""
    return mesh.mapped(lambda p: (p[0], p[2], -p[1]))


def barrel(radius, low, high, z=0.0, y=0.0, sides=36):
    """The housing of a joint that turns about y."""
    return along_y(housing(radius, low, high, sides)).moved((0, y, z))


def gripper(z0, opening=0.07):
    """A palm and two fingers that point along z."""
    palm = carve([((-0.022, -0.075, z0), (0.022, 0.075, z0 + 0.05))])
    fingers = Mesh()
    for side in (-1, 1):
        y = side * opening / 2
        low, high = sorted((y, y + side * 0.014))
        fingers += carve([((-0.011, low, z0 + 0.052), (0.011, high, z0 + 0.12)), ((-0.009, low, z0 + 0.12), (0.009, high, z0 + 0.125))])
    return palm + fingers


# URDF

def number(x):
    return f'{x:.6f}'.rstrip('0').rstrip('.') if x else '0'


def numbers(v):
    return ' '.join(number(x) for x in v)


class Urdf:
    """Collects links and joints, and writes them as a URDF."""

    def __init__(self, name):
        self.name, self.parts = name, []

    def link(self, name, *collisions):
        if not collisions:
            self.parts.append(f'  <link name="{name}"/>')
            return
        rows = [f'  <link name="{name}">']
        for geometry, xyz, rpy in collisions:
            rows += ['    <collision>', f'      <origin xyz="{numbers(xyz)}" rpy="{numbers(rpy)}"/>', f'      <geometry>{geometry}</geometry>', '    </collision>']
        self.parts.append('\n'.join(rows + ['  </link>']))

    def joint(self, name, kind, parent, child, xyz=(0, 0, 0), rpy=(0, 0, 0), axis=None, limits=None):
        rows = [f'  <joint name="{name}" type="{kind}">', f'    <parent link="{parent}"/>', f'    <child link="{child}"/>',
                f'    <origin xyz="{numbers(xyz)}" rpy="{numbers(rpy)}"/>']
        if axis:
            rows.append(f'    <axis xyz="{numbers(axis)}"/>')
        if limits:
            rows.append(f'    <limit lower="{number(limits[0])}" upper="{number(limits[1])}" effort="100" velocity="2"/>')
        self.parts.append('\n'.join(rows + ['  </joint>']))

    def write(self, path):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f'<?xml version="1.0"?>\n<!-- made by robots/make_robots.py -->\n<robot name="{self.name}">\n' + '\n'.join(self.parts) + '\n</robot>\n')


def mesh(file, scale=None):
    return f'<mesh filename="{file}"' + (f' scale="{numbers((scale,) * 3)}"' if scale else '') + '/>', (0, 0, 0), (0, 0, 0)


def box_at(size, xyz=(0, 0, 0), rpy=(0, 0, 0)):
    return f'<box size="{numbers(size)}"/>', xyz, rpy


def cylinder_at(radius, length, xyz=(0, 0, 0), rpy=(0, 0, 0)):
    return f'<cylinder radius="{number(radius)}" length="{number(length)}"/>', xyz, rpy


def write_srdf(path, name, groups, states=(), disabled=()):
    """`groups`: name -> (base link, tip link); `states`: (name, group, {joint: value}); `disabled`: (link, link, reason)."""
    rows = ['<?xml version="1.0"?>', '<!-- made by robots/make_robots.py -->', f'<robot name="{name}">']
    for group, (base, tip) in groups.items():
        rows += [f'  <group name="{group}">', f'    <chain base_link="{base}" tip_link="{tip}"/>', '  </group>']
    for state, group, values in states:
        rows.append(f'  <group_state name="{state}" group="{group}">')
        rows += [f'    <joint name="{joint}" value="{number(value)}"/>' for joint, value in values.items()]
        rows.append('  </group_state>')
    rows += [f'  <disable_collisions link1="{a}" link2="{b}" reason="{why}"/>' for a, b, why in disabled]
    path.write_text('\n'.join(rows + ['</robot>']) + '\n')


# A 7-joint arm: roll and bend joints alternate, all in one line

ARM7 = [  # joint, height of its origin in the parent link, axis, limits
    ('pan', 0.16, (0, 0, 1), 2.9), ('lift', 0.20, (0, 1, 0), 2.0), ('roll', 0.20, (0, 0, 1), 2.9), ('elbow', 0.20, (0, 1, 0), 2.4),
    ('wrist', 0.20, (0, 0, 1), 2.9), ('bend', 0.19, (0, 1, 0), 2.1), ('tool', 0.09, (0, 0, 1), 2.9)]
ARM7_LINKS = ['base', 'shoulder', 'upper_arm', 'elbow_link', 'forearm', 'wrist_link', 'palm', 'hand']


def make_arm7():
    foot = [(0, 0), (0.11, 0), (0.115, 0.006), (0.115, 0.018), (0.11, 0.024), (0.092, 0.03), (0.086, 0.05), (0.082, 0.14), (0.078, 0.155), (0, 0.155)]
    parts = {
        'base': revolve([(r, z) for r, z in foot[:1]] + spline(foot[1:-1], 3) + foot[-1:], 48),
        'shoulder': housing(0.078, 0.0, 0.15, 48) + barrel(0.074, -0.088, 0.088, z=0.20, sides=44),
        'upper_arm': housing(0.066, -0.06, 0.195, 44, edge=0.6, waist=0.92),
        'elbow_link': housing(0.066, 0.0, 0.15, 44) + barrel(0.062, -0.074, 0.074, z=0.20, sides=40),
        'forearm': housing(0.055, -0.05, 0.195, 40, edge=0.6, waist=0.9),
        'wrist_link': housing(0.054, 0.0, 0.145, 40) + barrel(0.05, -0.06, 0.06, z=0.19, sides=36),
        'palm': housing(0.045, -0.04, 0.085, 36, edge=0.6),
        'hand': housing(0.04, 0.0, 0.03, 36) + gripper(0.032)}
    urdf = Urdf('arm7')
    for link in ARM7_LINKS:
        write(parts[link], ROOT / f'arm7/{link}.stl')
        urdf.link(link, mesh(f'package://arm7/{link}.stl'))
    for (joint, z, axis, limit), parent, child in zip(ARM7, ARM7_LINKS, ARM7_LINKS[1:]):
        urdf.joint(joint, 'revolute', parent, child, (0, 0, z), axis=axis, limits=(-limit, limit))
    urdf.write(ROOT / 'arm7/arm7.urdf')
    up = {joint: 0 for joint, *_ in ARM7}
    write_srdf(ROOT / 'arm7/arm7.srdf', 'arm7', {'arm': ('base', 'hand')},
               [('up', 'arm', up), ('ready', 'arm', dict(up, lift=-0.4, elbow=1.9, bend=1.5))],
               [('palm', 'wrist_link', 'Adjacent')])


# A 6-joint arm with its links side by side

def arm6_parts():
    return {
        'base': revolve([(0, 0), (0.085, 0), (0.09, 0.005), (0.09, 0.02), (0.075, 0.03), (0.07, 0.075), (0, 0.075)], 48),
        'shoulder': housing(0.066, -0.04, 0.05, 44) + barrel(0.062, -0.06, 0.066, z=0.0, sides=44),
        'upper_arm': barrel(0.062, -0.06, 0.06, sides=44) + housing(0.05, 0.03, 0.40, 40, waist=0.88) + barrel(0.054, -0.056, 0.056, z=0.42, sides=40),
        'forearm': barrel(0.054, -0.05, 0.05, sides=40) + housing(0.042, 0.03, 0.35, 36, waist=0.88) + barrel(0.043, -0.05, 0.046, z=0.38, sides=36),
        'wrist1': barrel(0.042, -0.048, 0.045, sides=36) + housing(0.04, -0.042, 0.05, 36),
        'wrist2': housing(0.04, -0.046, 0.045, 36) + barrel(0.039, -0.04, 0.05, sides=36),
        'hand': along_y(housing(0.036, -0.036, 0.03, 36) + gripper(0.032))}


ARM6 = [  # joint, parent, child, origin, axis, limits
    ('pan', 'base', 'shoulder', (0, 0, 0.16), (0, 0, 1), 3.1), ('lift', 'shoulder', 'upper_arm', (0, 0.13, 0), (0, 1, 0), 2.2),
    ('elbow', 'upper_arm', 'forearm', (0, -0.112, 0.42), (0, 1, 0), 2.7), ('wrist1', 'forearm', 'wrist1', (0, 0.098, 0.38), (0, 1, 0), 3.1),
    ('wrist2', 'wrist1', 'wrist2', (0, 0, 0.098), (0, 0, 1), 3.1), ('wrist3', 'wrist2', 'hand', (0, 0.09, 0), (0, 1, 0), 3.1)]


def add_arm6(urdf, package, prefix='', scale=None):
    s = scale or 1
    for link in arm6_parts():
        urdf.link(prefix + link, mesh(f'package://{package}/{link}.stl', scale))
    for joint, parent, child, xyz, axis, limit in ARM6:
        urdf.joint(prefix + joint, 'revolute', prefix + parent, prefix + child, [s * x for x in xyz], axis=axis, limits=(-limit, limit))


def make_arm6():
    for link, part in arm6_parts().items():
        write(part, ROOT / f'arm6/{link}.stl')
    urdf = Urdf('arm6')
    add_arm6(urdf, 'arm6')
    urdf.write(ROOT / 'arm6/arm6.urdf')
    zero = {joint: 0 for joint, *_ in ARM6}
    write_srdf(ROOT / 'arm6/arm6.srdf', 'arm6', {'arm': ('base', 'hand')},
               [('up', 'arm', zero), ('ready', 'arm', dict(zero, lift=-0.9, elbow=2.0, wrist1=0.4))])


# A mobile manipulator: a cart that drives and rotates in the plane carries the 6-joint arm at three quarters of its size

def make_rover():
    body = carve([((-0.36, -0.25, 0.08), (0.36, 0.25, 0.30)), ((-0.30, -0.21, 0.30), (-0.02, 0.21, 0.46))])
    wheel = along_y(housing(0.09, -0.03, 0.03, 40, edge=0.2))
    for x in (-0.22, 0.22):
        for y in (-0.285, 0.285):
            body += wheel.moved((x, y, 0.09))
    body += housing(0.03, 0.46, 0.75, 24).moved((-0.22, 0, 0))  # a mast with a camera
    body += box((-0.27, -0.06, 0.75), (-0.15, 0.06, 0.79))
    write(body, ROOT / 'rover/cart.stl')
    urdf = Urdf('rover')
    urdf.link('ground')
    urdf.link('cart', mesh('package://rover/cart.stl'))
    urdf.joint('drive', 'planar', 'ground', 'cart', axis=(0, 0, 1))
    add_arm6(urdf, 'arm6', 'arm_', 0.75)
    urdf.joint('mount', 'fixed', 'cart', 'arm_base', (0.18, 0, 0.302))
    urdf.write(ROOT / 'rover/rover.urdf')


# A gantry of primitives: three prismatic joints, and a gripper that rotates

def make_gantry():
    urdf = Urdf('gantry')
    urdf.link('frame', *[box_at((0.1, 0.1, 2.0), (x, y, 1.0)) for x in (-1.6, 1.6) for y in (-1.05, 1.05)],
              *[box_at((3.3, 0.1, 0.1), (0, y, 2.05)) for y in (-1.05, 1.05)])
    urdf.link('bridge', box_at((0.14, 2.2, 0.14), (0, 0, 0)), *[box_at((0.2, 0.16, 0.1), (0, y, -0.02)) for y in (-1.05, 1.05)])
    urdf.link('carriage', box_at((0.26, 0.2, 0.12), (0, 0, 0.14)), box_at((0.05, 0.2, 0.34), (0.105, 0, 0)))
    urdf.link('ram', box_at((0.06, 0.06, 1.1), (0.17, 0, 0.35)))
    tool = (cylinder_at(0.045, 0.06, (0, 0, -0.03)), box_at((0.04, 0.22, 0.03), (0, 0, -0.075)),
            box_at((0.03, 0.015, 0.1), (0, 0.1, -0.14)), box_at((0.03, 0.015, 0.1), (0, -0.1, -0.14)))
    urdf.link('gripper', *tool)
    urdf.joint('x', 'prismatic', 'frame', 'bridge', (0, 0, 2.2), axis=(1, 0, 0), limits=(-1.35, 1.35))
    urdf.joint('y', 'prismatic', 'bridge', 'carriage', axis=(0, 1, 0), limits=(-0.85, 0.85))
    urdf.joint('z', 'prismatic', 'carriage', 'ram', axis=(0, 0, 1), limits=(-1.5, 0))
    urdf.joint('turn', 'continuous', 'ram', 'gripper', (0.17, 0, -0.2), axis=(0, 0, 1))
    urdf.write(ROOT / 'gantry/gantry.urdf')


# A chain of ten links in the plane

def make_snake():
    links, length = 10, 0.24
    urdf = Urdf('snake')
    urdf.link('head_post', cylinder_at(0.05, 0.1))
    names = ['head_post'] + [f'link{k}' for k in range(1, links + 1)]
    for name in names[1:]:
        urdf.link(name, box_at((length - 0.04, 0.035, 0.06), (length / 2, 0, 0)), cylinder_at(0.025, 0.06, (length, 0, 0)))
    for k, (parent, child) in enumerate(zip(names, names[1:])):
        urdf.joint(f'joint{k + 1}', 'revolute', parent, child, (length if k else 0, 0, 0), axis=(0, 0, 1), limits=(-2.2, 2.2) if k else (-3.1, 3.1))
    urdf.write(ROOT / 'snake/snake.urdf')


if __name__ == '__main__':
    make_arm7()
    make_arm6()
    make_rover()
    make_gantry()
    make_snake()
