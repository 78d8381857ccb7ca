#pragma once

#include "exitance/lab/study/study_run.hpp"

namespace exitance {

/// The rows that a filter lets through; `last_only`: of those with the column `is_last`, the last solutions alone.
std::vector<std::size_t> chosen_rows(const Table& table, const RowFilter& where, bool last_only);

/// The same without runs that met a limit, failed or did not run: what they took says nothing of what they would take.
std::vector<std::size_t> measured_rows(const Table& table, const RowFilter& where, bool last_only);

/// What a conclusion came to.
struct Verdict {
    const StudyConclusion* conclusion = nullptr;
    enum class Holds : std::uint8_t { yes, no, unknown } holds = Holds::unknown;
    double value = std::numeric_limits<double>::quiet_NaN();
    std::string detail;  ///< "1.93, asked 1.6 to 2.4"
};
std::vector<Verdict> judge(const Study& study, const StudyTables& tables);

/// y = sigma x^2 + beta x by least squares of relative misfits.
struct QuadraticFit {
    double sigma = 0, beta = 0;
    double misfit = 0;  ///< Relative, root mean square.
};
QuadraticFit fit_quadratic(const std::vector<double>& x, const std::vector<double>& y);

/// The exponent of y ~ x^p by least squares of logarithms; NaN with fewer than two different x.
double fit_power(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace exitance
