#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/copy_on_write.hpp"
#include "exitance/base/ids.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

using ElementId = Id<struct ElementTag>;  ///< A node of an ElementTree.

/// The affine image of a reference shape: p(u, v) = origin + u a + v b, with (u, v) in the unit square for a
/// parallelogram and in {u, v >= 0, u + v <= 1} for a triangle. Its front is where a x b points. Metres.
struct Patch {
    enum class Shape : std::uint8_t { parallelogram, triangle };

    Point origin;
    Vec3 a, b;
    Shape shape = Shape::parallelogram;

    bool is_triangle() const { return shape == Shape::triangle; }
    Point at(double u, double v) const { return origin + u * a + v * b; }
    Point at(Vec2 uv) const { return at(uv.x, uv.y); }
    double area() const { return norm(cross(a, b)) * (is_triangle() ? 0.5 : 1.0); }  ///< m^2
    Normal normal() const { return normalized(cross(a, b)); }
    Point centre() const { return is_triangle() ? at(1.0 / 3, 1.0 / 3) : at(0.5, 0.5); }

    int corner_count() const { return is_triangle() ? 3 : 4; }
    /// Corner i, counter-clockwise: (0,0), (1,0), then (1,1), (0,1) or for a triangle (0,1).
    Point corner(int i) const { return at(corner_uv(i)); }
    Vec2 corner_uv(int i) const;

    /// The coordinates (u, v) of the foot of p in the patch's plane.
    Vec2 coordinates(const Point& p) const;
};

/// How an element is cut: across its u direction, across v, or both; a triangle has one way, `both`: four, at its
/// edges' midpoints. `line`: along any straight line, into cells. `fan`: into triangles around a place.
enum class Cut : std::uint8_t { none, u, v, both, line, fan };

/// A straight line in an element's own coordinates: its first side is normal . uv <= offset.
struct CutLine {
    Vec2 normal;
    double offset = 0;

    double distance(Vec2 uv) const { return dot(normal, uv) - offset; }
};

/// Triangles around a place of an element: (apex, border[i], border[i + 1]), counter-clockwise, in its coordinates.
struct Fan {
    Vec2 apex;
    std::vector<Vec2> border;
};
/// A fan as a tree holds it.
struct FanView {
    Vec2 apex;
    std::span<const Vec2> border;
};

/// Coordinates that rounding left at most a little outside the reference shape, moved onto it.
Vec2 into_shape(Vec2 uv, Patch::Shape shape);

/// A place of a reference shape with uniform density, from two numbers in [0, 1).
Vec2 uniform_in_shape(Patch::Shape shape, double s, double t);

/// The pieces of a patch, in a fixed order; `ratio` in (0, 1) is where a cut across one direction stands.
std::vector<Patch> cut(const Patch& patch, Cut way, double ratio = 0.5);

/// Elements from whole pieces of a region (roots) to leaves, in one growing pool. Children lie side by side and after
/// their parent. Hence one forward sweep pushes light down, one backward sweep pulls it up, and neither recurses.
/// Ids survive growth; spans and references do not. Copies share their memory until one of them is cut; cutting leaves
/// into fans takes no more of it than what the fans are.
///
/// Where other polygons touch an element (a box on a floor), light jumps along a straight line that follows none of its
/// directions. There an element is cut along that line into cells: convex parts of a parallelogram, their frame. A
/// cell's patch is its frame, its domain what it really covers.
class ElementTree {
  public:
    ElementId add_root(RegionId region, const Patch& shape);
    /// Cuts a leaf; returns the first child.
    ElementId split(ElementId leaf, Cut way, double ratio = 0.5);
    /// Cuts a leaf along a line into two cells, the first side first; returns the first child. None, and nothing is
    /// done, when less than `least` of the leaf's area would lie on one side.
    ElementId split_by_line(ElementId leaf, CutLine line, double least = 1e-6);

    /// Cuts a leaf into the triangles of a fan, which are to cover it; returns the first child. None, and nothing is
    /// done, when one of them has no area.
    ElementId split_fan(ElementId leaf, const Fan& fan);

    std::size_t size() const { return stored() + cuts_->fan_of.size(); }
    IdRange<ElementId> ids() const { return {0, size()}; }  ///< Parents before children.
    const std::vector<ElementId>& roots() const { return content_->roots; }
    IdRange<ElementId> children(ElementId e) const { return node(e).children; }  ///< Empty for a leaf.
    bool is_leaf(ElementId e) const { return node(e).children.empty(); }
    Cut way(ElementId e) const { return node(e).way; }         ///< How an element was cut; none for a leaf.
    double ratio(ElementId e) const { return node(e).ratio; }  ///< Where; meaningful for cuts across one direction.
    ElementId parent(ElementId e) const {
        return is_stored(e) ? content_->parent[e] : fanned(e);
    }  ///< None for a root.
    RegionId region(ElementId e) const { return content_->region[is_stored(e) ? e : fanned(e)]; }
    Patch patch(ElementId e) const { return is_stored(e) ? content_->patch[e] : fan_triangle(e); }
    double area(ElementId e) const {
        return is_stored(e) ? content_->area[e] : fan_triangle(e).area();
    }  ///< Of its domain, m^2.
    const CutLine& line(ElementId e) const {
        return content_->lines[node(e).line].line;
    }  ///< Of an element cut along a line.
    /// Of an element cut into a fan.
    FanView fan(ElementId e) const {
        const std::uint32_t i = node(e).line, first = cuts_->fans[i].first_place;
        const std::size_t end = i + 1 < cuts_->fans.size() ? cuts_->fans[i + 1].first_place : cuts_->places.size();
        return {cuts_->places[first], std::span(cuts_->places).subspan(first + 1, end - first - 1)};
    }
    /// Elements from this one on are the triangles of fans, which are leaves: those that were cut last.
    ElementId first_of_fans() const { return ElementId(stored()); }
    /// Of an element cut along a line: the frame of its cell on a side, origin and size in the element's coordinates.
    std::array<Vec2, 2> cell_frame(ElementId e, std::size_t side) const {
        const LineCut& cut = content_->lines[node(e).line];
        return {cut.origin[side], cut.size[side]};
    }
    bool is_cell(ElementId e) const {
        return is_stored(e) && content_->cell[e] != none;
    }  ///< Is its domain less than its patch?
    /// What the element covers, as a convex polygon in its own coordinates, counter-clockwise.
    std::vector<Vec2> domain(ElementId e) const;
    /// The same in space, metres.
    std::vector<Point> outline(ElementId e) const;
    /// Mean place of the domain.
    Vec2 centre(ElementId e) const;
    /// How much of the way from the centre to a place lies within the domain; at most 1.
    double reach(ElementId e, Vec2 uv) const;
    /// A place of the domain with uniform density, from two numbers in [0, 1).
    Vec2 uniform(ElementId e, double s, double t) const;
    std::vector<ElementId> leaves() const;  ///< In order of their ids.

