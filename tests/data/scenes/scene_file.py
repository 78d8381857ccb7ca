"""Scenes of polygons, and their OBJ and MTL files."""
import math
import os

from vectors import dot, mul, newell, sub


def rgb(v):
    return (v, v, v) if isinstance(v, (int, float)) else tuple(v)


class Scene:
    def __init__(self, name, note):
        self.name = name
        self.note = note
        self.vid = {}
        self.v = []
        self.f = []  # (group, material, indices)
        self.mats = {}  # name -> (kd, ke)
        self.xf = None

    def mat(self, name, kd, ke=0.0):
        self.mats[name] = (rgb(kd), rgb(ke))
        return name

    def vert(self, p):
        k = (p[0] + 0.0, p[1] + 0.0, p[2] + 0.0)
        i = self.vid.get(k)
        if i is None:
            i = len(self.v)
            self.v.append(k)
            self.vid[k] = i
        return i

    def poly(self, g, m, pts, toward=None, away=None):
        """Add a face. With toward/away the winding is set so that the front sees / does not see that point."""
        pts = [tuple(float(c) for c in p) for p in pts]
        if toward is not None or away is not None:
            n = newell(pts)
            c = mul([sum(p[k] for p in pts) for k in range(3)], 1.0 / len(pts))
            s = dot(n, sub(toward, c)) if toward is not None else -dot(n, sub(away, c))
            if s < 0:
                pts.reverse()
        self.f.append((g, m, [self.vert(p) for p in pts]))

    def quad_z(self, g, m, x0, y0, x1, y1, z, up=True):
        p = [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)]
        self.poly(g, m, p if up else p[::-1])

    def hexa(self, g, m, base, top, faces="bt*"):
        """Prism-like solid: base and top are matching loops, counter-clockwise seen from above; outward fronts.
        faces: b bottom, t top, * all sides, or digits for single sides (side i joins vertex i and i+1)."""
        n = len(base)
        if "b" in faces:
            self.poly(g, m, base[::-1])
        if "t" in faces:
            self.poly(g, m, top)
        for i in range(n):
            if "*" in faces or str(i) in faces:
                j = (i + 1) % n
                self.poly(g, m, [base[i], base[j], top[j], top[i]])

    def box(self, g, m, lo, hi, faces="bt*", T=None):
        """Axis-aligned box in local coordinates, T maps to world. Sides: 0 = -y, 1 = +x, 2 = +y, 3 = -x."""
        x0, y0, z0 = lo
        x1, y1, z1 = hi
        b = [(x0, y0, z0), (x1, y0, z0), (x1, y1, z0), (x0, y1, z0)]
        t = [(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)]
        if T:
            b = [T(p) for p in b]
            t = [T(p) for p in t]
        self.hexa(g, m, b, t, faces)

    def transform(self, fn):
        self.v = [fn(p) for p in self.v]

    def write(self, folder):
        os.makedirs(folder, exist_ok=True)
        with open(os.path.join(folder, self.name + ".mtl"), "w") as o:
            o.write("# %s: %s\n" % (self.name, self.note))
            for n, (kd, ke) in self.mats.items():
                o.write("newmtl %s\nKd %.6g %.6g %.6g\n" % ((n,) + kd))
                if any(ke):
                    o.write("Ke %.6g %.6g %.6g\n" % ke)
        with open(os.path.join(folder, self.name + ".obj"), "w") as o:
            o.write("# %s: %s\n# %d polygons\nmtllib %s.mtl\n" % (self.name, self.note, len(self.f), self.name))
            for p in self.v:
                o.write("v " + " ".join(coord(c) for c in p) + "\n")
            cg = cm = None
            for g, m, idx in self.f:
                if g != cg:
                    o.write("g %s\n" % g)
                    cg = g
                if m != cm:
                    o.write("usemtl %s\n" % m)
                    cm = m
                o.write("f " + " ".join(str(i + 1) for i in idx) + "\n")
        return len(self.f)


def coord(c):
    """Decimal text of a coordinate: 12 decimals near 1, full precision far from the origin or in tiny scenes."""
    if c == 0 or (abs(c) < 1e3 and abs(round(c, 12) - c) < 1e-9 * abs(c)):
        return "%.12g" % (round(c, 12) + 0.0)
    return "0" if abs(c) < 1e-15 else "%.16g" % c


def placer(x, y, z, deg=0.0):
    c, s = math.cos(math.radians(deg)), math.sin(math.radians(deg))
    if deg % 90 == 0:
        c, s = float(round(c)), float(round(s))
    return lambda p: (x + c * p[0] - s * p[1], y + s * p[0] + c * p[1], z + p[2])
