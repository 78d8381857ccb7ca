// Checks of the shape of a face by SceneBuilder: area, orientation of holes, self-intersections, planarity.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "exitance/base/triangulation.hpp"
#include "exitance/scene/joining/outline.hpp"
#include "exitance/scene/joining/uncross.hpp"
#include "exitance/scene/outline_repair.hpp"
#include "exitance/scene/scene_builder.hpp"

namespace exitance {
namespace {

/// Returns the rounding error of corners in a file, m: that of single precision. glTF stores it, and most text files
/// have no more digits.
double rounding_of(std::span<const Point> corners) {
    double largest = 0;
    for (const Point& p : corners) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return static_cast<double>(std::numeric_limits<float>::epsilon()) * largest;
}

}  // namespace

bool SceneBuilder::is_bent(std::span<const Point> corners, const Normal& n, double extent) const {
    return out_of_plane(corners, n) > std::max(tol_.place, std::min(tol_.plane, tol_.tilt * extent));
}

void SceneBuilder::add_triangle(std::uint32_t f, std::span<const std::uint32_t> outline, std::span<const Point> corners,
                                const std::array<std::size_t, 3>& t) {
    const Vec3 a = corners[t[1]] - corners[t[0]], b = corners[t[2]] - corners[t[0]], area = 0.5 * cross(a, b);
    if (norm(area) > tol_.place * std::max({norm(a), norm(b), norm(b - a)}))
        add_face(f, std::array{outline[t[0]], outline[t[1]], outline[t[2]]}, area);
}

bool SceneBuilder::split_folded(std::uint32_t f, std::span<const std::uint32_t> outline,
                                std::span<const Point> corners) {
    const auto twice_area = [&](std::size_t a, std::size_t b, std::size_t c) {
        return norm(cross(corners[b] - corners[a], corners[c] - corners[a]));
    };
    if (corners.size() != 4) return false;
    const bool is_first =
        std::min(twice_area(0, 1, 2), twice_area(0, 2, 3)) >= std::min(twice_area(1, 2, 3), twice_area(1, 3, 0));
    const std::size_t start = is_first ? 0 : 1;
    repair(in_.faces[f], "face of 4 corners is folded so far that it crosses itself: it is split into triangles",
           "faces that are folded so");
    for (const std::size_t k : {1, 2}) add_triangle(f, outline, corners, {start, (start + k) % 4, (start + k + 1) % 4});
    return true;
}

SceneBuilder::OutlineShape::OutlineShape(std::span<const Point> points, std::span<const std::uint32_t> outline) {
    Box box;
    for (std::uint32_t c : outline) corners.push_back(points[c]), box.add(points[c]);
    area = area_vector(corners);
    extent = box.diagonal();
}

double SceneBuilder::narrowest_width(const OutlineShape& shape) const {
    return std::max(tol_.place, std::numeric_limits<float>::epsilon() * shape.extent);
}

bool SceneBuilder::is_too_narrow(const OutlineShape& shape) const {
    return norm(shape.area) <= narrowest_width(shape) * shape.extent;
}

void SceneBuilder::check_shape(std::uint32_t f, std::vector<std::uint32_t> outline) {
    const SceneDescription::Face& face = in_.faces[f];
    OutlineShape shape(in_.points, outline);
    if (is_too_narrow(shape)) {
        const double narrowest = narrowest_width(shape);
        if (!is_collinear(shape.corners, std::max(2 * narrowest, std::min(tol_.plane, 1e-3 * shape.extent))))
            return split_crossed(f, outline);
        return repair(
            face, fmt::format("face of {} corners has no area, they are in line: it is left out", face.corners.size()),
            "faces without area");
    }
    if (const std::size_t turned = turn_holes(in_.points, normalized(shape.area), outline); turned > 0) {
        shape = OutlineShape(in_.points, outline);
        repair(face,
               fmt::format("{} of the face turn{} like its rim and is cut out anyway", turned == 1 ? "a hole" : "holes",
                           turned == 1 ? "s" : ""),
               "faces with such holes", "let holes turn the other way");
    }
    const Normal n = normalized(shape.area);
    EdgePair where{};
    if (crosses_itself(shape.corners, n, tol_.place, where)) {
        if (is_bent(shape.corners, n, shape.extent) && split_folded(f, outline, shape.corners)) return;
        const std::vector<std::uint32_t> given = outline;
        std::size_t dropped = 0;
        if (!drop_crossing_corners(in_.points, n, tol_.place, std::min(tol_.plane, 1e-3 * shape.extent), outline,
                                   dropped))
            return split_crossed(f, given);
        repair(face, fmt::format("face crosses itself by rounding: {} of its corners are left out", dropped),
               "faces that do so");
        if (outline.size() < 3) return;
        shape = OutlineShape(in_.points, outline);
        if (is_too_narrow(shape)) return;
    }
    if (!is_one_polygon(in_.points, outline, shape.area, tol_.place)) return split_crossed(f, outline);
    add_shape(f, outline, shape);
}

void SceneBuilder::split_crossed(std::uint32_t f, std::span<const std::uint32_t> outline) {
    const OutlineShape whole(in_.points, outline);
    const Normal n = is_too_narrow(whole) ? normal_of_corners(whole.corners) : Normal(normalized(whole.area));
    const UncrossedOutline uncrossed = uncross(whole.corners, n, tol_.place);
    const auto first_crossing = static_cast<std::uint32_t>(in_.points.size());
    in_.points.insert(in_.points.end(), uncrossed.crossings.begin(), uncrossed.crossings.end());
    std::size_t added = 0;
    for (const std::vector<std::uint32_t>& part : uncrossed.parts) {
        std::vector<std::uint32_t> corners;
        for (const std::uint32_t c : part)
            corners.push_back(c < outline.size() ? outline[c]
                                                 : first_crossing + c - static_cast<std::uint32_t>(outline.size()));
        drop_repeated_corners(corners);
        if (corners.size() < 3) continue;
        const OutlineShape shape(in_.points, corners);
        EdgePair where{};
        if (is_too_narrow(shape) || crosses_itself(shape.corners, normalized(shape.area), tol_.place, where)) continue;
        add_shape(f, corners, shape), ++added;
    }
    const char* kind = "faces that cross themselves";
    if (added == 0)
        return repair(in_.faces[f], "face crosses itself and its parts have no area: it is left out", kind,
                      "order its corners counter-clockwise");
    repair(in_.faces[f],
           fmt::format("face of {} corners crosses itself: it is split into {} where its edges cross", outline.size(),
                       added == 1 ? std::string("its one part") : fmt::format("{} parts", added)),
           kind, "order its corners counter-clockwise");
}

void SceneBuilder::add_shape(std::uint32_t f, std::span<const std::uint32_t> outline, const OutlineShape& shape) {
    const Normal n = normalized(shape.area);
    const double off = out_of_plane(shape.corners, n);
    if (is_bent(shape.corners, n, shape.extent)) {
        repair(in_.faces[f],
               fmt::format("face of {} corners is {:.3g} m out of plane: it is split into triangles, each a "
                           "surface of its own",
                           shape.corners.size(), off),
               "faces out of plane");
        for (const auto& [a, b, c] : triangulate(shape.corners, n)) add_triangle(f, outline, shape.corners, {a, b, c});
        return;
    }
    if (off > std::max(tol_.place, rounding_of(shape.corners))) {
        if (flattened_.count++ == 0) flattened_.first_line = in_.faces[f].line;
        flattened_.farthest = std::max(flattened_.farthest, off);
    }
    add_face(f, outline, shape.area);
}

}  // namespace exitance
