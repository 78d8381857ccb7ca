"""Changes of a scene that do not affect its light, and the same changes of points and directions."""
import copy
import math
import random

import numpy as np


class Similarity:
    """x -> scale * turn x + shift."""

    def __init__(self, turn=None, shift=(0, 0, 0), scale=1.0):
        self.turn = np.eye(3) if turn is None else turn
        self.shift = np.array(shift, float)
        self.scale = scale

    def points(self, p):
        return self.scale * (p @ self.turn.T) + self.shift

    def directions(self, d):
        return d @ self.turn.T

    def scene(self, original, _random):
        scene = copy.deepcopy(original)
        for face in scene.faces:
            face.points = self.points(face.points)
        for light in scene.lights:
            light.position = self.points(light.position)
            light.intensity *= self.scale**2
            if light.direction is not None:
                light.direction = self.directions(light.direction)
        for luminaire in scene.luminaires:
            luminaire.position, luminaire.axes = self.points(luminaire.position), self.turn @ luminaire.axes
        scene.eye, scene.target, scene.up = self.points(scene.eye), self.points(scene.target), self.directions(scene.up)
        scene.plane = np.vstack([self.points(scene.plane[0]), self.scale * self.directions(scene.plane[1:])])
        scene.mesh_size *= self.scale
        scene.scale *= self.scale
        # North rotates with the scene about the vertical.
        scene.north = (scene.north - math.degrees(math.atan2(self.turn[1, 0], self.turn[0, 0]))) % 360
        return scene


class Unmoved(Similarity):
    """Changes the description of faces without moving them."""

    def __init__(self, change):
        super().__init__()
        self.change = change

    def scene(self, original, rng):
        scene = copy.deepcopy(original)
        self.change(scene, rng)
        return scene


def reorder(scene, rng):
    """Permutes the faces and changes their first corners."""
    rng.shuffle(scene.faces)
    for face in scene.faces:
        face.points = np.roll(face.points, rng.randrange(len(face.points)), axis=0)


def is_inside(p, outline):
    """Tests whether a point is in an outline by the even-odd rule, in 2D."""
    inside = False
    for a, b in zip(outline, np.roll(outline, -1, axis=0)):
        if (a[1] > p[1]) != (b[1] > p[1]) and p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]):
            inside = not inside
    return inside


def side(a, b, p):
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


def crosses(a, b, c, d):
    return side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0


def in_plane(points):
    """Projects the points to two dimensions, counter-clockwise."""
    normal = newell(points)
    u = points[1] - points[0]
    u = u / np.linalg.norm(u)
    v = np.cross(normal / np.linalg.norm(normal), u)
    return np.stack([(points - points[0]) @ u, (points - points[0]) @ v], axis=1)


def newell(points):
    """Normal vector with twice the area as its length."""
    q = points - points[0]
    return np.cross(q, np.roll(q, -1, axis=0)).sum(axis=0)


def halves(points):
    """Splits a polygon along an inner chord between corners or between midpoints of edges, into the most equal parts."""
    n = len(points)
    more = np.empty((2 * n, 3))
    more[0::2], more[1::2] = points, (points + np.roll(points, -1, axis=0)) / 2
    flat = in_plane(more)
    area = abs(np.linalg.norm(newell(points)))
    best = None
    for i in range(2 * n):
        for j in range(i + 2, 2 * n - (i == 0)):
            if (i + j) % 2:  # skip chords between a corner and a midpoint: the other two kinds are enough
                continue
            middle = (flat[i] + flat[j]) / 2
            edges = [(flat[k], flat[(k + 1) % (2 * n)]) for k in range(2 * n)]
            if not is_inside(middle, flat) or any(crosses(flat[i], flat[j], a, b) for a, b in edges):
                continue
            passes = [abs(side(flat[i], flat[j], p)) < 1e-9 * area for k, p in enumerate(flat) if k not in (i, j)
                      and (p - flat[i]) @ (flat[j] - flat[i]) > 0 and (p - flat[j]) @ (flat[i] - flat[j]) > 0]
            if any(passes):
                continue
            keep = [k for k in range(2 * n) if k % 2 == 0 or k in (i, j)]
            first, second = [k for k in keep if i <= k <= j], [k for k in keep if k >= j or k <= i]
            parts = [more[first], more[second]]
            least = min(np.linalg.norm(newell(p)) for p in parts)
            if best is None or least > 1.001 * best[0]:
                best = least, parts
    return best[1]


def cut(scene, _rng):
    faces = []
    for face in scene.faces:
        for part in halves(face.points):
            twin = copy.copy(face)
            twin.points = part
            faces.append(twin)
    scene.faces = faces


def jitter(scene, rng):
    """Moves corners by up to 1e-12 of the scene's size; coincident corners stay coincident."""
    corners = np.vstack([face.points for face in scene.faces])
    step = 1e-12 * np.linalg.norm(corners.max(axis=0) - corners.min(axis=0))
    moved = {}
    for face in scene.faces:
        face.points = np.array([moved.setdefault(tuple(p), p + np.array([rng.uniform(-step, step) for _ in range(3)]))
                                for p in face.points])


def turn(axis, degrees):
    axis = np.array(axis, float) / np.linalg.norm(axis)
    a = math.radians(degrees)
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + math.sin(a) * cross + (1 - math.cos(a)) * cross @ cross


QUARTER = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]], float)


def transformations(scene):
    """Transformations by name, first the identity. Scenes with a sky are only rotated about the vertical."""
    axis = (0, 0, 1) if scene.sky else (1, 2, 3)
    return {
        "as it is": Similarity(),
        "quarter turn": Similarity(QUARTER),
        "odd turn": Similarity(turn(axis, 37.3)),
        "moved": Similarity(shift=(640, -720, 269.072481)),
        "small": Similarity(scale=1e-3),
        "large": Similarity(scale=1e3),
        "other order": Unmoved(reorder),
        "cut": Unmoved(cut),
        "jittered": Unmoved(jitter),
    }


def transformed(scene, name):
    transformation = transformations(scene)[name]
    return transformation, transformation.scene(scene, random.Random(1))
