"""Checks of a scene file: planarity, simple polygons, coplanar overlaps; counts, areas, emitters."""
import math
import os

from vectors import dot, mul, newell, norm, sub


def load(path):
    v, f, mats = [], [], {}
    g = m = ""
    for ln, line in enumerate(open(path), 1):
        t = line.split("#")[0].split()
        if not t:
            continue
        if t[0] == "v":
            v.append(tuple(float(c) for c in t[1:4]))
        elif t[0] == "f":
            f.append((g, m, [int(c.split("/")[0]) - 1 for c in t[1:]], ln))
        elif t[0] == "g":
            g = " ".join(t[1:])
        elif t[0] == "usemtl":
            m = t[1]
        elif t[0] == "mtllib":
            cur = None
            for l2 in open(os.path.join(os.path.dirname(path), t[1])):
                u = l2.split("#")[0].split()
                if not u:
                    continue
                if u[0] == "newmtl":
                    cur = u[1]
                    mats[cur] = [(0.0,) * 3, (0.0,) * 3]
                elif u[0] in ("Kd", "Ke"):
                    mats[cur][u[0] == "Ke"] = tuple(float(c) for c in u[1:4])
    return v, f, mats


def project2(pts, n):
    k = max(range(3), key=lambda i: abs(n[i]))
    a, b = [(1, 2), (2, 0), (0, 1)][k]
    q = [(p[a], p[b]) for p in pts]
    return q if n[k] > 0 else [(x, -y) for x, y in q]


