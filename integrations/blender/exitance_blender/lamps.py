"""Lamps of Blender as faces, lights and suns of exitance. Needs no Blender."""
from __future__ import annotations

import math

import numpy as np

from .model import Body, Faces, Light, Model, Sun, Surface
from .units import Colour, area_lamp_radiance, lambertian_radiance, point_intensity, scaled, spot_cones, sun_radiance, triple

LAMP_REFLECTANCE: Colour = (0.8, 0.8, 0.8)  # Blender's grey; light passes Blender's lamps, and black ones would darken rooms
DISC_CORNERS = 32   # of the polygon in place of a round area lamp; it has the disc's area
SMALLEST_DISC = math.radians(0.01)  # below this angle the sun is parallel light


def _emitter(name: str, corners: np.ndarray, coordinates: np.ndarray, radiance: Colour) -> Body:
    """Returns a body of triangles (n, 3, 3) that shines from its front."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    surface = Surface(name, LAMP_REFLECTANCE, radiance)
    positions = corners.reshape(-1, 3)
    return Body(name, [Faces(surface, positions, np.repeat(normals, 3, axis=0), coordinates, coordinates)])


def _area(corners: np.ndarray) -> float:
    """Returns the area of triangles (n, 3, 3)."""
    return float(np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2)


def unit_sphere() -> np.ndarray:
    """Returns the triangles (80, 3, 3) of an icosahedron whose edges are halved, with corners at distance 1 from the origin."""
    golden = (1 + math.sqrt(5)) / 2
    points = np.array([[0, s, t * golden] for s in (-1, 1) for t in (-1, 1)], dtype=float)
    points = np.concatenate([np.roll(points, k, axis=1) for k in range(3)])
    points /= np.linalg.norm(points[0])
    edge = min(np.linalg.norm(points[0] - p) for p in points[1:])
    near = np.linalg.norm(points[:, None] - points[None], axis=2) < 1.01 * edge
    triangles = [points[[i, j, k]] for i in range(12) for j in range(i + 1, 12) for k in range(j + 1, 12)
                 if near[i, j] and near[j, k] and near[i, k]]
    pieces = []
    for a, b, c in triangles:
        if np.dot(np.cross(b - a, c - a), a) < 0:
            b, c = c, b
        middles = [m / np.linalg.norm(m) for m in (a + b, b + c, c + a)]
        pieces += [[a, middles[0], middles[2]], [middles[0], b, middles[1]], [middles[2], middles[1], c], middles]
    return np.array(pieces)


def add_point(model: Model, name: str, power: Colour, position: np.ndarray, radius: float) -> None:
    """Adds a point lamp: a sphere of 80 faces with the area and flux of Blender's sphere, or a point if `radius` is 0."""
    if radius <= 0:
        intensity = scaled(power, point_intensity(1))
        model.lights.append(Light(name, "point", intensity, triple(position)))
        return
    sphere = unit_sphere()
    sphere *= radius * math.sqrt(4 * math.pi / _area(sphere))
    area = 4 * math.pi * radius**2
    cells = np.arange(len(sphere))
    grid = math.ceil(math.sqrt(len(sphere)))
    origin = np.stack([cells % grid, cells // grid], axis=1) / grid
    corner = np.array([[0.2, 0.2], [0.8, 0.2], [0.2, 0.8]]) / grid  # one cell of the light map per face
    coordinates = (origin[:, None] + corner[None]).reshape(-1, 2)
    radiance = scaled(power, lambertian_radiance(1, area))
    model.bodies.append(_emitter(name, sphere + np.asarray(position), coordinates, radiance))


def add_spot(model: Model, name: str, power: Colour, position: np.ndarray, direction: np.ndarray, size: float,
             blend: float) -> None:
    """Adds a spot lamp: a light without extent in a cone of the full angle `size`, radians."""
    intensity = scaled(power, point_intensity(1))
    model.lights.append(Light(name, "spot", intensity, triple(position), triple(direction),
                              spot_cones(size, blend)))


def add_sun(model: Model, name: str, irradiance: Colour, direction: np.ndarray, angle: float) -> None:
    """Adds a sun that shines towards `direction`: a disc of `angle` radians.

    It is parallel light if the angle is near 0, or if the sky is a picture, beside which exitance takes no disc.
    """
    towards = triple(-np.asarray(direction))
    if angle < SMALLEST_DISC or model.sky:
        model.lights.append(Light(name, "directional", irradiance, direction=triple(direction)))
        return
    angle = min(angle, math.pi)
    model.suns.append(Sun(name, scaled(irradiance, sun_radiance(1, angle)), towards, angle))


def add_area(model: Model, name: str, power: Colour, to_world: np.ndarray, width: float, height: float,
             is_round: bool) -> None:
    """Adds an area lamp: a rectangle, or a polygon of 32 corners with the area of the ellipse, that shines along its -z axis
    and has a back that reflects.

    to_world  (4, 4) from the lamp's axes to the scene's; width, height  along its x and y axes before that, metres
    """
    if is_round:
        step = 2 * math.pi / DISC_CORNERS
        radius = 0.5 * math.sqrt(step / math.sin(step))  # the area is then that of the ellipse
        angles = np.arange(DISC_CORNERS) * step
        outline = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    else:
        outline = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
    flat = np.concatenate([outline * [width, height], np.zeros((len(outline), 1))], axis=1)
    world = flat @ to_world[:3, :3].T + to_world[:3, 3]
    fan = [[0, i + 1, i] for i in range(1, len(outline) - 1)]  # clockwise seen along +z: the front looks along -z
    if np.linalg.det(to_world[:3, :3]) < 0:
        fan = [[a, c, b] for a, b, c in fan]
    corners = world[np.array(fan)]
    coordinates = (0.5 + 0.9 * outline)[np.array(fan)].reshape(-1, 2) * [0.5, 1]  # the left half of its light map
    radiance = scaled(power, area_lamp_radiance(1, _area(corners)))
    lamp = _emitter(name, corners, coordinates, radiance)
    front, right = lamp.faces[0], (coordinates + [0.5, 0])[::-1]
    lamp.faces.append(Faces(Surface(f"{name} back", LAMP_REFLECTANCE), front.positions[::-1], -front.normals, right, right))
    model.bodies.append(lamp)
