"""Vectors and polygons of test scenes: tuples of three numbers."""
import math


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def mul(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def norm(a):
    return math.sqrt(dot(a, a))


def newell(pts):
    """Area vector (normal times area) of a polygon."""
    o = pts[0]
    x = y = z = 0.0
    for i in range(1, len(pts) - 1):
        c = cross(sub(pts[i], o), sub(pts[i + 1], o))
        x += c[0]
        y += c[1]
        z += c[2]
    return (x / 2, y / 2, z / 2)
