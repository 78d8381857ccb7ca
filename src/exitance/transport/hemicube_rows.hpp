#pragma once

#include <vector>

#include "exitance/mesh/numbered_leaves.hpp"
#include "exitance/transport/stage.hpp"
#include "exitance/transport/transport_operator.hpp"

namespace exitance {

/// Hemicube of side 2 around a point, open below, cut into square cells: N x N on top, N x N / 2 on each side. Each
/// cell has its exact form factor (as a polygon) from the centre of the base; all sum to 1.
/// Source: [Cohen85], which evaluates the form factor at the centre of the cell.
struct Hemicube {
    /// `cells` along an edge of the top, even and at least 2.
    explicit Hemicube(unsigned cells);

    std::vector<Vec3> direction;  ///< Vectors to the centre of each cell, not normalized; the normal is (0, 0, 1).
    std::vector<double> factor;
};

/// The direction in the plane of a patch, with normal n, with which its hemicube is aligned: its principal axis, which
/// does not depend on the order of corners; the first edge of patches that are as long in all directions.
Normal hemicube_axis(const Patch& patch, const Normal& n);

/// Transport by hemicubes. A hemicube is placed at the centre of every element, aligned with the principal axis of its
/// patch. A ray through the centre of each cell finds the element whose front is visible there. F_ij is the sum of the
/// form factors of the cells that see j. Rows of a closed scene sum to 1. The error of an entry is that of the cells on
/// the outline of j; an element that lies between the rays gets F_ij = 0. 3 N^2 rays per row, 8 bytes per entry.
/// Source: [Cohen85], with rays instead of a depth buffer.
class HemicubeRows final : public TransportOperator {
  public:
    /// `cells`: cells along an edge of the hemicube's top, N.
    HemicubeRows(const Stage& stage, const NumberedLeaves& leaves, unsigned cells);

    std::size_t size() const override { return first_.size() - 1; }
    void gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const override;
    Spectrum gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const override;
    std::size_t memory_bytes() const override { return 8 * entry_.size() + 8 * first_.size(); }
    std::size_t rays() const { return rays_; }
    std::size_t entries() const { return entry_.size(); }
    /// F_ij between the leaves with these numbers.
    double form_factor(std::size_t receiver, std::size_t source) const;

  private:
    struct Entry {
        std::uint32_t source;
        float factor;
    };
    std::vector<std::size_t> first_;  ///< Row i is entry_[first_[i], first_[i + 1]), sorted by source.
    std::vector<Entry> entry_;
    std::size_t rays_ = 0;
};

}  // namespace exitance
