#include "exitance/mesh/leaf_finder.hpp"

#include <array>
#include <bit>

#include "exitance/base/limits.hpp"
#include "exitance/base/parallel.hpp"

namespace exitance {

/// Coordinates in an element, relative to those of its root: (root's - origin) x scale. All elements except triangles
/// of fans are parallel to their root.
struct LeafFinder::Frame {
    Vec2 origin, scale;

    Frame part(Vec2 at, Vec2 stretch) const {
        return {{origin.x + at.x / scale.x, origin.y + at.y / scale.y}, {scale.x * stretch.x, scale.y * stretch.y}};
    }
    /// A cut along the line normal . uv = offset in these coordinates.
    Node line(Vec2 normal, double offset) const {
        const Vec2 n = {normal.x * scale.x, normal.y * scale.y};
        return {n, offset + dot(n, origin), {0, 1}};
    }
};

/// Finds triangles of a fan by bisection with lines through its apex. In a fan that surrounds its apex, the first line
/// separates two halves that share the triangle on the far side.
class LeafFinder::FanWalk {
  public:
    FanWalk(const ElementTree& tree, ElementId e, const Frame& frame)
        : tree_(tree), element_(e), fan_(tree.fan(e)), frame_(frame) {}

    /// Returns the index in the fan of the triangle that contains a point of the root.
    std::size_t find(Vec2 uv) const {
        std::size_t begin = 0, end = fan_.border.size() - 1;
        if (goes_around()) {
            const std::size_t far = far_side();
            if (ray(0).part_of(uv) == 1)
                end = far + 1;
            else
                begin = far;
        }
        while (end - begin > 1) {
            const std::size_t middle = (begin + end) / 2;
            (ray(middle).part_of(uv) == 0 ? end : begin) = middle;
        }
        return begin;
    }
    Leaf leaf(std::size_t i) const {
        const Vec2 a = fan_.border[i] - fan_.apex, b = fan_.border[i + 1] - fan_.apex, s = frame_.scale;
        const double area = cross(a, b);
        return {{frame_.origin.x + fan_.apex.x / s.x, frame_.origin.y + fan_.apex.y / s.y},
                {s.x * b.y / area, -s.y * b.x / area},
                {-s.x * a.y / area, s.y * a.x / area},
                tree_.children(element_)[i],
                Patch::Shape::triangle};
    }

    std::uint32_t add_nodes(Builder& builder) const;

  private:
    bool goes_around() const { return fan_.border.front() == fan_.border.back(); }
    std::size_t far_side() const {
        const Vec2 start = fan_.border[0] - fan_.apex;
        std::size_t far = 0;
        while (far + 2 < fan_.border.size() && cross(start, fan_.border[far + 1] - fan_.apex) >= 0) ++far;
        return far;
    }
    /// The line through a border point; its parts are the triangles before and after that point.
    Node ray(std::size_t i) const {
        const Vec2 d = fan_.border[i] - fan_.apex, n = {-d.y, d.x};
        return frame_.line(n, dot(n, fan_.apex));
    }
    std::uint32_t add_sectors(Builder& builder, std::size_t begin, std::size_t end) const;

    const ElementTree& tree_;
    ElementId element_;
    FanView fan_;
    Frame frame_;
};

/// The deepest part below `part` that contains a whole box.
std::uint32_t LeafFinder::deepest_around(std::span<const Node> nodes, std::uint32_t part, Vec2 lo, Vec2 hi) {
    const Vec2 middle = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
    while (!(part & is_leaf)) {
        const Node& node = nodes[part];
        const double height = dot(node.normal, middle) - node.offset;
        const double reach = std::abs(node.normal.x) * half.x + std::abs(node.normal.y) * half.y;
        // Most cuts are along a side of the box and leave it whole; the far sides of the box belong to its neighbours.
        const double rounding = zero_sine * (std::abs(node.normal.x) + std::abs(node.normal.y));
        if (std::abs(height) < reach - rounding) break;
        part = node.part[height > 0 ? 1 : 0];
    }
    return part;
}

/// Records the cuts and leaves below a block of consecutive roots, in the coordinates of each root. Positions of nodes
/// and fans count from the first of the block.
struct LeafFinder::Builder {
    const ElementTree& tree;
    const Field<ElementId, std::uint32_t>& number;
    std::span<Leaf> leaves;  ///< All leaves of the tree; each parallel block fills its own part.
    std::vector<Node> nodes = {};
    std::vector<Leaf> fans = {};
    std::vector<Grid> grids = {};
    std::vector<std::uint32_t> start = {};
    std::size_t leaves_met = 0;

