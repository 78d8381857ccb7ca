#include "exitance/visibility/edge_sum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "exitance/base/limits.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"

namespace exitance {
namespace {

using Workspace = VisibilityWorkspace;

/// Gap between pieces that is too large for rounding; derived from double precision, with a margin of a million.
constexpr double max_rounding_gap = 1e-9;

/// An edge of the source or of an occluder, counter-clockwise around its polygon as seen from x.
struct Edge {
    Vec3 a, b;
    Vec3 inward;  ///< Unit normal of the plane through x and the edge, pointing into the polygon.
    int owner;    ///< Index of the occluder, -1 for the source.
    double noise_a, noise_b;
};

double noise(const Vec3& r) {
    return edge_on_sine * (std::abs(r.x) + std::abs(r.y) + std::abs(r.z));
}

/// Reduces [from, to] to the part of an edge on the inner side of a plane through x that does not contain the edge.
void clip_interval(double ha, double hb, double& from, double& to) {
    if (ha <= 0 && hb <= 0) {
        to = from;
    } else if (ha < 0) {
        from = std::max(from, ha / (ha - hb));
    } else if (hb < 0) {
        to = std::min(to, ha / (ha - hb));
    }
}

/// Reduces [from, to] to the part of an edge whose visible side an occluder hides.
void hidden_interval(const Edge& edge, int occluder, std::span<const Vec3> planes, double& from, double& to) {
    for (const Vec3& plane : planes) {
        const double ha = dot(plane, edge.a), hb = dot(plane, edge.b);
        if (std::abs(ha) <= edge.noise_a &&
            std::abs(hb) <= edge.noise_b) {  // the edge lies in the plane: decide on which side it is visible
            const bool same_side = dot(plane, edge.inward) > 0;
            const bool hidden = edge.owner < 0 ? same_side : same_side ? occluder < edge.owner : true;
            if (!hidden) to = from;
        } else {
            clip_interval(ha, hb, from, to);
        }
        if (to <= from) return;
    }
}

class Boundary {
  public:
    Boundary(const Normal& n, Workspace& scratch) : scratch_(scratch), sum_(n, scratch.source) {
        const Vec3 &p = scratch.source[0], &q = scratch.source[1], &r = scratch.source[2];
        source_normal_ = cross(q - p, r - p);
        source_height_ = dot(source_normal_, p);
        scratch.lit.begin(scratch.source);
        scratch.boxes.clear();
        for (const Workspace::Shadow& shadow : scratch.shadows)
            scratch.boxes.push_back(scratch.lit.bounds(scratch.outlines[shadow.outline]));
        source_box_ = scratch.lit.bounds(scratch.source);
    }

    void add_edge(const Edge& edge) {
        double from = 0, to = 1;
        const std::array<Vec3, 2> ends{edge.a, edge.b};
        const Rectangle bounds = scratch_.lit.bounds(ends);
        if (!bounds.meets(source_box_)) return;
        if (edge.owner >= 0)
            for (const Vec3& plane : scratch_.source_pyramid) {
                const double ha = dot(plane, edge.a), hb = dot(plane, edge.b);
                if (std::abs(ha) <= edge.noise_a && std::abs(hb) <= edge.noise_b)
                    return;  // the source's own edge is counted instead
                clip_interval(ha, hb, from, to);
                if (to <= from) return;
            }
        auto& hidden = scratch_.intervals;
        hidden.clear();
        for (std::size_t j = 0; j < scratch_.shadows.size(); ++j) {
            const Workspace::Shadow& shadow = scratch_.shadows[j];
            if (!bounds.meets(scratch_.boxes[j]) || static_cast<int>(j) == edge.owner) continue;
            double first = from, last = to;
            hidden_interval(edge, static_cast<int>(j),
                            std::span(scratch_.planes).subspan(shadow.first_plane, shadow.plane_count), first, last);
            if (first < last) hidden.push_back({first, last});
            if (first <= from && last >= to) return;
        }
        std::sort(hidden.begin(), hidden.end());
        for (const auto& [first, last] : hidden) {
            if (first > from) add_piece(edge, from, first);
            from = std::max(from, last);
        }
        if (to > from) add_piece(edge, from, to);
    }

    double total() const {
        return norm(gap_) > max_rounding_gap ? std::numeric_limits<double>::quiet_NaN() : sum_.total();
    }

  private:
    Vec3 on_source(const Vec3& r) const { return (source_height_ / dot(source_normal_, r)) * r; }

    void add_piece(const Edge& edge, double from, double to) {
        Vec3 a = from == 0 ? edge.a : edge.a + from * (edge.b - edge.a);
        Vec3 b = to == 1 ? edge.b : edge.a + to * (edge.b - edge.a);
        if (edge.owner >= 0) {
            std::swap(a, b);
            if (sum_.is_small()) a = on_source(a), b = on_source(b);
        }
        gap_ += normalized(b) - normalized(a);
        sum_.add(a, b);
    }

    Workspace& scratch_;
    EdgeSum sum_;
    Vec3 source_normal_, gap_;
    Rectangle source_box_;
    double source_height_;
};

void add_polygon(std::span<const Vec3> corners, int owner, bool reversed, Boundary& boundary) {
    for (std::size_t i = 0, m = corners.size(); i < m; ++i) {
        Edge edge{corners[i], corners[i + 1 == m ? 0 : i + 1], {}, owner, 0, 0};
        if (reversed) std::swap(edge.a, edge.b);
        const Vec3 inward = cross(edge.b - edge.a, edge.a);
        const double length = norm(inward);
        // the edge points at x and appears as a single point
        if (length <= edge_on_sine * norm(edge.a) * norm(edge.b)) continue;
        edge.inward = inward / length;
        edge.noise_a = noise(edge.a), edge.noise_b = noise(edge.b);
        boundary.add_edge(edge);
    }
}

}  // namespace

double edge_sum(const Normal& n, VisibilityWorkspace& scratch) {
    Boundary boundary(n, scratch);
    add_polygon(scratch.source, -1, false, boundary);
    for (std::size_t i = 0; i < scratch.shadows.size(); ++i)
        add_polygon(scratch.outlines[scratch.shadows[i].outline], static_cast<int>(i), scratch.shadows[i].reversed,
                    boundary);
    return boundary.total();
}

}  // namespace exitance
