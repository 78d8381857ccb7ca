#include "exitance/mesh/leaf_finder.hpp"

#include <array>
#include <bit>

namespace exitance {

/// Walks the tree from its roots and writes cuts and leaves down in the coordinates of the root.
struct LeafFinder::Builder {
    const ElementTree& tree;
    LeafFinder& out;
    Field<ElementId, std::uint32_t> number;
    std::size_t leaves_met = 0;

    /// Own coordinates of an element are (root's - origin) x scale: all but a fan's triangles are parallel to their
    /// root.
    struct Frame {
        Vec2 origin, scale;

        Frame part(Vec2 at, Vec2 stretch) const {
            return {{origin.x + at.x / scale.x, origin.y + at.y / scale.y}, {scale.x * stretch.x, scale.y * stretch.y}};
        }
    };

    std::uint32_t add_node(const Frame& frame, Vec2 normal, double offset) {
        const Vec2 n = {normal.x * frame.scale.x, normal.y * frame.scale.y};
        out.nodes_.push_back({n, offset + dot(n, frame.origin), {0, 0}});
        return static_cast<std::uint32_t>(out.nodes_.size() - 1);
    }
    void set(std::uint32_t node, std::size_t side, std::uint32_t part) { out.nodes_[node].part[side] = part; }

    std::uint32_t add_leaf(ElementId e, Vec2 origin, Vec2 du, Vec2 dv) {
        ++leaves_met;
        out.leaves_[number[e]] = {origin, du, dv, e, tree.patch(e).shape};
        return is_leaf | number[e];
    }

    std::uint32_t add(ElementId e, const Frame& frame) {
        if (tree.is_leaf(e)) return add_leaf(e, frame.origin, {frame.scale.x, 0}, {0, frame.scale.y});
        if (tree.way(e) == Cut::line) return add_line(e, frame);
        if (tree.way(e) == Cut::fan) return add_fan(e, frame);
        return tree.patch(e).is_triangle() ? add_triangle(e, frame) : add_parallelogram(e, frame);
    }

    std::uint32_t add_line(ElementId e, const Frame& frame) {
        const IdRange<ElementId> children = tree.children(e);
        const CutLine line = tree.line(e);
        const std::uint32_t node = add_node(frame, line.normal, line.offset);
        for (std::size_t side = 0; side < 2; ++side) {
            const auto [origin, size] = tree.cell_frame(e, side);
            set(node, side, add(children[side], frame.part(origin, {1 / size.x, 1 / size.y})));
        }
        return node;
    }

    /// Lines through the apex. Where the triangles go all around it, the first line parts them in two halves, which
    /// share the triangle on its far side.
    std::uint32_t add_fan(ElementId e, const Frame& frame) {
        const Fan& fan = tree.fan(e);
        const std::size_t count = fan.border.size() - 1;
        if (!(fan.border.front() == fan.border.back())) return add_sectors(e, frame, 0, count);
        const Vec2 start = fan.border[0] - fan.apex;
        std::size_t far = 0;
        while (far + 1 < count && cross(start, fan.border[far + 1] - fan.apex) >= 0) ++far;
        const std::uint32_t node = add_ray(fan, 0, frame);
        set(node, 1, add_sectors(e, frame, 0, far + 1));
        set(node, 0, add_sectors(e, frame, far, count));
        return node;
    }

    std::uint32_t add_ray(const Fan& fan, std::size_t i, const Frame& frame) {
        const Vec2 d = fan.border[i] - fan.apex, n = {-d.y, d.x};
        return add_node(frame, n, dot(n, fan.apex));
    }

    /// Triangles that together take half a turn at most.
    std::uint32_t add_sectors(ElementId e, const Frame& frame, std::size_t begin, std::size_t end) {
        const Fan& fan = tree.fan(e);
        if (end - begin == 1) {
            const Vec2 a = fan.border[begin] - fan.apex, b = fan.border[end] - fan.apex, s = frame.scale;
            const double area = cross(a, b);
            return add_leaf(tree.children(e)[begin],
                            {frame.origin.x + fan.apex.x / s.x, frame.origin.y + fan.apex.y / s.y},
                            {s.x * b.y / area, -s.y * b.x / area}, {-s.x * a.y / area, s.y * a.x / area});
        }
        const std::size_t middle = (begin + end) / 2;
        const std::uint32_t node = add_ray(fan, middle, frame);
        set(node, 0, add_sectors(e, frame, begin, middle));
        set(node, 1, add_sectors(e, frame, middle, end));
        return node;
    }

    /// Corners at (1, 0) and (0, 1), then what the third line leaves: the corner at (0, 0) and the middle, upside down.
    std::uint32_t add_triangle(ElementId e, const Frame& frame) {
        const IdRange<ElementId> children = tree.children(e);
        const std::uint32_t u = add_node(frame, {1, 0}, 0.5), v = add_node(frame, {0, 1}, 0.5),
                            w = add_node(frame, {1, 1}, 0.5);
        set(u, 0, v), set(v, 0, w);
        set(u, 1, add(children[1], frame.part({0.5, 0}, {2, 2})));
        set(v, 1, add(children[2], frame.part({0, 0.5}, {2, 2})));
        set(w, 0, add(children[0], frame.part({0, 0}, {2, 2})));
        set(w, 1, add(children[3], frame.part({0.5, 0.5}, {-2, -2})));
        return u;
    }

