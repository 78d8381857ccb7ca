#include "exitance/mesh/conforming.hpp"

#include <algorithm>
#include <numeric>

#include "exitance/base/bvh.hpp"
#include "exitance/base/disjoint_sets.hpp"
#include "exitance/base/shared_results.hpp"
#include "exitance/mesh/found_leaves.hpp"
#include "exitance/mesh/on_jump.hpp"
#include "exitance/mesh/planes.hpp"
#include "exitance/scene/joining/weld.hpp"

namespace exitance {
namespace {

/// A leaf as a polygon, including the corners of other leaves on its sides.
struct Polygon {
    ElementId leaf;
    std::vector<std::uint32_t> vertex;  ///< Indices of welded points.
    std::vector<Vec2> uv;               ///< Vertices, in the leaf's coordinates.
    std::vector<bool> is_own;           ///< Per vertex: false if it is a corner of another leaf.
    std::uint32_t first_slot = 0;       ///< Index of its first vertex among the vertices of all polygons.
};

/// A side of a polygon, starting at its vertex `slot`.
struct Side {
    std::uint32_t from, to;  ///< Vertices.
    std::uint32_t polygon, slot;
};

/// Finds the splits and the shared nodes of the leaves of one plane.
class PlaneNodes {
  public:
    PlaneNodes(const ElementTree& tree, std::span<const ElementId> leaves, std::span<const ContactLines::Line> jumps)
        : tree_(tree) {
        find_vertices(leaves, jumps);
        insert_hanging_vertices();
        join_corners(jumps);
        choose_fans();
    }

    struct Leaf {
        ElementId leaf;
        Fan fan;  ///< Fan of triangles; with an empty border the leaf stays whole.
        /// Node numbers within the plane: of the apex, then of the border; or of the leaf's corners.
        std::vector<std::uint32_t> node;
    };
    std::vector<Leaf> leaves;
    std::uint32_t node_count = 0;

  private:
    void find_vertices(std::span<const ElementId> leaves, std::span<const ContactLines::Line> jumps);
    void insert_hanging_vertices();
    void join_corners(std::span<const ContactLines::Line> jumps);
    void choose_fans();
    std::vector<Side> sorted_sides() const;
    std::vector<Side> unmatched_sides() const;
    struct Hanging;
    std::vector<Side> inner_sides(std::span<const Side> open, std::span<const Hanging> found) const;
    void find_hanging(std::span<const Side> sides, std::vector<std::uint32_t> ends, std::vector<Hanging>& out) const;
    Leaf with_own_nodes(const Polygon& polygon);
    Leaf as_fan(const Polygon& polygon, const std::vector<std::uint32_t>& node_of_slot);

