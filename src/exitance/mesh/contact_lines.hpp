#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/base/progress.hpp"
#include "exitance/mesh/element_tree.hpp"
#include "exitance/mesh/gap_lines.hpp"

namespace exitance {

/// Where other polygons touch a surface or pass through it. Across such a line light jumps: under a box that stands on
/// a floor it is dark, beside it not; on either side of a pane it is unlike. No polynomial follows that: elements are
/// cut.
class ContactLines {
  public:
    /// The scene must outlive it. O(n log n).
    explicit ContactLines(const Scene& scene);

    /// A stretch of a line over a plane, and how high it is above it at most, metres.
    struct Line {
        Point a, b;
        double height;
        double gap_depth = 0;  ///< Of a line between strips of a gap: how far into it all of them reach, metres.
    };
    /// Lines that may run through an element's domain, from faces of other regions: edges that lie in its plane or
    /// hover over it by little, with a line on either side of the latter; the lines in which faces cross it; and in
    /// gaps, along whose mouths light falls off, up to three lines inwards. What is little, and what a gap, are shares
    /// of its width across the line and of the root of `area` (m^2), the element's before contacts cut it, so that its
    /// parts share its lines.
    std::vector<Line> around(const ElementTree& tree, ElementId e, double area) const;
    /// Leaves of the lines those that meet an element's domain; returns what of them runs through its inside, as pairs
    /// of points in the element's own coordinates.
    std::vector<std::pair<Vec2, Vec2>> inside(const ElementTree& tree, ElementId e, std::vector<Line>& lines) const;

    /// All contacts of a whole region's plane within the region's box, along its border, too. Metres.
    std::vector<std::pair<Point, Point>> of_region(RegionId region) const;

    /// The same of regions in one plane, ascending, but for contacts among themselves; up to a height of `gap` metres.
    std::vector<Line> over_plane(std::span<const RegionId> regions, double gap) const;

    /// Under an edge that hovers over a surface light changes within a strip as narrow as the edge is high: that is a
    /// jump to elements whose area (m^2) is so large.
    static double height_of_jump(double area) { return 0.05 * std::sqrt(area); }
    /// Between two faces light falls off within their distance from where it enters: elements of such an area that are
    /// more than twice as wide as the faces are apart would carry it further in than it goes, and from there back out.
    static double height_of_gap(double area) { return 0.5 * std::sqrt(area); }

    /// Calls visit(span) for the plain arrays that most of it stands in.
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
    std::vector<Edge> edges_;         ///< Of borders of regions, and of panes, which are of none.
    std::vector<GapLine> gap_lines_;  ///< What `gaps_` is of.
    double tolerance_;                ///< Metres; what is nearer than this to a plane touches it.
};

/// Cuts every leaf of `from` along the contacts inside it: into parallelograms where they run in its directions, else
/// into cells. Leaves those that are still to be cut as they are where a stop is asked for.
void cut_along_contacts(ElementTree& tree, const std::vector<ElementId>& from, const ContactLines& contacts,
                        const StopRequest* stop = nullptr);

}  // namespace exitance
