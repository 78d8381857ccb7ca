#pragma once

#include <span>
#include <vector>

#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/shaft.hpp"

namespace exitance {

/// Returns whether a source is a window (Occluders::windows) with possible occluders or panes outside: a ground, the
/// outer part of a reveal, another house, a railing. The sky seen through it is then the part that no face on either
/// side of the pane hides. Tested with the scene's box: may return true unnecessarily, which costs only time.
bool looks_out_on_faces(const Occluders& occluders, PieceId source);

/// Finds the occluders beyond a window for all points of a convex receiver. A line from the receiver through the window
/// stays, behind the pane, on the window's side of every separating plane through an edge of one and a corner of the
/// other. Can be reused without new allocations.
class WindowView {
  public:
    /// Adds to `candidates` the pieces that may hide sky behind a window, without duplicates of those already in it. If
    /// `from` is given, only those pieces are tested.
    void add(const Occluders& occluders, const Facet& receiver, PieceId window, std::vector<PieceId>& candidates);
    void add(const Occluders& occluders, const Facet& receiver, PieceId window, std::span<const PieceId> from,
             std::vector<PieceId>& candidates);

  private:
    bool set(const Occluders& occluders, const Facet& receiver, PieceId window);
    void add_separating_planes(std::span<const Point> edges, std::span<const Point> corners, double side, double slack);
    bool reaches_in(const Occluders& occluders, PieceId p);
    void clip_by(const Plane& plane, std::vector<Point>& polygon);

    RegionId own_;
    Plane window_plane_;
    std::vector<Plane> planes_;
    std::vector<Point> receiver_, window_, part_, buffer_;
};

}  // namespace exitance
