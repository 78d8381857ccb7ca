#include "exitance/view_factors/exchange_areas.hpp"

namespace exitance {

TableExchange::TableExchange(const SparseFactors& factors) : rows_(factors.size()) {
    for (std::size_t i = 0; i < factors.size(); ++i) {
        const auto columns = factors.row_columns(i);
        const auto values = factors.row_values(i);
        for (std::size_t k = 0; k < columns.size(); ++k) {
            const double half = 0.5 * factors.areas[i] * values[k];
            rows_[i].push_back({columns[k], half}), rows_[columns[k]].push_back({static_cast<std::uint32_t>(i), half});
        }
    }
}

void TableExchange::apply(std::span<const double> x, std::span<double> y) const {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        double sum = 0;
        for (const auto& [j, s] : rows_[i]) sum += s * x[j];
        y[i] = sum;
    }
}

void OperatorExchange::apply(std::span<const double> x, std::span<double> y) const {
    const std::vector<double>& area = transport_.rows.areas;
    std::vector<double> power(size()), received(size());
    for (std::size_t i = 0; i < size(); ++i) power[i] = area[i] * x[i];
    transport_.apply(x, y);
    transport_.apply_transposed(power, received);
    for (std::size_t i = 0; i < size(); ++i) y[i] = 0.5 * (area[i] * y[i] + received[i]);
}

}  // namespace exitance
