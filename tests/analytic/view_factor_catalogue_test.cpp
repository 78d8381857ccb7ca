// Exact view factors of Howell's catalogue [Howell20] and of configurations that follow from symmetry, closure and
// cutting. Every configuration is turned, moved and scaled.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "support/dense_view_factors.hpp"
#include "support/outline_scene.hpp"

namespace exitance {
namespace {

/// A scene of polygons, with pairs of faces and their exact factors.
struct Configuration {
    std::string name;
    std::vector<Outline> faces;
    struct Factor {
        std::size_t from, to;
        double F;
    };
    std::vector<Factor> exact;
    double tolerance = 1e-6;  ///< Absolute; the accuracy of the catalogue, or of a polygon in place of a disc.
};

/// Turns, moves and scales a configuration, differently for every number.
void place(Configuration& c, int number) {
    const double a = 0.7 + 1.3 * number, b = 0.4 + 0.77 * number, scale = std::pow(10, number % 5 - 2);
    for (Outline& outline : c.faces)
        for (Point& p : outline) {
            const Vec3 q{std::cos(a) * p.x - std::sin(a) * p.y, std::sin(a) * p.x + std::cos(a) * p.y, p.z};
            const Vec3 r{q.x, std::cos(b) * q.y - std::sin(b) * q.z, std::sin(b) * q.y + std::cos(b) * q.z};
            p = Point(scale * (r + Vec3{3.0 + number, -2, 5}));
        }
}

/// A rectangle in the plane z, front upwards or downwards.
Outline level(double x0, double x1, double y0, double y1, double z, bool up) {
    Outline out = {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
    if (!up) std::reverse(out.begin(), out.end());
    return out;
}

Outline turned(Outline outline) {
    std::reverse(outline.begin(), outline.end());
    return outline;
}

/// C-11: equal rectangles opposite each other, X = a / c, Y = b / c.
double opposite(double X, double Y) {
    const double x = std::sqrt(1 + X * X), y = std::sqrt(1 + Y * Y);
    return 2 / (pi * X * Y) *
           (std::log(x * y / std::sqrt(1 + X * X + Y * Y)) + X * y * std::atan(X / y) + Y * x * std::atan(Y / x) -
            X * std::atan(X) - Y * std::atan(Y));
}

/// C-14: perpendicular rectangles with a common edge of length 1; from the one of width W to the one of height H.
double corner(double W, double H) {
    const double w = W * W, h = H * H, s = std::sqrt(w + h);
    const double logs = std::log((1 + w) * (1 + h) / (1 + w + h)) +
                        w * std::log(w * (1 + w + h) / ((1 + w) * (w + h))) +
                        h * std::log(h * (1 + w + h) / ((1 + h) * (w + h)));
    return (W * std::atan(1 / W) + H * std::atan(1 / H) - s * std::atan(1 / s) + 0.25 * logs) / (pi * W);
}

/// Sum over the corners of two rectangles, as in C-12 and C-15.
double corner_sum(const double (&x)[2], const double (&y)[2], const double (&u)[2], const double (&v)[2],
                  const std::function<double(double, double, double, double)>& G) {
    double sum = 0;
    for (int k = 0; k < 16; ++k) {
        const int i = k & 1, j = k >> 1 & 1, l = k >> 2 & 1, m = k >> 3 & 1;
        sum += ((i + j + l + m) % 2 ? -1 : 1) * G(x[i], y[j], u[l], v[m]);
    }
    return sum / ((x[1] - x[0]) * (y[1] - y[0]));
}

/// C-12: rectangles in parallel planes at distance z.
double parallel(const double (&x)[2], const double (&y)[2], const double (&u)[2], const double (&v)[2], double z) {
    return corner_sum(x, y, u, v, [z](double xi, double yi, double ui, double vi) {
        const double a = std::hypot(xi - ui, z), b = std::hypot(yi - vi, z), p = xi - ui, q = yi - vi;
        return (q * a * std::atan(q / a) + p * b * std::atan(p / b) - 0.5 * z * z * std::log(p * p + q * q + z * z)) /
               (2 * pi);
    });
}

/// C-15: a rectangle in the plane z = 0 (x > 0) and one in the plane x = 0 with v <= y <= and u <= z <=.
double perpendicular(const double (&x)[2], const double (&y)[2], const double (&v)[2], const double (&u)[2]) {
    return corner_sum(x, y, v, u, [](double xi, double yi, double vi, double ui) {
        const double q = xi * xi + ui * ui, d = yi - vi, r = std::sqrt(q);
        const double first = r > 0 ? d * r * std::atan(d / r) : 0;
        return (first - 0.25 * (q - d * d) * (q + d * d > 0 ? std::log(q + d * d) : 0)) / (2 * pi);
    });
}

/// C-16: rectangles at an angle with a common edge of length 1; from the one of width B to the one of width A.
/// Source: [Howell20]; the integral by Simpson's rule, whose error is below 1e-12.
double wedge(double A, double B, double angle) {
    const double C = A * A + B * B - 2 * A * B * std::cos(angle), s = std::sin(angle), c = std::cos(angle);
    const auto D = [&](double z) { return std::sqrt(1 + z * z * s * s); };
    const double c2 = std::cos(2 * angle);
    double F = -std::sin(2 * angle) / (4 * pi * B) *
               (A * B * s + (pi / 2 - angle) * (A * A + B * B) + B * B * std::atan((A - B * c) / (B * s)) +
                A * A * std::atan((B - A * c) / (A * s)));
    F += s * s / (4 * pi * B) *
         ((2 / (s * s) - 1) * std::log((1 + A * A) * (1 + B * B) / (1 + C)) +
          B * B * std::log(B * B * (1 + C) / ((1 + B * B) * C)) +
          A * A * std::log(A * A * std::pow(1 + A * A, c2) / (C * std::pow(1 + C, c2))));
    F +=
        std::atan(1 / B) / pi + A / (pi * B) * std::atan(1 / A) - std::sqrt(C) / (pi * B) * std::atan(1 / std::sqrt(C));
    F += s * std::sin(2 * angle) / (2 * pi * B) * A * D(A) * (std::atan(A * c / D(A)) + std::atan((B - A * c) / D(A)));
    constexpr int n = 2000;
    double sum = 0;
    for (int k = 0; k <= n; ++k) {
        const double z = B * k / n;
        sum += (k == 0 || k == n ? 1
                : k % 2          ? 4
                                 : 2) *
               D(z) * (std::atan(z * c / D(z)) + std::atan((A - z * c) / D(z)));
    }
    return F + c / (pi * B) * sum * B / (3 * n);
}

/// A regular polygon with the area of a disc.
Outline disc(double radius, double z, bool up, int corners) {
    const double r = radius * std::sqrt(2 * pi / (corners * std::sin(2 * pi / corners)));
    Outline out;
    for (int k = 0; k < corners; ++k)
        out.push_back({r * std::cos(2 * pi * k / corners), r * std::sin(2 * pi * k / corners), z});
    return up ? out : turned(out);
}

/// The faces of a box with k x k pieces per side, fronts inwards or outwards.
void add_box(std::vector<Outline>& faces, const Point& lo, const Point& hi, bool inwards) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const bool upper : {false, true}) {
            Outline face;
            for (const auto& [s, t] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
                Point p = lo;
                p[axis] = upper ? hi[axis] : lo[axis];
                p[(axis + 1) % 3] = s ? hi[(axis + 1) % 3] : lo[(axis + 1) % 3];
                p[(axis + 2) % 3] = t ? hi[(axis + 2) % 3] : lo[(axis + 2) % 3];
                face.push_back(p);
            }
            faces.push_back(upper == inwards ? turned(face) : face);
        }
}

/// A sphere of triangles: an octahedron whose faces are cut into four `cuts` times; fronts inwards or outwards.
std::vector<Outline> sphere(double radius, int cuts, bool inwards) {
    std::vector<std::array<Vec3, 3>> triangles;
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            for (const double z : {-1.0, 1.0}) {
                std::array<Vec3, 3> t = {Vec3{x, 0, 0}, Vec3{0, y, 0}, Vec3{0, 0, z}};
                if (x * y * z < 0) std::swap(t[0], t[1]);
                triangles.push_back(t);
            }
    for (int cut = 0; cut < cuts; ++cut) {
        std::vector<std::array<Vec3, 3>> finer;
        for (const auto& [a, b, c] : triangles) {
            const Vec3 ab = normalized(a + b), bc = normalized(b + c), ca = normalized(c + a);
            finer.push_back({a, ab, ca}), finer.push_back({ab, b, bc}), finer.push_back({ca, bc, c});
            finer.push_back({ab, bc, ca});
        }
        triangles = std::move(finer);
    }
    std::vector<Outline> faces;
    for (const auto& [a, b, c] : triangles) {
        Outline face = {Point(radius * a), Point(radius * b), Point(radius * c)};
        faces.push_back(inwards ? turned(face) : face);
    }
    return faces;
}

void add_parallel(std::vector<Configuration>& all) {
    for (const double X : {0.05, 0.5, 2.0, 20.0})
        for (const double Y : {0.1, 0.7, 1.0, 30.0})
            all.push_back(
                {"C-11", {level(0, X, 0, Y, 0, true), level(0, X, 0, Y, 1, false)}, {{0, 1, opposite(X, Y)}}});
    for (const double u : {-2.0, 0.25, 0.9, 1.5, 7.0})
        for (const double v : {0.0, 0.6, 3.0})
            all.push_back({"C-12",
                           {level(0, 1, 0, 2, 0, true), level(u, u + 1.5, v, v + 0.5, 0.8, false)},
                           {{0, 1, parallel({0, 1}, {0, 2}, {u, u + 1.5}, {v, v + 0.5}, 0.8)}}});
}

Outline upright(double y0, double y1, double z0, double z1) {
    return {{0, y0, z0}, {0, y1, z0}, {0, y1, z1}, {0, y0, z1}};  // in the plane x = 0, front towards +x
}

void add_perpendicular(std::vector<Configuration>& all) {
    for (const double W : {0.1, 0.5, 2.0, 10.0})
        for (const double H : {0.05, 0.5, 1.0, 20.0})
            all.push_back({"C-14", {level(0, W, 0, 1, 0, true), upright(0, 1, 0, H)}, {{0, 1, corner(W, H)}}});
    for (const double x : {0.0, 0.3, 2.0})
        for (const double y : {-1.5, 0.0, 0.5})
            for (const double z : {0.0, 0.4})
                all.push_back({"C-15",
                               {level(x, x + 1, 0, 2, 0, true), upright(y, y + 0.7, z, z + 1.2)},
                               {{0, 1, perpendicular({x, x + 1}, {0, 2}, {y, y + 0.7}, {z, z + 1.2})}}});
    for (const double degrees : {15.0, 30.0, 45.0, 60.0, 120.0, 150.0})
        for (const double A : {0.5, 2.0}) {
            const double angle = degrees * pi / 180, B = 1.3;
            const Outline other = {{0, 1, 0},
                                   {0, 0, 0},
                                   {A * std::cos(angle), 0, A * std::sin(angle)},
                                   {A * std::cos(angle), 1, A * std::sin(angle)}};
            all.push_back({"C-16", {level(0, B, 0, 1, 0, true), turned(other)}, {{0, 1, wedge(A, B, angle)}}});
        }
}

void add_discs(std::vector<Configuration>& all) {
    constexpr int corners = 96;
    for (const double R1 : {0.2, 1.0, 3.0})
        for (const double R2 : {0.1, 0.5, 1.0, 4.0}) {
            const double S = 1 + (1 + R2 * R2) / (R1 * R1);
            const double F = 0.5 * (S - std::sqrt(S * S - 4 * std::pow(R2 / R1, 2)));
            // Areas of the inscribed and the circumscribed polygon differ by this share.
            const double own_error = std::pow(pi / corners, 2) * F;
            all.push_back({"C-41", {disc(R1, 0, true, corners), disc(R2, 1, false, corners)}, {{0, 1, F}}, own_error});
        }
}

/// Plates with a partition that separates both halves: each half is C-11 of its own.
void add_partitions(std::vector<Configuration>& all) {
    for (const double a : {0.5, 1.0, 4.0})
        for (const double b : {0.3, 2.0}) {
            Configuration c{"partition",
                            {level(0, 2 * a, 0, b, 0, true),
                             level(0, 2 * a, 0, b, 1, false),
                             {{a, 0, 0}, {a, b, 0}, {a, b, 1}, {a, 0, 1}}},
                            {{0, 1, opposite(a, b)}}};
            all.push_back(c);
        }
    for (const double gap : {0.2, 1.0, 3.0}) {  // a plate between others hides the one behind it
        Configuration c{"hidden", {level(0, 1, 0, 1, 0, true), level(0, 1, 0, 1, 2 * gap, false)}, {{0, 1, 0}}};
        c.faces.push_back(level(-0.5, 1.5, -0.5, 1.5, gap, true));
        all.push_back(c);
    }
    for (const double share : {0.25, 0.5}) {  // a block on the floor hides its share of the floor's middle from above
        Configuration c{"box in two rooms", {}, {}};
        add_box(c.faces, {0, 0, 0}, {1, 2, 3}, true);
        add_box(c.faces, {2, 0, 0}, {2 + share, 1, 1}, true);
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t j = 6; j < 12; ++j) c.exact.push_back({i, j, 0});
        c.exact.push_back({0, 1, opposite(2, 3)}), c.exact.push_back({4, 5, opposite(1.0 / 3, 2.0 / 3)});
        c.exact.push_back({6, 7, opposite(1 / share, 1 / share)});
        all.push_back(c);
    }
}

