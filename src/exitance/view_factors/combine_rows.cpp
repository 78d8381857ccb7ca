#include "exitance/view_factors/combine_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

/// Closure defects within this many standard deviations are noise: one row in 2,000 exceeds it by chance.
constexpr double max_noise_deviations = 3.5;
constexpr int max_sweeps = 200;         ///< Sweeps of the relaxation that distributes closure defects, at most.
constexpr double settled_share = 1e-6;  ///< Remaining share of the largest defect at which the relaxation stops.

/// An exchange area A_i F_ij, m^2, and its variance.
struct Exchange {
    std::uint32_t column;
    double area, variance;
};

const RowEntry* find_entry(const RawRow& row, std::uint32_t column) {
    const auto at = std::lower_bound(row.entries.begin(), row.entries.end(), column,
                                     [](const RowEntry& entry, std::uint32_t c) { return entry.column < c; });
    return at != row.entries.end() && at->column == column ? &*at : nullptr;
}

struct OneSide {
    double area = 0, variance = 0, density = 0;
};

OneSide side_of(const RawRow& row, const RowEntry* entry, double face_area) {
    if (!entry) return {0, 0, row.cast_density};
    return {face_area * entry->F, face_area * face_area * double(entry->variance), double(entry->density)};
}

Exchange combined(const OneSide& a, const OneSide& b, std::uint32_t column) {
    double share = 0.5;  // weight of the first estimate
    if (a.density != b.density)
        share = std::isinf(a.density) ? 1 : std::isinf(b.density) ? 0 : a.density / (a.density + b.density);
    return {column, share * a.area + (1 - share) * b.area,
            share * share * a.variance + (1 - share) * (1 - share) * b.variance};
}

/// The combined rows, and the relaxation that removes their closure defects.
class Combination {
  public:
    Combination(const std::vector<RawRow>& rows, const std::vector<double>& areas)
        : rows_(rows), areas_(areas), exchanges_(rows.size()) {}

    void combine() {
        find_absent();
        parallel_for(rows_.size(), 16, [&](std::size_t i) { combine_row(static_cast<std::uint32_t>(i)); });
        absent_.clear();
    }

    /// Distributes the closure defects. Returns the number of rows whose defect is not explained by their variance.
    std::size_t close() {
        const std::size_t n = rows_.size();
        defect_.assign(n, 0), stiffness_.assign(n, 0), multiplier_.assign(n, 0);
        std::size_t unexplained = 0;
        double largest = 0;
        for (std::size_t i = 0; i < n; ++i) {
            double sum = areas_[i] * rows_[i].missed, variance = areas_[i] * areas_[i] * rows_[i].missed_variance;
            for (const Exchange& e : exchanges_[i]) sum += e.area, variance += e.variance;
            const double d = areas_[i] - sum;
            if (std::abs(d) > max_noise_deviations * std::sqrt(variance) + areas_[i] * rows_[i].bound) {
                ++unexplained;
                continue;
            }
            if (variance <= 0) continue;
            defect_[i] = d, stiffness_[i] = variance, largest = std::max(largest, std::abs(d));
        }
        relax(settled_share * largest);
        parallel_for(n, 64, [&](std::size_t i) {
            for (Exchange& e : exchanges_[i])
                e.area = std::max(0.0, e.area + e.variance * (multiplier_[i] + multiplier_[e.column]));
        });
        return unexplained;
    }

    const std::vector<Exchange>& row(std::size_t i) const { return exchanges_[i]; }
    void release(std::size_t i) { std::vector<Exchange>().swap(exchanges_[i]); }

  private:
    /// For every row, finds the rows that have an entry for it although it has none for them.
    void find_absent() {
        absent_.assign(rows_.size(), {});
        for (std::uint32_t i = 0; i < rows_.size(); ++i)
            for (const RowEntry& entry : rows_[i].entries)
                if (!find_entry(rows_[entry.column], i)) absent_[entry.column].push_back(i);
    }

    void combine_row(std::uint32_t i) {
        std::vector<Exchange>& out = exchanges_[i];
        out.reserve(rows_[i].entries.size() + absent_[i].size());
        const auto add = [&](std::uint32_t j, const RowEntry* entry) {
            const OneSide mine = side_of(rows_[i], entry, areas_[i]);
            const OneSide theirs = side_of(rows_[j], find_entry(rows_[j], i), areas_[j]);
            // In fixed order, so that both rows get the same bits.
            const Exchange e = i < j ? combined(mine, theirs, j) : combined(theirs, mine, j);
            if (e.area > 0) out.push_back(e);
        };
        auto late = absent_[i].begin();
        for (const RowEntry& entry : rows_[i].entries) {
            for (; late != absent_[i].end() && *late < entry.column; ++late) add(*late, nullptr);
            add(entry.column, &entry);
        }
        for (; late != absent_[i].end(); ++late) add(*late, nullptr);
    }

