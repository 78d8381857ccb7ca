#include "exitance/io/scenes/textures/obj_match.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

double perimeter(std::span<const Point> outline) {
    double sum = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) sum += norm(outline[(i + 1) % outline.size()] - outline[i]);
    return sum;
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

bool ObjMatch::align() {
    double longest = 0;
    SurfaceId best;
    for (SurfaceId s : scene_.surfaces().ids()) {
        const ObjPlaces* face = face_of(s);
        if (!face || face->corners.size() != scene_.outline(s).size()) continue;
        if (const double length = perimeter(scene_.outline(s)); length > longest) longest = length, best = s;
    }
    if (best.is_none()) return true;  // all faces were repaired, or have no line
    const std::vector<Point>& corners = face_of(best)->corners;
    scale_ = perimeter(scene_.outline(best)) / perimeter(corners);
    // derived from rounding: units of length differ by more from 1.
    constexpr double rounding = 1e-6;
    if (std::abs(scale_ - 1) < rounding) scale_ = 1;
    for (const bool turns : {false, true}) {
        turns_ = turns;
        if (std::all_of(corners.begin(), corners.end(), [&](const Point& c) {
                return distance_to_corner(scene_.outline(best), in_scene(c)) < tolerance();
            }))
            return true;
    }
    return false;
}

std::optional<std::vector<CornerMean>> ObjMatch::corners(SurfaceId s) const {
    std::vector<Point> corners;
    for (const Point& c : face_of(s)->corners) corners.push_back(in_scene(c));
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
