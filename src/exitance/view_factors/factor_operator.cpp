#include "exitance/view_factors/factor_operator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

constexpr std::size_t rows_a_task = 256, rows_a_block = 16384;
constexpr int threshold_steps = 10;  ///< Bisections of the logarithm of a row's threshold.
/// Smallest threshold, as a share of the largest. Derived from threshold_steps: they leave a factor of 1.01 between
/// two thresholds.
constexpr double min_threshold_share = 1e-4;

/// Sum of the values of all faces of each node, after the values themselves.
std::vector<double> with_sums(const FaceTree& tree, std::vector<double> of_faces) {
    const std::size_t n = of_faces.size();
    of_faces.resize(n + tree.nodes());
    const std::span<double> all(of_faces);
    tree.sum_up(all.first(n), all.subspan(n));
    return of_faces;
}

/// A row of an operator: columns and values.
struct MergedRow {
    std::vector<std::pair<std::uint32_t, double>> entries;
    double squares = 0;  ///< Sum of T_iC^2.
};

/// Merges the entries of one row at a time. One object serves one thread.
class RowMerger {
  public:
    RowMerger(const FaceTree& tree, std::span<const std::uint32_t> position, const SparseFactors& table)
        : tree_(tree), position_(position), table_(table) {}

    /// The threshold of row i if all of its entries may be merged.
    double threshold(std::size_t i, double error) {
        set_row(i, {}, nullptr);
        return largest_threshold(error);
    }

    /// Row i, without merging the entries that are above the threshold of their column's row.
    MergedRow operator()(std::size_t i, std::span<const double> thresholds, double error) {
        MergedRow row;
        set_row(i, thresholds, &row);
        row.squares = merge(0, entries_, largest_threshold(error), &row);
        std::sort(row.entries.begin(), row.entries.end());
        return row;
    }

  private:
    struct Entry {
        std::uint32_t position, column;
        double F;
    };

    /// Sets the entries that may be merged, sorted by their place in the tree; appends the others to `row`.
    void set_row(std::size_t i, std::span<const double> thresholds, MergedRow* row) {
        entries_.clear();
        const auto columns = table_.row_columns(i);
        const auto values = table_.row_values(i);
        for (std::size_t k = 0; k < columns.size(); ++k) {
            const std::uint32_t j = columns[k];
            const double back = table_.areas[i] * values[k] / table_.areas[j];  // F_ji
            if (row && back > thresholds[j])
                row->entries.emplace_back(j, values[k]);
            else
                entries_.push_back({position_[j], j, values[k]});
        }
        std::sort(entries_.begin(), entries_.end(),
                  [](const Entry& a, const Entry& b) { return a.position < b.position; });
    }

    /// The largest limit on T_iC with sqrt(sum_C T_iC^2) <= `error`.
    double largest_threshold(double error) const {
        const auto is_within = [&](double limit) { return merge(0, entries_, limit, nullptr) <= error * error; };
        double low = min_threshold_share * error, high = error;
        if (is_within(high)) return high;
        for (int step = 0; step < threshold_steps; ++step) {
            const double middle = std::sqrt(low * high);
            (is_within(middle) ? low : high) = middle;
        }
        return is_within(low) ? low : 0;
    }

    /// Merges entries of a node whose sum is at most `threshold`; appends to `row` if there is one. Returns the sum of
    /// T_iC^2.
    double merge(std::size_t node, std::span<const Entry> entries, double threshold, MergedRow* row) const {
        if (entries.empty()) return 0;
        if (entries.size() == 1) {
            if (row) row->entries.emplace_back(entries[0].column, entries[0].F);
            return 0;
        }
        const std::uint32_t middle = tree_.range(node).middle();
        const auto second = static_cast<std::size_t>(
            std::partition_point(entries.begin(), entries.end(), [&](const Entry& e) { return e.position < middle; }) -
            entries.begin());
        double sum = 0;
        for (const Entry& entry : entries) sum += entry.F;
        if (sum <= threshold && second > 0 && second < entries.size()) {
            if (row) row->entries.emplace_back(static_cast<std::uint32_t>(tree_.size() + node), sum);
            return sum * sum;
        }
        return merge(FaceTree::first_child(node), entries.first(second), threshold, row) +
               merge(tree_.second_child(node), entries.subspan(second), threshold, row);
    }

