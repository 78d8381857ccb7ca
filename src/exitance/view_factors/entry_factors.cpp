#include "exitance/view_factors/entry_factors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/memory.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/view_factors/row_worker.hpp"
#include "exitance/view_factors/view_pairs.hpp"

namespace exitance {
namespace {

/// Shares of the tolerance: rows that differ by less than `agreeing` are not recomputed, and quadrature uses
/// `aimed_at`. Both rows may have the same error. Measured in a town: one of 120 pairs within 0.7 of each other was
/// off by more than the tolerance, up to 1.5 times as much (2.0 at 1e-4); of those within 0.3 one of 7,500, up to 1.2
/// times. Measured by `exitance viewfactors SCENE --tolerance 1e-3` for a chair: a quarter of `agreeing` takes five
/// times as long, four times as much has twice the error; a quarter of `aimed_at` takes 1.3 times as long.
constexpr double agreeing = 0.3, aimed_at = 0.8;
/// Numbers of rows and of pairs between two progress reports.
constexpr std::size_t rows_of_process = 64, pairs_of_process = 512;

Error stopped(const std::string& what) {
    return {ErrorCode::limit, "stopped " + what, "", "allow more time or a larger --tolerance"};
}

/// True if any process is over the limit. Collective.
bool exceeds_memory(std::size_t limit) {
    return limit != SIZE_MAX && largest_of_all(proportional_memory_bytes() > limit ? 1 : 0) > 0;
}

/// Relative difference of the two rows' values for a pair of faces, by the larger one.
double disagreement(const ViewFactors& table, std::size_t i, std::size_t j) {
    const double there = table.areas[i] * table.row(i)[j], back = table.areas[j] * table.row(j)[i];
    if (!std::isfinite(there) || !std::isfinite(back)) return HUGE_VAL;  // the quadrature failed: recompute the pair
    const double larger = std::max(there, back);
    return larger > 0 ? std::abs(there - back) / larger : 0;
}

bool matters(const ViewFactors& table, std::size_t i, std::size_t j) {
    const double there = table.row(i)[j], back = table.row(j)[i];
    return !std::isfinite(there + back) || std::max(there, back) > smallest_entry;
}

struct Pair {
    std::uint32_t i, j;
};

/// Pairs i < j whose rows disagree by more than `most`.
std::vector<Pair> disagreeing(const ViewFactors& table, double most) {
    std::vector<Pair> found;
    for (std::uint32_t i = 0; i < table.size(); ++i)
        for (std::uint32_t j = i + 1; j < table.size(); ++j)
            if (matters(table, i, j) && disagreement(table, i, j) > most) found.push_back({i, j});
    return found;
}

void add_row_sums(ViewFactors& table) {
    for (std::size_t i = 0; i < table.size(); ++i) {
        double sum = 0;
        for (double F : table.row(i)) sum += F;
        table.row_sums.push_back(sum);
    }
}

/// Sets the reciprocity and entry defects of a table.
void find_defects(ViewFactors& table) {
    for (std::size_t i = 0; i < table.size(); ++i) {
        const std::span<const double> row = table.row(i);
        const double largest = *std::max_element(row.begin(), row.end());
        if (largest == 0) continue;
        for (std::size_t j = 0; j < table.size(); ++j) {
            const double difference = table.areas[i] * row[j] - table.areas[j] * table.row(j)[i];
            table.reciprocity_defect =
                std::max(table.reciprocity_defect, std::abs(difference) / (table.areas[i] * largest));
            if (matters(table, i, j)) table.entry_defect = std::max(table.entry_defect, disagreement(table, i, j));
        }
    }
}

/// Computes a table: first the rows, then again the entries on which rows disagree.
class TableMaker {
  public:
    TableMaker(ViewPairs& pairs, ViewFactors& table, double tolerance, Progress& progress, const StopRequest& stop)
        : pairs_(pairs), table_(table), tolerance_(tolerance), progress_(progress), stop_(stop) {}

