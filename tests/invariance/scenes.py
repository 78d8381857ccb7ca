"""Scenes of the invariance test: small scenes of different kinds, as plain values that transformations can change."""
import dataclasses
import math

import numpy as np


@dataclasses.dataclass
class Face:
    group: str
    material: str
    points: np.ndarray  # n x 3, metres, counter-clockwise seen from the front
    parent: int = -1  # index of the face in the original scene that contains this face


@dataclasses.dataclass
class Material:
    reflectance: tuple
    radiance: tuple = (0, 0, 0)  # W/(m^2 sr)
    transmission: float = 0  # transmittance of clear glass at normal incidence; 0: opaque
    texture: tuple = ()  # sRGB bytes of a row of pixels, repeated over the face

    @property
    def exitance(self):
        return math.pi * np.array(self.radiance, float)


@dataclasses.dataclass
class PointLight:
    position: np.ndarray
    intensity: float  # W/sr
    direction: np.ndarray = None  # None if it is not a spot
    angle: float = 0  # half the opening angle of a spot, degrees


@dataclasses.dataclass
class Luminaire:
    position: np.ndarray
    axes: np.ndarray  # columns: the directions of C0, C90, and up (opposite to its axis)


@dataclasses.dataclass
class Scene:
    name: str
    faces: list
    materials: dict
    eye: np.ndarray
    target: np.ndarray
    plane: np.ndarray  # measuring plane: rows are a corner and two edges, metres
    mesh_size: float  # element size of uniform meshes, metres
    up: np.ndarray = dataclasses.field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    sky: str = ""
    north: float = 0  # degrees clockwise from y, seen from above
    lights: list = dataclasses.field(default_factory=list)
    luminaires: list = dataclasses.field(default_factory=list)
    lamp_group: str = "lamp"  # name of its light group
    scale: float = 1  # lengths of this copy divided by those of the original
    is_lit: bool = True
    is_faulty: bool = False


GREY, WHITE, RED, LAMP = "grey", "white", "red", "lamp"
MATERIALS = {
    GREY: Material((0.5, 0.4, 0.3)),
    WHITE: Material((0.75, 0.75, 0.7)),
    RED: Material((0.6, 0.2, 0.1)),
    LAMP: Material((0, 0, 0), (20, 18, 15)),
}


