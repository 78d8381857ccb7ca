#include "exitance/view_factors/row_factors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "exitance/base/memory.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/processes/exchange_archived.hpp"
#include "exitance/view_factors/combine_rows.hpp"
#include "exitance/view_factors/row_estimator.hpp"

namespace exitance {
namespace {

constexpr std::size_t rows_a_step = 64;  ///< Rows of a process between progress reports and checks of memory.
constexpr std::size_t rows_a_range = 4;  ///< Rows that one thread computes without interruption.

/// Tolerance of rows in the first pass, relative to R, the requested error. It applies to the error that is expected
/// after rows were combined with their reciprocal ones.
constexpr double first_share = 1;
/// Rows whose error exceeds R after the second pass are recomputed at most `max_repeats` times. Each time, the
/// tolerance is this share of the one that would suffice if a row's own rays caused all of its variance. Measured by
/// `exitance viewfactors SCENE --error 2e-3`: a quarter of it takes 3 to 4 times as long; with four times as much,
/// errors exceed R by up to 40%.
constexpr double repeated_share = 0.75;
constexpr std::uint32_t max_repeats = 4;
/// Lower limit of the factor on a row's tolerance, derived from errors that fall with the root of the number of rays: a
/// repeat takes at most about 16 times as many. If a row misses 1 by more than that, chance is not the only cause, and
/// more rays would not help.
constexpr double min_factor = 0.25;
/// Rows that miss 1 by at least this share of their last defect, on the same side, are not repeated again. Derived from
/// min_factor: had chance caused the defect, about a quarter of it would be left.
constexpr double persistent_share = 0.5;

class RowRun {
  public:
    RowRun(const Scene& scene, const RowFactorOptions& options, RawRowStore* store, Progress& progress,
           const StopRequest& stop)
        : scene_(scene), options_(options), store_(store), progress_(progress), stop_(stop) {}

    SparseFactors operator()() {
        SparseFactors out;
        for (SurfaceId s : scene_.surfaces().ids()) {
            out.areas.push_back(scene_.surfaces()[s].area);
            out.emittances.push_back(1 - mean(scene_.material(s).reflectance));
        }
        rows_.resize(out.size()), shares_.assign(out.size(), first_share), is_pooled_.assign(out.size(), 0);
        finished_.assign(out.size(), 0);
        missing_.assign(out.size(), 0);
        resumed_ = resumed_rows(store_);
        std::vector<std::size_t> faces(out.size());
        std::iota(faces.begin(), faces.end(), 0);
        const CombineOptions combine{options_.smallest, options_.deviations, options_.error};
        for (std::uint32_t round = 0; compute_rows(faces, round); ++round) {
            progress_.phase("combine rows");
            const std::vector<double> limits = combine_rows(rows_, combine, out);
            faces = round < max_repeats ? faces_above(out, limits) : std::vector<std::size_t>();
            if (!faces.empty()) continue;
            add_missing(out);
            return out;
        }
        store_raw_rows(rows_, finished_, combine, out);
        out.is_settled = false;  // even if all rows have been computed once
        return out;
    }

  private:
    /// Returns the rows to compute again. These are rows whose limit after combination, without dropped entries,
    /// exceeds R, and rows whose sum, with the sky and backs of faces, differs from 1 by more than R. Such sums occur
    /// if samples have rare large values, which the variance of a row's own samples does not show. Rows with a
    /// difference that more rays did not reduce are left out, since it has other causes than chance. Sets the
    /// tolerances of the rows.
    std::vector<std::size_t> faces_above(const SparseFactors& out, const std::vector<double>& limits) {
        std::vector<std::size_t> faces;
        for (std::size_t i = 0; i < out.size(); ++i) {
            const double missing = missing_from(out, i), before = std::exchange(missing_[i], missing);
            const double error = std::max(limits[i] - out.dropped[i], std::abs(missing));
            if (error <= options_.error) continue;
            const bool is_persistent = std::abs(before) > options_.error && missing / before > persistent_share;
            if (is_persistent && limits[i] - out.dropped[i] <= options_.error) continue;
            is_pooled_[i] = std::abs(missing) <= options_.error;
            shares_[i] *= std::max(min_factor, repeated_share * options_.error / error);
            faces.push_back(i);
        }
        return faces;
    }

    /// Difference between 1 and the sum of a row with the sky and backs of faces.
    static double missing_from(const SparseFactors& out, std::size_t i) {
        return 1 - out.row_sums[i] - out.dropped[i] - out.sky[i] - out.back[i];
    }

