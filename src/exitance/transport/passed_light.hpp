#pragma once

#include <functional>
#include <span>
#include <type_traits>
#include <vector>

#include "exitance/base/parallel.hpp"
#include "exitance/mesh/element_tree.hpp"
#include "exitance/transport/transport_operator.hpp"

namespace exitance {

/// What elements of diffusing panes meet, from what arrives at each of their sides by itself (`Material::through`):
///
///     E_met = (1 - through) E + through P E_behind,
///
/// with P the projection of what the elements behind hold, in the mean square, on the functions of an element. Both
/// sides may be cut in ways of their own: P is made of integrals over the common parts of elements, so that no flux is
/// lost on the way. O(elements of panes x elements that each meets).
class PassedLight {
  public:
    /// How an element's numbers make its function at a place: factors, as many as it holds.
    using Interpolate = std::function<void(ElementId e, const Point& x, std::span<double> factors)>;

    /// `elements`: all that values are given for, a partition of every pane; each holds one number, its mean.
    PassedLight(const Scene& scene, const ElementTree& tree, std::span<const ElementId> elements);
    /// The same where each holds `nodes` numbers, as many as a polynomial of degree `degree` in each direction takes at
    /// most.
    PassedLight(const Scene& scene, const ElementTree& tree, std::span<const ElementId> elements, std::size_t nodes,
                int degree, const Interpolate& interpolate);

    bool empty() const { return rows_.empty(); }  ///< Are there no panes?

    /// Replaces E by E_met: number k of element i stands at i nodes + k.
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

    /// One of them, of what `value(i)` gives for number i.
    template <class Get>
    auto met_at(std::size_t i, const Get& value) const -> std::decay_t<decltype(value(i))> {
        const std::uint32_t row = row_of_.empty() ? none : row_of_[i / nodes_];
        if (row == none) return value(i);
        return of_row(rows_[row], i % nodes_, value);
    }

    /// Calls visit(j, weight) for the elements behind element i, where each holds one number; weights sum to 1.
    template <class Visit>
    void visit_behind(std::size_t i, const Visit& visit) const {
        if (row_of_.empty() || row_of_[i] == none) return;
        const Row& row = rows_[row_of_[i]];
        for (std::uint32_t t = row.first; t < row.last; ++t) visit(terms_[t].element, weights_[terms_[t].weights]);
    }
    /// The share of what comes through, of what element i meets.
    double through(std::size_t i) const {
        return row_of_.empty() || row_of_[i] == none ? 0 : rows_[row_of_[i]].through;
    }

  private:
    static constexpr std::uint32_t none = 0xffffffffu;
    struct Row {
        std::uint32_t element;
        double through;
        std::uint32_t first, last;  ///< Of the terms.
    };
    /// An element behind, and nodes x nodes weights, row by row.
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
    std::vector<Row> rows_;              ///< Of elements of panes, in their order.
    std::vector<std::uint32_t> row_of_;  ///< By element; empty where there are no panes.
    std::vector<Term> terms_;
    std::vector<double> weights_;
};

/// Transport of which diffusing panes meet what comes to both of their sides, of one that takes light to one side.
class PassingTransport final : public TransportOperator {
  public:
    /// Both must outlive it.
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