def box(low, high, group, material, inward=False, without=""):
    """Faces of an upright box without those whose letters are in `without`: west, east, south, north, below, top."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    sides = {
        "w": [(x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)],
        "e": [(x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1)],
        "s": [(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)],
        "n": [(x0, y1, z0), (x0, y1, z1), (x1, y1, z1), (x1, y1, z0)],
        "b": [(x0, y0, z0), (x0, y1, z0), (x1, y1, z0), (x1, y0, z0)],
        "t": [(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)],
    }
    return [Face(group, material, np.array(p[::-1] if inward else p, float)) for k, p in sides.items() if k not in without]


def turned(faces, degrees, about):
    """Rotates faces about a vertical axis."""
    a = math.radians(degrees)
    turn = np.array([[math.cos(a), -math.sin(a), 0], [math.sin(a), math.cos(a), 0], [0, 0, 1]])
    return [Face(f.group, f.material, (f.points - about) @ turn.T + about) for f in faces]


def lamp_below(x0, y0, x1, y1, z, group="lamp"):
    """A rectangle that emits downwards."""
    return [Face(group, LAMP, np.array([(x0, y0, z), (x0, y1, z), (x1, y1, z), (x1, y0, z)], float))]


def make(name, faces, mesh_size=0.5, eye=(3.6, 0.5, 1.7), target=(1.2, 2, 0.8), plane=((0.4, 0.4, 0.8), (3.2, 0, 0), (0, 2.2, 0)),
         **more):
    for number, face in enumerate(faces):
        face.parent = number
    return Scene(name, faces, dict(more.pop("materials", MATERIALS)), np.array(eye, float), np.array(target, float),
                 np.array(plane, float), mesh_size, **more)


def room(without=""):
    """A grey room of 4 x 3 x 2.5 m."""
    return box((0, 0, 0), (4, 3, 2.5), "room", GREY, inward=True, without=without)


def lamp_and_box():
    body = turned(box((1.0, 0.9, 0), (1.8, 1.7, 0.9), "box", WHITE, without="b"), 25, (1.4, 1.3, 0))
    return make("lamp_and_box", room() + body + lamp_below(1.6, 1, 2.4, 2, 2.3))


def court():
    body = turned(box((2.2, 1, 0), (3, 1.8, 1.1), "box", RED, without="b"), 15, (2.6, 1.4, 0))
    return make("court", room(without="t") + body, sky="perez,altitude=50,azimuth=160,dni=600,dhi=120", lamp_group="")


def window():
    """A room with a pane in its eastern wall, which has no thickness."""
    y0, y1, z0, z1 = 0.8, 2.2, 0.9, 2.0
    wall = [[(4, 0, 0), (4, 0, z0), (4, 3, z0), (4, 3, 0)], [(4, 0, z1), (4, 0, 2.5), (4, 3, 2.5), (4, 3, z1)],
            [(4, 0, z0), (4, 0, z1), (4, y0, z1), (4, y0, z0)], [(4, y1, z0), (4, y1, z1), (4, 3, z1), (4, 3, z0)]]
    glass = Face("pane", "glass", np.array([(4, y0, z0), (4, y1, z0), (4, y1, z1), (4, y0, z1)], float))
    faces = room(without="e") + [Face("room", GREY, np.array(p, float)) for p in wall] + [glass]
    return make("window", faces, sky="clear,altitude=35,azimuth=110,dni=500,dhi=100", lamp_group="",
                materials=MATERIALS | {"glass": Material((0, 0, 0), transmission=0.88)})


def two_rooms():
    """Two rooms with a wall 0.1 m thick between them, and a door in it; the lamp is in one of them."""
    wall = box((1.95, 0, 0), (2.05, 1.9, 2.5), "wall", WHITE, without="sbt") + box((1.95, 2.7, 0), (2.05, 3, 2.5), "wall", WHITE, without="nbt")
    wall += box((1.95, 1.9, 2), (2.05, 2.7, 2.5), "wall", WHITE, without="snt")
    return make("two_rooms", room() + wall + lamp_below(0.6, 1, 1.2, 2, 2.4))


def slats():
    """Twelve slats without thickness, each of two faces, between the lamp and half of the room."""
    faces = []
    for i in range(12):
        y = 0.4 + 0.2 * i
        sheet = np.array([(0.5, y, 1.4), (2.5, y, 1.4), (2.5, y + 0.12, 1.5), (0.5, y + 0.12, 1.5)])
        faces += [Face("slats", WHITE, sheet), Face("slats", WHITE, sheet[::-1].copy())]
    return make("slats", room() + faces + lamp_below(1.2, 1.1, 1.8, 1.7, 2.3))


def stairs():
    """A flight of five steps whose sides are concave polygons."""
    faces, n, run, rise = [], 5, 0.3, 0.18
    outline = [(1, 0)]
    for i in range(n):
        outline += [(1 + run * i, rise * (i + 1)), (1 + run * (i + 1), rise * (i + 1))]
    outline.append((1 + run * n, 0))
    side = np.array([(x, 1.0, z) for x, z in outline])
    faces.append(Face("stairs", WHITE, side[::-1].copy()))
    faces.append(Face("stairs", WHITE, side + (0, 1, 0)))
    for (x0, z0), (x1, z1) in zip(outline, outline[1:]):
        faces.append(Face("stairs", WHITE, np.array([(x0, 1, z0), (x0, 2, z0), (x1, 2, z1), (x1, 1, z1)])[::-1].copy()))
    return make("stairs", room() + faces + lamp_below(0.4, 1, 0.9, 2, 2.3))


def concave_room():
    """An L-shaped room whose floor and ceiling are one concave polygon each."""
    plan = [(0, 0), (4, 0), (4, 1.4), (1.6, 1.4), (1.6, 3), (0, 3)]
    floor = np.array([(x, y, 0.0) for x, y in plan])
    faces = [Face("floor", WHITE, floor), Face("ceiling", GREY, (floor + (0, 0, 2.5))[::-1].copy())]
    for (x0, y0), (x1, y1) in zip(plan, plan[1:] + plan[:1]):
        faces.append(Face("walls", GREY, np.array([(x0, y0, 0), (x0, y0, 2.5), (x1, y1, 2.5), (x1, y1, 0)])))
    return make("concave_room", faces + lamp_below(2.6, 0.3, 3.4, 1.1, 2.3), eye=(3.7, 0.4, 1.6), target=(0.5, 1.2, 0.8),
                plane=((0.3, 0.3, 0.8), (1, 0, 0), (0, 2.4, 0)))


def piercing():
    """Intersecting triangles with two sides."""
    corners = [[(0.8, 0.8, 0.4), (2.6, 1.0, 0.9), (1.4, 2.4, 1.6)], [(2.5, 2.3, 0.5), (1.0, 1.2, 1.5), (2.8, 1.1, 1.2)],
               [(0.7, 1.9, 1.1), (2.3, 0.6, 0.6), (2.2, 2.2, 1.3)]]
    faces = []
    for triangle in corners:
        p = np.array(triangle)
        faces += [Face("triangles", RED, p), Face("triangles", WHITE, p[::-1].copy())]
    return make("piercing", room() + faces + lamp_below(1.5, 1.2, 2.1, 1.8, 2.3))


def outdoor():
    ground = [Face("ground", GREY, np.array([(-10, -10, 0), (10, -10, 0), (10, 10, 0), (-10, 10, 0)], float))]
    bodies = turned(box((-4, -3, 0), (-1, 1, 4), "house", WHITE, without="b"), 20, (-2, -1, 0))
    bodies += box((2, 1, 0), (5, 5, 2.5), "shed", RED, without="b")
    bodies += box((1, -4, 2), (3, -2, 2.3), "canopy", WHITE)
    return make("outdoor", ground + bodies, mesh_size=2, eye=(8, -8, 6), target=(0, 0, 1), plane=((-8, -8, 1), (6, 0, 0), (0, 4, 0)),
                sky="perez,altitude=40,azimuth=200,dni=500,dhi=150", lamp_group="")


def luminaires():
    """Two luminaires with a photometric file whose light differs between C0 and C90."""
    quarter = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]], float)
    a = math.radians(30)
    tilted = np.array([[math.cos(a), 0, math.sin(a)], [0, 1, 0], [-math.sin(a), 0, math.cos(a)]])
    body = box((1.4, 0.8, 0), (2.2, 1.6, 0.7), "table", WHITE, without="b")
    return make("luminaires", room() + body, lamp_group="",
                luminaires=[Luminaire(np.array([1.2, 1.5, 2.3]), quarter), Luminaire(np.array([3.0, 1.2, 2.2]), tilted)])


def points():
    body = turned(box((1.4, 0.8, 0), (2.2, 1.6, 0.7), "table", WHITE, without="b"), 40, (1.8, 1.2, 0))
    down = np.array([0.3, 0.2, -1]) / math.sqrt(1.13)
    return make("points", room() + body, lamp_group="",
                lights=[PointLight(np.array([1.1, 2.0, 2.1]), 12), PointLight(np.array([2.6, 1.0, 2.2]), 30, down, 35)])


def materials():
    """Closed bodies of several materials, one of them with a texture, in a closed room with two lamps."""
    bodies = turned(box((0.8, 0.7, 0), (1.6, 1.5, 0.8), "first", RED, without="b"), 35, (1.2, 1.1, 0))
    bodies += box((2.4, 1.6, 0.6), (3, 2.2, 1.2), "second", "blue") + box((2.2, 0.4, 0), (2.9, 1, 1.5), "third", "tiles", without="b")
    return make("materials", room() + bodies + lamp_below(1.6, 1.2, 2.2, 1.8, 2.3) + lamp_below(0.2, 2.2, 0.6, 2.8, 2.4, "second lamp"),
                materials=MATERIALS | {"blue": Material((0.1, 0.2, 0.7)),
                                       "tiles": Material((0.9, 0.9, 0.9), texture=((200, 60, 60), (60, 200, 90), (90, 90, 200), (220, 220, 220)))})


def enclosure():
    """A closed enclosure with bodies and no light, for view factors."""
    bodies = turned(box((0.8, 0.7, 0.4), (1.6, 1.5, 1.2), "heater", RED), 35, (1.2, 1.1, 0)) + box((2.4, 1.4, 0), (3, 2.2, 1.4), "desk", WHITE, without="b")
    return make("enclosure", room() + bodies, is_lit=False)


def faulty():
    """Faulty faces: self-intersecting, bent, with a spike, repeated, and without area."""
    def face(group, *points):
        return Face(group, RED, np.array(points, float))

    faults = [face("crossing", (1, 1, 1), (2, 2, 1.2), (2, 1, 1.1), (1, 2.2, 1.12)),
              face("bent", (0.5, 0.5, 0.5), (1.5, 0.5, 0.5), (1.5, 1.5, 0.6), (0.5, 1.5, 0.5)),
              face("spike", (2.5, 0.5, 0.5), (3.5, 0.5, 0.5), (3.5, 2.5, 0.5), (3.5, 1.5, 0.5), (2.5, 1.5, 0.5)),
              face("repeated", (2.5, 2, 0.5), (3, 2, 0.5), (3, 2.5, 0.5)), face("repeated", (2.5, 2, 0.5), (3, 2, 0.5), (3, 2.5, 0.5)),
              face("line", (0.2, 2.5, 1), (0.6, 2.5, 1), (1.2, 2.5, 1))]
    return make("faulty", room() + faults + lamp_below(1.6, 1, 2.4, 2, 2.3), is_faulty=True)


ALL = [lamp_and_box, court, window, two_rooms, slats, stairs, concave_room, piercing, outdoor, luminaires, points, materials,
       enclosure, faulty]
