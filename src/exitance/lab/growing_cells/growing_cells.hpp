#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/lab/growing_cells/cell_complex.hpp"

namespace exitance {

/// How a network learns; numbers as in [Fritzke94] unless said otherwise.
struct GrowingCellsOptions {
    std::size_t simplex = 2;    ///< k, dimension of the complex.
    std::size_t dimension = 3;  ///< n, of the samples, at least k.
    std::size_t outputs = 0;    ///< Values a unit holds; 0: none is learned.
    double winner_rate = 0.06;
    double neighbour_rate = 0.002;
    double output_rate = 0.2;  ///< Of the delta rule, by the activations' sum of squares where that is above 1.
    double decay = 0.05;       ///< Share of resource that a unit loses between two insertions.
    double width_share = 1;    ///< Of the mean length of a unit's edges, as the width of its Gaussian.
    bool normalised = false;   ///< Are activations divided by their sum?
};

/// Growing cell structures: units in R^n at the corners of a simplicial complex, which move towards samples, learn to
/// answer with outputs, and become more where resource gathers. Sources: [Fritzke94]; Gaussian outputs by the delta
/// rule. A step costs O(log units) for the winner, and its neighbourhood. No randomness of its own: the same samples
/// give the same network.
class GrowingCells {
  public:
    using Unit = CellComplex::Unit;

    /// `corners`: n coordinates of k + 1 units, one after the other.
    GrowingCells(const GrowingCellsOptions& options, std::span<const double> corners);

    const GrowingCellsOptions& options() const { return options_; }
    const CellComplex& complex() const { return complex_; }
    std::size_t unit_count() const { return complex_.unit_count(); }
    std::vector<Unit> units() const;
    std::span<const double> position(Unit u) const { return {&position_[u * options_.dimension], options_.dimension}; }
    std::span<const double> output(Unit u) const { return {&output_[u * options_.outputs], options_.outputs}; }
    std::span<double> output(Unit u) { return {&output_[u * options_.outputs], options_.outputs}; }
    double width(Unit u) const { return width_[u]; }  ///< Of the unit's Gaussian, as last measured.
    double resource(Unit u) const { return resource_[u] / increment_; }

    /// The unit nearest to a sample, of two the one of the lower number.
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

    /// Output at a place: sum of activations times outputs, by the sum of activations where `normalised`; zeros where
    /// no unit is near, then normalised the winner's own.
    void evaluate(std::span<const double> x, std::span<double> out) const;

    /// One step: the winner and its neighbours move, outputs follow the target by the delta rule, the winner's resource
    /// grows by `density` plus `error` times the squared error before the step. Returns that error squared.
    double learn(std::span<const double> sample, std::span<const double> target, double density, double error);

    /// A new unit on the longest edge at the unit of the largest resource. Returns it.
    Unit insert();

    /// Takes away units that have won too few samples since this was last called, of those that were there then: the
    /// count, by volume (mean edge to the power k) or as it is, is below `threshold` times the mean. Returns how many.
    std::size_t remove_idle(double threshold, bool by_volume = true);

    /// Measures all widths and makes the index anew; insert() does so from time to time.
    void refresh();

  private:
    struct Node {
        std::uint32_t first = 0, count = 0;  ///< Of a leaf; else children are at `first` and `first` + 1.
        double reach = 0;                    ///< Three of the largest width below.
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
    std::vector<std::uint32_t> signals_;  ///< Samples won since the last look for idle units; `young`: not there then.
    static constexpr std::uint32_t young = 0x80000000u;
    double increment_ = 1;  ///< What one unit of resource is worth now: decay makes it grow instead.

    // The index: boxes around units as they stood when it was made, by how far any has moved since; later ones aside.
    std::vector<Node> nodes_;
    std::vector<double> boxes_;  ///< Low corner, then high one, of every node.
    std::vector<Unit> items_, tail_;
    std::vector<double> indexed_at_;  ///< Positions when the index was made.
    double drift_ = 0, mean_width_ = 0;
    std::vector<std::pair<Unit, double>> active_;  ///< Room to work in.
};

}  // namespace exitance
