#include "exitance/measure/light_maps/texel_cover.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/clip_convex.hpp"

namespace exitance {
namespace {

constexpr double rounding = 1e-5;  ///< Share of a texel: positions nearer to a border are on it.

/// A (0, 2)-net of 16 points that is symmetric about the centre, so that its mean is the centre. Its first four points
/// are in the four quarters, and their mean is the centre, too.
constexpr std::array<Vec2, texel_points> make_net() {
    constexpr std::array<unsigned, texel_points> order{4, 11, 3, 12, 1, 14, 6, 9, 0, 15, 5, 10, 2, 13, 7, 8};
    std::array<Vec2, texel_points> net{};
    for (std::size_t k = 0; k < texel_points; ++k) {
        const unsigned i = order[k];
        const unsigned mirrored = (i & 1u) << 3 | (i & 2u) << 1 | (i & 4u) >> 1 | (i & 8u) >> 3;
        net[k] = {(i + 0.5) / texel_points, (mirrored + 0.5) / texel_points};
    }
    return net;
}
constexpr std::array<Vec2, texel_points> net = make_net();

bool holds(const TexelOutline& outline, Vec2 p) {
    for (std::size_t i = 0; i < outline.corners; ++i) {
        const Vec2 edge = outline.corner[(i + 1) % outline.corners] - outline.corner[i];
        if (cross(edge, p - outline.corner[i]) < -rounding * std::hypot(edge.x, edge.y)) return false;
    }
    return true;
}

/// Clips a convex polygon to the half-plane normal . p <= offset.
void clip(std::vector<Vec2>& polygon, Vec2 normal, double offset, std::vector<Vec2>& out) {
    clip_convex<Vec2>(
        polygon, [&](const Vec2& p) { return offset - dot(normal, p); }, out);
    polygon.swap(out);
}

}  // namespace

void clip_to_texel(std::vector<Vec2>& polygon, int x, int y, std::vector<Vec2>& rest) {
    clip(polygon, {-1, 0}, -x, rest), clip(polygon, {1, 0}, x + 1, rest);
    clip(polygon, {0, -1}, -y, rest), clip(polygon, {0, 1}, y + 1, rest);
}

TexelOutline::TexelOutline(const Chart& chart, const Patch& patch) : corners(patch.is_triangle() ? 3 : 4) {
    for (std::size_t i = 0; i < corners; ++i) corner[i] = chart.place(patch.corner(static_cast<int>(i)));
    finish();
}

TexelOutline::TexelOutline(const std::array<Vec2, 3>& triangle) : corners(3) {
    std::copy(triangle.begin(), triangle.end(), corner.begin());
    finish();
}

void TexelOutline::finish() {
    if (cross(corner[1] - corner[0], corner[2] - corner[0]) < 0)
        std::reverse(corner.begin(), corner.begin() + static_cast<std::ptrdiff_t>(corners));
    lo = hi = corner[0];
    for (std::size_t i = 1; i < corners; ++i) {
        lo = {std::min(lo.x, corner[i].x), std::min(lo.y, corner[i].y)};
        hi = {std::max(hi.x, corner[i].x), std::max(hi.y, corner[i].y)};
    }
}

/// Adds the part of one outline in one texel, as triangles.
void TexelCutter::add_part(const TexelOutline& outline, int x, int y, std::size_t texel) {
    polygon_.assign(outline.corner.begin(), outline.corner.begin() + static_cast<std::ptrdiff_t>(outline.corners));
    clip_to_texel(polygon_, x, y, rest_);
    for (std::size_t i = 2; i < polygon_.size(); ++i) {
        const double area = 0.5 * cross(polygon_[i - 1] - polygon_[0], polygon_[i] - polygon_[0]);
        if (!(area > 0)) continue;
        parts_.push_back({texel, polygon_[0], polygon_[i - 1], polygon_[i], area});
        area_[texel] += area;
    }
}

void TexelCutter::add(const TexelOutline& outline, const Chart::Rectangle& rectangle) {
    const int x0 = std::max(rectangle.x, static_cast<int>(std::floor(outline.lo.x)));
    const int x1 = std::min(rectangle.x + rectangle.width, static_cast<int>(std::ceil(outline.hi.x)));
    const int y0 = std::max(rectangle.y, static_cast<int>(std::floor(outline.lo.y)));
    const int y1 = std::min(rectangle.y + rectangle.height, static_cast<int>(std::ceil(outline.hi.y)));
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const auto texel = static_cast<std::size_t>((y - rectangle.y) * rectangle.width + x - rectangle.x);
            const double u = x, v = y;
            if (holds(outline, {u, v}) && holds(outline, {u + 1, v}) && holds(outline, {u, v + 1}) &&
                holds(outline, {u + 1, v + 1}))
                area_[texel] = 2;  // mark as wholly covered, regardless of other outlines
            else
                add_part(outline, x, y, texel);
        }
}

/// Adds points in some triangles, one in each of equal shares of their area.
void TexelCutter::add_places(std::span<const Triangle> parts, double area, std::vector<Vec2>& places) const {
    for (std::size_t k = 0; k < texel_points; ++k) {
        double left = net[k].x * area;
        std::size_t i = 0;
        while (i + 1 < parts.size() && left >= parts[i].area) left -= parts[i++].area;
        const Triangle& t = parts[i];
        const double s = std::sqrt(std::clamp(left / t.area, 0.0, 1.0)), r = net[k].y;
        places.push_back(t.a + s * (1 - r) * (t.b - t.a) + s * r * (t.c - t.a));
    }
}

void TexelCutter::cut(std::span<const TexelOutline> outlines, Chart::Rectangle rectangle,
                      std::vector<TexelCover>& covers, std::vector<Vec2>& places) {
    covers.clear(), places.clear(), parts_.clear();
    area_.assign(static_cast<std::size_t>(rectangle.width) * static_cast<std::size_t>(rectangle.height), 0.0);
    for (const TexelOutline& outline : outlines) add(outline, rectangle);
    std::stable_sort(parts_.begin(), parts_.end(),
                     [](const Triangle& a, const Triangle& b) { return a.texel < b.texel; });
    std::size_t begin = 0, end = 0;
    for (std::size_t texel = 0; texel < area_.size(); ++texel, begin = end) {
        while (end < parts_.size() && parts_[end].texel == texel) ++end;
        if (!(area_[texel] > rounding * rounding)) continue;
        const auto row = static_cast<int>(texel / static_cast<std::size_t>(rectangle.width));
        const auto column = static_cast<int>(texel % static_cast<std::size_t>(rectangle.width));
        TexelCover cover{rectangle.x + column, rectangle.y + row, std::min(area_[texel], 1.0), places.size()};
        if (cover.share < 1 - 4 * rounding) {
            add_places(std::span(parts_).subspan(begin, end - begin), area_[texel], places);
        } else {
            cover.share = 1;
            for (const Vec2& p : net) places.push_back({cover.x + p.x, cover.y + p.y});
        }
        covers.push_back(cover);
    }
}

}  // namespace exitance