    const ElementTree& tree_;
    std::vector<Point> places_;
    double tolerance_ = 0;  ///< Metres: points nearer to each other coincide.
    std::vector<std::uint32_t> on_jumps_;
    std::vector<Polygon> polygons_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> joined_;  ///< Pairs of slots that share a node.
    std::uint32_t slot_count_ = 0;
};

void PlaneNodes::find_vertices(std::span<const ElementId> leaves, std::span<const ContactLines::Line> jumps) {
    Box box;
    for (ElementId leaf : leaves) {
        Polygon& polygon = polygons_.emplace_back(Polygon{leaf, {}, tree_.domain(leaf), {}});
        for (const Vec2& uv : polygon.uv) {
            polygon.vertex.push_back(static_cast<std::uint32_t>(places_.size()));
            places_.push_back(tree_.patch(leaf).at(uv));
            box.add(places_.back());
        }
    }
    // Share of the surface's size and of its distance from the origin; derived from double precision, with a margin for
    // cut points.
    constexpr double rounding = 1e-9;
    tolerance_ = rounding * (norm(box.hi - box.lo) + std::max(norm(box.hi - Point{}), norm(box.lo - Point{})));
    // At the ends of a line, the corners of both sides share a node. So that a function can be discontinuous across the
    // line, it gets a vertex in its middle, too.
    const Patch& patch = tree_.patch(leaves.front());
    for (const ContactLines::Line& line : jumps)
        for (const Point& place : {line.a, line.b, 0.5 * (line.a + line.b)}) {
            on_jumps_.push_back(static_cast<std::uint32_t>(places_.size()));
            places_.push_back(patch.at(patch.coordinates(place)));
        }
    const std::vector<std::uint32_t> welded = weld(places_, tolerance_);
    for (std::uint32_t& v : on_jumps_) v = welded[v];
    for (Polygon& polygon : polygons_) {
        for (std::uint32_t& v : polygon.vertex) v = welded[v];
        for (std::size_t i = polygon.vertex.size(); i-- > 0 && polygon.vertex.size() > 1;)
            if (polygon.vertex[i] == polygon.vertex[(i + 1) % polygon.vertex.size()]) {
                polygon.vertex.erase(polygon.vertex.begin() + static_cast<std::ptrdiff_t>(i));
                polygon.uv.erase(polygon.uv.begin() + static_cast<std::ptrdiff_t>(i));
            }
        polygon.is_own.assign(polygon.vertex.size(), true);
    }
}

/// All sides of all polygons, sorted so that sides between the same vertices are adjacent.
std::vector<Side> PlaneNodes::sorted_sides() const {
    std::vector<Side> sides;
    for (std::uint32_t p = 0; p < polygons_.size(); ++p) {
        const std::vector<std::uint32_t>& v = polygons_[p].vertex;
        for (std::uint32_t i = 0; i < v.size(); ++i) sides.push_back({v[i], v[(i + 1) % v.size()], p, i});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        const auto key = [](const Side& s) {
            return std::tuple(std::min(s.from, s.to), std::max(s.from, s.to), s.polygon, s.slot);
        };
        return key(a) < key(b);
    });
    return sides;
}

bool are_opposite(const Side& a, const Side& b) {
    return a.from == b.to && a.to == b.from;
}

std::vector<Side> PlaneNodes::unmatched_sides() const {
    const std::vector<Side> sides = sorted_sides();
    std::vector<Side> out;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (i + 1 < sides.size() && are_opposite(sides[i], sides[i + 1]))
            ++i;
        else
            out.push_back(sides[i]);
    }
    return out;
}

struct PlaneNodes::Hanging {
    std::uint32_t polygon, slot, vertex;
    double at;  ///< Position along the side, in (0, 1).
};

/// Finds those of the given vertices that are inside a side.
void PlaneNodes::find_hanging(std::span<const Side> sides, std::vector<std::uint32_t> ends,
                              std::vector<Hanging>& out) const {
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    if (ends.empty()) return;
    std::vector<Box> boxes(ends.size());
    for (std::size_t i = 0; i < ends.size(); ++i) boxes[i].add(places_[ends[i]]);
    const Bvh tree(boxes);
    const Vec3 around{tolerance_, tolerance_, tolerance_};
    for (const Side& side : sides) {
        const Point a = places_[side.from], b = places_[side.to];
        const double length = norm(b - a);
        Box box;
        box.add(a), box.add(b);
        box.lo -= around, box.hi += around;
        tree.visit_box(box, [&](std::uint32_t i) {
            if (ends[i] == side.from || ends[i] == side.to) return;
            const Vec3 w = places_[ends[i]] - a;
            const double at = dot(w, b - a) / (length * length);
            if (at <= 0 || at >= 1 || norm(w - at * (b - a)) > tolerance_) return;
            out.push_back({side.polygon, side.slot, ends[i], at});
        });
    }
}

/// Returns all sides except those on the border of the surface, which have no light beyond them and thus no
/// discontinuity. A border side matches no other side, has no hanging vertices, and its ends do not hang on other
/// sides. Border sides are left out because the back of a sheet would otherwise contribute an edge along each of them.
std::vector<Side> PlaneNodes::inner_sides(std::span<const Side> open, std::span<const Hanging> found) const {
    std::vector<std::uint32_t> hanging;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> stood_on, border;
    for (const Hanging& h : found) hanging.push_back(h.vertex), stood_on.emplace_back(h.polygon, h.slot);
    std::sort(hanging.begin(), hanging.end()), std::sort(stood_on.begin(), stood_on.end());
    const auto hangs = [&](std::uint32_t v) { return std::binary_search(hanging.begin(), hanging.end(), v); };
    for (const Side& side : open)
        if (!hangs(side.from) && !hangs(side.to) &&
            !std::binary_search(stood_on.begin(), stood_on.end(), std::pair(side.polygon, side.slot)))
            border.emplace_back(side.polygon, side.slot);
    std::sort(border.begin(), border.end());
    std::vector<Side> out = sorted_sides();
    std::erase_if(out, [&](const Side& side) {
        return std::binary_search(border.begin(), border.end(), std::pair(side.polygon, side.slot));
    });
    return out;
}

