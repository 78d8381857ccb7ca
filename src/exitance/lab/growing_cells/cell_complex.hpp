#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace exitance {

/// The topology of growing cells: a pure simplicial complex of dimension k (1 to 4) over numbered units. Every edge and
/// every unit belongs to a simplex of k + 1 units; no two simplices are equal. Source: [Fritzke94].
class CellComplex {
  public:
    static constexpr std::size_t largest_dimension = 4;
    using Unit = std::uint32_t;
    using Simplex = std::array<Unit, largest_dimension + 1>;  ///< The first k + 1 entries are used, in ascending order.
    static constexpr Unit none = 0xffffffffu;

    /// Starts with one simplex of the units 0 to k.
    explicit CellComplex(std::size_t k);

    std::size_t dimension() const { return k_; }
    std::size_t unit_count() const { return alive_units_; }    ///< Number of existing units.
    std::size_t unit_end() const { return incident_.size(); }  ///< One past the largest unit number.
    bool has_unit(Unit u) const { return u < incident_.size() && !incident_[u].empty(); }
    std::span<const Unit> neighbours(Unit u) const { return neighbours_[u]; }  ///< In ascending order.
    std::size_t simplex_count() const { return alive_simplices_; }
    /// The k + 1 units of every simplex, simplex after simplex.
    std::vector<Unit> simplices() const;
    std::size_t simplices_of_edge(Unit a, Unit b) const;

    /// Inserts a unit in the middle of an edge: every simplex that contains the edge becomes two, with the new unit
    /// replacing one end each. This is a stellar move, so manifolds stay manifolds. Returns the new unit. O(simplices
    /// at both ends).
    Unit split_edge(Unit a, Unit b);

    /// Removes a unit, all simplices that contain it, and everything that then belongs to no simplex. Returns the
    /// removed units; returns none, and does nothing, if no simplex would be left.
    std::vector<Unit> remove(Unit u);

    /// Checks the invariants stated above. For tests. O(simplices).
    bool is_valid() const;
    std::size_t component_count() const;

  private:
    std::uint32_t add_simplex(const Simplex& simplex);
    void remove_simplex(std::uint32_t s);
    void find_neighbours(Unit u);
    bool holds(std::uint32_t s, Unit u) const;

    std::size_t k_, alive_units_ = 0, alive_simplices_ = 0;
    std::vector<Simplex> simplices_;  ///< Removed ones begin with `none`.
    std::vector<std::uint32_t> free_;
    std::vector<std::vector<std::uint32_t>> incident_;  ///< Per unit: its simplices, ascending.
    std::vector<std::vector<Unit>> neighbours_;
};

}  // namespace exitance
