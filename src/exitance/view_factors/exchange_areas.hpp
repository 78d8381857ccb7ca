#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "exitance/view_factors/factor_operator.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

/// Exchange areas between surfaces, the mean of both directions: S_ij = S_ji = (A_i F_ij + A_j F_ji) / 2, m^2.
class ExchangeAreas {
  public:
    virtual ~ExchangeAreas() = default;
    virtual std::size_t size() const = 0;
    /// y = S x; x and y have size() entries and must not overlap.
    virtual void apply(std::span<const double> x, std::span<double> y) const = 0;
};

/// Exchange areas of a table. Memory: 32 bytes per entry.
class TableExchange final : public ExchangeAreas {
  public:
    explicit TableExchange(const SparseFactors& factors);
    std::size_t size() const override { return rows_.size(); }
    void apply(std::span<const double> x, std::span<double> y) const override;

  private:
    std::vector<std::vector<std::pair<std::uint32_t, double>>> rows_;
};

/// Exchange areas of an operator, which must outlive this object.
class OperatorExchange final : public ExchangeAreas {
  public:
    explicit OperatorExchange(const FactorOperator& transport) : transport_(transport) {}
    std::size_t size() const override { return transport_.size(); }
    void apply(std::span<const double> x, std::span<double> y) const override;

  private:
    const FactorOperator& transport_;
};

}  // namespace exitance