    void add_root(ElementId root) {
        const std::size_t before = leaves_met;
        const std::uint32_t whole = add(root, {{0, 0}, {1, 1}});
        // About four cells per leaf, as square as the root's shape allows.
        const double cells = 4.0 * static_cast<double>(leaves_met - before);
        const double aspect = norm(tree.patch(root).a) / norm(tree.patch(root).b);
        const auto power = [](double wanted) {
            constexpr double max_cells = 1024;
            return std::bit_floor(static_cast<std::uint32_t>(std::clamp(wanted, 1.0, max_cells)));
        };
        Grid grid{static_cast<std::uint32_t>(start.size())};
        if (cells > 4) grid.columns = power(std::sqrt(cells * aspect)), grid.rows = power(cells / grid.columns);
        for (std::uint32_t row = 0; row < grid.rows; ++row)
            for (std::uint32_t column = 0; column < grid.columns; ++column) {
                const Vec2 lo = {static_cast<double>(column) / grid.columns, static_cast<double>(row) / grid.rows};
                start.push_back(deepest_around(nodes, whole, lo, lo + Vec2{1.0 / grid.columns, 1.0 / grid.rows}));
            }
        grids.push_back(grid);
    }

    std::uint32_t add_node(const Frame& frame, Vec2 normal, double offset) {
        return add_node(frame.line(normal, offset));
    }
    std::uint32_t add_node(const Node& node) {
        nodes.push_back(node);
        return static_cast<std::uint32_t>(nodes.size() - 1);
    }
    void set(std::uint32_t node, std::size_t side, std::uint32_t part) { nodes[node].part[side] = part; }

    std::uint32_t add_leaf(const Leaf& leaf) {
        ++leaves_met;
        leaves[number[leaf.id]] = leaf;
        return is_leaf | number[leaf.id];
    }

    std::uint32_t add(ElementId e, const Frame& frame) {
        if (tree.is_leaf(e))
            return add_leaf({frame.origin, {frame.scale.x, 0}, {0, frame.scale.y}, e, tree.patch(e).shape});
        if (tree.cut_of(e) == Cut::line) return add_line(e, frame);
        if (tree.cut_of(e) == Cut::fan) return add_fan(e, frame);
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

    std::uint32_t add_fan(ElementId e, const Frame& frame) {
        if (tree.children(e).front().value < number.size()) return FanWalk(tree, e, frame).add_nodes(*this);
        ++leaves_met;
        fans.push_back({frame.origin, {frame.scale.x, 0}, {0, frame.scale.y}, e, tree.patch(e).shape});
        return is_leaf | is_fan | static_cast<std::uint32_t>(fans.size() - 1);
    }

    /// Cuts off the corners at (1, 0) and (0, 1); a third line then separates the corner at (0, 0) from the inverted
    /// middle triangle.
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
        const Cut kind = tree.cut_of(e);
        const double r = kind == Cut::both ? 0.5 : tree.ratio(e);
        const auto halves = [&](Vec2 along, const Frame& whole, ElementId low, ElementId high) {
            const Vec2 across = {along.y, along.x};
            const std::uint32_t node = add_node(whole, along, r);
            set(node, 0, add(low, whole.part({0, 0}, (1 / r) * along + across)));
            set(node, 1, add(high, whole.part(r * along, (1 / (1 - r)) * along + across)));
            return node;
        };
        if (kind == Cut::u) return halves({1, 0}, frame, children[0], children[1]);
        if (kind == Cut::v) return halves({0, 1}, frame, children[0], children[1]);
        const std::uint32_t node = add_node(frame, {0, 1}, r);
        set(node, 0, halves({1, 0}, frame.part({0, 0}, {1, 2}), children[0], children[1]));
        set(node, 1, halves({1, 0}, frame.part({0, 0.5}, {1, 2}), children[2], children[3]));
        return node;
    }
};

std::uint32_t LeafFinder::FanWalk::add_nodes(Builder& builder) const {
    if (!goes_around()) return add_sectors(builder, 0, fan_.border.size() - 1);
    const std::size_t far = far_side();
    const std::uint32_t node = builder.add_node(ray(0));
    builder.set(node, 1, add_sectors(builder, 0, far + 1));
    builder.set(node, 0, add_sectors(builder, far, fan_.border.size() - 1));
    return node;
}

/// Adds the nodes for triangles that together span at most half a turn.
std::uint32_t LeafFinder::FanWalk::add_sectors(Builder& builder, std::size_t begin, std::size_t end) const {
    if (end - begin == 1) return builder.add_leaf(leaf(begin));
    const std::size_t middle = (begin + end) / 2;
    const std::uint32_t node = builder.add_node(ray(middle));
    builder.set(node, 0, add_sectors(builder, begin, middle));
    builder.set(node, 1, add_sectors(builder, middle, end));
    return node;
}

LeafFinder::LeafFinder(const ElementTree& tree) {
    // Above this, triangles of fans are not stored: with dependent data they take 200 bytes each, 25 MB in all.
    constexpr std::size_t max_stored_triangles = std::size_t(1) << 17;
    const bool by_fans = tree.size() - tree.first_of_fans().value > max_stored_triangles;
    const std::size_t stored = by_fans ? tree.first_of_fans().value : tree.size();
    if (by_fans) tree_ = tree;
    Field<ElementId, std::uint32_t> number(stored);
    std::uint32_t count = 0;
    for (ElementId e : number.ids())
        if (tree.is_leaf(e)) number[e] = count++;
    leaves_.resize(count);
    const std::span<const ElementId> roots = tree.roots();
    constexpr std::size_t max_blocks = 256;
    const std::size_t length = roots.size() / max_blocks + 1;
    std::vector<Builder> blocks((roots.size() + length - 1) / length, Builder{tree, number, leaves_});
    parallel_for(blocks.size(), 1, [&](std::size_t b) {
        for (std::size_t i = b * length; i < std::min((b + 1) * length, roots.size()); ++i)
            blocks[b].add_root(roots[i]);
    });
    join(blocks);
}

/// Appends the arrays of all blocks, so that positions count from the first node and fan of all.
void LeafFinder::join(std::vector<Builder>& blocks) {
    struct Size {
        std::size_t nodes = 0, fans = 0, grids = 0, start = 0;
    };
    std::vector<Size> before(1);
    for (const Builder& b : blocks) {
        const Size& last = before.back();
        before.push_back({last.nodes + b.nodes.size(), last.fans + b.fans.size(), last.grids + b.grids.size(),
                          last.start + b.start.size()});
    }
    nodes_.resize(before.back().nodes), fans_.resize(before.back().fans);
    grids_.resize(before.back().grids), start_.resize(before.back().start);
    parallel_for(blocks.size(), 1, [&](std::size_t k) {
        Builder& b = blocks[k];
        const Size& at = before[k];
        const auto moved = [&](std::uint32_t part) {
            if (!(part & is_leaf)) return part + static_cast<std::uint32_t>(at.nodes);
            return part & is_fan ? part + static_cast<std::uint32_t>(at.fans) : part;
        };
        for (Node& node : b.nodes) node.part[0] = moved(node.part[0]), node.part[1] = moved(node.part[1]);
        for (std::uint32_t& part : b.start) part = moved(part);
        for (Grid& grid : b.grids) grid.first += static_cast<std::uint32_t>(at.start);
        const auto append = [](const auto& from, auto& to, std::size_t first) {
            std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(first));
        };
        append(b.nodes, nodes_, at.nodes), append(b.fans, fans_, at.fans);
        append(b.grids, grids_, at.grids), append(b.start, start_, at.start);
        b.nodes = {}, b.fans = {}, b.grids = {}, b.start = {};  // frees memory before all blocks are copied
    });
}

