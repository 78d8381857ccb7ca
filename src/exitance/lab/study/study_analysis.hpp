#pragma once

#include "exitance/lab/study/study_run.hpp"

namespace exitance {

/// Returns the rows that a filter accepts. `last_only`: if there is a column `is_last`, only final solutions.
std::vector<std::size_t> chosen_rows(const Table& table, const RowFilter& where, bool last_only);

/// Like `chosen_rows`, without runs that exceeded a limit, failed or did not run, since their costs are meaningless.
std::vector<std::size_t> measured_rows(const Table& table, const RowFilter& where, bool last_only);

/// Result of a conclusion.
struct Verdict {
    const StudyConclusion* conclusion = nullptr;
    /// `not_judged`: measured in a quick run, whose scenes and settings are too few for the statement.
    enum class Holds : std::uint8_t { yes, no, unknown, not_judged } holds = Holds::unknown;
    double value = std::numeric_limits<double>::quiet_NaN();
    std::string detail;  ///< For example "1.93, asked 1.6 to 2.4".
};
/// Measures and judges the conclusions of a study; those of a quick run are measured only.
std::vector<Verdict> judge(const Study& study, const StudyTables& tables, bool quick);

/// Fit of y = sigma x^2 + beta x by least squares of relative errors.
struct QuadraticFit {
    double sigma = 0, beta = 0;
    double misfit = 0;  ///< Relative RMS error.
};
QuadraticFit fit_quadratic(const std::vector<double>& x, const std::vector<double>& y);

/// Returns the exponent of y ~ x^p by least squares of logarithms; NaN for fewer than two different x.
double fit_power(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace exitance