def orient(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def seg_cross(a, b, c, d, tol):
    """True if the segments meet (touching counts) by more than tol (an area)."""
    o1, o2, o3, o4 = orient(a, b, c), orient(a, b, d), orient(c, d, a), orient(c, d, b)
    if ((o1 > tol and o2 < -tol) or (o1 < -tol and o2 > tol)) and ((o3 > tol and o4 < -tol) or (o3 < -tol and o4 > tol)):
        return True

    def on(p, q, r, o):
        return abs(o) <= tol and min(p[0], q[0]) - 1e-12 <= r[0] <= max(p[0], q[0]) + 1e-12 and min(p[1], q[1]) - 1e-12 <= r[1] <= max(p[1], q[1]) + 1e-12

    return on(a, b, c, o1) or on(a, b, d, o2) or on(c, d, a, o3) or on(c, d, b, o4)


def triangulate2(q):
    idx = list(range(len(q)))
    out = []
    guard = 0
    while len(idx) > 3 and guard < 10000:
        guard += 1
        for k in range(len(idx)):
            i, j, l = idx[k - 1], idx[k], idx[(k + 1) % len(idx)]
            o = orient(q[i], q[j], q[l])
            if o < 0:
                continue
            if o > 0 and any(p not in (i, j, l) and q[p] not in (q[i], q[j], q[l]) and orient(q[i], q[j], q[p]) >= 0 and orient(q[j], q[l], q[p]) >= 0
                             and orient(q[l], q[i], q[p]) >= 0 for p in idx):
                continue
            if o > 0:
                out.append((q[i], q[j], q[l]))
            idx.pop(k)
            break
        else:
            break
    if len(idx) == 3:
        out.append(tuple(q[i] for i in idx))
    return out


def tri_overlap(A, B):
    """Area of the intersection of two counter-clockwise triangles."""
    p = list(A)
    for i in range(3):
        a, b = B[i], B[(i + 1) % 3]
        out = []
        for k in range(len(p)):
            c, d = p[k], p[(k + 1) % len(p)]
            oc, od = orient(a, b, c), orient(a, b, d)
            if oc >= 0:
                out.append(c)
            if (oc > 0 and od < 0) or (oc < 0 and od > 0):
                t = oc / (oc - od)
                out.append((c[0] + t * (d[0] - c[0]), c[1] + t * (d[1] - c[1])))
        p = out
        if len(p) < 3:
            return 0.0
    return abs(sum(p[i][0] * p[(i + 1) % len(p)][1] - p[(i + 1) % len(p)][0] * p[i][1] for i in range(len(p)))) / 2


def check(path, quiet=False):
    v, f, mats = load(path)
    lo = [min(p[k] for p in v) for k in range(3)]
    hi = [max(p[k] for p in v) for k in range(3)]
    size = norm(sub(hi, lo))
    bad, area, planes, em, nconc, ncol = [], 0.0, {}, [], 0, 0
    worst = 0.0
    for g, m, idx, ln in f:
        pts = [v[i] for i in idx]
        if m not in mats:
            bad.append("line %d: unknown material %s" % (ln, m))
            continue
        if len(pts) < 3 or len(set(idx)) != len(idx):
            bad.append("line %d: fewer than 3 different vertices" % ln)
            continue
        av = newell(pts)
        A = norm(av)
        if A < 1e-12 * size * size:
            bad.append("line %d: no area" % ln)
            continue
        n = mul(av, 1 / A)
        c = pts[0]
        dev = max(abs(dot(n, sub(p, c))) for p in pts)
        worst = max(worst, dev / size)
        if dev > 1e-9 * size:
            bad.append("line %d: not planar by %.3g" % (ln, dev))
        q = project2(pts, n)
        k = len(q)
        d2 = max(abs(x) for p in q for x in p) or 1
        tol = 1e-13 * d2 * d2
        if k > 3:
            for i in range(k):
                for j in range(i + 2, k):
                    if i == 0 and j == k - 1:
                        continue
                    if seg_cross(q[i], q[(i + 1) % k], q[j], q[(j + 1) % k], tol):
                        bad.append("line %d: not simple" % ln)
            turns = [orient(q[i - 1], q[i], q[(i + 1) % k]) for i in range(k)]
            nconc += any(o < -tol for o in turns)
            ncol += any(abs(o) <= tol for o in turns)
        area += A
        kd, ke = mats[m]
        if any(not (0 <= x < 1) for x in kd) or any(not (0 <= x < 1e30) for x in ke):
            bad.append("line %d: material %s out of range" % (ln, m))
        if any(ke):
            em.append((g, A, ke))
        d = dot(n, c)
        s = 1 if (n[0], n[1], n[2]) > (-n[0], -n[1], -n[2]) else -1
        key = tuple(round(s * x, 5) for x in n) + (round(s * d / size, 6),)
        planes.setdefault(key, []).append((ln, pts, mul(n, s)))
    over = 0
    if len(f) <= 20000:
        for grp in planes.values():
            if len(grp) < 2 or len(grp) > 3000:
                continue
            base = grp[0][2]
            it = []
            for ln, pts, n in grp:
                q = project2(pts, base)
                if orient_area(q) < 0:
                    q = q[::-1]
                it.append((ln, min(p[0] for p in q), max(p[0] for p in q), min(p[1] for p in q), max(p[1] for p in q), q))
            it.sort(key=lambda r: r[1])
            tr = {}
            for i in range(len(it)):
                for j in range(i + 1, len(it)):
                    a, b = it[i], it[j]
                    if b[1] >= a[2] - 1e-12:
                        break
                    if b[3] >= a[4] or a[3] >= b[4]:
                        continue
                    for r in (a, b):
                        if r[0] not in tr:
                            tr[r[0]] = triangulate2(r[5])
                    ov = sum(tri_overlap(x, y) for x in tr[a[0]] for y in tr[b[0]])
                    if ov > 1e-8 * size * size:
                        over += 1
                        if over <= 5:
                            bad.append("lines %d and %d: coplanar overlap of %.3g m^2" % (a[0], b[0], ov))
    power = [sum(math.pi * A * ke[k] for _, A, ke in em) for k in range(3)]
    print("%-22s %8d polygons %9d vertices  area %-11.6g emitters %d (area %.6g, flux %.4g %.4g %.4g W)  concave %d collinear %d  non-planarity %.1e  %s"
          % (os.path.basename(path), len(f), len(v), area, len(em), sum(A for _, A, _ in em), power[0], power[1], power[2], nconc, ncol, worst,
             "OK" if not bad else "%d PROBLEMS" % len(bad)))
    if not quiet:
        for b in bad[:12]:
            print("    " + b)
    return not bad


def orient_area(q):
    return sum(q[i][0] * q[(i + 1) % len(q)][1] - q[(i + 1) % len(q)][0] * q[i][1] for i in range(len(q))) / 2
