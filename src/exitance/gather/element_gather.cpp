#include "exitance/gather/element_gather.hpp"

#include <algorithm>

#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/form_factors/quad_lanes.hpp"

namespace exitance {
namespace {

using namespace lanes_of;
using four::Real;

Spectrum larger(const Spectrum& a, const Spectrum& b) {
    Spectrum out;
    for (std::size_t k = 0; k < bands; ++k) out[k] = std::max(a[k], b[k]);
    return out;
}

Spectrum magnitude(const Spectrum& a) {
    return larger(a, -1.0 * a);
}

/// The first four corners of a convex domain; with fewer than four the last one is repeated.
std::array<Vec2, 4> four_corners(const std::vector<Vec2>& domain) {
    std::array<Vec2, 4> out;
    for (std::size_t k = 0; k < 4; ++k) out[k] = domain[std::min(k, domain.size() - 1)];
    return out;
}

}  // namespace

bool ElementGather::suits(const Stage& stage) {
    return stage.occluders.has_nothing_inside() && stage.scene.panes().empty() && !stage.scene.has_diffusing_panes();
}

/// Light of an element or of a part of a leaf.
struct ElementGather::Node {
    std::array<Point, 4> corners;
    bool triangle = false;
    Point centre;
    double radius = 0;
    Spectrum mean;
    std::array<Spectrum, 4> lean{};
    Spectrum rest;

    Node() = default;
    /// A parallelogram or triangle with bilinear or linear b, by its values at the corners.
    Node(const std::array<Point, 4>& at, const std::array<Spectrum, 4>& b, bool is_triangle)
        : corners(at), triangle(is_triangle) {
        const std::size_t count = triangle ? 3 : 4;
        for (std::size_t i = 0; i < count; ++i) {
            centre = centre + 1.0 / static_cast<double>(count) * corners[i];
            mean += 1.0 / static_cast<double>(count) * b[i];
        }
        for (std::size_t i = 0; i < 4; ++i) lean[i] = b[i] - mean;
        find_radius();
    }

    void find_radius() {
        for (const Point& corner : corners) radius = std::max(radius, norm(corner - centre));
    }
    Spectrum slope() const {
        Spectrum out;
        for (const Spectrum& l : lean) out = larger(out, magnitude(l));
        return out;
    }
};

void ElementGather::Group::set(std::size_t lane, const Node& node) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t c = 0; c < 4; ++c) corners[c][axis][lane] = node.corners[c][axis];
        centre[axis][lane] = node.centre[axis];
    }
    radius[lane] = node.radius;
    inward[lane] =
        node.triangle
            ? 0.5
            : 0.5773502691896257;  // derived from the Gauss points of triangles (half-way) and squares (1 / sqrt(3))
    last[lane] = node.triangle ? 0.5 : 1;
    const Spectrum node_slope = node.slope();
    for (std::size_t k = 0; k < bands; ++k) {
        mean[k][lane] = node.mean[k], slope[k][lane] = node_slope[k], rest[k][lane] = node.rest[k];
        for (std::size_t c = 0; c < 4; ++c) lean[c][k][lane] = node.lean[c][k];
    }
}

/// Splits a parallelogram or a triangle, on which b is bilinear or linear, into quarters.
ElementGather::Group ElementGather::Group::quarters(std::size_t lane) const {
    struct Corner {
        Point p;
        Spectrum b;
    };
    const auto corner = [&](std::size_t c) {
        Corner out{{corners[c][0][lane], corners[c][1][lane], corners[c][2][lane]}, {}};
        for (std::size_t k = 0; k < bands; ++k) out.b[k] = mean[k][lane] + lean[c][k][lane];
        return out;
    };
    const auto between = [](const Corner& i, const Corner& j) { return Corner{0.5 * (i.p + j.p), 0.5 * (i.b + j.b)}; };
    const bool triangle = last[lane] < 1;
    Group out;
    const auto set = [&](std::size_t to, const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
        out.set(to, Node({a.p, b.p, c.p, d.p}, {a.b, b.b, c.b, d.b}, triangle));
    };
    const Corner a = corner(0), b = corner(1), c = corner(2), d = corner(3), ab = between(a, b), bc = between(b, c);
    if (triangle) {
        const Corner ca = between(c, a);
        set(0, a, ab, ca, ca), set(1, ab, b, bc, bc), set(2, ca, bc, c, c), set(3, ab, bc, ca, ca);
    } else {
        const Corner cd = between(c, d), da = between(d, a), middle = between(ab, cd);
        set(0, a, ab, middle, da), set(1, ab, b, bc, middle), set(2, middle, bc, c, cd), set(3, da, middle, cd, d);
    }
    return out;
}

