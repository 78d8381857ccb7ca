#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/cli/json_output.hpp"
#include "exitance/cli/terminal.hpp"
#include "exitance/view_factors/factor_operator.hpp"

namespace exitance {

/// Number of rows that a stopped run has left without values.
std::size_t unfinished_rows(const SparseFactors& table);

/// Returns the facts that follow from a table of view factors alone. `seconds`: time of its computation.
ViewFactorFacts facts_of(const SparseFactors& table, double seconds);
/// Returns the facts about an operator, and measures the time of a product.
OperatorFacts facts_of(const FactorOperator& transport);

/// Number of checked rows that miss the error: those of an operator in its products, those of a table also in the sum
/// of squared errors.
std::size_t wrong_rows(const ViewFactorFacts& facts);

/// Formats the facts as a summary for people.
std::string words_of(const ViewFactorFacts& facts);

/// Beginning of the warning that a scene has no light, which view factors do not need.
inline constexpr std::string_view missing_light[]{"nothing emits light"};

/// Shows findings, except warnings that begin with one of the given words.
void show_findings_without(std::span<const std::string_view> beginnings, std::vector<Finding> findings,
                           Terminal& terminal);

}  // namespace exitance
