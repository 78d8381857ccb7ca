#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/visibility/convex_blockers.hpp"

namespace exitance {

/// Bounding planes of convex blockers, pointing outwards: the faces of a solid, or both sides and the borders of a
/// sheet.
class BlockerPlanes {
  public:
    /// Adds a blocker, enlarged by `slack` (metres) on all sides.
    void add(const ConvexBlocker& blocker, double slack);
    void clear() { planes_.clear(), first_.assign(1, 0); }

    std::size_t size() const { return first_.size() - 1; }
    std::span<const Plane> operator[](std::size_t blocker) const {
        return std::span(planes_).subspan(first_[blocker], first_[blocker + 1] - first_[blocker]);
    }

  private:
    std::vector<Plane> planes_;
    std::vector<std::size_t> first_ = {0};
};

/// Tests whether several convex blockers together hide one convex polygon from another. Both polygons are bisected
/// until, for each pair of parts, a single blocker meets all segments between their corners. That is sufficient: for a
/// fixed point, the points whose segment to it meets a convex set form a convex set. One object per thread.
class JointShadow {
  public:
    /// True is certain, except for slivers as thin as the slack. Returns false if some segment is unoccluded, or if 256
    /// pairs of parts did not decide. Uses at most the first 64 blockers.
    bool hides(std::span<const Point> receiver, std::span<const Point> source, const BlockerPlanes& planes,
               std::span<const std::uint32_t> blockers);

  private:
    using Mask = std::uint64_t;  ///< Set of blockers, one bit each.
    /// A triangle or quadrilateral, by the indices of its corners.
    struct Cell {
        std::array<std::uint32_t, 4> corner;
        std::uint32_t count;
        std::span<const std::uint32_t> corners() const { return std::span(corner).first(count); }
    };
    struct CellPair {
        Cell receiver, source;
        int depth;
        Mask near;  ///< Blockers that may be between receiver and source.
    };

    std::uint32_t add_point(const Point& p);
    std::uint32_t add_middle(std::uint32_t a, std::uint32_t b);
    std::uint32_t add_middle(const Cell& cell);
    void add_cells(std::span<const Point> polygon, std::vector<Cell>& cells);
    bool meets(std::uint32_t p, std::uint32_t q, std::size_t blocker) const;
    Mask meeting(std::uint32_t p, std::uint32_t q, Mask of) const;
    Mask hiding(const CellPair& pair) const;
    Mask reaching(const CellPair& pair) const;
    double squared_size(const Cell& cell) const;
    std::array<Cell, 2> halves(const Cell& cell);

    std::vector<Plane> used_;           ///< Planes of the current blockers.
    std::vector<std::uint32_t> first_;  ///< Index in `used_` of each blocker's first plane.
    std::vector<Point> points_;
    std::vector<double> heights_;  ///< Signed distance of each point to each plane in use, metres.
    std::vector<Cell> receiver_cells_, source_cells_;
    std::vector<CellPair> stack_;
};

}  // namespace exitance
