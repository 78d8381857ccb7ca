"""Converts the units of Blender's lights to those of exitance. Needs no Blender.

Blender's point and spot lamps have a radiant flux in W, its sun an irradiance in W/m^2, its emission shaders and its world
a radiance in W/(m^2 sr), all per channel of red, green and blue. The power of its area lamps is 4 / pi times their flux. exitance reads radiances of faces and of the sky,
W/(m^2 sr), intensities of lights without extent, W/sr, and irradiances of parallel light, W/m^2.
"""
from __future__ import annotations

import math
from typing import Any

Colour = tuple[float, float, float]


def triple(values: Any) -> Colour:
    """Returns the first three of a sequence of numbers."""
    return (float(values[0]), float(values[1]), float(values[2]))


def scaled(colour: Colour, factor: float) -> Colour:
    """Returns a colour times a number."""
    return (colour[0] * factor, colour[1] * factor, colour[2] * factor)


def point_intensity(power: float) -> float:
    """Returns the intensity, W/sr, of a point lamp of `power` watts: power / (4 pi) in all directions.

    A spot lamp has the intensity of the point lamp that it is cut from, so its flux is below its power.
    """
    return power / (4 * math.pi)


def lambertian_radiance(power: float, area: float) -> float:
    """Returns the radiance, W/(m^2 sr), of a diffuse emitter of `power` watts and `area` m^2: power / (pi area)."""
    return power / (math.pi * area)


def area_lamp_radiance(power: float, area: float) -> float:
    """Returns the radiance, W/(m^2 sr), that Cycles gives an area lamp of `power` watts and `area` m^2: power / (4 area).

    Its flux is therefore pi / 4 of its power. scripts/check_blender_addon measures this.
    """
    return power / (4 * area)


def sun_radiance(irradiance: float, angle: float) -> float:
    """Returns the radiance, W/(m^2 sr), of a solar disc.

    irradiance  on a plane that faces the sun, W/m^2
    angle       diameter of the disc, radians, in (0, pi)
    The disc has the projected solid angle pi sin^2(angle / 2).
    """
    return irradiance / (math.pi * math.sin(angle / 2) ** 2)


def exitance_of_radiance(radiance: float) -> float:
    """Returns the exitance, W/m^2, of a diffuse face of `radiance` W/(m^2 sr): pi times as much."""
    return math.pi * radiance


def spot_flux(power: float, size: float, blend: float) -> float:
    """Returns the flux, W, of a spot lamp.

    power  of the point lamp that it is cut from, W
    size   full angle of the cone, radians
    blend  share of the cone, measured in cosines, over which the light falls to 0; in [0, 1]
    Blender's falloff is t^2 (3 - 2 t), whose mean over the blend is 1/2.
    """
    width = 1 - math.cos(size / 2)
    return 2 * math.pi * point_intensity(power) * width * (1 - blend / 2)


def spot_cones(size: float, blend: float) -> tuple[float, float]:
    """Returns the half angles (inner, outer) of a glTF spot light with the flux of Blender's, radians.

    The outer cone is Blender's. The falloff of glTF is t^2, whose mean is 1/3, over a range of cosines that is 3/4 of
    Blender's: then both lose the same flux, 1/2 * width = 2/3 * (3/4 width). Within the blend the intensities differ by
    at most a fifth of the full one.
    """
    outer = min(size / 2, math.pi / 2)
    cosine = math.cos(outer) + 0.75 * blend * (1 - math.cos(outer))
    inner = math.acos(min(1.0, cosine))
    return min(inner, outer * (1 - 1e-6)), outer  # glTF requires inner < outer


def shown_radiance(reflectance: float, irradiance: float) -> float:
    """Returns the radiance, W/(m^2 sr), of a diffuse face that is shown with a light map: reflectance irradiance / pi."""
    return reflectance * irradiance / math.pi
