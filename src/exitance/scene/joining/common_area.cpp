#include "exitance/scene/joining/common_area.hpp"

#include "exitance/base/triangulation.hpp"

namespace exitance {
namespace {

/// Overlaps below this share of the smaller outline's area are rounding errors.
constexpr double negligible = 1e-6;

double perimeter(std::span<const Point> outline) {
    double sum = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) sum += norm(outline[(i + 1) % outline.size()] - outline[i]);
    return sum;
}

std::vector<std::vector<Point>> convex_parts(std::span<const Point> outline, const Normal& n) {
    if (outline.size() == 3 || is_convex(outline, n)) return {std::vector<Point>(outline.begin(), outline.end())};
    std::vector<std::vector<Point>> out;
    for (const auto& piece : convex_pieces(outline, n)) {
        out.emplace_back();
        for (std::uint32_t c : piece) out.back().push_back(outline[c]);
    }
    return out;
}

double common_area_of_convex(std::span<const Point> a, std::span<const Point> b, const Normal& n) {
    std::vector<Point> part(a.begin(), a.end()), next;
    for (std::size_t i = 0; i < b.size() && !part.empty(); ++i) {
        const Vec3 across = cross(n, b[(i + 1) % b.size()] - b[i]);
        clip(part, {across, dot(across, b[i])}, next);
        std::swap(part, next);
    }
    return part.empty() ? 0 : norm(area_vector(part));
}

}  // namespace

double common_area(std::span<const Point> a, std::span<const Point> b, const Normal& n, double tolerance) {
    double sum = 0;
    const auto parts = convex_parts(b, n);
    for (const auto& p : convex_parts(a, n))
        for (const auto& q : parts) sum += common_area_of_convex(p, q, n);
    const double smaller = std::min(norm(area_vector(a)), norm(area_vector(b)));
    return sum > negligible * smaller + tolerance * std::min(perimeter(a), perimeter(b)) ? sum : 0;
}

}  // namespace exitance
