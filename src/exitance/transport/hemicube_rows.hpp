#pragma once

#include <vector>

#include "exitance/mesh/element_locator.hpp"
#include "exitance/transport/stage.hpp"
#include "exitance/transport/transport_operator.hpp"

namespace exitance {

/// Half a cube of side 2 around a point, open below, cut into square cells: N x N on top, N x N / 2 on each side. Each
/// has the form factor from the middle of the cube's base, exactly (its border is a polygon); all sum to 1.
/// Source: [Cohen85], where it is taken at the middle of the cell.
struct Hemicube {
    /// `cells` along an edge of the top, even and at least 2.
    explicit Hemicube(unsigned cells);

    std::vector<Vec3> direction;  ///< To the middle of each cell, of any length; the normal is (0, 0, 1).
    std::vector<double> factor;
};

/// Transport by hemicubes: one stands on the middle of every element, along the first edge of its patch, and a ray
/// through the middle of each cell finds the element whose front that cell shows. F_ij is the sum of the form factors
/// of the cells that show j. Rows of a closed scene sum to 1; an entry is off by what the cells on the outline of j
/// come to, and j is missed where it lies between the rays. 3 N^2 rays a row, 8 bytes an entry.
/// Source: [Cohen85], by rays in place of a depth buffer.
class HemicubeRows final : public TransportOperator {
  public:
    HemicubeRows(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
                 const ElementLocator& locator, unsigned cells);

    std::size_t size() const override { return first_.size() - 1; }
    void gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const override;
    Spectrum gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const override;
    std::size_t memory_bytes() const override { return 8 * entry_.size() + 8 * first_.size(); }
    std::size_t rays() const { return rays_; }
    std::size_t entries() const { return entry_.size(); }
    /// F_ij of two leaf numbers.
    double form_factor(std::size_t receiver, std::size_t source) const;

  private:
    struct Entry {
        std::uint32_t source;
        float factor;
    };
    std::vector<std::size_t> first_;  ///< Row i stands in entry_[first_[i], first_[i + 1]), sorted by source.
    std::vector<Entry> entry_;
    std::size_t rays_ = 0;
};

}  // namespace exitance
