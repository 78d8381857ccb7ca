#include "exitance/view_factors/sparse_factors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace exitance {
namespace {

/// Indices of the faces of every row.
std::vector<std::vector<std::uint32_t>> members_of(std::span<const std::uint32_t> rows, std::size_t count) {
    std::vector<std::vector<std::uint32_t>> members(count);
    for (std::uint32_t i = 0; i < rows.size(); ++i)
        if (rows[i] != no_row) members[rows[i]].push_back(i);
    return members;
}

}  // namespace

SparseFactors sparse_from(const ViewFactors& table, double smallest) {
    SparseFactors out;
    out.areas = table.areas, out.emittances = table.emittances, out.row_sums = table.row_sums;
    out.dropped.assign(table.size(), 0);
    for (std::size_t i = 0; i < table.size(); ++i) {
        const std::span<const double> row = table.row(i);
        for (std::uint32_t j = 0; j < row.size(); ++j)
            if (row[j] != 0 && row[j] >= smallest)
                out.columns.push_back(j), out.values.push_back(row[j]);
            else
                out.dropped[i] += row[j];
        if (out.dropped[i] > 0) out.row_sums[i] -= out.dropped[i];
        out.starts.push_back(out.values.size());
    }
    out.finished.assign(table.size(), 1);
    out.reciprocity_defect = table.reciprocity_defect, out.entry_defect = table.entry_defect;
    out.mended = table.mended, out.unsettled = table.unsettled;
    return out;
}

void close_rows(SparseFactors& table) {
    constexpr int max_sweeps = 1000;
    // Derived from the seven digits of View3D's files.
    constexpr double tolerance = 1e-7;
    const std::size_t n = table.size();
    std::vector<double> scale(n, 1), sum(n);
    for (int sweep = 0; sweep < max_sweeps; ++sweep) {
        double largest = 0;
        for (std::size_t i = 0; i < n; ++i) {
            sum[i] = 0;
            for (std::size_t k = table.starts[i]; k < table.starts[i + 1]; ++k)
                sum[i] += table.values[k] * scale[table.columns[k]];
            if (sum[i] > 0) largest = std::max(largest, std::abs(1 - scale[i] * sum[i]));
        }
        if (largest <= tolerance) break;
        for (std::size_t i = 0; i < n; ++i)
            if (sum[i] > 0) scale[i] = std::sqrt(scale[i] / sum[i]);
    }
    for (std::size_t i = 0; i < n; ++i) {
        table.row_sums[i] = 0;
        for (std::size_t k = table.starts[i]; k < table.starts[i + 1]; ++k) {
            table.values[k] *= scale[i] * scale[table.columns[k]];
            table.row_sums[i] += table.values[k];
        }
    }
}

SparseFactors merge_rows(const SparseFactors& table, std::span<const std::uint32_t> rows, std::size_t count) {
    SparseFactors out;
    out.combined = table.combined, out.unclosed = table.unclosed;
    out.reciprocity_defect = table.reciprocity_defect, out.entry_defect = table.entry_defect;
    out.closure_defect = table.closure_defect;
    out.mended = table.mended, out.unsettled = table.unsettled, out.is_settled = table.is_settled;
    std::vector<double> sums(count);
    const bool has_errors = !table.row_errors.empty(), has_sky = !table.sky.empty();
    for (const std::vector<std::uint32_t>& members : members_of(rows, count)) {
        double area = 0, error = 0, dropped = 0, sky = 0, back = 0, emittance = 0;
        bool finished = true;
        std::fill(sums.begin(), sums.end(), 0);
        for (std::uint32_t i : members) {
            area += table.areas[i], emittance += table.areas[i] * table.emittances[i],
                finished &= table.finished[i] != 0;
            if (has_errors) error += table.areas[i] * table.row_errors[i];
            if (has_sky) sky += table.areas[i] * table.sky[i], back += table.areas[i] * table.back[i];
            dropped += table.areas[i] * table.dropped[i];
            for (std::size_t k = table.starts[i]; k < table.starts[i + 1]; ++k)
                if (rows[table.columns[k]] != no_row) sums[rows[table.columns[k]]] += table.areas[i] * table.values[k];
        }
        out.areas.push_back(area), out.finished.push_back(finished);
        out.emittances.push_back(area > 0 ? emittance / area : 1);
        for (std::uint32_t j = 0; j < count; ++j)
            if (sums[j] > 0) out.columns.push_back(j), out.values.push_back(sums[j] / area);
        out.starts.push_back(out.values.size());
        out.row_sums.push_back(area > 0 ? std::accumulate(sums.begin(), sums.end(), 0.0) / area : 0);
        if (has_sky) out.sky.push_back(area > 0 ? sky / area : 0), out.back.push_back(area > 0 ? back / area : 0);
        if (has_errors) out.row_errors.push_back(area > 0 ? error / area : 0);
        out.dropped.push_back(area > 0 ? dropped / area : 0);
    }
    return out;
}

}  // namespace exitance
