#include "exitance/cli/verbs/factor_facts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/base/distinct_numbers.hpp"

namespace exitance {

std::size_t unfinished_rows(const SparseFactors& table) {
    return static_cast<std::size_t>(std::count(table.finished.begin(), table.finished.end(), 0));
}

ViewFactorFacts facts_of(const SparseFactors& table, double seconds) {
    ViewFactorFacts facts;
    facts.surfaces = table.size(), facts.entries = table.entries(), facts.seconds = seconds;
    facts.finished_rows = table.size() - unfinished_rows(table);
    facts.has_defects = facts.finished_rows == facts.surfaces && table.is_settled;
    facts.reciprocity_defect = table.reciprocity_defect, facts.closure_defect = table.closure_defect;
    facts.entry_defect = table.entry_defect;
    facts.mended = table.mended, facts.unsettled = table.unsettled, facts.unclosed = table.unclosed;
    for (std::size_t i = 0; i < table.size(); ++i) {
        if (!table.finished[i]) continue;
        if (!table.row_errors.empty()) facts.row_error = std::max(facts.row_error, table.row_errors[i]);
        if (!table.dropped.empty()) facts.dropped = std::max(facts.dropped, table.dropped[i]);
        facts.min_row_sum = std::min(facts.min_row_sum, table.row_sums[i]);
        facts.max_row_sum = std::max(facts.max_row_sum, table.row_sums[i]);
    }
    if (facts.finished_rows == 0) facts.min_row_sum = 0;
    return facts;
}

OperatorFacts facts_of(const FactorOperator& transport) {
    OperatorFacts facts;
    facts.entries = transport.rows.entries(), facts.node_entries = transport.node_entries();
    for (std::size_t i = 0; i < transport.size(); ++i)
        if (transport.rows.finished[i]) facts.row_error = std::max(facts.row_error, transport.rows.row_errors[i]);
    facts.closure_defect = transport.closure_defect();
    const std::vector<double> x(transport.size(), 1);
    std::vector<double> y(transport.size());
    const Stopwatch time;
    transport.apply(x, y);
    facts.product_seconds = time.seconds();
    return facts;
}

std::size_t wrong_rows(const ViewFactorFacts& facts) {
    return facts.transport ? facts.row_check.wrong_sums : facts.row_check.wrong;
}

namespace {

std::string words_of_rows(const ViewFactorFacts& facts) {
    const NumberTexts errors = distinct_texts(facts.row_error, facts.error);
    std::string text = fmt::format("error of rows at most {} (requested {}); {} entries\n", errors.first, errors.second,
                                   facts.entries);
    if (facts.dropped > 0)
        text += fmt::format("dropped: entries below {:g}, at most {:.3g} in a row\n", facts.smallest, facts.dropped);
    if (facts.has_defects)
        text += fmt::format(
            "rows computed independently: reciprocity defect {:.2g} of a row's largest entry, closure defect {:.2g}\n",
            facts.reciprocity_defect, facts.closure_defect);
    if (facts.transport)
        text += fmt::format(
            "operator: {} entries, {} of them nodes; error of rows at most {:.3g}, closure defect {:.2g}; product "
            "{:.2g} "
            "s\n",
            facts.transport->entries, facts.transport->node_entries, facts.transport->row_error,
            facts.transport->closure_defect, facts.transport->product_seconds);
    if (!facts.row_check.rows.empty())
        text += fmt::format(
            "rays: {} random rows, {} rays each: error {:.2g}, sums over rows and groups {:.2g}; {} rows above the "
            "error requested, where these rays find any error above {:.2g}\n",
            facts.row_check.rows.size(), facts.row_check.rays / facts.row_check.rows.size(), facts.row_check.error,
            facts.row_check.sum_error, wrong_rows(facts),
            facts.transport ? facts.row_check.detectable_sum : facts.row_check.detectable_error);
    return text;
}

std::string words_of_entries(const ViewFactorFacts& facts) {
    std::string text;
    if (facts.has_defects)
        text = fmt::format(
            "reciprocity: entries above 1e-6 agree to {:.2g}, {:.2g} of their rows' largest; {} pairs computed again\n",
            facts.entry_defect, facts.reciprocity_defect, facts.mended);
    const RayCheck& check = facts.check;
    if (check.entries > 0)
        text += fmt::format(
            "rays: {} random entries, {} off by more than the tolerance and six standard errors of {} "
            "rays each; largest deviation {:.2g} of the entry, where the standard error of the rays is {:.2g} (median "
            "{:.2g})\n",
            check.entries, check.wrong, check.rays / check.entries, check.largest_relative, check.relative_error_there,
            check.usual_relative_error);
    return text;
}

}  // namespace

std::string words_of(const ViewFactorFacts& facts) {
    return fmt::format("{} surfaces, row sums from {:.6f} to {:.6f}, {:.3g} s\n", facts.surfaces, facts.min_row_sum,
                       facts.max_row_sum, facts.seconds) +
           (facts.tolerance ? words_of_entries(facts) : words_of_rows(facts));
}

void show_findings_without(std::span<const std::string_view> beginnings, std::vector<Finding> findings,
                           Terminal& terminal) {
    std::erase_if(findings, [&](const Finding& f) {
        return f.kind == Finding::Kind::warning &&
               std::any_of(beginnings.begin(), beginnings.end(),
                           [&](std::string_view words) { return f.message.starts_with(words); });
    });
    terminal.show(findings);
}

}  // namespace exitance