/// Computes nodes of all elements from the leaves up, then makes groups of them from the roots down.
class ElementGather::Builder {
  public:
    Builder(const Stage& stage, const ElementFunction& b) : b_(b), tree_(b.tree) {
        nodes_.resize(tree_.size()), moments_.resize(tree_.size());
        is_quad_.resize(tree_.size()), is_dark_.resize(tree_.size());
        for (std::size_t i = tree_.size(); i-- > 0;) {
            const ElementId e(i);
            is_quad_[e] = tree_.domain(e).size() <= 4;
            if (tree_.is_leaf(e)) {
                const Normal& n = stage.scene.regions()[tree_.region(e)].plane.n;
                const Point centre = tree_.patch(e).at(tree_.centre(e));
                is_dark_[e] = stage.occluders.is_covered(centre, n, tree_.region(e));
                nodes_[e] = is_dark_[e] ? Node() : leaf_node(e);
                nodes_[e].centre = centre;
                continue;
            }
            is_dark_[e] = true;
            for (ElementId child : tree_.children(e)) is_dark_[e] &= is_dark_[child];
            nodes_[e] = inner_node(e);
        }
    }

    /// Makes all groups, those of root elements first; writes the regions of the roots to `of_region`.
    std::vector<Group> groups(std::vector<std::array<RegionId, lanes>>& of_region) {
        std::vector<Piece> roots;
        for (ElementId root : tree_.roots()) add_element(root, roots);
        of_region.resize((roots.size() + lanes - 1) / lanes);
        for (std::size_t i = 0; i < roots.size(); ++i) of_region[i / lanes][i % lanes] = tree_.region(roots[i].element);
        add_groups(roots);
        return std::move(groups_);
    }

  private:
    /// A convex quadrilateral or triangle: an element, or a part of a leaf.
    struct Piece {
        Node node;
        ElementId element;
        bool is_whole;
    };

    Node part(ElementId leaf, const std::array<Vec2, 4>& uv) const;
    Node leaf_node(ElementId e);
    Node inner_node(ElementId e);
    void set_lean(Node& node, ElementId e) const;
    void add_element(ElementId e, std::vector<Piece>& out) const;
    std::vector<Piece> pieces_below(ElementId e) const;
    std::uint32_t add_groups(const std::vector<Piece>& pieces);

    const ElementFunction& b_;
    const ElementTree& tree_;
    Field<ElementId, Node> nodes_;
    Field<ElementId, std::array<Vec3, bands>> moments_;  ///< 1/A int (b - mean) (y - centre) dA, W/m.
    Field<ElementId, std::uint8_t> is_quad_;             ///< True with at most four corners.
    Field<ElementId, std::uint8_t> is_dark_;             ///< True if all light of the element is omitted.
    std::vector<Group> groups_;
};

ElementGather::Node ElementGather::Builder::part(ElementId leaf, const std::array<Vec2, 4>& uv) const {
    std::array<Point, 4> corners;
    std::array<Spectrum, 4> b;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = tree_.patch(leaf).at(uv[i]), b[i] = b_.at({leaf, uv[i]});
    return {corners, b, uv[2] == uv[3]};
}

ElementGather::Node ElementGather::Builder::leaf_node(ElementId e) {
    const std::vector<Vec2> domain = tree_.domain(e);
    Node out = part(e, four_corners(domain));
    if (tree_.is_cell(e)) {  // cells, which may be any convex polygon, are treated as uniform
        out.mean = b_.at({e, tree_.centre(e)});
        out.lean = {};
        for (const Vec2& uv : domain) out.rest = larger(out.rest, magnitude(b_.at({e, uv}) - out.mean));
    }
    for (std::size_t k = 0; k < bands; ++k)
        for (std::size_t c = 0; c < (out.triangle ? 3 : 4); ++c)
            moments_[e][k] = moments_[e][k] + out.lean[c][k] / 12 * (out.corners[c] - out.centre);
    return out;
}

/// Sets the linear function that has an element's moments. In the element's coordinates the variances of u and v are
/// 1/12 on a parallelogram, and 1/18 with a covariance of -1/36 on a triangle.
void ElementGather::Builder::set_lean(Node& node, ElementId e) const {
    if (tree_.is_cell(e)) return;
    const Patch& patch = tree_.patch(e);
    const Vec2 centre = tree_.centre(e);
    for (std::size_t k = 0; k < bands; ++k) {
        const Vec2 m = patch.coordinates(patch.origin + moments_[e][k]);
        const Vec2 slope = node.triangle ? Vec2{24 * m.x + 12 * m.y, 12 * m.x + 24 * m.y} : 12 * m;
        for (int c = 0; c < 4; ++c)
            node.lean[static_cast<std::size_t>(c)][k] =
                dot(slope, patch.corner_uv(std::min(c, patch.corner_count() - 1)) - centre);
    }
}