    /// Minimizes sum (change_ij)^2 / v_ij subject to sum_j change_ij = d_i. The solution is change_ij = v_ij (m_i +
    /// m_j), where the multipliers satisfy sum_j v_ij (m_i + m_j) = d_i and are computed by Gauss-Seidel. Rows without
    /// variance keep m = 0.
    void relax(double settled) {
        for (int sweep = 0; sweep < max_sweeps; ++sweep) {
            double left = 0;
            for (std::size_t i = 0; i < rows_.size(); ++i) {
                if (stiffness_[i] <= 0) continue;
                double sum = defect_[i];
                for (const Exchange& e : exchanges_[i]) sum -= e.variance * multiplier_[e.column];
                left = std::max(left, std::abs(sum - stiffness_[i] * multiplier_[i]));
                multiplier_[i] = sum / stiffness_[i];
            }
            if (left <= settled) return;
        }
    }

    const std::vector<RawRow>& rows_;
    const std::vector<double>& areas_;
    std::vector<std::vector<std::uint32_t>> absent_;
    std::vector<std::vector<Exchange>> exchanges_;
    std::vector<double> defect_, stiffness_, multiplier_;  ///< m^2, m^4, 1 / m^2.
};

/// Computes the reciprocity and closure defects of independently computed rows.
void find_defects(const std::vector<RawRow>& rows, double error, SparseFactors& out) {
    std::vector<double> reciprocity(rows.size()), closure(rows.size());
    parallel_for(rows.size(), 16, [&](std::size_t i) {
        double sum = rows[i].missed, largest = 0, off = 0;
        for (const RowEntry& entry : rows[i].entries) {
            sum += entry.F, largest = std::max(largest, entry.F);
            const RowEntry* back = find_entry(rows[entry.column], static_cast<std::uint32_t>(i));
            const double there = out.areas[i] * entry.F, here = back ? out.areas[entry.column] * back->F : 0;
            if (back || rows[entry.column].cast_density > 0) off = std::max(off, std::abs(there - here));
        }
        if (largest > 0) reciprocity[i] = off / (out.areas[i] * largest);
        if (std::sqrt(rows[i].missed_variance) <= error) closure[i] = std::abs(1 - sum);
    });
    for (std::size_t i = 0; i < rows.size(); ++i) {
        out.reciprocity_defect = std::max(out.reciprocity_defect, reciprocity[i]);
        out.closure_defect = std::max(out.closure_defect, closure[i]);
    }
}

/// Appends rows entry by entry and drops entries that are too small.
class RowAppender {
  public:
    RowAppender(const CombineOptions& options, SparseFactors& out) : options_(options), out_(out) {
        out.starts.assign(1, 0), out.columns.clear(), out.values.clear();
        out.row_sums.clear(), out.row_errors.clear(), out.dropped.clear();
    }
    void add(std::uint32_t column, double F, double variance) {
        variance_ += variance;
        if (F < options_.smallest) {
            dropped_ += F;
            return;
        }
        out_.columns.push_back(column), out_.values.push_back(F);
        sum_ += F;
    }
    void end_row(double bound) {
        out_.starts.push_back(out_.values.size());
        out_.row_sums.push_back(sum_), out_.dropped.push_back(dropped_);
        out_.row_errors.push_back(std::sqrt(variance_) + bound + dropped_);
        sum_ = dropped_ = variance_ = 0;
    }

  private:
    const CombineOptions& options_;
    SparseFactors& out_;
    double sum_ = 0, dropped_ = 0, variance_ = 0;
};

}  // namespace

void combine_rows(const std::vector<RawRow>& rows, const CombineOptions& options, SparseFactors& out) {
    if (out.starts.size() == 1) find_defects(rows, options.error, out);  // after the first pass
    Combination combination(rows, out.areas);
    combination.combine();
    out.unclosed = combination.close();
    RowAppender appender(options, out);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double area = out.areas[i];
        for (const Exchange& e : combination.row(i))
            appender.add(e.column, std::min(1.0, e.area / area), e.variance / (area * area));
        appender.end_row(rows[i].bound);
        combination.release(i);
    }
    out.finished.assign(rows.size(), 1), out.combined = true;
}

void store_raw_rows(const std::vector<RawRow>& rows, const std::vector<std::uint8_t>& finished,
                    const CombineOptions& options, SparseFactors& out) {
    RowAppender appender(options, out);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (const RowEntry& entry : rows[i].entries) appender.add(entry.column, entry.F, entry.variance);
        appender.end_row(finished[i] ? rows[i].bound : std::numeric_limits<double>::infinity());
    }
    out.finished = finished, out.combined = false;
}

}  // namespace exitance
