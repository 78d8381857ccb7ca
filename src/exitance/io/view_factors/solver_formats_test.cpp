#include "exitance/io/view_factors/solver_formats.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "exitance/io/view_factors/view_factor_file.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

SparseFactors two_faces() {
    SparseFactors table = sparse_from({{1, 2}, {0.5, 0.25}, {0, 0.5, 0.25, 0}, {0.5, 0.25}, 0});
    table.names = {"floor, north", "roof"}, table.sky = {0.4, 0.75}, table.back = {0.1, 0};
    return table;
}

std::string written(const std::string& name, const FactorFileOptions& options, const std::string& part = "") {
    const TemporaryFolder folder;
    EXPECT_TRUE(write_view_factors(folder / name, two_faces(), StopRequest(), options));
    std::ifstream in(folder / (name + part));
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

TEST(SolverFormats, EnergyPlusGetsAllPairsUnderTheNamesOfSurfaces) {
    EXPECT_EQ(written("F.idf", {.zone = "hall"}),
              "ZoneProperty:UserViewFactors:BySurfaceName,\n  hall,\n  floor_ north,floor_ north,0,\n"
              "  floor_ north,roof,0.5,\n  roof,floor_ north,0.25,\n  roof,roof,0;\n");
}

TEST(SolverFormats, PairsHaveIdsFromZeroAndTheSkyBehindTheLastFace) {
    EXPECT_EQ(written("F.csv", {.format = FactorFormat::pairs}), "from_id,to_id,F\n0,1,0.5\n1,0,0.25\n");
    EXPECT_EQ(
        written("F.csv", {.format = FactorFormat::pairs, .with_sky = true}),
        "from_id,to_id,F\n0,1,0.5\n0,2,0.40000000000000002\n0,3,0.10000000000000001\n1,0,0.25\n1,2,0.75\n1,3,0\n");
}

TEST(SolverFormats, OpenFoamGetsTwoListsOfLists) {
    const FactorFileOptions options{.format = FactorFormat::openfoam};
    const std::string F = written("constant", options, "/F"),
                      columns = written("constant", options, "/globalFaceFaces");
    EXPECT_NE(F.find("class       scalarListList;"), std::string::npos);
    EXPECT_NE(F.find("\n2\n(\n1(0.5 )\n1(0.25 )\n)\n"), std::string::npos) << F;
    EXPECT_NE(columns.find("class       labelListList;"), std::string::npos);
    EXPECT_NE(columns.find("\n2\n(\n1(1 )\n1(0 )\n)\n"), std::string::npos) << columns;
}

TEST(SolverFormats, MatricesGetTwoMoreColumns) {
    EXPECT_EQ(written("F.csv", {.with_sky = true}),
              "surface,area,row_sum,F_1,F_2,sky,back\n1,1,0.5,0,0.5,0.40000000000000002,0.10000000000000001\n"
              "2,2,0.25,0.25,0,0.75,0\n");
    EXPECT_NE(written("F.mtx", {.with_sky = true}).find("\n2 4 6\n1 2 0.5\n1 3 0.4"), std::string::npos);
}

}  // namespace
}  // namespace exitance