/// Inserts hanging vertices: corners of other leaves (ends of sides that match no other), and ends and middles of lines
/// of discontinuity.
void PlaneNodes::insert_hanging_vertices() {
    const std::vector<Side> open = unmatched_sides();
    std::vector<std::uint32_t> ends;
    for (const Side& side : open) ends.insert(ends.end(), {side.from, side.to});
    std::vector<Hanging> found;
    find_hanging(open, std::move(ends), found);
    find_hanging(inner_sides(open, found), on_jumps_, found);
    // In descending order, so that an insertion does not shift the vertices inserted later.
    std::sort(found.begin(), found.end(), [](const Hanging& a, const Hanging& b) {
        return std::tuple(a.polygon, a.slot, a.at, a.vertex) > std::tuple(b.polygon, b.slot, b.at, b.vertex);
    });
    found.erase(std::unique(found.begin(), found.end(),
                            [](const Hanging& a, const Hanging& b) {
                                return a.polygon == b.polygon && a.slot == b.slot && a.vertex == b.vertex;
                            }),
                found.end());
    for (const Hanging& h : found) {
        Polygon& p = polygons_[h.polygon];
        const auto after = static_cast<std::ptrdiff_t>(h.slot) + 1;
        p.vertex.insert(p.vertex.begin() + after, h.vertex);
        // Welded points may be off by the tolerance, which is large relative to a thin leaf.
        const Patch& patch = tree_.patch(p.leaf);
        p.uv.insert(p.uv.begin() + after, into_shape(patch.coordinates(places_[h.vertex]), patch.shape));
        p.is_own.insert(p.is_own.begin() + after, false);
    }
}

void PlaneNodes::join_corners(std::span<const ContactLines::Line> jumps) {
    for (Polygon& p : polygons_) p.first_slot = slot_count_, slot_count_ += static_cast<std::uint32_t>(p.vertex.size());
    if (polygons_.empty()) return;
    // Derived from ContactLines, whose tolerance is 1e-7 of the scene's size: cut points are that accurate.
    constexpr double jump_tolerance_factor = 1e3;
    const Patch& patch = tree_.patch(polygons_[0].leaf);
    const OnJump jumps_at(jumps, patch.normal(), patch.origin, jump_tolerance_factor * tolerance_);
    const std::vector<Side> sides = sorted_sides();
    for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
        const Side &a = sides[i], &b = sides[i + 1];
        if (!are_opposite(a, b)) continue;
        ++i;
        const double area = std::min(tree_.area(polygons_[a.polygon].leaf), tree_.area(polygons_[b.polygon].leaf));
        if (jumps_at(places_[a.from], places_[a.to], area)) continue;
        const auto slot = [&](const Side& s, std::uint32_t further) {
            const Polygon& p = polygons_[s.polygon];
            return p.first_slot + (s.slot + further) % static_cast<std::uint32_t>(p.vertex.size());
        };
        joined_.emplace_back(slot(a, 0), slot(b, 1));
        joined_.emplace_back(slot(a, 1), slot(b, 0));
    }
}

PlaneNodes::Leaf PlaneNodes::with_own_nodes(const Polygon& polygon) {
    Leaf out{polygon.leaf, {}, {}};
    for (int i = 0; i < tree_.patch(polygon.leaf).corner_count(); ++i) out.node.push_back(node_count++);
    return out;
}

/// Returns whether every triangle has an area above 1e-6 of the element's frame.
bool has_area(const Fan& fan) {
    // Chosen: half of it and twice it give the same mesh, measured by `exitance solve furniture.obj --error 0.02`.
    constexpr double min_area = 1e-6;
    for (std::size_t i = 1; i < fan.border.size(); ++i)
        if (cross(fan.border[i - 1] - fan.apex, fan.border[i] - fan.apex) < min_area) return false;
    return true;
}

