#include "exitance/view_factors/combine_rows.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "exitance/base/parallel.hpp"
#include "exitance/view_factors/closed_variance.hpp"

namespace exitance {
namespace {

constexpr int max_sweeps = 200;  ///< Maximum number of sweeps of the relaxation of closure defects.
/// Remaining share of the largest defect at which the relaxation stops. Derived from the six decimals with which row
/// sums are printed.
constexpr double settled_share = 1e-6;

/// An exchange area A_i F_ij, m^2, and its variance.
struct Exchange {
    double area, variance;
};

/// Exchange areas of a row, and their variances; columns are those of the row's entries.
struct ExchangeRow {
    std::vector<double> areas;
    std::vector<float> variances;
};

const RowEntry* find_entry(const RawRow& row, std::uint32_t column) {
    const auto at = std::lower_bound(row.entries.begin(), row.entries.end(), column,
                                     [](const RowEntry& entry, std::uint32_t c) { return entry.column < c; });
    return at != row.entries.end() && at->column == column ? &*at : nullptr;
}

struct OneSide {
    double area = 0, variance = 0, density = 0;
};

OneSide side_of(const RowEntry& entry, double face_area) {
    return {face_area * entry.F, face_area * face_area * double(entry.variance), double(entry.density)};
}

Exchange combined(const OneSide& a, const OneSide& b) {
    double share = 0.5;  // weight of estimate `a`
    if (a.density != b.density)
        share = std::isinf(a.density) ? 1 : std::isinf(b.density) ? 0 : a.density / (a.density + b.density);
    return {share * a.area + (1 - share) * b.area, share * share * a.variance + (1 - share) * (1 - share) * b.variance};
}

/// The combined rows, and the relaxation that removes their closure defects.
class Combination {
  public:
    Combination(std::vector<RawRow>& rows, const std::vector<double>& areas)
        : rows_(rows), areas_(areas), exchanges_(rows.size()) {}

    void combine() {
        add_absent();
        parallel_for(rows_.size(), 16, [&](std::size_t i) { combine_row(static_cast<std::uint32_t>(i)); });
    }

    /// Distributes the closure defects. Returns the number of rows whose defect is not explained by their variance.
    std::size_t close() {
        const std::size_t n = rows_.size();
        defect_.assign(n, 0), stiffness_.assign(n, 0), multiplier_.assign(n, 0), unseen_.assign(n, 0);
        std::size_t unexplained = 0;
        double largest = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const RawRow& row = rows_[i];
            const double squared_area = areas_[i] * areas_[i];
            double sum = areas_[i] * (row.sky + row.back), entries = 0;
            for (std::size_t k = 0; k < row.entries.size(); ++k)
                sum += exchanges_[i].areas[k], entries += double(exchanges_[i].variances[k]);
            const double d = areas_[i] - sum;
            const double noise = entries + squared_area * (row.missed_variance + unseen_variance(row));
            if (std::abs(d) > max_noise_deviations * std::sqrt(noise) + areas_[i] * row.bound) {
                ++unexplained;
                continue;
            }
            // If the variance of the entries does not explain the defect, the only other cause is a sky that no ray
            // reached.
            if (row.sky == 0 && d > max_noise_deviations * std::sqrt(entries) + areas_[i] * row.bound)
                unseen_[i] = unseen_variance(row);
            const double variance = entries + squared_area * (row.sky_variance + row.back_variance + unseen_[i]);
            if (variance <= 0) continue;
            defect_[i] = d, stiffness_[i] = variance, largest = std::max(largest, std::abs(d));
        }
        relax(settled_share * largest);
        parallel_for(n, 64, [&](std::size_t i) {
            for (std::size_t k = 0; k < rows_[i].entries.size(); ++k) {
                const double change = multiplier_[i] + multiplier_[rows_[i].entries[k].column];
                double& area = exchanges_[i].areas[k];
                area = std::max(0.0, area + double(exchanges_[i].variances[k]) * change);
            }
        });
        return unexplained;
    }

