// View factors between symmetric solids inside each other. Their corners, edges and planes are aligned, except for the
// rounding of their coordinates, so that many decisions of the exact visible parts are ties.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"
#include "exitance/scene/add_polygon.hpp"
#include "exitance/view_factors/ray_check.hpp"
#include "exitance/view_factors/sparse_factors.hpp"
#include "support/dense_view_factors.hpp"

namespace exitance {
namespace {

using Outline = std::vector<Point>;

/// Corners of solids that contain -p with every corner p.
std::vector<Point> corners_of(const std::string& solid) {
    std::vector<Point> out;
    const double golden = 0.5 * (1 + std::sqrt(5.0));
    for (const double s : {-1.0, 1.0})
        for (const double t : {-1.0, 1.0}) {
            if (solid == "cube") out.insert(out.end(), {{s, t, -1}, {s, t, 1}});
            if (solid == "icosahedron")
                out.insert(out.end(), {{0, s, golden * t}, {s, golden * t, 0}, {golden * t, 0, s}});
            if (solid == "cuboctahedron") out.insert(out.end(), {{0, s, t}, {s, t, 0}, {t, 0, s}});
        }
    for (const double s : {-1.0, 1.0}) {
        if (solid == "octahedron") out.insert(out.end(), {{s, 0, 0}, {0, s, 0}, {0, 0, s}});
        for (int k = 0; k < 6 && solid == "prism"; ++k) out.push_back({std::cos(pi * k / 3), std::sin(pi * k / 3), s});
    }
    return out;
}

/// The faces of the convex hull of a few points, fronts outwards: all planes through three points with the others on
/// one side.
std::vector<Outline> hull(const std::vector<Point>& points) {
    constexpr double in_plane =
        1e-9;  ///< Metres; derived from the rounding of corners of size 1, far below their gaps.
    std::vector<std::vector<std::size_t>> known;
    std::vector<Outline> faces;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < points.size(); ++j)
            for (std::size_t k = 0; k < points.size(); ++k) {
                const Vec3 across = cross(points[j] - points[i], points[k] - points[i]);
                if (norm(across) < in_plane) continue;
                const Normal n = normalized(across);
                std::vector<std::size_t> on;
                bool is_face = true;
                for (std::size_t m = 0; m < points.size(); ++m) {
                    const double h = dot(n, points[m] - points[i]);
                    is_face &= h < in_plane;
                    if (std::abs(h) < in_plane) on.push_back(m);
                }
                if (!is_face || std::find(known.begin(), known.end(), on) != known.end()) continue;
                known.push_back(on);
                Vec3 sum;
                for (std::size_t m : on) sum += points[m] - Point{};
                const Point middle = Point(sum / static_cast<double>(on.size()));
                const Vec3 u = normalized(points[on[0]] - middle), v = cross(n, u);
                const auto angle = [&](std::size_t m) {
                    return std::atan2(dot(v, points[m] - middle), dot(u, points[m] - middle));
                };
                std::sort(on.begin(), on.end(), [&](std::size_t a, std::size_t b) { return angle(a) < angle(b); });
                for (Outline& face = faces.emplace_back(); std::size_t m : on) face.push_back(points[m]);
            }
    return faces;
}

/// The largest factor by which the inner solid can grow inside the outer one.
double largest_scale(const std::vector<Point>& inner, const std::vector<Outline>& outer) {
    double scale = HUGE_VAL;
    for (const Outline& face : outer) {
        const Vec3 n = area_vector(face);
        for (const Point& p : inner)
            if (dot(n, p - Point{}) > 0) scale = std::min(scale, dot(n, face[0] - Point{}) / dot(n, p - Point{}));
    }
    return scale;
}

/// A solid (or two half as large that touch at a corner in the middle) inside another one whose fronts face inwards.
std::vector<Outline> nested(const std::string& outer, const std::string& inner, double share, bool two) {
    std::vector<Outline> faces = hull(corners_of(outer));
    std::vector<Point> corners = corners_of(inner);
    const double scale = share * largest_scale(corners, faces);
    for (Outline& face : faces) std::reverse(face.begin(), face.end());
    for (const double side : two ? std::vector{-1.0, 1.0} : std::vector{0.0}) {
        std::vector<Point> body;
        for (const Point& p : corners)
            body.push_back(two ? Point(0.5 * scale * ((p - Point{}) + side * (corners[0] - Point{})))
                               : Point(scale * (p - Point{})));
        for (const Outline& face : hull(body)) faces.push_back(face);
    }
    return faces;
}

Scene placed_scene(const std::vector<Outline>& outlines, double angle, double scale, const Vec3& offset) {
    SceneDescription d;
    d.materials.push_back({"grey", Spectrum(0.5), Spectrum()});
    d.groups.push_back("all");
    const double c = std::cos(angle), s = std::sin(angle);
    for (const Outline& outline : outlines) {
        add_polygon(d, outline, [&](const Point& p) {
            const Vec3 q = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
            return Point(scale * Vec3{q.x, c * q.y - s * q.z, s * q.y + c * q.z} + offset);
        });
    }
    return *make_scene(d).scene;
}

TEST(AlignedSolids, RowsSumToOneHoweverTheyAreTurnedMovedAndScaled) {
    const std::vector<std::string> solids = {"cube", "octahedron", "icosahedron", "cuboctahedron", "prism"};
    RandomStream random(8, Stream::mesh);
    const double tolerance = 1e-3;
    for (const std::string& outer : solids)
        for (const std::string& inner : solids)
            for (const bool two : {false, true}) {
                const auto one_of = [&](const auto& values) {
                    return values[static_cast<std::size_t>(random.uniform() * static_cast<double>(values.size()))];
                };
                const double share = one_of(std::array{0.2, 0.5, 0.7, 0.9}), angle = 2 * pi * random.uniform();
                const double scale = one_of(std::array{1e-3, 1.0, 30.0});
                const Vec3 offset = random.uniform() < 0.5 ? Vec3{3, -2, 5} : Vec3{1000, -700, 300};
                const std::string what = inner + " in " + outer + (two ? ", two" : ", one") + ", " +
                                         std::to_string(share) + ", " + std::to_string(scale) + ", " +
                                         std::to_string(angle) + ", at " + std::to_string(offset.x);
                const Scene scene = placed_scene(nested(outer, inner, share, two), angle, scale, offset);
                const ViewFactors table = dense_view_factors(scene, tolerance);
                for (std::size_t i = 0; i < table.size(); ++i)
                    ASSERT_NEAR(table.row_sums[i], 1, tolerance) << what << ": " << i;
                EXPECT_EQ(table.unsettled, 0u) << what;
                const RayCheck rays =
                    check_by_rays(scene, sparse_from(table, 0),
                                  {.entries = 8, .rays = 1u << 12, .tolerance = tolerance}, StopRequest());
                EXPECT_EQ(rays.wrong, 0u) << what;
            }
}

}  // namespace
}  // namespace exitance