/// Returns the leaf of a part, and its index.
LeafFinder::Leaf LeafFinder::leaf_at(std::uint32_t part, Vec2 uv, std::uint32_t& number) const {
    if (!(part & is_fan)) {
        number = part & ~is_leaf;
        return leaves_[number];
    }
    const Leaf& fan = fans_[part & ~(is_leaf | is_fan)];
    const FanWalk walk(tree_, fan.id, {fan.origin, {fan.du.x, fan.dv.y}});
    const Leaf triangle = walk.leaf(walk.find(uv));
    number = static_cast<std::uint32_t>(leaves_.size() + (triangle.id.value - tree_.first_of_fans().value));
    return triangle;
}

/// Index in `start_` of the cell that contains a point.
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
    std::uint32_t number = 0;
    const Leaf leaf = leaf_at(part, uv, number);
    const Vec2 from = uv - leaf.origin;
    return {number, into_shape({dot(leaf.du, from), dot(leaf.dv, from)}, leaf.shape)};
}

void LeafFinder::find(std::span<Query> queries) const {
    constexpr std::size_t batch_size = 32;
    std::size_t at[batch_size];
    for (std::size_t first = 0; first < queries.size(); first += batch_size) {
        const std::span<Query> batch = queries.subspan(first, std::min(batch_size, queries.size() - first));
        for (std::size_t i = 0; i < batch.size(); ++i) {
            at[i] = cell(batch[i].root, batch[i].uv);
            __builtin_prefetch(&start_[at[i]]);
        }
        for (std::size_t i = 0; i < batch.size(); ++i) {
            batch[i].leaf = start_[at[i]];
            if (!(batch[i].leaf & is_leaf)) __builtin_prefetch(&nodes_[batch[i].leaf]);
        }
        // The unfinished queries, compacted after every step without an unpredictable branch.
        std::array<std::uint32_t, batch_size> open;
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
        for (Query& q : batch) {
            if (q.leaf & is_fan)
                leaf_at(q.leaf, q.uv, q.leaf);
            else
                q.leaf &= ~is_leaf;
        }
    }
}

}  // namespace exitance