void add_symmetric(std::vector<Configuration>& all) {
    Configuration tetrahedron{"tetrahedron", {}, {}};
    const Point t[] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    for (const auto& [a, b, c] : {std::array{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}})
        tetrahedron.faces.push_back(turned({t[a], t[b], t[c]}));
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) tetrahedron.exact.push_back({i, j, i == j ? 0 : 1.0 / 3});
    all.push_back(tetrahedron);
    Configuration cube{"cube", {}, {}};
    add_box(cube.faces, {0, 0, 0}, {1, 1, 1}, true);
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j)
            cube.exact.push_back({i, j, i == j ? 0 : i / 2 == j / 2 ? opposite(1, 1) : corner(1, 1)});
    all.push_back(cube);
}

TEST(ViewFactorCatalogue, HasAtLeastAHundredExactConfigurations) {
    std::vector<Configuration> all;
    add_parallel(all), add_perpendicular(all), add_discs(all), add_partitions(all), add_symmetric(all);
    EXPECT_GE(all.size(), 100U);
    for (std::size_t k = 0; k < all.size(); ++k) {
        Configuration c = all[k];
        place(c, static_cast<int>(k));
        const Scene scene = scene_of(c.faces);
        const ViewFactors table = dense_view_factors(scene, 1e-8);
        for (const auto& [from, to, F] : c.exact)
            EXPECT_NEAR(table.row(from)[to], F, c.tolerance) << c.name << " " << k << ": " << from << " to " << to;
    }
}

