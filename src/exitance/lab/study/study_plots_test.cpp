#include "exitance/lab/study/study_plots.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "exitance/io/files/child_process.hpp"
#include "exitance/io/files/whole_file.hpp"

namespace exitance {
namespace {

/// Script of the plot of y = 3 x^2 at x = 1, 2, 4, where x = 2 has two rows, 9 and 16, and each x has a label 10 x.
std::string script_of(const std::string& fit, const std::string& labels) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("exitance_plots_" + fit + labels);
    Table table;
    for (const auto& [x, y] : {std::pair(1, 3), std::pair(2, 9), std::pair(2, 16), std::pair(4, 48)}) {
        table.add_row();
        table.set("row", "a"), table.set("x", std::to_string(x)), table.set("y", std::to_string(y));
        table.set("tens", std::to_string(10 * x));
    }
    Study study;
    StudyPlot& plot = study.plots.emplace_back();
    plot.name = "p", plot.x = "x", plot.y = "y", plot.log = "xy", plot.labels = labels, plot.fit = fit;
    const StopRequest stop;
    const auto drawn = draw_plots(study, {{"results", table}}, folder.string(), stop);
    EXPECT_TRUE(drawn) << drawn.error().message;
    const Result<std::string> script = read_whole_file((folder / "plots/p.gp").string());
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    return script ? *script : "";
}

class StudyPlots : public testing::Test {
    void SetUp() override {
        if (!is_program("gnuplot")) GTEST_SKIP() << "gnuplot is not installed";
    }
};

TEST_F(StudyPlots, RowsOfOneXAreOnePoint) {
    EXPECT_NE(script_of("", "").find("\n2 12\n"), std::string::npos) << "the geometric mean of 9 and 16";
}

TEST_F(StudyPlots, LegendsTellTheLawOfACurve) {
    EXPECT_NE(script_of("power", "").find("title \"a: x^2.00\""), std::string::npos);
    const std::string quadratic = script_of("quadratic", "");
    EXPECT_NE(quadratic.find("title \"a: 3 x^2 + "), std::string::npos) << quadratic;
    EXPECT_NE(quadratic.find("* x**2 + "), std::string::npos) << "the fitted curve is drawn";
}

TEST_F(StudyPlots, LabelsStandAboveTheHighestPointOfTheirX) {
    const std::string script = script_of("", "tens");
    EXPECT_NE(script.find("\n2 16 \"20\"\n"), std::string::npos) << script;
    EXPECT_EQ(script_of("", "").find("$labels"), std::string::npos);
}

}  // namespace
}  // namespace exitance
