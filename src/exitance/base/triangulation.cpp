#include "exitance/base/triangulation.hpp"

#include <algorithm>

#include "exitance/base/limits.hpp"
#include "exitance/base/polygon.hpp"

namespace exitance {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
constexpr std::size_t max_corners_for_best_ear = 128;  ///< With more corners left, the first ear found is clipped.

/// The outline in plane coordinates, and a bound on the rounding error of a corner's triangle area.
struct Flat {
    std::vector<Vec2> at;
    double noise = 0;

    Flat(std::span<const Point> outline, const Normal& n) {
        const Frame frame(n);
        double reach = 0;
        for (const Point& p : outline) {
            at.push_back({dot(p - outline[0], frame.u), dot(p - outline[0], frame.v)});
            reach = std::max({reach, std::abs(at.back().x), std::abs(at.back().y)});
        }
        noise = 1e-13 * reach * reach;
    }
    double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const { return cross(at[b] - at[a], at[c] - at[b]); }
};

/// True if the ear at b contains no other remaining corner. Corners that coincide with the ear's own (bridges) are
/// ignored.
bool is_free(const Flat& flat, std::span<const std::uint32_t> rest, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (std::uint32_t i : rest) {
        const Vec2 p = flat.at[i];
        if (p == flat.at[a] || p == flat.at[b] || p == flat.at[c]) continue;
        if (flat.turn(a, b, i) >= -flat.noise && flat.turn(b, c, i) >= -flat.noise && flat.turn(c, a, i) >= -flat.noise)
            return false;
    }
    return true;
}

/// Shape quality of a triangle: area over the square of its longest side.
double shape(const Flat& flat, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Vec2 u = flat.at[b] - flat.at[a], v = flat.at[c] - flat.at[b], w = flat.at[a] - flat.at[c];
    return cross(u, v) / std::max({dot(u, u), dot(v, v), dot(w, w), min_divisor});
}

bool stays_convex(const Flat& flat, const std::vector<std::uint32_t>& piece) {
    const std::size_t m = piece.size();
    for (std::size_t i = 0; i < m; ++i)
        if (flat.turn(piece[i], piece[(i + 1) % m], piece[(i + 2) % m]) < -flat.noise) return false;
    return true;
}

/// Merges b into a across a shared side, if there is one and the union is convex. Returns true if it did.
bool join(const Flat& flat, std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j) {
            if (a[i] != b[(j + 1) % b.size()] || a[(i + 1) % a.size()] != b[j]) continue;
            std::vector<std::uint32_t> both(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(i) + 1);
            for (std::size_t k = 2; k < b.size(); ++k) both.push_back(b[(j + k) % b.size()]);
            both.insert(both.end(), a.begin() + static_cast<std::ptrdiff_t>(i) + 1, a.end());
            if (!stays_convex(flat, both)) return false;
            a = std::move(both);
            return true;
        }
    return false;
}

}  // namespace

std::vector<Triangle> triangulate(std::span<const Point> outline, const Normal& n) {
    const Flat flat(outline, n);
    std::vector<std::uint32_t> rest(outline.size());
    for (std::uint32_t i = 0; i < rest.size(); ++i) rest[i] = i;
    std::vector<Triangle> triangles;
    while (rest.size() >= 3) {
        const std::size_t m = rest.size();
        std::size_t best = m, fallback = 0;
        double best_shape = -1, widest = -HUGE_VAL;
        for (std::size_t i = 0; i < m; ++i) {
            const std::uint32_t a = rest[(i + m - 1) % m], b = rest[i], c = rest[(i + 1) % m];
            const double turn = flat.turn(a, b, c), s = shape(flat, a, b, c);
            if (s > widest) widest = s, fallback = i;
            if (std::abs(turn) <= flat.noise) {  // no area: remove it at once
                best = i;
                break;
            }
            if (turn < 0 || s <= best_shape || !is_free(flat, rest, a, b, c)) continue;
            best = i, best_shape = s;
            if (m > max_corners_for_best_ear) break;
        }
        if (best == m) best = fallback;  // rounding errors left no ear: take the best shaped corner
        const std::uint32_t a = rest[(best + m - 1) % m], b = rest[best], c = rest[(best + 1) % m];
        if (flat.turn(a, b, c) > flat.noise) triangles.push_back({a, b, c});
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(best));
    }
    return triangles;
}

std::vector<std::vector<std::uint32_t>> convex_pieces(std::span<const Point> outline, const Normal& n) {
    if (is_convex(outline, n, 1e-14 * norm(area_vector(outline)))) {
        std::vector<std::uint32_t> all(outline.size());
        for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
        return {all};
    }
    const Flat flat(outline, n);
    std::vector<std::vector<std::uint32_t>> pieces;
    for (const Triangle& t : triangulate(outline, n)) pieces.emplace_back(t.begin(), t.end());
    for (bool joined = true; joined;) {
        joined = false;
        for (std::size_t i = 0; i < pieces.size(); ++i)
            for (std::size_t j = i + 1; j < pieces.size(); ++j)
                if (join(flat, pieces[i], pieces[j])) {
                    pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(j));
                    joined = true;
                    --j;
                }
    }
    return pieces;
}

}  // namespace exitance
