"""The office floor: rooms with doors, luminaires, windows and furnished work places."""
import random

from furniture import chair27, shelf
from scene_file import Scene, placer


def office(nx=2, ny=2, nfurn=2, books=6, seed=7):
    """office(nx,ny,nfurn,books,seed): an office floor of nx x ny rooms of 4 x 4 m, 2.8 m high. Inner walls are 0.12 m thick with door
    openings (the wall face is one concave 8-gon per side) with jambs; outer walls carry window panels that emit (sky light, no
    opening: the floor is closed and no light escapes). Each room: a floor and a ceiling polygon, 4 ceiling luminaires (thin boxes,
    5 faces, the lower one emits), nfurn (0..4) work places of desk (18 polygons, one more for a black pad), chair (27), monitor (11) and shelf with books
    (26 + 5 per book, `books` on each of 4 boards). Reflectances: floor 0.2, walls 0.5, ceiling 0.8. About
    nx*ny*(32 + nfurn*(83+20*books)) polygons: 1e3 .. 1e6 (nx=ny=30, nfurn=4, books=10 is about 1.05 million, 3600 luminaires)."""
    nx, ny, nfurn, books, seed = int(nx), int(ny), int(nfurn), int(books), int(seed)
    s = Scene("office_%dx%dx%d" % (nx, ny, nfurn), "office floor, %d x %d rooms, %d work places each, %d books a board" % (nx, ny, nfurn, books))
    s.mat("floor", (0.22, 0.20, 0.18))
    s.mat("wall", (0.50, 0.50, 0.48))
    s.mat("ceiling", 0.80)
    s.mat("luminaire", (0.5, 0.5, 0.5), (95.0, 90.0, 80.0))
    s.mat("housing", 0.7)
    s.mat("window", 0.08, (22.0, 25.0, 30.0))
    s.mat("desk", (0.55, 0.42, 0.28))
    s.mat("shelf", (0.60, 0.58, 0.55))
    s.mat("screen", 0.05)
    bookm = []
    for i, c in enumerate([(0.5, 0.1, 0.1), (0.1, 0.25, 0.5), (0.15, 0.4, 0.15), (0.6, 0.5, 0.2), (0.35, 0.3, 0.3)]):
        bookm.append(s.mat("book%d" % i, c))
    for i, c in enumerate([(0.15, 0.15, 0.17), (0.2, 0.3, 0.45)]):
        s.mat("seat%d" % i, c)
    W, H, t = 4.0, 2.8, 0.06  # cell, height, half wall thickness
    dw, dh = 0.9, 2.1  # door
    rng = random.Random(seed)
    X, Y = nx * W, ny * W
    for i in range(nx):
        for j in range(ny):
            x0, y0 = i * W, j * W
            g = "room_%d_%d" % (i, j)
            s.quad_z(g + "_floor", "floor", x0, y0, x0 + W, y0 + W, 0.0)
            s.quad_z(g + "_ceiling", "ceiling", x0, y0, x0 + W, y0 + W, H, up=False)
            for a in (0.27, 0.73):
                for b in (0.27, 0.73):
                    cx, cy = x0 + a * W, y0 + b * W
                    s.box(g + "_lum", "housing", (cx - 0.6, cy - 0.075, H - 0.06), (cx + 0.6, cy + 0.075, H), "*")
                    s.quad_z(g + "_lum", "luminaire", cx - 0.6, cy - 0.075, cx + 0.6, cy + 0.075, H - 0.06, up=False)
    # outer walls: faces in the planes x=0, x=X, y=0, y=Y, one bay per cell, each with an emitting window panel

    def bay(g, M, inside):
        # 2D (u, z) in the bay, u 0..W; corners shared with the inner walls' ends lie in these polygons (abutting)
        a0, a1, z0, z1 = 0.9, 3.1, 0.95, 2.15
        q = lambda m, *p: s.poly(g, m, [M(u, z) for u, z in p], toward=inside)
        q("wall", (0, 0), (W, 0), (W, z0), (a1, z0), (a0, z0), (0, z0))
        q("wall", (0, z1), (a0, z1), (a1, z1), (W, z1), (W, H), (0, H))
        q("wall", (0, z0), (a0, z0), (a0, z1), (0, z1))
        q("wall", (a1, z0), (W, z0), (W, z1), (a1, z1))
        q("window", (a0, z0), (a1, z0), (a1, z1), (a0, z1))

    ins = (X / 2, Y / 2, 1.0)
    for i in range(nx):
        bay("outer_s%d" % i, lambda u, z, i=i: (i * W + u, 0.0, z), ins)
        bay("outer_n%d" % i, lambda u, z, i=i: (i * W + u, Y, z), ins)
    for j in range(ny):
        bay("outer_w%d" % j, lambda u, z, j=j: (0.0, j * W + u, z), ins)
        bay("outer_e%d" % j, lambda u, z, j=j: (X, j * W + u, z), ins)

    # inner walls: between cells; each segment spans between the wall-crossing posts (t clear at inner crossings)
    def inner(g, M, u0, u1):
        """wall along u with its two faces at v = -t and v = +t; M maps (u, v, z)."""
        d0 = 0.45
        a, b = d0, d0 + dw
        loop = [(u0, 0), (a, 0), (a, dh), (b, dh), (b, 0), (u1, 0), (u1, H), (u0, H)]
        mid = 2.0
        s.poly(g, "wall", [M(u, t, z) for u, z in loop], toward=M(mid, 1.0, 1.0))
        s.poly(g, "wall", [M(u, -t, z) for u, z in loop], toward=M(mid, -1.0, 1.0))
        c = M((a + b) / 2, 0, 1.0)
        s.poly(g, "wall", [M(a, -t, 0), M(a, t, 0), M(a, t, dh), M(a, -t, dh)], toward=c)
        s.poly(g, "wall", [M(b, -t, 0), M(b, t, 0), M(b, t, dh), M(b, -t, dh)], toward=c)
        s.poly(g, "wall", [M(a, -t, dh), M(a, t, dh), M(b, t, dh), M(b, -t, dh)], toward=c)

    for i in range(1, nx):
        for j in range(ny):
            u0 = 0.0 if j == 0 else t
            u1 = W if j == ny - 1 else W - t
            inner("wall_x%d_%d" % (i, j), lambda u, v, z, i=i, j=j: (i * W + v, j * W + u, z), u0, u1)
    for j in range(1, ny):
        for i in range(nx):
            u0 = 0.0 if i == 0 else t
            u1 = W if i == nx - 1 else W - t
            inner("wall_y%d_%d" % (j, i), lambda u, v, z, i=i, j=j: (i * W + u, j * W + v, z), u0, u1)
    # work places
    spots = [(1.35, 3.2, 180.0), (3.1, 0.85, 0.0), (3.1, 3.2, 180.0), (2.05, 1.9, 90.0)]
    for i in range(nx):
        for j in range(ny):
            for k in range(min(nfurn, 4)):
                px, py, a = spots[k]
                x, y = i * W + px + rng.uniform(-0.05, 0.05), j * W + py + rng.uniform(-0.05, 0.05)
                T = placer(x, y, 0.0, a)
                g = "w_%d_%d_%d" % (i, j, k)
                # desk: top 6, two side panels (4 sides each), back panel 4 (abut the top, the floor and each other's faces)
                s.box(g + "_desk", "desk", (-0.62, -0.33, 0.70), (0.62, 0.33, 0.73), "bt*", T)
                s.box(g + "_desk", "desk", (-0.58, -0.30, 0.0), (-0.55, 0.30, 0.70), "*", T)
                s.box(g + "_desk", "desk", (0.55, -0.30, 0.0), (0.58, 0.30, 0.70), "*", T)
                s.box(g + "_desk", "desk", (-0.55, -0.25, 0.30), (0.55, -0.23, 0.70), "b02", T)
                s.poly(g + "_desk", "screen", [T(p) for p in [(-0.2, 0.05, 0.731), (0.2, 0.05, 0.731), (0.2, 0.2, 0.731), (-0.2, 0.2, 0.731)]])
                # monitor: foot 5 and a turned panel of 6, 7 cm above the desk (the foot is a low plate)
                s.box(g + "_monitor", "screen", (-0.1, -0.2, 0.73), (0.1, -0.08, 0.75), "t*", T)
                s.box(g + "_monitor", "screen", (-0.28, -0.15, 0.80), (0.28, -0.13, 1.14), "bt*", T)
                da = rng.uniform(-25, 25)
                cl = placer(rng.uniform(-0.1, 0.1), 0.56, 0, 180 + da)
                chair27(s, g + "_chair", "seat%d" % ((i + j + k) % 2), lambda p, T=T, cl=cl: T(cl(p)))
                # shelf behind the desk: 2 sides, back, 4 boards
                S = (lambda p, T=T: T((p[0], p[1] - 0.42, p[2])))
                shelf(s, g + "_shelf", S, books, rng, bookm)
    return s