    /// Finds hidden pairs once for both of their rows. In a town most pairs of faces are hidden by several houses.
    Result<void> find_hidden() {
        const std::size_t n = table_.size(), rows_a_step = rows_of_process * processes();
        progress_.phase("hidden pairs");
        for (std::size_t first = 0; first < n; first += rows_a_step) {
            const std::size_t last = std::min(first + rows_a_step, n);
            pairs_.find_hidden(first, last, stop_);
            if (stop_.requested()) return stopped("before the first row of view factors");
            progress_.advance(static_cast<double>(last) / static_cast<double>(n));
        }
        return {};
    }

    /// Computes and keeps the rows that are not finished.
    Result<void> compute_rows(std::vector<std::uint8_t>& finished, RawRowStore* store, std::size_t memory_limit) {
        const std::size_t n = table_.size(), rows_a_step = rows_of_process * processes();
        progress_.phase("view factors");
        for (std::size_t first = 0; first < n; first += rows_a_step) {
            const std::size_t count = std::min(rows_a_step, n - first);
            std::vector<std::uint8_t> made(count);
            shared_ranges(
                count, 4,
                [&](std::size_t from, std::size_t to) {
                    RowWorker worker(pairs_, aimed_at * tolerance_, stop_);
                    for (std::size_t i = first + from; i < first + to && !stop_.requested(); ++i) {
                        if (finished[i]) continue;
                        worker.compute(i, std::span(table_.factors).subspan(i * n, n));
                        made[i - first] = !stop_.requested();
                    }
                },
                [&](std::size_t k) { return std::span(table_.factors).subspan((first + k) * n, n); }, {"rows"});
            exchange_values(
                count, 4, [&](std::size_t k) -> std::uint8_t& { return made[k]; }, "rows");
            for (std::size_t k = 0; k < count; ++k) {
                finished[first + k] |= made[k];
                if (made[k] && store) store->keep(raw_row(first + k));
            }
            if (store) store->flush();
            if (stop_.requested() || exceeds_memory(memory_limit))
                return stopped(fmt::format("after {} of {} rows of view factors", first, n));
            progress_.advance(static_cast<double>(first + count) / static_cast<double>(n),
                              fmt::format("{} of {} rows", first + count, n));
        }
        return {};
    }

    /// Recomputes pairs whose two rows disagree, so that at least one is wrong: up to four times with smaller
    /// tolerances, the last times without critical lines.
    Result<void> mend() {
        struct Round {
            double share;  ///< Tolerance of this round, as a share of the requested one.
            RowWorker::Means means;
        };
        // A fifth of the tolerance, and a fifth of that. Derived from `agreeing`: two rows that are each within a fifth
        // of the tolerance usually agree.
        constexpr double finer = 0.2, finest = 0.04;
        constexpr Round rounds[] = {{finer, RowWorker::Means::usual},
                                    {finest, RowWorker::Means::usual},
                                    {finer, RowWorker::Means::without_lines},
                                    {finest, RowWorker::Means::patient}};
        progress_.phase("look again");
        const std::size_t pairs_a_step = pairs_of_process * processes();
        for (const Round& round : rounds) {
            const std::vector<Pair> pairs = disagreeing(table_, agreeing * tolerance_);
            if (&round == &rounds[0]) table_.mended = pairs.size();
            for (std::size_t first = 0; first < pairs.size(); first += pairs_a_step) {
                const std::size_t count = std::min(pairs_a_step, pairs.size() - first);
                const std::span<const Pair> some = std::span(pairs).subspan(first, count);
                shared_ranges(
                    count, 4,
                    [&](std::size_t from, std::size_t to) {
                        RowWorker worker(pairs_, aimed_at * tolerance_, stop_);
                        for (std::size_t k = from; k < to && !stop_.requested(); ++k)
                            look_again(worker, some[k], round.share * tolerance_, round.means);
                    },
                    [&](std::size_t k) -> double& { return at(some[k].i, some[k].j); }, {"pairs"});
                exchange_values(
                    count, 4, [&](std::size_t k) -> double& { return at(some[k].j, some[k].i); }, "pairs");
                if (stop_.requested())
                    return stopped(fmt::format("while {} pairs of faces were computed again", pairs.size()));
                progress_.advance(static_cast<double>(first + count) / static_cast<double>(pairs.size()));
            }
        }
        take_finite();
        table_.unsettled = disagreeing(table_, tolerance_).size();
        return {};
    }