/// Concentric spheres of triangles: the inner one is convex, so that all its flux reaches the outer one, and the outer
/// one's share follows by reciprocity from the areas of the triangles.
TEST(ViewFactorCatalogue, SpheresOfTrianglesSeeEachOtherByTheirAreas) {
    struct Case {
        double inner;
        int cuts, number;
    };
    for (const auto& [inner, cuts, number] : {Case{0.2, 0, 2}, {0.7, 0, 7}, {0.9, 0, 4}, {0.5, 1, 5}, {0.8, 1, 11}}) {
        Configuration c{"C-137", sphere(inner, cuts, false), {}};
        const std::size_t n = c.faces.size();
        for (const Outline& face : sphere(1, cuts, true)) c.faces.push_back(face);
        place(c, number);
        const double tolerance = 1e-3;
        const ViewFactors table = dense_view_factors(scene_of(c.faces), tolerance);
        double inside = 0, outside = 0, received = 0;
        for (std::size_t i = 0; i < 2 * n; ++i) (i < n ? inside : outside) += table.areas[i];
        for (std::size_t i = 0; i < 2 * n; ++i) {
            EXPECT_NEAR(table.row_sums[i], 1, 2 * tolerance) << inner << ' ' << i;
            double to_inner = 0;
            for (std::size_t j = 0; j < n; ++j) to_inner += table.row(i)[j];
            if (i < n) {
                EXPECT_EQ(to_inner, 0);
            }
            received += table.areas[i] * to_inner;
        }
        EXPECT_NEAR(received / outside, inside / outside, 2 * tolerance * inside / outside);
    }
}

}  // namespace
}  // namespace exitance
