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

/// Affine image of a reference shape: p(u, v) = origin + u a + v b, with (u, v) in the unit square for a parallelogram
/// and in {u, v >= 0, u + v <= 1} for a triangle. The front is where a x b points. Metres.
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
    /// Corner i, counter-clockwise: (0,0), (1,0), then (1,1), (0,1) for a parallelogram or (0,1) for a triangle.
    Point corner(int i) const { return at(corner_uv(i)); }
    Vec2 corner_uv(int i) const;

    /// The coordinates (u, v) of the projection of p onto the patch's plane.
    Vec2 coordinates(const Point& p) const;
};

/// How an element is split. `u`, `v`: across that direction. `both`: into four (the only way for triangles: at the
/// middles of their edges). `line`: along any straight line, into two cells. `fan`: into triangles around a point.
enum class Cut : std::uint8_t { none, u, v, both, line, fan };

/// A straight line in an element's coordinates. Its first side is normal . uv <= offset.
struct CutLine {
    Vec2 normal;
    double offset = 0;

    double distance(Vec2 uv) const { return dot(normal, uv) - offset; }
};

/// Triangles around a point of an element: (apex, border[i], border[i + 1]), counter-clockwise, in its coordinates.
struct Fan {
    Vec2 apex;
    std::vector<Vec2> border;
};
/// A view of a fan stored in a tree.
struct FanView {
    Vec2 apex;
    std::span<const Vec2> border;
};

/// Moves coordinates that are slightly outside the reference shape, because of rounding, onto it.
Vec2 into_shape(Vec2 uv, Patch::Shape shape);

/// Maps two numbers in [0, 1) to a point of the reference shape, with uniform density.
Vec2 uniform_in_shape(Patch::Shape shape, double s, double t);

/// The parts of a patch after a split, in a fixed order. `ratio`: position of a cut across one direction, in (0, 1).
std::vector<Patch> cut(const Patch& patch, Cut kind, double ratio = 0.5);

/// Elements from whole pieces of a region (roots) to leaves, in one growing pool. Children are consecutive and come
/// after their parent. Hence one forward sweep pushes light down and one backward sweep pulls it up, both without
/// recursion. Ids stay valid when the tree grows; spans and references do not. Copies share memory until one of them is
/// split (copy on write); splitting leaves into fans then copies only the data of the cuts.
///
/// Where other polygons touch an element (e.g. a box on a floor), light is discontinuous across a line that is not
/// parallel to the element's directions. The element is then split along that line into cells: convex parts of a
/// parallelogram, their frame. The patch of a cell is its frame; its domain is the part that it really covers.
class ElementTree {
  public:
    ElementId add_root(RegionId region, const Patch& shape);
    /// Splits a leaf; returns the first child.
    ElementId split(ElementId leaf, Cut kind, double ratio = 0.5);
    /// Splits a leaf along a line into two cells, the first side first. Returns the first child; returns none, and does
    /// nothing, if one side has less than `least` of the leaf's area.
    ElementId split_by_line(ElementId leaf, CutLine line, double least = 0);

    /// Splits a leaf into the triangles of a fan, which must cover it. Returns the first child; returns none, and does
    /// nothing, if a triangle has no area.
    ElementId split_fan(ElementId leaf, const Fan& fan);

    std::size_t size() const { return stored() + cuts_->fan_of.size(); }
    IdRange<ElementId> ids() const { return {0, size()}; }  ///< All elements, parents before children.
    const std::vector<ElementId>& roots() const { return content_->roots; }
    /// Children of an element; empty for a leaf.
    IdRange<ElementId> children(ElementId e) const { return node(e).children; }
    bool is_leaf(ElementId e) const { return node(e).children.empty(); }
    Cut cut_of(ElementId e) const { return node(e).cut; }  ///< How an element was split; none for a leaf.
    double ratio(ElementId e) const {                      ///< Position of the cut, for splits across one direction.
        return node(e).ratio;
    }
    ElementId parent(ElementId e) const {  ///< Parent of an element; none for a root.
        return is_stored(e) ? content_->parent[e] : fanned(e);
    }
    RegionId region(ElementId e) const { return content_->region[is_stored(e) ? e : fanned(e)]; }
    Patch patch(ElementId e) const { return is_stored(e) ? content_->patch[e] : fan_triangle(e); }
    double area(ElementId e) const {  ///< Area of its domain, m^2.
        return is_stored(e) ? content_->area[e] : fan_triangle(e).area();
    }
    const CutLine& line(ElementId e) const {  ///< Line along which the element was split, if cut_of(e) is Cut::line.
        return content_->lines[node(e).line].line;
    }
    /// The fan into which an element was split (cut_of(e) is Cut::fan).
    FanView fan(ElementId e) const {
        const std::uint32_t i = node(e).line, first = cuts_->fans[i].first_place;
        const std::size_t end = i + 1 < cuts_->fans.size() ? cuts_->fans[i + 1].first_place : cuts_->places.size();
        return {cuts_->places[first], std::span(cuts_->places).subspan(first + 1, end - first - 1)};
    }
    /// The first element that is a triangle of an unstored fan; from it on all elements are such triangles, and leaves.
    ElementId first_of_fans() const { return ElementId(stored()); }
    /// For an element split along a line: the frame of the cell on one side, as origin and size in the element's
    /// coordinates.
    std::array<Vec2, 2> cell_frame(ElementId e, std::size_t side) const {
        const LineCut& cut = content_->lines[node(e).line];
        return {cut.origin[side], cut.size[side]};
    }
    bool is_cell(ElementId e) const {  ///< True if the element's domain is smaller than its patch.
        return is_stored(e) && content_->cell[e] != none;
    }
    /// The domain as a convex polygon in the element's coordinates, counter-clockwise.
    std::vector<Vec2> domain(ElementId e) const;
    /// The domain in space, metres.
    std::vector<Point> outline(ElementId e) const;
    /// Centroid of the domain.
    Vec2 centre(ElementId e) const;
    /// Fraction of the segment from the centre to uv inside the domain; at most 1.
    double reach(ElementId e, Vec2 uv) const;
    /// Maps two numbers in [0, 1) to a point of the domain, with uniform density.
    Vec2 uniform(ElementId e, double s, double t) const;
    std::vector<ElementId> leaves() const;  ///< Returns all leaves, in the order of their ids.