  private:
    /// Replaces entries whose quadrature failed by the other row's entry.
    void take_finite() {
        for (std::size_t i = 0; i < table_.size(); ++i)
            for (std::size_t j = 0; j < table_.size(); ++j)
                if (!std::isfinite(at(i, j)) && std::isfinite(at(j, i)))
                    at(i, j) = table_.areas[j] * at(j, i) / table_.areas[i];
    }

    RawRow raw_row(std::size_t i) const {
        RawRow row;
        row.face = static_cast<std::uint32_t>(i);
        for (std::uint32_t j = 0; j < table_.size(); ++j)
            if (table_.row(i)[j] != 0) row.entries.push_back({table_.row(i)[j], j, 0, integrated});
        return row;
    }

    double& at(std::size_t i, std::size_t j) { return table_.factors[i * table_.size() + j]; }

    /// Recomputes both entries of a pair, and keeps them unless the old ones agree better.
    void look_again(RowWorker& worker, Pair pair, double tolerance, RowWorker::Means means) {
        const auto [i, j] = pair;
        const double before = disagreement(table_, i, j), there = at(i, j), back = at(j, i);
        at(i, j) = worker.entry(i, j, tolerance, means);
        at(j, i) = worker.entry(j, i, tolerance, means);
        if (disagreement(table_, i, j) > before) at(i, j) = there, at(j, i) = back;
    }

    ViewPairs& pairs_;
    ViewFactors& table_;
    double tolerance_;
    Progress& progress_;
    const StopRequest& stop_;
};

/// A table with only the faces' areas and emittances set.
ViewFactors empty_table(const Scene& scene) {
    ViewFactors table;
    for (SurfaceId s : scene.surfaces().ids()) {
        table.areas.push_back(scene.surfaces()[s].area);
        table.emittances.push_back(1 - mean(scene.material(s).reflectance));
    }
    table.factors.assign(table.size() * table.size(), 0);
    return table;
}

/// Restores the rows that an earlier run kept; returns 1 for each of them.
std::vector<std::uint8_t> take_resumed(RawRowStore* store, ViewFactors& table) {
    std::vector<std::uint8_t> finished(table.size());
    for (const RawRow& row : resumed_rows(store)) {
        finished[row.face] = 1;
        for (const RowEntry& entry : row.entries) table.factors[row.face * table.size() + entry.column] = entry.F;
    }
    return finished;
}

/// Runs all phases. On an error of code `limit`, `table` contains the rows marked in `finished`.
Result<void> fill(const Scene& scene, const EntryFactorOptions& options, RawRowStore* store, Progress& progress,
                  const StopRequest& stop, ViewFactors& table, std::vector<std::uint8_t>& finished) {
    ViewPairs pairs(scene, stop);
    if (stop.requested()) return stopped("before the first row of view factors");
    TableMaker maker(pairs, table, std::clamp(options.tolerance, min_entry_error, max_entry_error), progress, stop);
    if (Result<void> done = maker.find_hidden(); !done) return done;
    if (Result<void> done = maker.compute_rows(finished, store, options.memory_limit_bytes); !done) return done;
    return maker.mend();
}

}  // namespace

SparseFactors compute_entry_factors(const Scene& scene, const EntryFactorOptions& options, RawRowStore* store,
                                    Progress& progress, const StopRequest& stop) {
    ViewFactors table = empty_table(scene);
    std::vector<std::uint8_t> finished = take_resumed(store, table);
    const bool is_settled = static_cast<bool>(fill(scene, options, store, progress, stop, table, finished));
    for (std::size_t i = 0; i < table.size(); ++i)  // clears rows that a stop left incomplete
        if (!finished[i]) std::fill_n(table.factors.begin() + std::ptrdiff_t(i * table.size()), table.size(), 0.0);
    add_row_sums(table);
    if (is_settled) find_defects(table);
    SparseFactors out = sparse_from(table, options.smallest);
    out.finished = std::move(finished), out.is_settled = is_settled;
    return out;
}

}  // namespace exitance