    const FaceTree& tree_;
    std::span<const std::uint32_t> position_;
    const SparseFactors& table_;
    std::vector<Entry> entries_;
};

}  // namespace

void FactorOperator::apply(std::span<const double> x, std::span<double> y) const {
    const std::size_t n = size();
    std::vector<double> power(n);
    for (std::size_t j = 0; j < n; ++j) power[j] = rows.areas[j] * x[j];
    std::vector<double> mean = with_sums(tree, std::move(power));
    const std::vector<double> area = with_sums(tree, rows.areas);
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] = k < n ? x[k] : mean[k] / area[k];
    parallel_for(n, rows_a_task, [&](std::size_t i) {
        const auto columns = rows.row_columns(i);
        const auto values = rows.row_values(i);
        double sum = 0;
        for (std::size_t k = 0; k < columns.size(); ++k) sum += values[k] * mean[columns[k]];
        y[i] = sum;
    });
}

void FactorOperator::apply_transposed(std::span<const double> x, std::span<double> y) const {
    const std::size_t n = size();
    std::vector<double> received(n + tree.nodes());
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = rows.starts[i]; k < rows.starts[i + 1]; ++k)
            received[rows.columns[k]] += rows.values[k] * x[i];
    const std::vector<double> area = with_sums(tree, rows.areas);
    for (std::size_t k = n; k < received.size(); ++k) received[k] /= area[k];
    std::vector<double> density(n);
    tree.hand_down(std::span(received).subspan(n), density);
    for (std::size_t j = 0; j < n; ++j) y[j] = received[j] + rows.areas[j] * density[j];
}

std::vector<double> FactorOperator::dense_row(std::size_t i) const {
    std::vector<double> row(size());
    for (std::size_t k = rows.starts[i]; k < rows.starts[i + 1]; ++k) {
        const std::uint32_t column = rows.columns[k];
        if (column < size()) {
            row[column] += rows.values[k];
            continue;
        }
        const FaceTree::Range range = tree.range(column - size());
        const auto members = tree.order().subspan(range.first, range.size());
        double area = 0;
        for (const std::uint32_t j : members) area += rows.areas[j];
        for (const std::uint32_t j : members) row[j] += rows.values[k] * rows.areas[j] / area;
    }
    return row;
}

std::size_t FactorOperator::node_entries() const {
    return static_cast<std::size_t>(
        std::count_if(rows.columns.begin(), rows.columns.end(), [&](std::uint32_t c) { return c >= size(); }));
}

double FactorOperator::closure_defect() const {
    double largest = 0;
    for (std::size_t i = 0; i < rows.sky.size(); ++i)
        if (rows.finished[i]) largest = std::max(largest, std::abs(1 - rows.row_sums[i] - rows.sky[i] - rows.back[i]));
    return largest;
}

FactorOperator make_factor_operator(std::span<const ViewFace> faces, SparseFactors table, double error) {
    FactorOperator out{FaceTree(faces), {}};
    const std::size_t n = table.size();
    std::vector<std::uint32_t> position(n);
    for (std::uint32_t p = 0; p < n; ++p) position[out.tree.order()[p]] = p;
    std::vector<double> thresholds(n);
    parallel_ranges(n, rows_a_task, [&](std::size_t from, std::size_t to) {
        RowMerger merger(out.tree, position, table);
        for (std::size_t i = from; i < to; ++i) thresholds[i] = merger.threshold(i, error);
    });
    std::vector<std::size_t> starts = {0};
    std::vector<std::uint32_t> columns;
    std::vector<double> values;
    for (std::size_t first = 0; first < n; first += rows_a_block) {
        std::vector<MergedRow> rows(std::min(rows_a_block, n - first));
        parallel_ranges(rows.size(), rows_a_task, [&](std::size_t from, std::size_t to) {
            RowMerger merger(out.tree, position, table);
            for (std::size_t k = from; k < to; ++k) rows[k] = merger(first + k, thresholds, error);
        });
        for (std::size_t k = 0; k < rows.size(); ++k) {
            for (const auto& [column, value] : rows[k].entries) columns.push_back(column), values.push_back(value);
            starts.push_back(values.size());
            double& row_error = table.row_errors[first + k];
            row_error = std::sqrt(row_error * row_error + rows[k].squares);
        }
    }
    table.starts = std::move(starts), table.columns = std::move(columns), table.values = std::move(values);
    out.rows = std::move(table);
    return out;
}

}  // namespace exitance
