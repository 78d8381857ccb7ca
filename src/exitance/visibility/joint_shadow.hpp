#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/visibility/convex_blockers.hpp"

namespace exitance {

/// The planes that bound convex blockers, outwards: those of a solid's faces; both sides and the borders of a sheet.
class BlockerPlanes {
  public:
    /// slack  metres: every blocker counts as thicker by this all around
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

/// Do several convex blockers together hide one convex polygon from another? Both are halved until each pair of parts
/// has one blocker that all segments between their corners meet: for a fixed point, the points whose segment to it
/// meets a convex set form a convex set, so that the corners decide for all. One object serves one thread.
class JointShadow {
  public:
    /// Certain when true, up to slivers as thin as the slack. False when some segment is free, or when 256 pairs
    /// of parts did not decide. Of more than 64 blockers the first 64 are asked.
    bool hides(std::span<const Point> receiver, std::span<const Point> source, const BlockerPlanes& planes,
               std::span<const std::uint32_t> blockers);

  private:
    using Mask = std::uint64_t;  ///< A bit a blocker.
    /// A triangle or quadrilateral, by the numbers of its corners.
    struct Cell {
        std::array<std::uint32_t, 4> corner;
        std::uint32_t count;
        std::span<const std::uint32_t> corners() const { return std::span(corner).first(count); }
    };
    struct CellPair {
        Cell receiver, source;
        int depth;
        Mask near;  ///< Blockers that may stand between.
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

    std::vector<Plane> used_;           ///< Planes of the blockers at hand.
    std::vector<std::uint32_t> first_;  ///< Where those of each blocker begin.
    std::vector<Point> points_;
    std::vector<double> heights_;  ///< Of each point over each plane in use.
    std::vector<Cell> receiver_cells_, source_cells_;
    std::vector<CellPair> stack_;
};

}  // namespace exitance