    /// A point of an element, by the element's own coordinates.
    struct Place {
        ElementId element;
        Vec2 uv;
    };
    /// Finds the leaf below `e` that contains the point (u, v) of `e`. Returns it with the point's coordinates on the
    /// leaf, which are clamped to its domain. O(depth).
    Place leaf_at(ElementId e, Vec2 uv) const;

    std::size_t memory_bytes() const;
    /// Calls visit(span) for the arrays that hold most of the memory.
    template <class Visit>
    void visit_arrays(const Visit& visit) const {
        const Content& c = *content_;
        visit(c.patch.span()), visit(c.parent.span()), visit(c.region.span()), visit(c.area.span());
        visit(c.cell.span()), visit(std::span(c.lines)), visit(std::span(c.corners)), visit(cuts_->nodes.span());
        visit(std::span(cuts_->fan_of)), visit(std::span(cuts_->fans)), visit(std::span(cuts_->places));
    }
    /// Reserves memory for this many elements in all, excluding triangles of fans, so that growing copies nothing.
    void reserve(std::size_t elements);
    /// Reserves memory for this many more fans, with this many triangles in all.
    void reserve_fans(std::size_t fans, std::size_t triangles);
    /// Releases memory kept for growth.
    void shrink_to_fit();

  private:
    static constexpr std::uint32_t none = 0xffffffffu;
    /// The data of an element that finding a leaf reads, contiguous in memory.
    struct Node {
        IdRange<ElementId> children;
        double ratio = 0.5;
        std::uint32_t line = none;  ///< Index of the line or fan, for elements split by one.
        Cut cut = Cut::none;
        Patch::Shape shape = Patch::Shape::parallelogram;
    };
    /// A split along a line, with the frames of the two cells in the coordinates of the split element.
    struct LineCut {
        CutLine line;
        std::array<Vec2, 2> origin, size;
    };
    /// The elements themselves.
    struct Content {
        void add(RegionId region, ElementId parent, const Patch& shape, double area);

        Field<ElementId, Patch> patch;
        Field<ElementId, ElementId> parent;
        Field<ElementId, RegionId> region;
        Field<ElementId, double> area;
        /// Index of a cell; `none` for other elements. Its domain is corners[first_corner[cell], first_corner[cell +
        /// 1]).
        Field<ElementId, std::uint32_t> cell;
        std::vector<std::uint32_t> first_corner = {0};
        std::vector<Vec2> corners;
        std::vector<LineCut> lines;
        std::vector<ElementId> roots;
    };
    struct FanCut {
        ElementId element;
        std::uint32_t first_place;
    };
    /// How the elements are split. The triangles of fans follow from this, so those at the end of the tree are not
    /// stored as long as no other elements are added. In trees with many of them, such as those of continuous
    /// functions, each takes about 20 bytes instead of more than 100.
    struct Cuts {
        Field<ElementId, Node> nodes;       ///< Data of stored elements.
        std::vector<FanCut> fans;           ///< Fans in the order of their splits.
        std::vector<Vec2> places;           ///< Per fan: its apex, followed by the corners of its border.
        std::vector<std::uint32_t> fan_of;  ///< Per unstored triangle: the index of its fan.
    };

    std::size_t stored() const { return content_->patch.size(); }
    bool is_stored(ElementId e) const { return e.value < stored(); }
    const Node& node(ElementId e) const {
        static constexpr Node triangle{.children = {}, .shape = Patch::Shape::triangle};
        return is_stored(e) ? cuts_->nodes[e] : triangle;
    }
    /// The parent of an unstored triangle.
    ElementId fanned(ElementId e) const { return cuts_->fans[cuts_->fan_of[e.value - stored()]].element; }
    Patch fan_triangle(ElementId e) const;
    /// Stores all triangles of fans, so that other elements can be added after them.
    void store_triangles();
    void add(RegionId region, ElementId parent, const Patch& shape, double area);
    Place in_fan(ElementId e, Vec2 uv) const;
    std::span<const Vec2> cell_domain(ElementId e) const {
        const std::uint32_t* const first = &content_->first_corner[content_->cell[e]];
        return std::span(content_->corners).subspan(first[0], first[1] - first[0]);
    }

    CopyOnWrite<Content> content_;  ///< Shared by the trees of many functions.
    CopyOnWrite<Cuts> cuts_;        ///< Trees with different fans share the rest.
};

}  // namespace exitance