    /// The leaf below `e` that holds the point (u, v) of `e`, and the point's coordinates there, pushed into the leaf.
    /// O(depth).
    struct Place {
        ElementId element;
        Vec2 uv;
    };
    Place leaf_at(ElementId e, Vec2 uv) const;

    std::size_t memory_bytes() const;
    /// Calls visit(span) for the plain arrays that most of it stands in.
    template <class Visit>
    void visit_arrays(const Visit& visit) const {
        const Content& c = *content_;
        visit(c.patch.span()), visit(c.parent.span()), visit(c.region.span()), visit(c.area.span());
        visit(c.cell.span()), visit(std::span(c.lines)), visit(std::span(c.corners)), visit(cuts_->nodes.span());
        visit(std::span(cuts_->fan_of)), visit(std::span(cuts_->fans)), visit(std::span(cuts_->places));
    }
    /// Makes room for so many elements but for the triangles of fans, so that growing to them copies nothing.
    void reserve(std::size_t elements);
    /// The same for fans, with so many triangles.
    void reserve_fans(std::size_t fans, std::size_t triangles);
    /// Gives back memory kept for growth.
    void shrink_to_fit();

  private:
    static constexpr std::uint32_t none = 0xffffffffu;
    /// What finding a leaf reads of an element, side by side.
    struct Node {
        IdRange<ElementId> children;
        double ratio = 0.5;
        std::uint32_t line = none;  ///< Of an element cut along a line or into a fan: where that stands among those.
        Cut way = Cut::none;
        Patch::Shape shape = Patch::Shape::parallelogram;
    };
    /// A cut along a line, and the frames of the two cells in the coordinates of the element that was cut.
    struct LineCut {
        CutLine line;
        std::array<Vec2, 2> origin, size;
    };
    /// What elements are.
    struct Content {
        void add(RegionId region, ElementId parent, const Patch& shape, double area);

        Field<ElementId, Patch> patch;
        Field<ElementId, ElementId> parent;
        Field<ElementId, RegionId> region;
        Field<ElementId, double> area;
        Field<ElementId, std::uint32_t>
            cell;  ///< Of a cell: its domain is [first_corner[cell], first_corner[cell + 1])
        std::vector<std::uint32_t> first_corner = {0};
        std::vector<Vec2> corners;  ///< of these.
        std::vector<LineCut> lines;
        std::vector<ElementId> roots;
    };
    struct FanCut {
        ElementId element;
        std::uint32_t first_place;
    };
    /// How they are cut. The triangles of fans follow from these. Where they are many, as in functions that are joined
    /// to continuous ones, each takes some 20 bytes in place of more than 100: as long as no others are added, those at
    /// the end are not stored.
    struct Cuts {
        Field<ElementId, Node> nodes;       ///< Of what is stored.
        std::vector<FanCut> fans;           ///< In the order in which they were cut.
        std::vector<Vec2> places;           ///< Of each, its apex, then its border.
        std::vector<std::uint32_t> fan_of;  ///< The fan of each triangle that is not stored.
    };

    std::size_t stored() const { return content_->patch.size(); }
    bool is_stored(ElementId e) const { return e.value < stored(); }
    const Node& node(ElementId e) const {
        static constexpr Node triangle{.children = {}, .shape = Patch::Shape::triangle};
        return is_stored(e) ? cuts_->nodes[e] : triangle;
    }
    /// The parent of a triangle that is not stored.
    ElementId fanned(ElementId e) const { return cuts_->fans[cuts_->fan_of[e.value - stored()]].element; }
    Patch fan_triangle(ElementId e) const;
    /// Stores all triangles, so that other elements can follow them.
    void store_triangles();
    void add(RegionId region, ElementId parent, const Patch& shape, double area);
    Place in_fan(ElementId e, Vec2 uv) const;
    std::span<const Vec2> cell_domain(ElementId e) const {
        const std::uint32_t* const first = &content_->first_corner[content_->cell[e]];
        return std::span(content_->corners).subspan(first[0], first[1] - first[0]);
    }

    CopyOnWrite<Content> content_;  ///< Many functions stand on one tree,
    CopyOnWrite<Cuts> cuts_;        ///< and on some that differ by their fans alone.
};

}  // namespace exitance