    /// Reports the defects of rows that could not be closed as their errors.
    void add_missing(SparseFactors& out) const {
        for (std::size_t i = 0; i < out.size(); ++i) {
            const double missing = std::abs(missing_from(out, i));
            if (missing > options_.error) out.row_errors[i] = std::max(out.row_errors[i], missing + out.dropped[i]);
        }
    }

    /// Restores the rows of a round that an earlier run kept; returns the remaining faces.
    std::vector<std::size_t> take_resumed(const std::vector<std::size_t>& faces, std::uint32_t round) {
        std::vector<std::uint8_t> taken(rows_.size());
        for (RawRow& row : resumed_) {
            if (row.round != round) continue;
            const std::size_t face = row.face;
            rows_[face] = std::move(row), finished_[face] = taken[face] = 1;
        }
        std::vector<std::size_t> left;
        for (std::size_t face : faces)
            if (!taken[face]) left.push_back(face);
        return left;
    }

    /// Computes the rows of some faces; returns false if stopped before the last of them.
    bool compute_rows(const std::vector<std::size_t>& faces, std::uint32_t round) {
        const std::vector<std::size_t> left = take_resumed(faces, round);
        if (left.empty()) return true;
        progress_.phase(round == 0 ? "view factors" : "rows again");
        if (!ready_) ready_.emplace(scene_, stop_);
        const std::size_t before = faces.size() - left.size();
        const std::size_t rows_at_once = rows_a_step * processes();
        for (std::size_t first = 0; first < left.size(); first += rows_at_once) {
            const std::span<const std::size_t> step =
                std::span(left).subspan(first, std::min(rows_at_once, left.size() - first));
            if (!compute_step(step, round) || exceeds_memory()) return false;
            const std::size_t done = before + first + step.size();
            progress_.advance(static_cast<double>(done) / static_cast<double>(faces.size()),
                              fmt::format("{} of {} rows", done, faces.size()));
        }
        return true;
    }

    /// Computes and keeps a few rows; returns false if a stop request left some out.
    bool compute_step(std::span<const std::size_t> faces, std::uint32_t round) {
        std::vector<std::optional<RawRow>> made(faces.size());
        parallel_own_ranges(
            faces.size(), rows_a_range,
            [&](std::size_t from, std::size_t to) {
                std::unique_ptr<RowEstimator>& estimator = estimators_[from / rows_a_range / processes()];
                if (!estimator)
                    estimator = std::make_unique<RowEstimator>(
                        *ready_,
                        RowDemand{options_.error, options_.missed_error.value_or(options_.error), options_.deviations},
                        options_.seed, stop_);
                for (std::size_t k = from; k < to && !stop_.requested(); ++k)
                    made[k] = (*estimator)(faces[k], round, shares_[faces[k]],
                                           is_pooled_[faces[k]] ? &rows_[faces[k]] : nullptr);
            },
            {"rows"});
        exchange_archived(
            std::span(made), rows_a_range, [](auto& archive, std::optional<RawRow>& row) { archive(row); }, "rows");
        bool all = true;
        for (std::size_t k = 0; k < faces.size(); ++k) {
            all &= made[k].has_value();
            if (!made[k]) continue;
            if (store_) store_->keep(*made[k]);
            rows_[faces[k]] = std::move(*made[k]), finished_[faces[k]] = 1;
        }
        if (store_) store_->flush();
        return all;
    }

    /// True if any process is over the limit. Collective.
    bool exceeds_memory() const {
        if (options_.memory_limit_bytes == SIZE_MAX) return false;
        return largest_of_all(proportional_memory_bytes() > options_.memory_limit_bytes ? 1 : 0) > 0;
    }

    const Scene& scene_;
    const RowFactorOptions& options_;
    RawRowStore* store_;
    Progress& progress_;
    const StopRequest& stop_;
    std::optional<RowScene> ready_;
    /// One for each range of a step: their counters of all faces would take longer to set up than a row.
    std::array<std::unique_ptr<RowEstimator>, rows_a_step / rows_a_range> estimators_;
    std::vector<RawRow> rows_, resumed_;
    std::vector<double> shares_;   ///< Share of R that each row may use on its own.
    std::vector<double> missing_;  ///< missing_from() of each row after the last round.
    /// 1 for each row that gets further samples in the next round; 0 if all of them are new, because the row misses 1.
    std::vector<std::uint8_t> is_pooled_;
    std::vector<std::uint8_t> finished_;
};

}  // namespace

SparseFactors compute_row_factors(const Scene& scene, const RowFactorOptions& options, RawRowStore* store,
                                  Progress& progress, const StopRequest& stop) {
    return RowRun(scene, options, store, progress, stop)();
}

}  // namespace exitance
