"""Furniture of the test scenes: chairs, a table and a shelf, with their numbers of polygons.

Legs stand on the floor with open bottoms and abut the seat with open tops: no face lies on another face. The inside
of such a leg shows only back sides, so it is black, and the floor under it is dark.
"""


def chair27(s, g, m, T):
    """27 polygons: seat 6, back 5 (open where it stands on the seat), 4 legs of 4 sides. Sits facing +y, 0.42 wide."""
    w, d, h, t = 0.21, 0.21, 0.45, 0.04
    s.box(g, m, (-w, -d, h - t), (w, d, h), "bt*", T)
    s.box(g, m, (-w + 0.01, -d + 0.01, h), (w - 0.01, -d + 0.04, 0.90), "t*", T)
    for sx in (-1, 1):
        for sy in (-1, 1):
            cx, cy = sx * (w - 0.03), sy * (d - 0.03)
            s.box(g, m, (cx - 0.02, cy - 0.02, 0.0), (cx + 0.02, cy + 0.02, h - t), "*", T)


def chair36(s, g, m, T):
    """36 polygons: the 27 of chair27 and three aprons of 3 faces (outer, inner, bottom) between the legs."""
    chair27(s, g, m, T)
    w, h, t = 0.21, 0.45, 0.04
    a, z0, z1 = w - 0.05, h - t - 0.05, h - t
    b = w - 0.03
    s.box(g, m, (-a, b - 0.01, z0), (a, b + 0.01, z1), "b02", T)
    s.box(g, m, (-b - 0.01, -a, z0), (-b + 0.01, a, z1), "b13", T)
    s.box(g, m, (b - 0.01, -a, z0), (b + 0.01, a, z1), "b13", T)


def chair63(s, g, m, T):
    """63 polygons: seat 6, legs 4x4, back posts 2x5, cushion 5, slats 3x4, aprons 2x3, stretchers 2x4."""
    w, h, t = 0.23, 0.45, 0.04
    s.box(g, m, (-w, -w, h - t), (w, w, h), "bt*", T)
    for sx in (-1, 1):
        for sy in (-1, 1):
            cx, cy = sx * (w - 0.03), sy * (w - 0.03)
            s.box(g, m, (cx - 0.02, cy - 0.02, 0.0), (cx + 0.02, cy + 0.02, h - t), "*", T)
    for sx in (-1, 1):
        cx, cy = sx * (w - 0.03), -(w - 0.03)
        s.box(g, m, (cx - 0.018, cy - 0.018, h), (cx + 0.018, cy + 0.018, 1.0), "t*", T)
    s.box(g, "cushion", (-w + 0.07, -w + 0.07, h), (w - 0.03, w - 0.03, h + 0.04), "t*", T)
    b = w - 0.03
    for z in (0.58, 0.72, 0.86):
        s.box(g, m, (-b + 0.018, -b - 0.008, z), (b - 0.018, -b + 0.008, z + 0.07), "bt02", T)
    for sy in (-1, 1):
        s.box(g, m, (-b + 0.02, sy * b - 0.01, h - t - 0.05), (b - 0.02, sy * b + 0.01, h - t), "b02", T)
    for sx in (-1, 1):
        s.box(g, m, (sx * b - 0.01, -b + 0.02, 0.16), (sx * b + 0.01, b - 0.02, 0.19), "bt13", T)


def table32(s, g, m, T):
    """32 polygons: top 6, legs 4x4, two long aprons 2x3, one low stretcher 4."""
    w, d, h, t = 0.80, 0.45, 0.74, 0.04
    s.box(g, m, (-w, -d, h - t), (w, d, h), "bt*", T)
    for sx in (-1, 1):
        for sy in (-1, 1):
            cx, cy = sx * (w - 0.07), sy * (d - 0.07)
            s.box(g, m, (cx - 0.03, cy - 0.03, 0.0), (cx + 0.03, cy + 0.03, h - t), "*", T)
    for sy in (-1, 1):
        s.box(g, m, (-w + 0.10, sy * (d - 0.07) - 0.01, h - t - 0.08), (w - 0.10, sy * (d - 0.07) + 0.01, h - t), "b02", T)
    cx = -(w - 0.07)
    s.box(g, m, (cx - 0.015, -d + 0.10, 0.12), (cx + 0.015, d - 0.10, 0.15), "bt13", T)


def shelf(s, g, T, books, rng, bookm):
    """26 polygons: low open shelf 1.2 wide, 0.22 deep, 1.15 high: two sides of 5, four boards of 4; plus 5 per book."""
    w, d, h = 0.6, 0.11, 1.15
    M = "shelf"
    # no back panel: sides and boards only
    s.box(g, M, (-w, -d, 0.0), (-w + 0.02, d, h), "t*", T)
    s.box(g, M, (w - 0.02, -d, 0.0), (w, d, h), "t*", T)
    nb = 4
    zs = [0.05 + i * (h - 0.09) / nb for i in range(nb)]
    for z in zs:
        s.box(g, M, (-w + 0.02, -d, z), (w - 0.02, d, z + 0.02), "bt02", T)
    for z in zs:
        x = -w + 0.03
        n = int(books)
        pitch = (2 * w - 0.06) / max(n, 1)
        for b in range(n):
            th = pitch * rng.uniform(0.55, 0.95)
            dep = rng.uniform(0.14, 0.19)
            he = rng.uniform(0.14, 0.215)
            s.box(g + "_books", bookm[rng.randrange(len(bookm))], (x, -d + 0.005, z + 0.02), (x + th, -d + dep, z + 0.02 + he), "t*", T)
            x += pitch
