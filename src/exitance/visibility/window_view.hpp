#pragma once

#include <span>
#include <vector>

#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/shaft.hpp"

namespace exitance {

/// Is a source a window (Occluders::windows) beyond which there may be faces: a ground, the outer part of a reveal,
/// another house? Then what it shows of the sky is what no face hides on the whole way out, before and behind the
/// pane. By the scene's box: true too often at worst, which costs time alone.
bool looks_out_on_faces(const Occluders& occluders, PieceId source);

/// What stands beyond a window, for all points of a convex receiver. A line from the receiver through the window stays,
/// behind the pane, on the window's side of every plane that separates the two, through an edge of one and a corner of
/// the other. Reusable, keeps its memory.
class WindowView {
  public:
    /// Adds to `candidates` the pieces that may hide sky behind a window, those that are in it left out. With `from`
    /// given only these are looked at.
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
