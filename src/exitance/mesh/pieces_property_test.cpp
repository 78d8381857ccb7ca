#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "exitance/mesh/pieces.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {
namespace {

using Outline = std::vector<Point>;

/// A convex outline in a plane of any orientation: corners on an ellipse at random angles.
Outline random_outline(const Frame& frame) {
    const int corners = *rc::gen::inRange(3, 9);
    std::vector<double> angles;
    for (int i = 0; i < corners; ++i)
        angles.push_back(2 * pi * (i + 0.8 * *rc::gen::inRange(0, 1000) / 1000.0) / corners);
    Outline out;
    for (double a : angles) out.push_back(Point{3, -1, 2} + frame.to_world(2 * std::cos(a), std::sin(a), 0));
    return out;
}

/// Cuts every outline along a random line through the middle of the first one, which makes faces that meet in
/// T-vertices.
std::vector<Outline> cut_up(Outline whole, const Normal& n, int cuts) {
    std::vector<Outline> parts = {std::move(whole)};
    for (int i = 0; i < cuts; ++i) {
        const std::size_t which = *rc::gen::inRange<std::size_t>(0, parts.size());
        const Point middle = centroid(parts[which]);
        const double angle = *rc::gen::inRange(0, 360) * pi / 180;
        const Normal across = Frame(n).to_world(std::cos(angle), std::sin(angle), 0);
        Outline left, right;
        clip(parts[which], {across, dot(across, middle)}, left);
        clip(parts[which], {-across, -dot(across, middle)}, right);
        if (left.empty() || right.empty()) continue;
        parts[which] = left;
        parts.push_back(right);
    }
    return parts;
}

Scene scene_of(const std::vector<Outline>& outlines) {
    SceneDescription d;
    d.groups = {"all"};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(1)}};
    for (const Outline& outline : outlines) {
        SceneDescription::Face face;
        for (const Point& p : outline) {
            face.corners.push_back(static_cast<std::uint32_t>(d.points.size()));
            d.points.push_back(p);
        }
        d.faces.push_back(face);
    }
    CheckedScene scene = make_scene(d);
    RC_ASSERT(bool(scene.scene));
    return *scene.scene;
}

double area_of_pieces(const Scene& scene) {
    double sum = 0;
    for (const Piece& piece : cut_into_pieces(scene)) {
        RC_ASSERT(dot(piece.patch.normal(), scene.regions()[piece.region].plane.n) > 0.999);
        sum += piece.patch.area();
    }
    return sum;
}

RC_GTEST_PROP(Regions, HowAPolygonIsCutDoesNotShow, ()) {
    const Frame frame(normalized(Vec3{*rc::gen::inRange(-9, 10) + 0.5, *rc::gen::inRange(-9, 10) / 1.0, 3}));
    const Outline whole = random_outline(frame);
    std::vector<Outline> parts = cut_up(whole, frame.n, *rc::gen::inRange(1, 12));
    const std::size_t turn = *rc::gen::inRange<std::size_t>(0, parts.size());
    std::rotate(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(turn), parts.end());
    const Scene once = scene_of({whole}), cut = scene_of(parts);
    RC_ASSERT(cut.regions().size() == 1u);
    const Region &a = once.regions()[RegionId(0)], &b = cut.regions()[RegionId(0)];
    RC_ASSERT(b.loops.size() == 1u);
    RC_ASSERT(a.loops == b.loops);  // bitwise: cuts do not change the corners of the whole
    RC_ASSERT(a.area == b.area);
    RC_ASSERT(std::abs(area_of_pieces(cut) - b.area) <= 1e-12 * b.area);
}

/// A union of grid cells, one face per cell: any rectilinear shape, with holes and touching corners.
RC_GTEST_PROP(Regions, PiecesOfAnyRectilinearShapeCoverIt, ()) {
    const int n = 6;
    std::vector<Outline> cells;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            if (*rc::gen::inRange(0, 3) == 2) continue;
            const double x = i * i + i, y = j * 0.75;
            cells.push_back({{x, y, 1}, {x + 2 * i + 2, y, 1}, {x + 2 * i + 2, y + 0.75, 1}, {x, y + 0.75, 1}});
        }
    if (cells.empty()) return;
    const Scene scene = scene_of(cells);
    double area = 0, pieces = 0;
    for (const Outline& cell : cells) area += norm(area_vector(cell));
    for (const Piece& piece : cut_into_pieces(scene)) {
        RC_ASSERT(!piece.patch.is_triangle());
        pieces += piece.patch.area();
        // Pieces do not overlap: the centre of each is in one cell of its own region.
        const Point c = piece.patch.centre();
        RC_ASSERT(std::any_of(cells.begin(), cells.end(), [&](const Outline& o) {
            return o[0].x <= c.x && c.x <= o[2].x && o[0].y <= c.y && c.y <= o[2].y;
        }));
    }
    RC_ASSERT(std::abs(pieces - area) <= 1e-12 * area);
}

}  // namespace
}  // namespace exitance
