#include "exitance/lab/classical/interaction_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "exitance/base/polygon.hpp"
#include "exitance/base/quadrature.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"

namespace exitance {
namespace {

constexpr int grid = 4;  // jittered rays along each side of an element [Hanrahan91]

std::vector<Point> corners_of(const Patch& patch) {
    std::vector<Point> out;
    for (int i = 0; i < patch.corner_count(); ++i) out.push_back(patch.corner(i));
    return out;
}

/// Kernel cos cos / (pi r^2 + area), that of a disc of this area from its axis; 0 from behind.
double disc_kernel(const Point& x, const Normal& n, const Point& y, const Normal& m, double area) {
    const Vec3 d = y - x;
    const double up = dot(n, d), down = -dot(m, d), squared = dot(d, d);
    if (up <= 0 || down <= 0) return 0;
    return up * down / (squared * (pi * squared + area));
}

}  // namespace

bool InteractionKernel::faces(const ElementTree& tree, ElementId receiver, ElementId source) const {
    const auto rises_over = [&](ElementId e, ElementId plane) {
        const Patch& p = tree.patch(plane);
        const Normal n = p.normal();
        const double least = 1e-9 * stage_.scene.size();
        const Patch& patch = tree.patch(e);
        for (int i = 0; i < patch.corner_count(); ++i)
            if (dot(n, patch.corner(i) - p.origin) > least) return true;
        return false;
    };
    return rises_over(source, receiver) && rises_over(receiver, source);
}

double InteractionKernel::visible_share(const ElementTree& tree, ElementId receiver, ElementId source,
                                        Workspace& w) const {
    const Patch &p = tree.patch(receiver), &q = tree.patch(source);
    RandomStream random(seed_, Stream::visibility, receiver.value, source.value);
    const unsigned cells = grid * grid, count = std::max(1u, choice_.rays);
    w.from.resize(count), w.to.resize(count);
    for (unsigned i = 0; i < count; ++i) {
        // Latin square: every cell of either grid is used once per round.
        const unsigned a = i % cells, b = (7 * a + 5 * (i / cells) + 3) % cells;
        const auto place = [&](unsigned cell, const Patch& patch) {
            const double s = (cell % grid + random.uniform()) / grid, t = (cell / grid + random.uniform()) / grid;
            return patch.at(uniform_in_shape(patch.shape, s, t));
        };
        w.from[i] = place(a, p), w.to[i] = place(b, q);
    }
    const std::unique_ptr<bool[]> blocked(new bool[count]);
    w.rays += stage_.tracer.occluded(w.from, w.to, tree.region(receiver), tree.region(source), {blocked.get(), count});
    const auto free = std::count(blocked.get(), blocked.get() + count, false);
    return static_cast<double>(free) / count;
}

double InteractionKernel::unoccluded(const ElementTree& tree, ElementId receiver, ElementId source) const {
    const Patch& p = tree.patch(receiver);
    return point_to_polygon(p.centre(), p.normal(), corners_of(tree.patch(source)));
}

void InteractionKernel::open_row(const Point& x, const Normal& n, const Patch& source, const Normal& m,
                                 std::span<double> row, Workspace& w) const {
    const auto nodes = basis_.nodes(source.shape);
    const double area = source.area();
    double sum = 0;
    for (std::size_t l = 0; l < nodes.size(); ++l) {
        const double own = area * nodes[l].weight;
        const double disc = choice_.kernel == TransferKernel::point ? 0 : own;
        row[l] = own > 0 ? own * disc_kernel(x, n, source.at(nodes[l].at), m, disc) : 0;
        sum += row[l];
    }
    if (choice_.kernel != TransferKernel::exact) return;
    ++w.form_factors;
    const double F = point_to_polygon(x, n, corners_of(source));
    for (std::size_t l = 0; l < nodes.size(); ++l) row[l] = sum > 0 ? row[l] * (F / sum) : F * nodes[l].weight;
}

/// Finds the pieces whose boxes meet the box of two elements.
void InteractionKernel::find_blockers(const ElementTree& tree, ElementId receiver, ElementId source,
                                      Workspace& w) const {
    const std::vector<Point> p = corners_of(tree.patch(receiver)), q = corners_of(tree.patch(source));
    Box between;
    for (const Point& corner : p) between.add(corner);
    for (const Point& corner : q) between.add(corner);
    w.blockers.clear();
    const Occluders& occluders = stage_.occluders;
    for (PieceId piece : occluders.pieces().ids()) {
        const RegionId region = occluders.pieces()[piece].region;
        if (occluders.is_own(region, tree.region(receiver)) || occluders.is_own(region, tree.region(source))) continue;
        Box box;
        for (const Point& corner : occluders.corners(piece)) box.add(corner);
        bool apart = false;
        for (std::size_t i = 0; i < 3; ++i) apart |= box.lo[i] > between.hi[i] || box.hi[i] < between.lo[i];
        if (!apart) w.blockers.push_back(piece);
    }
}

/// Removes from w.parts what a blocker hides from x: all inside the pyramid from x through it. Parts of the blocker
/// behind the source's plane or below the horizon are ignored.
void InteractionKernel::cut_away(const Point& x, const Normal& n, const Normal& m, double offset, PieceId blocker,
                                 Workspace& w) const {
    const double rounding = stage_.occluders.rounding();
    clip(stage_.occluders.corners(blocker), {m, offset + rounding}, w.cut);
    clip(w.cut, {n, dot(n, x - Point{}) + rounding}, w.kept);
    if (w.kept.size() < 3) return;
    Point middle = w.kept[0];
    for (std::size_t i = 1; i < w.kept.size(); ++i)
        middle = middle + (1.0 / static_cast<double>(i + 1)) * (w.kept[i] - middle);
    w.left.clear();
    for (std::vector<Point>& part : w.parts) {
        std::vector<Point> inside = std::move(part), next;
        for (std::size_t i = 0; i < w.kept.size() && inside.size() >= 3; ++i) {
            Vec3 side = cross(w.kept[i] - x, w.kept[(i + 1) % w.kept.size()] - x);
            if (!(dot(side, side) > 0)) continue;
            side = normalized(side);
            if (dot(side, middle - x) < 0) side = -1.0 * side;
            const Plane plane{side, dot(side, x - Point{})};
            clip(inside, {-1.0 * side, -plane.offset}, next);
            if (next.size() >= 3 && norm(area_vector(next)) > 0) w.left.push_back(next);
            clip(inside, plane, next);
            inside.swap(next);
        }
    }
    w.parts.swap(w.left);
}

void InteractionKernel::exact_row(const Point& x, const Normal& n, const Patch& source, const Normal& m,
                                  std::span<double> row, Workspace& w) const {
    constexpr int degree = 5;
    w.parts.assign(1, corners_of(source));
    const double offset = dot(m, source.origin - Point{});
    for (PieceId blocker : w.blockers) {
        if (w.parts.empty()) break;
        cut_away(x, n, m, offset, blocker, w);
    }
    std::fill(row.begin(), row.end(), 0.0);
    const std::size_t order = basis_.count();
    w.factors.resize(order);
    std::vector<double> own(order);
    for (const std::vector<Point>& part : w.parts) {
        ++w.form_factors;
        const double F = point_to_polygon(x, n, part);
        if (!(F > 0)) continue;
        std::fill(own.begin(), own.end(), 0.0);
        double sum = 0;
        for (std::size_t i = 1; i + 1 < part.size(); ++i) {
            const Vec3 a = part[i] - part[0], b = part[i + 1] - part[0];
            const double area = 0.5 * norm(cross(a, b));
            for (const PlanarNode& node : triangle_rule(degree)) {
                const Point y = part[0] + node.at.x * a + node.at.y * b;
                const double g = area * node.weight * disc_kernel(x, n, y, m, area * node.weight);
                basis_.interpolate(source.shape, source.coordinates(y), w.factors);
                for (std::size_t l = 0; l < order; ++l) own[l] += g * w.factors[l];
                sum += g;
            }
        }
        if (sum > 0)
            for (std::size_t l = 0; l < order; ++l) row[l] += own[l] * (F / sum);
    }
}

void InteractionKernel::block(const ElementTree& tree, ElementId receiver, ElementId source, double share,
                              std::span<float> K, Workspace& w) const {
    const Patch &p = tree.patch(receiver), &q = tree.patch(source);
    const Normal n = p.normal(), m = q.normal();
    const std::size_t count = basis_.count();
    bool is_exact = choice_.visibility == VisibilityKind::exact;
    const bool by_nodes = choice_.visibility == VisibilityKind::quadrature && share < 1;
    if (is_exact) find_blockers(tree, receiver, source, w);
    const bool is_open = is_exact && w.blockers.empty();
    if (is_open) is_exact = false;
    std::vector<double> row(count);
    const auto receiving = basis_.nodes(p.shape), sending = basis_.nodes(q.shape);
    const std::unique_ptr<bool[]> blocked(new bool[count]);
    for (std::size_t k = 0; k < count; ++k) {
        const Point x = p.at(receiving[k].at);
        if (is_exact)
            exact_row(x, n, q, m, row, w);
        else
            open_row(x, n, q, m, row, w);
        if (by_nodes) {
            w.from.assign(count, x), w.to.resize(count);
            for (std::size_t l = 0; l < count; ++l) w.to[l] = q.at(sending[l].at);
            w.rays += stage_.tracer.occluded(w.from, w.to, tree.region(receiver), tree.region(source),
                                             {blocked.get(), count});
        }
        for (std::size_t l = 0; l < count; ++l) {
            const double visible = is_exact || is_open ? 1 : by_nodes ? (blocked[l] ? 0 : 1) : share;
            K[k * count + l] = static_cast<float>(visible * row[l]);
        }
    }
}

}  // namespace exitance