    std::uint32_t add_parallelogram(ElementId e, const Frame& frame) {
        const IdRange<ElementId> children = tree.children(e);
        const Cut way = tree.way(e);
        const double r = way == Cut::both ? 0.5 : tree.ratio(e);
        const auto halves = [&](Vec2 along, const Frame& whole, ElementId low, ElementId high) {
            const Vec2 across = {along.y, along.x};
            const std::uint32_t node = add_node(whole, along, r);
            set(node, 0, add(low, whole.part({0, 0}, (1 / r) * along + across)));
            set(node, 1, add(high, whole.part(r * along, (1 / (1 - r)) * along + across)));
            return node;
        };
        if (way == Cut::u) return halves({1, 0}, frame, children[0], children[1]);
        if (way == Cut::v) return halves({0, 1}, frame, children[0], children[1]);
        const std::uint32_t node = add_node(frame, {0, 1}, r);
        set(node, 0, halves({1, 0}, frame.part({0, 0}, {1, 2}), children[0], children[1]));
        set(node, 1, halves({1, 0}, frame.part({0, 0.5}, {1, 2}), children[2], children[3]));
        return node;
    }
};

LeafFinder::LeafFinder(const ElementTree& tree) {
    Builder builder{tree, *this, Field<ElementId, std::uint32_t>(tree.size())};
    std::uint32_t count = 0;
    for (ElementId e : tree.ids())
        if (tree.is_leaf(e)) builder.number[e] = count++;
    leaves_.resize(count);
    nodes_.reserve(tree.size());
    for (ElementId root : tree.roots()) {
        const std::size_t before = builder.leaves_met;
        const std::uint32_t whole = builder.add(root, {{0, 0}, {1, 1}});
        // About four cells a leaf, as square as the root's shape allows.
        const double cells = 4.0 * static_cast<double>(builder.leaves_met - before);
        const double aspect = norm(tree.patch(root).a) / norm(tree.patch(root).b);
        const auto power = [](double wanted) {
            constexpr double most = 1024;
            return std::bit_floor(static_cast<std::uint32_t>(std::clamp(wanted, 1.0, most)));
        };
        Grid grid{static_cast<std::uint32_t>(start_.size())};
        if (cells > 4) grid.columns = power(std::sqrt(cells * aspect)), grid.rows = power(cells / grid.columns);
        for (std::uint32_t row = 0; row < grid.rows; ++row)
            for (std::uint32_t column = 0; column < grid.columns; ++column) {
                const Vec2 lo = {static_cast<double>(column) / grid.columns, static_cast<double>(row) / grid.rows};
                start_.push_back(deepest_around(whole, lo, lo + Vec2{1.0 / grid.columns, 1.0 / grid.rows}));
            }
        grids_.push_back(grid);
    }
    nodes_.shrink_to_fit(), start_.shrink_to_fit();
}

/// The last part on the way down from `part` that holds a whole box.
std::uint32_t LeafFinder::deepest_around(std::uint32_t part, Vec2 lo, Vec2 hi) const {
    const Vec2 middle = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
    while (!(part & is_leaf)) {
        const Node& node = nodes_[part];
        const double height = dot(node.normal, middle) - node.offset;
        const double reach = std::abs(node.normal.x) * half.x + std::abs(node.normal.y) * half.y;
        // A cut along the side of the box, where most are, leaves it whole; the box's further sides belong to others.
        const double rounding = 1e-12 * (std::abs(node.normal.x) + std::abs(node.normal.y));
        if (std::abs(height) < reach - rounding) break;
        part = node.part[height > 0 ? 1 : 0];
    }
    return part;
}

/// Where a point's way down begins, in `start_`.
std::size_t LeafFinder::cell(std::size_t root, Vec2 uv) const {
    const Grid& grid = grids_[root];
    const auto index = [](double t, std::uint32_t count) {
        return std::min(static_cast<std::uint32_t>(t * count), count - 1);
    };
    return grid.first + static_cast<std::size_t>(index(uv.y, grid.rows)) * grid.columns + index(uv.x, grid.columns);
}

LeafFinder::Found LeafFinder::find(std::size_t root, Vec2 uv) const {
    std::uint32_t part = start_[cell(root, uv)];
    while (!(part & is_leaf)) part = nodes_[part].part_of(uv);
    const std::uint32_t number = part & ~is_leaf;
    const Leaf& leaf = leaves_[number];
    const Vec2 from = uv - leaf.origin;
    return {number, into_shape({dot(leaf.du, from), dot(leaf.dv, from)}, leaf.shape)};
}

void LeafFinder::find(std::span<Query> queries) const {
    constexpr std::size_t together = 32;
    std::size_t at[together];
    for (std::size_t first = 0; first < queries.size(); first += together) {
        const std::span<Query> batch = queries.subspan(first, std::min(together, queries.size() - first));
        for (std::size_t i = 0; i < batch.size(); ++i) {
            at[i] = cell(batch[i].root, batch[i].uv);
            __builtin_prefetch(&start_[at[i]]);
        }
        for (std::size_t i = 0; i < batch.size(); ++i) {
            batch[i].leaf = start_[at[i]];
            if (!(batch[i].leaf & is_leaf)) __builtin_prefetch(&nodes_[batch[i].leaf]);
        }
        // Those still on their way, closed up after every step, without a branch that could be guessed wrong.
        std::array<std::uint32_t, together> open;
        std::size_t count = 0;
        for (std::size_t i = 0; i < batch.size(); ++i) {
            open[count] = static_cast<std::uint32_t>(i);
            count += (batch[i].leaf & is_leaf) == 0;
        }
        while (count > 0) {
            std::size_t left = 0;
            for (std::size_t k = 0; k < count; ++k) {
                Query& q = batch[open[k]];
                q.leaf = nodes_[q.leaf].part_of(q.uv);
                __builtin_prefetch(&nodes_[q.leaf & ~is_leaf]);
                open[left] = open[k];
                left += (q.leaf & is_leaf) == 0;
            }
            count = left;
        }
        for (Query& q : batch) q.leaf &= ~is_leaf;
    }
}

}  // namespace exitance
