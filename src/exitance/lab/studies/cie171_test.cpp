#include "exitance/lab/studies/cie171.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/io/files/probe_file.hpp"
#include "exitance/lab/cie171/exact_sky.hpp"
#include "exitance/lab/cie171/page.hpp"
#include "support/places.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

std::vector<Cie171Row> run(const std::string& only) {
    Progress progress;
    Cie171Options options;
    options.only = only, options.quick = true;
    const Result<std::vector<Cie171Row>> rows = run_cie171(options, progress, StopRequest());
    EXPECT_TRUE(rows) << rows.error().message;
    return rows ? *rows : std::vector<Cie171Row>();
}

double largest_error(const std::string& only) {
    double largest = 0;
    for (const Cie171Row& row : run(only)) largest = std::max(largest, row.relative_error);
    return largest;
}

TEST(Cie171, LampsAndDiffuseSurfacesAreExact) {
    EXPECT_LT(largest_error("5.2"), 5e-4);  // the source is a cube of a millimetre
    EXPECT_LT(largest_error("5.3"), 1e-5);
    EXPECT_LT(largest_error("5.4"), 1e-8);
    EXPECT_LT(largest_error("5.6"), 1e-10);
    EXPECT_LT(largest_error("5.7"), 1e-10);
}

TEST(Cie171, SkiesBehindAMaskAreAccurateToAThousandth) {
    EXPECT_LT(largest_error("5.13"), 1e-3);
}

TEST(Cie171, TheUniformSkyIsADiffuseOpening) {
    const Cie171Skies skies({0, 0.5, std::sqrt(0.75)});
    const SkyOpening opening{{0, 0, 3}, {1, 0, 0}, {0, 1, 0}, 1.5, 2.5, 1.5, 2.5};
    const std::vector<Point> polygon{{1.5, 1.5, 3}, {1.5, 2.5, 3}, {2.5, 2.5, 3}, {2.5, 1.5, 3}};
    for (const auto& [x, n] : {std::pair<Point, Normal>{{2, 0, 2.75}, {0, 1, 0}}, {{2, 0.3, 0}, {0, 0, 1}}}) {
        const double lambert = cie171_horizontal_lux * point_to_polygon(x, n, polygon);
        EXPECT_NEAR(illuminance_through(opening, x, n, skies)[4] / lambert, 1, 1e-8);
    }
}

/// Compares the exact values of rows with those of another program.
TEST(Cie171, ExactValuesAgreeWithTheReferences) {
    const std::filesystem::path folder = std::filesystem::path(test::data_folder()) / "reference/cie171";
    if constexpr (bands != 3) GTEST_SKIP() << "the references have three bands";
    const auto compare = [&](const std::string& file, const std::vector<Cie171Row>& rows, auto belongs) {
        const Result<ProbeReference> reference = load_probe_reference((folder / file).string());
        ASSERT_TRUE(reference) << file;
        std::size_t found = 0;
        for (const Cie171Row& row : rows) {
            if (!belongs(row)) continue;
            for (std::size_t i = 0; i < reference->irradiance.size(); ++i)
                if (norm(reference->probes.points[i] - row.x) < 1e-9 &&
                    norm(reference->probes.normals[i] - row.n) < 1e-9) {
                    ++found;
                    EXPECT_NEAR(row.exact, reference->irradiance[i][0], 1e-7 * (1e-3 + row.exact)) << file << row.point;
                }
        }
        EXPECT_GE(found, 8u) << file;
    };
    const auto any = [](const Cie171Row&) { return true; };
    compare("5_3/area_source_reference.csv", run("5.3"), any);
    compare("5_7/obstruction_reference.csv", run("5.7"), any);
    const std::vector<Cie171Row> factors = run("5.6");
    for (const char* scene : {"s1_50cm", "s2_4m", "s3_500m"})
        compare(std::string("5_6/") + scene + "_reference.csv", factors,
                [&](const Cie171Row& row) { return row.scene == scene; });
    const std::vector<Cie171Row> masks = run("5.14");
    for (const char* height : {"3", "6", "9"})
        for (const char* sky : {"01", "05", "12", "15"})
            compare(std::string("5_14/wall_") + height + "_sky" + sky + "_reference.csv", masks,
                    [&](const Cie171Row& row) {
                        return row.scene == std::string("wall_") + height &&
                               row.parameter == "sky=" + std::to_string(std::stoi(sky));
                    });
}

TEST(Cie171, WritesResultsAndSummary) {
    const TemporaryFolder folder;
    const std::vector<Cie171Row> rows = run("5.7");
    ASSERT_TRUE(write_cie171(folder / "new/results", rows));
    EXPECT_TRUE(std::filesystem::exists(folder / "new/results/results.csv"));
    const std::vector<Cie171Summary> summary = summarize(rows);
    ASSERT_EQ(summary.size(), 1u);
    EXPECT_EQ(summary[0].points, 11u);
    Progress progress;
    EXPECT_FALSE(run_cie171({.only = "5.5"}, progress, StopRequest()));
}

TEST(Cie171, ThePageListsTheWorstValuesAndPublishedErrors) {
    std::vector<Cie171Row> rows{{"5.3", "room", "", "A", {}, {}, 100, 101, 0.01},
                                {"5.3", "room", "", "B", {}, {}, 2000, 2100, 0.05},
                                {"5.8", "cube", "rho=0.5", "C", {}, {}, 310.98, 310.98, 0}};
    const std::string page = cie171_page(rows);
    EXPECT_NE(page.find("| 5.3 | area source in a ceiling | 2 | 3% | 5% | about 0 (Iray); 4.9% (Cycles) |"),
              std::string::npos)
        << page;
    EXPECT_NE(page.find("| 5.3 | room | B | 2000.0 | 2100.0 | 5% |"), std::string::npos);
    EXPECT_NE(page.find("| 5.8 | cube | rho=0.5, C | 310.98 | 310.98 | 0 |"), std::string::npos);
}

}  // namespace
}  // namespace exitance
