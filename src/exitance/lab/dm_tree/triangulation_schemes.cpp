#include <algorithm>
#include <cmath>
#include <map>

#include "exitance/lab/dm_tree/dm_tree.hpp"

namespace exitance {
namespace {

/// Vertices of a convex face; some may be collinear.
using Ring = std::vector<std::uint32_t>;

class FaceTriangulation {
  public:
    FaceTriangulation(std::vector<Vec2>& points, TriangulationScheme scheme,
                      std::vector<std::array<std::uint32_t, 3>>& triangles)
        : points_(points), scheme_(scheme), triangles_(triangles) {}

    void add(Ring ring) {
        std::vector<Ring> rings{std::move(ring)};
        while (!rings.empty()) {
            const Ring r = std::move(rings.back());
            rings.pop_back();
            if (r.size() == 3) {
                triangles_.push_back({r[0], r[1], r[2]});
                continue;
            }
            const auto [i, j] = best_diagonal(r);
            if (i == j) continue;  // no area
            if (scheme_ == TriangulationScheme::longest) {
                join_middle(r, i, j);
                continue;
            }
            rings.emplace_back(r.begin() + static_cast<std::ptrdiff_t>(i),
                               r.begin() + static_cast<std::ptrdiff_t>(j) + 1);
            Ring other(r.begin() + static_cast<std::ptrdiff_t>(j), r.end());
            other.insert(other.end(), r.begin(), r.begin() + static_cast<std::ptrdiff_t>(i) + 1);
            rings.push_back(std::move(other));
        }
    }

  private:
    const Vec2& at(std::uint32_t v) const { return points_[v]; }

    /// Quality of a diagonal at one end, where it divides the angle in two: the ratio of the smaller sine to the
    /// larger, times the smaller.
    double end_value(const Vec2& corner, const Vec2& before, const Vec2& after, const Vec2& other) const {
        const auto sine = [&](const Vec2& a, const Vec2& b) {
            return std::abs(cross(a - corner, b - corner)) / (length(a - corner) * length(b - corner));
        };
        const double s = sine(before, other), t = sine(other, after);
        const double least = std::min(s, t), most = std::max(s, t);
        return most > 0 ? least / most * least : 0;
    }

    double value(const Ring& r, std::size_t i, std::size_t j) const {
        const double d = length(at(r[j]) - at(r[i]));
        if (scheme_ == TriangulationScheme::longest) return d;
        if (scheme_ == TriangulationScheme::shortest) return -d;
        const std::size_t n = r.size();
        return end_value(at(r[i]), at(r[(i + n - 1) % n]), at(r[(i + 1) % n]), at(r[j])) *
               end_value(at(r[j]), at(r[j - 1]), at(r[(j + 1) % n]), at(r[i]));
    }

    /// Returns the ends of the diagonal with the largest value among those with area on both sides; equal indices if
    /// there is none. O(corners^2).
    std::pair<std::size_t, std::size_t> best_diagonal(const Ring& r) const {
        constexpr double flat = 1e-9;  // share of a diagonal's squared length
        std::pair<std::size_t, std::size_t> best{0, 0};
        double most = -HUGE_VAL;
        const std::size_t n = r.size();
        // Twice the area swept from the first corner by the edges before each corner.
        std::vector<double> swept(n + 1, 0);
        for (std::size_t k = 0; k < n; ++k)
            swept[k + 1] = swept[k] + cross(at(r[k]) - at(r[0]), at(r[(k + 1) % n]) - at(r[0]));
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = i + 2; j < n; ++j) {
                if (i == 0 && j == n - 1) continue;
                const Vec2 d = at(r[j]) - at(r[i]);
                const double side = swept[j] - swept[i] + cross(at(r[j]) - at(r[0]), at(r[i]) - at(r[0]));
                if (std::min(side, swept[n] - side) < flat * dot(d, d)) continue;
                if (const double v = value(r, i, j); v > most) most = v, best = {i, j};
            }
        return best;
    }

    void join_middle(const Ring& r, std::size_t i, std::size_t j) {
        const auto m = static_cast<std::uint32_t>(points_.size());
        points_.push_back(0.5 * (at(r[i]) + at(r[j])));
        for (std::size_t k = 0; k < r.size(); ++k) triangles_.push_back({r[k], r[(k + 1) % r.size()], m});
    }

    std::vector<Vec2>& points_;
    TriangulationScheme scheme_;
    std::vector<std::array<std::uint32_t, 3>>& triangles_;
};

}  // namespace

LabelledTriangles triangulated(const DmTree& tree, TriangulationScheme scheme,
                               std::span<const std::uint8_t> label_of_curve) {
    const WingedEdgeMesh& mesh = tree.mesh();
    LabelledTriangles out;
    for (const WingedEdgeMesh::Vertex& v : mesh.vertices()) out.points.push_back(v.at);
    FaceTriangulation faces(out.points, scheme, out.corners);
    for (std::uint32_t f = 0; f < mesh.faces().size(); ++f) {
        Ring ring;
        for (const auto& corner : mesh.loop(f)) ring.push_back(corner.vertex);
        faces.add(std::move(ring));
    }
    using Ends = std::pair<std::uint32_t, std::uint32_t>;
    std::map<Ends, std::uint8_t> labels;
    for (const WingedEdgeMesh::Edge& e : mesh.edges()) {
        const bool is_border = e.face[0] == WingedEdgeMesh::none || e.face[1] == WingedEdgeMesh::none;
        if (is_border || e.curve != WingedEdgeMesh::none)
            labels[std::minmax(e.vertex[0], e.vertex[1])] =
                is_border ? LabelledTriangles::border : label_of_curve[e.curve];
    }
    std::map<Ends, std::uint32_t> sides;
    for (std::uint32_t t = 0; t < out.corners.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) sides[{out.corners[t][k], out.corners[t][(k + 1) % 3]}] = t;
    for (const auto& c : out.corners) {
        auto& label = out.labels.emplace_back();
        auto& neighbor = out.neighbors.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = c[k], b = c[(k + 1) % 3];
            const auto known = labels.find(std::minmax(a, b));
            label[k] = known == labels.end() ? LabelledTriangles::unlabelled : known->second;
            const auto across = sides.find({b, a});
            neighbor[k] = across == sides.end() ? LabelledTriangles::none : across->second;
        }
    }
    return out;
}

double radius_ratio(const Vec2& a, const Vec2& b, const Vec2& c) {
    const double x = length(b - c), y = length(c - a), z = length(a - b), product = x * y * z;
    // r = 2 area / (x + y + z), R = x y z / (4 area).
    const double area = 0.5 * std::abs(cross(b - a, c - a));
    return product > 0 ? 8 * area * area / ((x + y + z) * product) : 0;
}

}  // namespace exitance