/// Makes a fan. The apex is the only hanging vertex if there is exactly one, the first corner of a cell without any,
/// and otherwise the centroid.
PlaneNodes::Leaf PlaneNodes::as_fan(const Polygon& polygon, const std::vector<std::uint32_t>& node_of_slot) {
    const std::size_t n = polygon.vertex.size();
    const auto hanging = static_cast<std::size_t>(std::count(polygon.is_own.begin(), polygon.is_own.end(), false));
    const auto node = [&](std::size_t i) { return node_of_slot[polygon.first_slot + i % n]; };
    Leaf out{polygon.leaf, {}, {}};
    if (hanging <= 1) {
        const auto stands = static_cast<std::size_t>(std::find(polygon.is_own.begin(), polygon.is_own.end(), false) -
                                                     polygon.is_own.begin()) %
                            n;
        out.fan.apex = polygon.uv[stands];
        out.node.push_back(node(stands));
        for (std::size_t i = stands + 1; i < stands + n; ++i)
            out.fan.border.push_back(polygon.uv[i % n]), out.node.push_back(node(i));
        if (has_area(out.fan)) return out;
        out = {polygon.leaf, {}, {}};
    }
    out.fan.apex = tree_.centre(polygon.leaf);
    out.node.push_back(node_count++);
    for (std::size_t i = 0; i <= n; ++i) out.fan.border.push_back(polygon.uv[i % n]), out.node.push_back(node(i));
    return out;
}

void PlaneNodes::choose_fans() {
    DisjointSets sets(slot_count_);
    for (const auto& [a, b] : joined_) sets.unite(a, b);
    constexpr std::uint32_t unset = 0xffffffffu;
    std::vector<std::uint32_t> node_of_slot(slot_count_, unset);
    for (std::uint32_t slot = 0; slot < slot_count_; ++slot) {
        std::uint32_t& node = node_of_slot[sets.root(slot)];
        if (node == unset) node = node_count++;
        node_of_slot[slot] = node;
    }
    for (const Polygon& polygon : polygons_) {
        const std::size_t n = polygon.vertex.size();
        if (n < 3) {
            leaves.push_back(with_own_nodes(polygon));
        } else if (!tree_.is_cell(polygon.leaf) &&
                   n == static_cast<std::size_t>(tree_.patch(polygon.leaf).corner_count())) {
            const auto first = node_of_slot.begin() + polygon.first_slot;
            leaves.push_back({polygon.leaf, {}, {first, first + static_cast<std::ptrdiff_t>(n)}});
        } else {
            leaves.push_back(as_fan(polygon, node_of_slot));
        }
    }
}

/// A leaf that no other leaf of its plane can share nodes with.
FoundLeaves alone(const ElementTree& tree, ElementId leaf) {
    FoundLeaves out;
    std::vector<std::uint32_t> node(static_cast<std::size_t>(tree.patch(leaf).corner_count()));
    std::iota(node.begin(), node.end(), 0u);
    out.node_count = static_cast<std::uint32_t>(node.size());
    out.add(leaf, {}, node);
    return out;
}

/// Reserves memory for fans and nodes: `share` times the numbers in `found`.
void reserve(const std::vector<FoundLeaves>& found, double share, ElementTree& tree, SharedNodes& nodes) {
    FoundLeaves::Counts counts;
    for (const FoundLeaves& f : found) f.count(counts);
    const auto shared = [&](std::size_t count) { return static_cast<std::size_t>(share * static_cast<double>(count)); };
    tree.reserve_fans(shared(counts.fans), shared(counts.triangles));
    nodes.first_corner.reserve(tree.size() + shared(counts.triangles)), nodes.node_of.reserve(shared(counts.corners));
}