ElementGather::Node ElementGather::Builder::inner_node(ElementId e) {
    const Patch& patch = tree_.patch(e);
    const std::array<Vec2, 4> corners = four_corners(tree_.domain(e));
    Node out;
    out.triangle = corners[2] == corners[3];
    out.centre = patch.at(tree_.centre(e));
    for (std::size_t k = 0; k < 4; ++k) out.corners[k] = patch.at(corners[k]);
    out.find_radius();
    double area = 0;
    for (ElementId child : tree_.children(e)) {
        area += tree_.area(child);
        out.mean += tree_.area(child) * nodes_[child].mean;
    }
    out.mean *= 1 / area;
    std::array<Vec3, bands>& moment = moments_[e];
    for (ElementId child : tree_.children(e))
        for (std::size_t k = 0; k < bands; ++k)
            moment[k] = moment[k] + tree_.area(child) / area *
                                        (moments_[child][k] +
                                         (nodes_[child].mean - out.mean)[k] * (nodes_[child].centre - out.centre));
    set_lean(out, e);
    const auto linear_at = [&](const Point& y) {
        // Differences of corner values determine the linear function; opposite corners of a parallelogram give the same
        // slope.
        const Vec2 uv = patch.coordinates(y), c = tree_.centre(e);
        const std::size_t last = out.triangle ? 2 : 3;
        const double u = uv.x - c.x, v = uv.y - c.y;
        return out.mean + u * (out.lean[1] - out.lean[0]) + v * (out.lean[last] - out.lean[0]);
    };
    for (ElementId child : tree_.children(e))
        out.rest =
            larger(out.rest, magnitude(nodes_[child].mean - linear_at(nodes_[child].centre)) + nodes_[child].rest);
    return out;
}

/// Adds an element to be summed. One with more than four corners is replaced by its children, a cell by triangles.
void ElementGather::Builder::add_element(ElementId e, std::vector<Piece>& out) const {
    if (is_dark_[e]) return;
    if (tree_.is_leaf(e) && tree_.is_cell(e)) {
        const std::vector<Vec2> domain = tree_.domain(e);
        for (std::size_t k = 2; k < domain.size(); ++k)
            out.push_back({part(e, {domain[0], domain[k - 1], domain[k], domain[k]}), e, false});
    } else if (is_quad_[e]) {
        out.push_back({nodes_[e], e, true});
    } else {
        for (ElementId child : tree_.children(e)) add_element(child, out);
    }
}

/// Pieces of an element. While there are fewer than four, the largest piece with few enough children is replaced by
/// them.
std::vector<ElementGather::Builder::Piece> ElementGather::Builder::pieces_below(ElementId e) const {
    std::vector<Piece> out;
    for (ElementId child : tree_.children(e)) add_element(child, out);
    std::vector<Piece> open = out;
    const auto smaller = [](const Piece& a, const Piece& b) { return a.node.radius < b.node.radius; };
    while (out.size() < lanes) {
        std::erase_if(open, [&](const Piece& p) { return !p.is_whole || tree_.is_leaf(p.element); });
        if (open.empty()) break;
        const auto largest = std::max_element(open.begin(), open.end(), smaller);
        const ElementId cut = largest->element;
        open.erase(largest);
        std::vector<Piece> below;
        for (ElementId child : tree_.children(cut)) add_element(child, below);
        if (out.size() - 1 + below.size() > lanes) continue;
        std::erase_if(out, [&](const Piece& p) { return p.element == cut; });
        out.insert(out.end(), below.begin(), below.end());
        open.insert(open.end(), below.begin(), below.end());
    }
    return out;
}

/// Makes groups of four from `pieces`, and all groups below them. Returns the index of the first group.
std::uint32_t ElementGather::Builder::add_groups(const std::vector<Piece>& pieces) {
    const std::size_t first = groups_.size(), count = (pieces.size() + lanes - 1) / lanes;
    groups_.resize(first + count);
    for (std::size_t g = 0; g < count; ++g) {
        groups_[first + g].more = g + 1 < count;
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const std::size_t i = lanes * g + lane;
            if (i < pieces.size()) {
                groups_[first + g].set(lane, pieces[i].node);
                if (!pieces[i].is_whole || tree_.is_leaf(pieces[i].element)) continue;
                const std::uint32_t below = add_groups(pieces_below(pieces[i].element));
                groups_[first + g].below[lane] = below;
            } else {
                Node spare = pieces.back().node;
                spare.mean = spare.rest = {}, spare.lean = {};
                groups_[first + g].set(lane, spare);
            }
        }
    }
    return static_cast<std::uint32_t>(first);
}

ElementGather::ElementGather(const Stage& stage, const ElementFunction& b) {
    groups_ = Builder(stage, b).groups(of_region_);
}

}  // namespace exitance
