#include "exitance/io/scenes/textures/obj_match.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace exitance {
namespace {

/// Diagonal of the bounding box, which is the same whichever axis is upright.
double diagonal(std::span<const Point> points) {
    Box box;
    for (const Point& p : points) box.add(p);
    return box.diagonal();
}

double distance_to_corner(std::span<const Point> outline, const Point& p) {
    double least = HUGE_VAL;
    for (const Point& q : outline) least = std::min(least, norm(q - p));
    return least;
}

}  // namespace

ObjMatch::ObjMatch(const Scene& scene, std::vector<ObjPlaces> faces) : scene_(scene), faces_(std::move(faces)) {
    for (std::size_t f = 0; f < faces_.size(); ++f) face_of_line_.emplace(faces_[f].line, f);
    is_aligned_ = align();
}

const ObjPlaces* ObjMatch::face_of(SurfaceId s) const {
    const auto face = face_of_line_.find(scene_.surfaces()[s].line);
    return face == face_of_line_.end() ? nullptr : &faces_[face->second];
}

double ObjMatch::tolerance() const {
    constexpr double of_size = 1e-5;  // derived from the tolerance of Locator
    return of_size * scene_.size();
}

std::vector<Point> ObjMatch::outline(const ObjPlaces& face) const {
    std::vector<Point> out;
    for (const Point& c : face.corners) out.push_back(in_scene(c));
    return out;
}

bool ObjMatch::align() {
    double longest = 0;
    const ObjPlaces* best = nullptr;
    std::vector<Point> points;                // points of the scene at the corners of `best`
    std::map<int, std::vector<Point>> parts;  // corners of parts of cut faces, by line
    for (SurfaceId s : scene_.surfaces().ids()) {
        const ObjPlaces* face = face_of(s);
        const std::span<const Point> own = scene_.outline(s);
        if (face && scene_.surfaces()[s].whole > 0)
            parts[face->line].insert(parts[face->line].end(), own.begin(), own.end());
        if (!face || scene_.surfaces()[s].whole > 0 || face->corners.size() != own.size()) continue;
        if (const double length = diagonal(own); length > longest)
            longest = length, best = face, points.assign(own.begin(), own.end());
    }
    const bool has_whole = best != nullptr;
    for (const auto& [line, own] : parts)
        if (const double length = diagonal(own); !has_whole && length > longest)
            longest = length, best = &faces_[face_of_line_.at(line)], points = own;
    if (!best) return true;  // nothing to align: all faces were repaired, or have no line number
    scale_ = longest / diagonal(best->corners);
    // derived from rounding: units of length differ by more from 1.
    constexpr double rounding = 1e-6;
    if (std::abs(scale_ - 1) < rounding) scale_ = 1;
    for (const bool turns : {false, true}) {
        turns_ = turns;
        if (std::all_of(best->corners.begin(), best->corners.end(),
                        [&](const Point& c) { return distance_to_corner(points, in_scene(c)) < tolerance(); }))
            return true;
    }
    return false;
}

std::optional<std::vector<CornerMean>> ObjMatch::corners(SurfaceId s) const {
    const std::vector<Point> corners = outline(*face_of(s));
    std::vector<CornerMean> out;
    for (const Point& p : scene_.outline(s)) {
        const std::optional<CornerMean> mean = mean_at(p, corners);
        if (!mean) return std::nullopt;
        out.push_back(*mean);
    }
    return out;
}

std::optional<CornerMean> ObjMatch::mean_at(const Point& p, std::span<const Point> corners) const {
    for (std::size_t i = 0; i < corners.size(); ++i)
        if (norm(corners[i] - p) < tolerance()) return CornerMean{{i, i, i}};
    // A point may be outside by this share of a triangle: derived from faces that are not planar and are flattened.
    constexpr double outside = 0.01;
    double best = -outside;
    std::optional<CornerMean> out;
    for (std::size_t i = 2; i < corners.size(); ++i) {
        const Vec3 a = corners[i - 1] - corners[0], b = corners[i] - corners[0], d = p - corners[0];
        const Vec3 n = cross(a, b);
        const double area = squared_norm(n);
        if (!(area > 0)) continue;
        const double s = dot(cross(d, b), n) / area, t = dot(cross(a, d), n) / area;
        const double least = std::min({s, t, 1 - s - t});
        if (least <= best) continue;
        best = least;
        out = CornerMean{{0, i - 1, i}, s, t};
    }
    return out;
}

}  // namespace exitance