/// Splits the leaves of one plane into their fans and assigns nodes, numbered after those of the previous planes.
void add_plane(const FoundLeaves& f, ElementTree& tree, SharedNodes& out) {
    const std::uint32_t first = out.first_node.back();
    std::uint32_t more = 0;  // number of nodes of slivers that could not be split
    const auto add_leaf = [&](ElementId e, std::initializer_list<std::uint32_t> nodes) {
        out.first_corner.resize(tree.size());
        out.first_corner[e] = static_cast<std::uint32_t>(out.node_of.size());
        out.node_of.insert(out.node_of.end(), nodes);
    };
    const std::uint32_t* n = f.node.data();
    const Vec2* place = f.place.data();
    for (std::size_t k = 0; k < f.leaf.size(); n += f.nodes[k], place += f.places[k], ++k) {
        const ElementId leaf = f.leaf[k],
                        child = f.places[k] > 0 ? tree.split_fan(leaf, {place[0], {place + 1, place + f.places[k]}})
                                                : ElementId();
        if (!child.is_none()) {
            for (std::uint32_t i = 0; i + 2 < f.places[k]; ++i)
                add_leaf(ElementId(child.value + i), {first + n[0], first + n[i + 1], first + n[i + 2]});
            continue;
        }
        const auto corner = [&](std::size_t i) { return first + (f.places[k] == 0 ? n[i] : f.node_count + more++); };
        if (tree.patch(leaf).is_triangle())
            add_leaf(leaf, {corner(0), corner(1), corner(2)});
        else
            add_leaf(leaf, {corner(0), corner(1), corner(2), corner(3)});
    }
    out.first_node.push_back(first + f.node_count + more);
}

}  // namespace

SharedNodes make_conforming(ElementTree& tree, const Field<RegionId, std::uint32_t>& plane,
                            const ContactLines& contacts, const StopRequest* stop) {
    const std::vector<std::vector<ElementId>> leaves = leaves_of_planes(tree, plane);
    const std::size_t planes = leaves.size();
    std::vector<std::vector<RegionId>> regions(planes);
    for (RegionId r : plane.ids()) regions[plane[r]].push_back(r);
    const auto find = [&](std::size_t p) {
        if (leaves[p].empty() || (stop && stop->requested())) return FoundLeaves();
        if (leaves[p].size() == 1 && !tree.is_cell(leaves[p][0])) return alone(tree, leaves[p][0]);
        double largest = 0;
        for (ElementId e : leaves[p]) largest = std::max(largest, tree.area(e));
        const PlaneNodes nodes(tree, leaves[p], contacts.over_plane(regions[p], ContactLines::height_of_jump(largest)));
        FoundLeaves out;
        out.node_count = nodes.node_count;
        for (const PlaneNodes::Leaf& l : nodes.leaves) out.add(l.leaf, l.fan, l.node);
        return out;
    };
    std::size_t left = 0;
    for (const std::vector<ElementId>& of_plane : leaves) left += of_plane.size();
    // Processes the planes in groups, because the intermediate result needs more memory than the final one.
    constexpr std::size_t group_size = std::size_t(1) << 17;  // leaves per group
    SharedNodes out;
    out.first_node.push_back(0);
    for (std::size_t first = 0, end = 0; first < planes; first = end) {
        std::size_t count = 0;
        for (; end < planes && count < group_size; ++end) count += leaves[end].size();
        std::vector<FoundLeaves> found(end - first);
        // Planes differ greatly: a floor may have as many leaves as all objects on it together.
        std::vector<double> work;
        for (std::size_t p = first; p < end; ++p) work.push_back(static_cast<double>(leaves[p].size()));
        find_together(
            found, 1, [&](std::size_t k) { return find(first + k); },
            [](auto& archive, FoundLeaves& f) { archive(f.node_count, f.leaf, f.places, f.nodes, f.place, f.node); },
            "nodes", work);
        for (std::size_t k = 0; k < found.size(); ++k)
            if (!leaves[first + k].empty() && found[k].leaf.empty()) return {};
        if (first == 0 && count > 0) {
            // Later planes may need more splits. Derived from memory: what is reserved and not used costs nothing.
            constexpr double margin = 1.1;
            reserve(found, left > count ? margin * static_cast<double>(left) / static_cast<double>(count) : 1, tree,
                    out);
        }
        for (const FoundLeaves& f : found) add_plane(f, tree, out);
    }
    out.first_corner.resize(tree.size());
    return out;
}

}  // namespace exitance
