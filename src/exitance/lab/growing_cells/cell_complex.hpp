#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace exitance {

/// The topology of growing cells: a pure simplicial complex of dimension k, 1 to 4, over numbered units. Every edge and
/// every unit belongs to a simplex of k + 1 units; two simplices are never the same. Source: [Fritzke94].
class CellComplex {
  public:
    static constexpr std::size_t largest_dimension = 4;
    using Unit = std::uint32_t;
    using Simplex = std::array<Unit, largest_dimension + 1>;  ///< The first k + 1 count, in ascending order.
    static constexpr Unit none = 0xffffffffu;

    /// One simplex of the units 0 to k.
    explicit CellComplex(std::size_t k);

    std::size_t dimension() const { return k_; }
    std::size_t unit_count() const { return alive_units_; }    ///< Units that are there.
    std::size_t unit_end() const { return incident_.size(); }  ///< Past the largest number of a unit.
    bool has_unit(Unit u) const { return u < incident_.size() && !incident_[u].empty(); }
    std::span<const Unit> neighbours(Unit u) const { return neighbours_[u]; }  ///< In ascending order.
    std::size_t simplex_count() const { return alive_simplices_; }
    /// The k + 1 units of every simplex, one after the other.
    std::vector<Unit> simplices() const;
    std::size_t simplices_of_edge(Unit a, Unit b) const;

    /// A unit in the middle of an edge: every simplex that holds the edge becomes two, one with the new unit in place
    /// of each end. A stellar move, so manifolds stay manifolds. Returns the new unit. O(simplices at both ends).
    Unit split_edge(Unit a, Unit b);

    /// Takes a unit and all simplices that hold it away, and what then belongs to no simplex. Returns the units that
    /// are gone; none, and nothing is done, where no simplex would be left.
    std::vector<Unit> remove(Unit u);

    /// Is all that is promised above true? For tests. O(simplices).
    bool is_valid() const;
    std::size_t component_count() const;

  private:
    std::uint32_t add_simplex(const Simplex& simplex);
    void remove_simplex(std::uint32_t s);
    void find_neighbours(Unit u);
    bool holds(std::uint32_t s, Unit u) const;

    std::size_t k_, alive_units_ = 0, alive_simplices_ = 0;
    std::vector<Simplex> simplices_;  ///< Those that are gone begin with `none`.
    std::vector<std::uint32_t> free_;
    std::vector<std::vector<std::uint32_t>> incident_;  ///< Simplices of a unit, ascending.
    std::vector<std::vector<Unit>> neighbours_;
};

}  // namespace exitance
