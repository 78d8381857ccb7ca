#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/base/progress.hpp"
#include "exitance/mesh/element_tree.hpp"
#include "exitance/mesh/gap_lines.hpp"

namespace exitance {

/// Distance up to which surfaces touch each other and regions are in one plane, as a share of the scene's size.
/// Derived from the rounding of coordinates in files with seven digits.
constexpr double contact_share = 1e-7;

/// Lines along which other polygons touch a surface or intersect it. Light is discontinuous across such a line: dark
/// under a box on the floor and lit next to it, or different on the two sides of a pane. No polynomial approximates
/// that, so elements are split along these lines.
class ContactLines {
  public:
    /// The scene must outlive this object. O(n log n).
    explicit ContactLines(const Scene& scene);

    /// A segment above a plane, with its largest height above the plane, metres.
    struct Line {
        Point a, b;
        double height;
        /// For a line between strips of a gap: how far all strips together extend into the gap, metres.
        double gap_depth = 0;
        double from_mouth = 0;  ///< For such a line: its distance from the mouth, metres.
        Vec3 inwards = {};      ///< For such a line: unit vector from the mouth into the gap.
        bool is_strip() const { return gap_depth > 0; }
    };
    /// Lines that may cross an element's domain, caused by faces of other regions: edges in its plane; edges at a small
    /// height above it, each with one more line on either side; intersections with faces; and in gaps, where light
    /// falls off from the mouth, up to three lines parallel to the mouth. These come last: those of short mouths first,
    /// and those far from a mouth first. The limits for small heights and for gaps depend on the element's width across
    /// the line and on `area`.
    /// area  of the element before contacts split it, m^2, so that its parts share its lines
    std::vector<Line> around(const ElementTree& tree, ElementId e, double area) const;
    /// Removes from `lines` those that do not cross the element's domain. Returns the part inside the domain of each of
    /// the others, as a pair of points in the element's coordinates.
    std::vector<std::pair<Vec2, Vec2>> inside(const ElementTree& tree, ElementId e, std::vector<Line>& lines) const;

    /// All contact lines in the plane of a whole region inside the region's box, including those along its border.
    /// Metres.
    std::vector<std::pair<Point, Point>> of_region(RegionId region) const;

    /// Like of_region(), for several coplanar regions (sorted), excluding contacts among them, and including edges up
    /// to a height of `gap` metres.
    std::vector<Line> over_plane(std::span<const RegionId> regions, double gap) const;

    /// Height (metres) up to which an edge above a surface counts as a discontinuity for elements of this area (m^2).
    /// The light changes within a strip as wide as the edge is high.
    static double height_of_jump(double area) { return jump_height_share * std::sqrt(area); }
    /// Share of the element's width. Chosen: half of it takes 6% more rays and twice it 30% fewer, both at about the
    /// same true error, measured by `exitance solve gaps.obj --error 0.02`.
    static constexpr double jump_height_share = 0.05;
    /// Distance (metres) of two faces up to which they count as a gap for elements of this area (m^2): half of the
    /// element's width. Light that enters a gap falls off within that distance; wider elements would carry it too far
    /// into the gap, and from there back out.
    static double height_of_gap(double area) { return 0.5 * std::sqrt(area); }

    /// Calls visit(span) for the arrays that hold most of the memory.
    template <class Visit>
    void visit_arrays(const Visit& visit) const {
        faces_.visit_arrays(visit), borders_.visit_arrays(visit), gaps_.visit_arrays(visit);
        visit(std::span(edges_)), visit(std::span(gap_lines_));
    }

  private:
    struct Edge {
        Point a, b;
        RegionId region;
    };
    const Scene* scene_;
    Bvh faces_, borders_, gaps_;
    std::vector<Edge> edges_;         ///< Border edges of regions, and edges of panes (region: none).
    std::vector<GapLine> gap_lines_;  ///< Gap lines; `gaps_` contains indices into them.
    double tolerance_;                ///< Metres: points nearer to a plane than this touch it.
};

/// Splits every leaf in `from` along the contact lines inside it: into parallelograms where the lines are parallel to
/// its directions, otherwise into cells. If a stop is requested, the remaining leaves stay unsplit.
void cut_along_contacts(ElementTree& tree, const std::vector<ElementId>& from, const ContactLines& contacts,
                        const StopRequest* stop = nullptr);

}  // namespace exitance
