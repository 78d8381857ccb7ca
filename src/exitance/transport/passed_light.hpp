#pragma once

#include <functional>
#include <span>
#include <type_traits>
#include <vector>

#include "exitance/base/parallel.hpp"
#include "exitance/mesh/element_tree.hpp"
#include "exitance/transport/transport_operator.hpp"

namespace exitance {

/// Incident light E_met on elements of diffusing panes, computed from the light that arrives at each side
/// (`Material::through`):
///     E_met = (1 - through) E + through P E_behind,
///
/// where P is the least-squares projection of the function on the elements behind onto the functions of an element. The
/// two sides may have different meshes: P is computed from integrals over the intersections of elements, so that flux
/// is conserved. O(elements of panes x elements that each overlaps).
class PassedLight {
  public:
    /// Writes the factors by which the values of element e make up its function at x; one factor per value.
    using Interpolate = std::function<void(ElementId e, const Point& x, std::span<double> factors)>;

    /// `elements`: all elements that have values, which must partition every pane. Each has one value, its mean.
    PassedLight(const Scene& scene, const ElementTree& tree, std::span<const ElementId> elements);
    /// Like the above, for `nodes` values per element, enough for polynomials of degree `degree` in each direction.
    PassedLight(const Scene& scene, const ElementTree& tree, std::span<const ElementId> elements, std::size_t nodes,
                int degree, const Interpolate& interpolate);

    bool empty() const { return rows_.empty(); }  ///< True if there are no panes.

    /// Replaces E by E_met. Value k of element i is values[i nodes + k].
    template <class Value>
    void meet(std::span<Value> values) const {
        if (empty()) return;
        std::vector<Value> met(rows_.size() * nodes_);
        parallel_for(rows_.size(), 64, [&](std::size_t r) {
            for (std::size_t k = 0; k < nodes_; ++k)
                met[r * nodes_ + k] = of_row(rows_[r], k, [&](std::size_t i) -> const Value& { return values[i]; });
        });
        for (std::size_t r = 0; r < rows_.size(); ++r)
            for (std::size_t k = 0; k < nodes_; ++k) values[rows_[r].element * nodes_ + k] = met[r * nodes_ + k];
    }

    /// Returns E_met of value i, where value(i) returns E.
    template <class Get>
    auto met_at(std::size_t i, const Get& value) const -> std::decay_t<decltype(value(i))> {
        const std::uint32_t row = row_of_.empty() ? none : row_of_[i / nodes_];
        if (row == none) return value(i);
        return of_row(rows_[row], i % nodes_, value);
    }

    /// Calls visit(j, weight) for the elements behind element i, if each element has one value. Weights sum to 1.
    template <class Visit>
    void visit_behind(std::size_t i, const Visit& visit) const {
        if (row_of_.empty() || row_of_[i] == none) return;
        const Row& row = rows_[row_of_[i]];
        for (std::uint32_t t = row.first; t < row.last; ++t) visit(terms_[t].element, weights_[terms_[t].weights]);
    }
    /// Share of the light incident on element i that comes through the pane; 0 if i is not on a pane.
    double through(std::size_t i) const {
        return row_of_.empty() || row_of_[i] == none ? 0 : rows_[row_of_[i]].through;
    }

  private:
    static constexpr std::uint32_t none = 0xffffffffu;
    struct Row {
        std::uint32_t element;
        double through;
        std::uint32_t first, last;  ///< Range of the row's terms.
    };
    /// An element on the other side, and its nodes x nodes weights, stored row by row.
    struct Term {
        std::uint32_t element;
        std::size_t weights;
    };
    class Maker;

    template <class Get>
    auto of_row(const Row& row, std::size_t k, const Get& value) const {
        using Value = std::decay_t<decltype(value(k))>;
        using Sum = std::conditional_t<std::is_same_v<Value, float>, double, Value>;
        Sum behind{};
        for (std::uint32_t t = row.first; t < row.last; ++t)
            for (std::size_t l = 0; l < nodes_; ++l)
                behind += weights_[terms_[t].weights + k * nodes_ + l] * Sum(value(terms_[t].element * nodes_ + l));
        return static_cast<Value>((1 - row.through) * Sum(value(row.element * nodes_ + k)) + row.through * behind);
    }

    std::size_t nodes_ = 1;
    std::vector<Row> rows_;              ///< One row per element of a pane, in ascending order of elements.
    std::vector<std::uint32_t> row_of_;  ///< Row of each element; empty if there are no panes.
    std::vector<Term> terms_;
    std::vector<double> weights_;
};

/// Adds the passage through diffusing panes to a transport operator that carries light to one side only.
class PassingTransport final : public TransportOperator {
  public:
    /// Both arguments must outlive this object.
    PassingTransport(const TransportOperator& one_sided, const PassedLight& passed) : F_(one_sided), passed_(passed) {}

    std::size_t size() const override { return F_.size(); }
    void gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const override {
        F_.gather(radiosity, irradiance);
        passed_.meet(irradiance);
    }
    Spectrum gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const override {
        return passed_.met_at(receiver, [&](std::size_t i) { return F_.gather_at(i, radiosity); });
    }
    std::size_t memory_bytes() const override { return F_.memory_bytes(); }

  private:
    const TransportOperator& F_;
    const PassedLight& passed_;
};

}  // namespace exitance