    const ExchangeRow& row(std::size_t i) const { return exchanges_[i]; }
    /// Share of the sky, with its part of the closure defect.
    double sky(std::size_t i) const { return closed_share(i, rows_[i].sky, rows_[i].sky_variance + unseen_[i]); }
    /// Share of backs of faces, with its part of the closure defect.
    double back(std::size_t i) const { return closed_share(i, rows_[i].back, rows_[i].back_variance); }
    /// Variance of the shares of sky and backs, or none if the row's defect was not distributed.
    std::optional<double> missed_variance(std::size_t i) const {
        return stiffness_[i] > 0 ? std::optional(rows_[i].sky_variance + rows_[i].back_variance + unseen_[i])
                                 : std::nullopt;
    }
    void release(std::size_t i) { exchanges_[i] = {}; }

  private:
    /// Returns the variance assumed for the share of a sky that no ray of a row reached. If nine rays are expected to
    /// reach it, none does in one of 8,000 rows. The variance is chosen such that nine hits are 3.5 standard
    /// deviations.
    static double unseen_variance(const RawRow& row) {
        constexpr double square_of_hits = 6.6;  // derived from (9 / 3.5)^2
        return row.cast_rays > 0 ? square_of_hits / std::pow(static_cast<double>(row.cast_rays), 2) : 0;
    }
    double closed_share(std::size_t i, double share, double variance) const {
        return std::clamp(share + areas_[i] * variance * multiplier_[i], 0.0, 1.0);
    }

    /// Makes the entries symmetric: if row j has an entry for i, but row i has none for j, row i gets an entry of 0.
    void add_absent() {
        std::vector<std::vector<RowEntry>> absent(rows_.size());
        for (std::uint32_t i = 0; i < rows_.size(); ++i)
            for (const RowEntry& entry : rows_[i].entries)
                if (!find_entry(rows_[entry.column], i))
                    absent[entry.column].push_back(
                        {.column = i, .density = static_cast<float>(rows_[entry.column].cast_density)});
        parallel_for(rows_.size(), 16, [&](std::size_t i) {
            if (absent[i].empty()) return;
            std::vector<RowEntry> all;
            all.reserve(rows_[i].entries.size() + absent[i].size());
            std::merge(rows_[i].entries.begin(), rows_[i].entries.end(), absent[i].begin(), absent[i].end(),
                       std::back_inserter(all),
                       [](const RowEntry& a, const RowEntry& b) { return a.column < b.column; });
            rows_[i].entries.swap(all);
        });
    }

    void combine_row(std::uint32_t i) {
        ExchangeRow& out = exchanges_[i];
        const std::size_t count = rows_[i].entries.size();
        out.areas.resize(count), out.variances.resize(count);
        for (std::size_t k = 0; k < count; ++k) {
            const RowEntry& entry = rows_[i].entries[k];
            const std::uint32_t j = entry.column;
            const OneSide mine = side_of(entry, areas_[i]), theirs = side_of(*find_entry(rows_[j], i), areas_[j]);
            // Combine in fixed order, so that both rows get identical bits.
            const Exchange e = i < j ? combined(mine, theirs) : combined(theirs, mine);
            out.areas[k] = e.area, out.variances[k] = static_cast<float>(e.variance);
        }
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
                for (std::size_t k = 0; k < rows_[i].entries.size(); ++k)
                    sum -= double(exchanges_[i].variances[k]) * multiplier_[rows_[i].entries[k].column];
                left = std::max(left, std::abs(sum - stiffness_[i] * multiplier_[i]));
                multiplier_[i] = sum / stiffness_[i];
            }
            if (left <= settled) return;
        }
    }

    std::vector<RawRow>& rows_;
    const std::vector<double>& areas_;
    std::vector<ExchangeRow> exchanges_;
    std::vector<double> defect_, stiffness_, multiplier_;  ///< In m^2, m^4 and 1 / m^2, one value per row.
    std::vector<double> unseen_;  ///< Variance of the share of a sky that no ray reached; 0: there is none.
};

