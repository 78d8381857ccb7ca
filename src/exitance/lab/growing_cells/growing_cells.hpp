#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/lab/growing_cells/cell_complex.hpp"

namespace exitance {

/// Parameters of learning; defaults as in [Fritzke94] unless stated otherwise.
struct GrowingCellsOptions {
    std::size_t simplex = 2;    ///< Dimension k of the complex.
    std::size_t dimension = 3;  ///< n, of the samples, at least k.
    std::size_t outputs = 0;    ///< Number of output values per unit; 0: none is learned.
    double winner_rate = 0.06;
    double neighbour_rate = 0.002;
    /// Rate of the delta rule, divided by the activations' sum of squares if that exceeds 1.
    double output_rate = 0.2;
    double decay = 0.05;      ///< Share of its resource that a unit loses between two insertions.
    double width_share = 1;   ///< Width of a unit's Gaussian as a share of the mean length of its edges.
    bool normalised = false;  ///< True if activations are divided by their sum.
};

/// Growing cell structures: units in R^n at the vertices of a simplicial complex. Units move towards samples, learn
/// outputs, and are inserted where resource accumulates. Sources: [Fritzke94]; Gaussian outputs by the delta rule. A
/// step costs O(log units) for finding the winner, plus its neighbourhood. Uses no random numbers: equal samples give
/// equal networks.
class GrowingCells {
  public:
    using Unit = CellComplex::Unit;

    /// `corners`: n coordinates of each of the k + 1 first units, unit after unit.
    GrowingCells(const GrowingCellsOptions& options, std::span<const double> corners);

    const GrowingCellsOptions& options() const { return options_; }
    const CellComplex& complex() const { return complex_; }
    std::size_t unit_count() const { return complex_.unit_count(); }
    std::vector<Unit> units() const;
    std::span<const double> position(Unit u) const { return {&position_[u * options_.dimension], options_.dimension}; }
    std::span<const double> output(Unit u) const { return {&output_[u * options_.outputs], options_.outputs}; }
    std::span<double> output(Unit u) { return {&output_[u * options_.outputs], options_.outputs}; }
    double width(Unit u) const { return width_[u]; }  ///< Width of the unit's Gaussian when last measured.
    double resource(Unit u) const { return resource_[u] / increment_; }

    /// The unit nearest to a sample; among equals, the one with the lower number.
    Unit winner(std::span<const double> sample) const;

    /// Calls visit(unit, exp(-|x - w|^2 / width^2)) for all units within three widths.
    template <class Visit>
    void visit(std::span<const double> x, const Visit& visit) const {
        walk(x, [&](Unit u) {
            const double q = distance_squared(u, x) / (width_[u] * width_[u]);
            if (q < cutoff) visit(u, std::exp(-q));
        });
    }
    static constexpr double cutoff = 9;

    /// Output at a point: the sum of activations times outputs, divided by the sum of activations if `normalised`. If
    /// no unit is near: the winner's output (normalised), or zeros.
    void evaluate(std::span<const double> x, std::span<double> out) const;

    /// Learns one sample. The winner and its neighbours move towards it, outputs follow the target by the delta rule,
    /// and the winner's resource grows by `density` plus `error` times the squared error before the step. Returns that
    /// squared error.
    double learn(std::span<const double> sample, std::span<const double> target, double density, double error);

    /// Inserts a unit on the longest edge at the unit with the largest resource. Returns it.
    Unit insert();

    /// Removes units that have won too few samples since the previous call; units added since then are exempt. A unit
    /// is idle if its count (per volume, i.e. the mean edge to the power k, if `by_volume`) is below `threshold` times
    /// the mean. Returns the number of removed units.
    std::size_t remove_idle(double threshold, bool by_volume = true);

    /// Measures all widths and rebuilds the search index; insert() does so from time to time.
    void refresh();

  private:
    struct Node {
        /// Leaf: range in `items_`. Otherwise: count = 0, children at `first` and `first` + 1.
        std::uint32_t first = 0, count = 0;
        double reach = 0;  ///< Three times the largest width below.
    };

    double distance_squared(Unit u, std::span<const double> x) const {
        double sum = 0;
        for (std::size_t i = 0; i < options_.dimension; ++i) {
            const double d = x[i] - position_[u * options_.dimension + i];
            sum += d * d;
        }
        return sum;
    }
    double box_distance(std::uint32_t node, std::span<const double> x) const;
    template <class Visit>
    void walk(std::span<const double> x, const Visit& visit) const {
        if (!nodes_.empty()) {
            std::uint32_t stack[64];
            std::size_t top = 0;
            stack[top++] = 0;
            while (top > 0) {
                const std::uint32_t at = stack[--top];
                const Node& node = nodes_[at];
                if (box_distance(at, x) > node.reach + drift_) continue;
                if (node.count == 0) {
                    stack[top++] = node.first + 1;
                    stack[top++] = node.first;
                } else {
                    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
                        if (complex_.has_unit(items_[i])) visit(items_[i]);
                }
            }
        }
        for (const Unit u : tail_)
            if (complex_.has_unit(u)) visit(u);
    }
    void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);
    double measured_width(Unit u) const;
    double volume(Unit u) const { return std::pow(measured_width(u), static_cast<double>(options_.simplex)); }
    void move(Unit u, std::span<const double> towards, double rate);

    GrowingCellsOptions options_;
    CellComplex complex_;
    std::vector<double> position_, output_, resource_, width_;
    /// Samples won since the last remove_idle(); flag `young`: inserted after it.
    std::vector<std::uint32_t> signals_;
    static constexpr std::uint32_t young = 0x80000000u;
    /// Current value of one unit of resource: it grows so that stored resources need not decay.
    double increment_ = 1;

    // The search index: boxes around the units where they were when it was built, valid up to the largest move since
    // (drift_). Units added later are in tail_.
    std::vector<Node> nodes_;
    std::vector<double> boxes_;  ///< Lower corner, then upper corner, of every node.
    std::vector<Unit> items_, tail_;
    std::vector<double> indexed_at_;  ///< Positions when the index was built.
    double drift_ = 0, mean_width_ = 0;
    std::vector<std::pair<Unit, double>> active_;  ///< Scratch memory.
};

}  // namespace exitance
