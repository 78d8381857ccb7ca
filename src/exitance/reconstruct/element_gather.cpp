#include "exitance/reconstruct/element_gather.hpp"

#include <algorithm>

namespace exitance {
namespace {

bool is_triangle(const std::array<Vec2, 4>& uv) {
    return uv[2] == uv[3];
}

Spectrum larger(const Spectrum& a, const Spectrum& b) {
    Spectrum out;
    for (std::size_t k = 0; k < bands; ++k) out[k] = std::max(a[k], b[k]);
    return out;
}

Spectrum magnitude(const Spectrum& a) {
    return larger(a, -1.0 * a);
}

/// The corners of a convex domain; of one with fewer than four the last one again.
std::array<Vec2, 4> four_corners(const std::vector<Vec2>& domain) {
    std::array<Vec2, 4> out;
    for (std::size_t k = 0; k < 4; ++k) out[k] = domain[std::min(k, domain.size() - 1)];
    return out;
}

}  // namespace

bool ElementGather::suits(const Stage& stage) {
    // Each gather begins at all pieces. Beyond some dozens, rays are cheaper.
    constexpr std::size_t most = 64;
    return stage.occluders.has_nothing_inside() && stage.pieces.size() <= most;
}

/// From the leaves up.
ElementGather::ElementGather(const Stage& stage, const ElementFunction& b) : b_(b) {
    const ElementTree& tree = b_.tree;
    nodes_.resize(tree.size()), moments_.resize(tree.size());
    is_quad_.resize(tree.size()), is_dark_.resize(tree.size());
    for (std::size_t i = tree.size(); i-- > 0;) {
        const ElementId e(i);
        is_quad_[e] = tree.domain(e).size() <= 4;
        if (tree.is_leaf(e)) {
            const Normal& n = stage.scene.regions()[tree.region(e)].plane.n;
            is_dark_[e] = stage.occluders.is_covered(tree.patch(e).at(tree.centre(e)), n, tree.region(e));
            nodes_[e] = is_dark_[e] ? Node() : leaf_node(e);
            nodes_[e].centre = tree.patch(e).at(tree.centre(e));
            for (std::size_t k = 0; k < bands; ++k)
                for (std::size_t c = 0; c < (nodes_[e].triangle ? 3 : 4); ++c)
                    moments_[e][k] =
                        moments_[e][k] + nodes_[e].lean[c][k] / 12 * (nodes_[e].corners[c] - nodes_[e].centre);
            continue;
        }
        is_dark_[e] = true;
        for (ElementId child : tree.children(e)) is_dark_[e] &= is_dark_[child];
        nodes_[e] = inner_node(e);
    }
}

ElementGather::Part ElementGather::part_of(ElementId leaf, const std::array<Vec2, 4>& uv) const {
    const Patch& patch = b_.tree.patch(leaf);
    Part out{{}, leaf, uv};
    Node& node = out.node;
    node.triangle = is_triangle(uv);
    const std::size_t count = node.triangle ? 3 : 4;
    Vec2 middle;
    for (std::size_t i = 0; i < count; ++i) middle = middle + (1.0 / static_cast<double>(count)) * uv[i];
    node.mean = b_.at({leaf, middle});
    node.centre = patch.at(middle);
    for (std::size_t i = 0; i < 4; ++i) {
        node.corners[i] = patch.at(uv[i]);
        node.lean[i] = b_.at({leaf, uv[i]}) - node.mean;
        node.slope = larger(node.slope, magnitude(node.lean[i]));
        node.radius = std::max(node.radius, norm(node.corners[i] - node.centre));
    }
    return out;
}

ElementGather::Node ElementGather::leaf_node(ElementId e) const {
    const std::vector<Vec2> domain = b_.tree.domain(e);
    Node out = part_of(e, four_corners(domain)).node;
    if (!b_.tree.is_cell(e)) return out;
    // A cell is any convex polygon: without its slope it is only cut sooner.
    out.centre = b_.tree.patch(e).at(b_.tree.centre(e));
    out.mean = b_.at({e, b_.tree.centre(e)});
    out.lean = {}, out.slope = {}, out.radius = 0;
    for (const Vec2& uv : domain) {
        out.rest = larger(out.rest, magnitude(b_.at({e, uv}) - out.mean));
        out.radius = std::max(out.radius, norm(b_.tree.patch(e).at(uv) - out.centre));
    }
    return out;
}

/// The linear function with an element's moments: in its coordinates the variances of u and v are 1/12 on a
/// parallelogram, 1/18 with a covariance of -1/36 on a triangle.
void ElementGather::set_lean(Node& node, ElementId e, const std::array<Vec3, bands>& moment) const {
    const Patch& patch = b_.tree.patch(e);
    if (b_.tree.is_cell(e)) return;
    const Vec2 centre = b_.tree.centre(e);
    for (std::size_t k = 0; k < bands; ++k) {
        const Vec2 m = patch.coordinates(patch.origin + moment[k]);
        const Vec2 slope = node.triangle ? Vec2{24 * m.x + 12 * m.y, 12 * m.x + 24 * m.y} : 12 * m;
        for (int c = 0; c < 4; ++c)
            node.lean[static_cast<std::size_t>(c)][k] =
                dot(slope, patch.corner_uv(std::min(c, patch.corner_count() - 1)) - centre);
    }
    for (const Spectrum& lean : node.lean) node.slope = larger(node.slope, magnitude(lean));
}

ElementGather::Node ElementGather::inner_node(ElementId e) {
    const ElementTree& tree = b_.tree;
    const Patch& patch = tree.patch(e);
    const std::array<Vec2, 4> corners = four_corners(tree.domain(e));
    Node out;
    out.triangle = is_triangle(corners);
    out.centre = patch.at(tree.centre(e));
    for (std::size_t k = 0; k < 4; ++k) {
        out.corners[k] = patch.at(corners[k]);
        out.radius = std::max(out.radius, norm(out.corners[k] - out.centre));
    }
    double area = 0;
    for (ElementId child : tree.children(e)) {
        area += tree.area(child);
        out.mean += tree.area(child) * nodes_[child].mean;
    }
    out.mean *= 1 / area;
    std::array<Vec3, bands>& moment = moments_[e];
    for (ElementId child : tree.children(e))
        for (std::size_t k = 0; k < bands; ++k)
            moment[k] = moment[k] + tree.area(child) / area *
                                        (moments_[child][k] +
                                         (nodes_[child].mean - out.mean)[k] * (nodes_[child].centre - out.centre));
    set_lean(out, e, moment);
    const auto linear_at = [&](const Point& y) {
        // Two of the corners and the mean span the function: a parallelogram's opposite ones lean alike.
        const Vec2 uv = patch.coordinates(y), c = tree.centre(e);
        const std::size_t last = out.triangle ? 2 : 3;
        const double u = uv.x - c.x, v = uv.y - c.y;
        return out.mean + u * (out.lean[1] - out.lean[0]) + v * (out.lean[last] - out.lean[0]);
    };
    for (ElementId child : tree.children(e))
        out.rest =
            larger(out.rest, magnitude(nodes_[child].mean - linear_at(nodes_[child].centre)) + nodes_[child].rest);
    return out;
}

/// An element to be summed; one with many corners as those below it, or as triangles.
void ElementGather::add_element(ElementId e, Workspace& w) const {
    if (is_dark_[e]) return;
    if (is_quad_[e]) {
        w.next_.push_back({e, whole});
    } else if (!b_.tree.is_leaf(e)) {
        for (ElementId child : b_.tree.children(e)) add_element(child, w);
    } else {
        const std::vector<Vec2> domain = b_.tree.domain(e);
        for (std::size_t k = 2; k < domain.size(); ++k) {
            w.next_.push_back({e, static_cast<std::uint32_t>(w.parts_.size())});
            w.parts_.push_back(part_of(e, {domain[0], domain[k - 1], domain[k], domain[k]}));
        }
    }
}

/// Children of an element, or quarters of a leaf or of a part of it.
void ElementGather::add_pieces(Item item, Workspace& w) const {
    const ElementId e = item.element;
    if (item.part == whole && !b_.tree.is_leaf(e)) {
        for (ElementId child : b_.tree.children(e)) add_element(child, w);
        return;
    }
    const std::array<Vec2, 4> uv = item.part == whole ? four_corners(b_.tree.domain(e)) : w.parts_[item.part].uv;
    const auto between = [&](std::size_t i, std::size_t j) { return 0.5 * (uv[i] + uv[j]); };
    const auto add = [&](const std::array<Vec2, 4>& corners) {
        w.next_.push_back({e, static_cast<std::uint32_t>(w.parts_.size())});
        w.parts_.push_back(part_of(e, corners));
    };
    const Vec2 ab = between(0, 1), bc = between(1, 2);
    if (is_triangle(uv)) {
        const Vec2 ca = between(2, 0);
        add({uv[0], ab, ca, ca}), add({ab, uv[1], bc, bc}), add({ca, bc, uv[2], uv[2]}), add({ab, bc, ca, ca});
        return;
    }
    const Vec2 cd = between(2, 3), da = between(3, 0), middle = 0.5 * (ab + cd);
    add({uv[0], ab, middle, da}), add({ab, uv[1], bc, middle}), add({middle, bc, uv[2], cd});
    add({da, middle, cd, uv[3]});
}

/// The mean of b over a node as x sees it.
Spectrum ElementGather::mean_seen(const Node& node, const Point& x, const Normal& n) {
    const std::size_t count = node.triangle ? 3 : 4;
    const double inward = node.triangle ? 0.5 : 0.5773502691896257;  // Gauss's points: halfway, or 1 / sqrt(3), out
    Spectrum sum;
    double weight = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 d = node.centre + inward * (node.corners[i] - node.centre) - x;
        const double above = std::max(0.0, dot(n, d)), below = squared_norm(d);
        if (below <= 0) continue;
        const double K = above / (below * below);  // the height of x over the node's plane is the same for all points
        weight += K;
        sum += K * node.lean[i];
    }
    return weight > 0 ? node.mean + inward / weight * sum : node.mean;
}