/// Computes the reciprocity and closure defects of independently computed rows.
void find_defects(const std::vector<RawRow>& rows, double error, SparseFactors& out) {
    std::vector<double> reciprocity(rows.size()), closure(rows.size());
    parallel_for(rows.size(), 16, [&](std::size_t i) {
        double sum = rows[i].sky + rows[i].back, largest = 0, off = 0;
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
    RowAppender(const std::vector<RawRow>& rows, const CombineOptions& options, SparseFactors& out)
        : options_(options), out_(out) {
        out.starts.assign(1, 0), out.columns.clear(), out.values.clear();
        out.row_sums.clear(), out.row_errors.clear(), out.dropped.clear();
        out.sky.clear(), out.back.clear();
        std::size_t entries = 0;
        for (const RawRow& row : rows) entries += row.entries.size();
        out.columns.reserve(entries), out.values.reserve(entries);
    }
    void add(std::uint32_t column, double F, double variance) {
        variance_.add(variance);
        if (F == 0) return;
        if (F < options_.smallest) {
            dropped_ += F;
            return;
        }
        out_.columns.push_back(column), out_.values.push_back(F);
        sum_ += F;
    }
    /// `missed_variance`: see Combination; none: the row was not closed.
    void end_row(double bound, double sky, double back, std::optional<double> missed_variance) {
        const double variance = missed_variance ? variance_.closed(*missed_variance) : variance_.open();
        out_.sky.push_back(sky), out_.back.push_back(back);
        out_.starts.push_back(out_.values.size());
        out_.row_sums.push_back(sum_), out_.dropped.push_back(dropped_);
        out_.row_errors.push_back(std::sqrt(variance) + bound + dropped_);
        limits_.push_back(std::sqrt(variance_.limit(missed_variance, options_.deviations)) + bound + dropped_);
        sum_ = dropped_ = 0, variance_ = {};
    }
    /// Returns the limit of each row: its error exceeds it only rarely.
    std::vector<double> take_limits() { return std::move(limits_); }

  private:
    const CombineOptions& options_;
    SparseFactors& out_;
    double sum_ = 0, dropped_ = 0;
    ClosedVariance variance_;
    std::vector<double> limits_;
};

}  // namespace

std::vector<double> combine_rows(std::vector<RawRow>& rows, const CombineOptions& options, SparseFactors& out) {
    if (out.starts.size() == 1) find_defects(rows, options.error, out);  // only after the first pass
    Combination combination(rows, out.areas);
    combination.combine();
    out.unclosed = combination.close();
    RowAppender appender(rows, options, out);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double area = out.areas[i];
        const ExchangeRow& exchanges = combination.row(i);
        for (std::size_t k = 0; k < rows[i].entries.size(); ++k) {
            const double variance = double(exchanges.variances[k]) / (area * area);
            appender.add(rows[i].entries[k].column, std::min(1.0, exchanges.areas[k] / area), variance);
        }
        appender.end_row(rows[i].bound, combination.sky(i), combination.back(i), combination.missed_variance(i));
        combination.release(i);
    }
    out.finished.assign(rows.size(), 1), out.combined = true;
    return appender.take_limits();
}

void store_raw_rows(const std::vector<RawRow>& rows, const std::vector<std::uint8_t>& finished,
                    const CombineOptions& options, SparseFactors& out) {
    RowAppender appender(rows, options, out);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (const RowEntry& entry : rows[i].entries) appender.add(entry.column, entry.F, entry.variance);
        appender.end_row(finished[i] ? rows[i].bound : std::numeric_limits<double>::infinity(), rows[i].sky,
                         rows[i].back, std::nullopt);
    }
    out.finished = finished, out.combined = false;
}

}  // namespace exitance
