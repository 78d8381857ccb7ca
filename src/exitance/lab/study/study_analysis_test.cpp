#include "exitance/lab/study/study_analysis.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace exitance {
namespace {

/// Rows of two methods with errors 1/x and 0.1 x, and one intermediate solution each.
Table two_methods() {
    Table table{{"study", "scene", "parameter", "row", "setting", "is_last", "status"}, {}};
    for (const bool second : {false, true})
        for (const double x : {1.0, 2.0, 4.0, 8.0})
            for (const bool last : {false, true}) {
                const double error = second ? 0.1 * x : 1 / x;
                table.add_row();
                table.set("scene", "s"), table.set("parameter", field(x));
                table.set("row", second ? "b" : "a"), table.set("setting", second ? "b" : "a");
                table.set("is_last", last ? "1" : "0"), table.set("status", last ? "done" : "on the way");
                table.set("relative_rms_error", field(last ? error : 4 * error));
                table.set("processor_seconds", field((second ? 4 : 1) * (last ? 16.0 : 1.0)));
                table.set("links", field(3 * x * x + 5 * x));
            }
    return table;
}

double measured(Measure measure, const std::string& y, const RowFilter& where, const RowFilter& against = {}) {
    Study study;
    StudyConclusion c;
    c.measure = measure, c.x = "parameter", c.y = y, c.where = where, c.against = against;
    study.conclusions = {c};
    const StudyTables tables{{"results", two_methods()}};
    return judge(study, tables, false).at(0).value;
}

TEST(StudyAnalysis, FitsRecoverTheirCoefficients) {
    const std::vector<double> x{1, 2, 5, 9};
    std::vector<double> quadratic, power;
    for (double v : x) quadratic.push_back(3 * v * v + 5 * v), power.push_back(7 * std::pow(v, 1.5));
    const QuadraticFit fit = fit_quadratic(x, quadratic);
    EXPECT_NEAR(fit.sigma, 3, 1e-9);
    EXPECT_NEAR(fit.beta, 5, 1e-9);
    EXPECT_NEAR(fit.misfit, 0, 1e-9);
    EXPECT_NEAR(fit_power(x, power), 1.5, 1e-12);
    EXPECT_TRUE(std::isnan(fit_power({2, 2}, {1, 3})));
}

TEST(StudyAnalysis, RunsThatMetALimitAreNotMeasured) {
    Table table = two_methods();
    table.set("status", "memory limit");  // applies to the last row of b, at x = 8
    EXPECT_EQ(chosen_rows(table, {{"row", {"b"}}}, true).size(), 4u);
    const std::vector<std::size_t> rows = measured_rows(table, {{"row", {"b"}}}, true);
    ASSERT_EQ(rows.size(), 3u);
    for (const std::size_t row : rows) EXPECT_LT(table.number(row, "parameter"), 8);
}

TEST(StudyAnalysis, MeasuresUseFinalSolutionsOnly) {
    const RowFilter a{{"row", {"a"}}}, b{{"row", {"b"}}};
    EXPECT_NEAR(measured(Measure::slope, "relative_rms_error", a), -1, 1e-6);
    EXPECT_NEAR(measured(Measure::largest, "relative_rms_error", b), 0.8, 1e-6);
    EXPECT_NEAR(measured(Measure::last, "relative_rms_error", a), 0.125, 1e-6);
    EXPECT_NEAR(measured(Measure::quadratic_misfit, "links", a), 0, 1e-9);
    EXPECT_NEAR(measured(Measure::last_ratio, "relative_rms_error", b, a), 6.4, 1e-5);
    // The ratio of 0.1 x to 1/x is 0.1 x^2; its geometric mean over 1, 2, 4, 8 is 0.1 * 8.
    EXPECT_NEAR(measured(Measure::ratio, "relative_rms_error", b, a), 0.8, 1e-5);
    // Straight lines between x = 2 (0.5, 0.2) and x = 4 (0.25, 0.4) meet at 2 + 2 * 0.3 / 0.45.
    EXPECT_NEAR(measured(Measure::crossing, "relative_rms_error", a, b), 2 + 2 * 0.3 / 0.45, 1e-5);
    EXPECT_TRUE(std::isnan(measured(Measure::value, "relative_rms_error", {{"row", {"c"}}})));
}

TEST(StudyAnalysis, AStatementHoldsWithinItsRange) {
    Study study;
    StudyConclusion c;
    c.y = "relative_rms_error", c.measure = Measure::largest, c.where = {{"row", {"b"}}};
    c.most = 0.9;
    study.conclusions = {c, c, c};
    study.conclusions[1].most = 0.7;
    study.conclusions[2].table = "nowhere";
    const StudyTables tables{{"results", two_methods()}};
    const std::vector<Verdict> verdicts = judge(study, tables, false);
    EXPECT_EQ(verdicts[0].holds, Verdict::Holds::yes);
    EXPECT_EQ(verdicts[1].holds, Verdict::Holds::no);
    EXPECT_EQ(verdicts[2].holds, Verdict::Holds::unknown);
    const std::vector<Verdict> quick = judge(study, tables, true);
    EXPECT_EQ(quick[0].holds, Verdict::Holds::not_judged);
    EXPECT_EQ(quick[0].detail, verdicts[0].detail);
    EXPECT_EQ(quick[2].holds, Verdict::Holds::unknown);
}

TEST(StudyAnalysis, EqualTimeInterpolatesLogarithms) {
    const Table table = equal_time_table(Study(), two_methods());
    // a ends at 16 s, b at 64 s; b has 4 * 0.1 x at 4 s and 0.1 x at 64 s: half-way between, 0.2 x.
    ASSERT_EQ(table.rows.size(), 8u);
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const double x = table.number(row, "parameter");
        EXPECT_NEAR(table.number(row, "seconds"), 16, 1e-9);
        EXPECT_NEAR(table.number(row, "relative_rms_error"), table.text(row, "row") == "a" ? 1 / x : 0.2 * x, 1e-5);
    }
}

}  // namespace
}  // namespace exitance