Spectrum ElementGather::operator()(const Point& x, const Normal& n, RegionId own, double share, Workspace& w) const {
    constexpr int most_levels = 16;
    w.parts_.clear(), w.next_.clear();
    for (ElementId root : b_.tree.roots())
        if (b_.tree.region(root) != own) add_element(root, w);
    const auto node_of = [&](Item item) -> const Node& {
        return item.part == whole ? nodes_[item.element] : w.parts_[item.part].node;
    };
    Spectrum E, allowed;
    for (int level = 0; !w.next_.empty(); ++level) {
        std::swap(w.level_, w.next_);
        w.quads_.clear(), w.next_.clear();
        for (const Item& item : w.level_) {
            const Node& node = node_of(item);
            w.quads_.add(node.corners, node.centre, node.radius);
        }
        w.F_.resize(w.level_.size());
        point_to_quads(x, n, w.quads_, w.F_);
        if (level == 0)
            for (std::size_t i = 0; i < w.level_.size(); ++i)
                allowed += share * w.F_[i] * magnitude(node_of(w.level_[i]).mean);
        for (std::size_t i = 0; i < w.level_.size(); ++i) {
            const Node& node = node_of(w.level_[i]);
            const double F = w.F_[i];
            if (F <= 0) continue;
            // How much the kernel varies over the node, and what is left over by Gauss's points.
            const double near = std::min(1.0, 3 * node.radius / norm(node.centre - x)), rest = 0.3 * near * near;
            bool even = true, level_enough = true;
            for (std::size_t k = 0; k < bands; ++k) {
                even &= F * (rest * node.slope[k] + 0.3 * near * node.rest[k]) <= allowed[k];
                level_enough &= F * near * node.slope[k] <= 0.1 * allowed[k];
            }
            if (even || level == most_levels)
                E += F * (level_enough ? node.mean : mean_seen(node, x, n));
            else
                add_pieces(w.level_[i], w);
        }
    }
    return E;
}

}  // namespace exitance
