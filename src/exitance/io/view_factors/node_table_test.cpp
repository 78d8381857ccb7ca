#include "exitance/io/view_factors/node_table.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "exitance/io/view_factors/view_factor_file.hpp"
#include "exitance/view_factors/sparse_factors.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

Result<FactorNodes> read(const std::string& text, std::size_t faces) {
    const TemporaryFolder folder;
    std::ofstream(folder / "nodes.csv") << text;
    return read_node_table(folder / "nodes.csv", faces);
}

TEST(NodeTable, GivesFacesRowsInTheOrderOfNames) {
    for (const char* text : {"face,node\n2,walls\n1,floor\n4,walls\n", "node,face\nwalls,2\nfloor,1\nwalls,4\n"}) {
        const Result<FactorNodes> nodes = read(text, 4);
        ASSERT_TRUE(nodes);
        EXPECT_EQ(nodes->names, (std::vector<std::string>{"walls", "floor"}));
        EXPECT_EQ(nodes->row_of_face, (std::vector<std::uint32_t>{1, 0, no_row, 0}));
    }
}

TEST(NodeTable, SaysWhatIsWrong) {
    EXPECT_NE(read("face,node\n5,a\n", 4).error().message.find("there is no face '5'"), std::string::npos);
    EXPECT_NE(read("face,node\n1,a\n1,b\n", 4).error().message.find("has a node already"), std::string::npos);
    EXPECT_NE(read("face,name\n1,a\n", 4).error().message.find("the header is"), std::string::npos);
    EXPECT_FALSE(read("face,node\n1,\n", 4));
    EXPECT_FALSE(read("", 4));
}

TEST(NodeTable, MergedRowsKeepSkyBackAndMeanEmittance) {
    SparseFactors table = sparse_from({{1, 3}, {0.5, 0.9}, {0, 0.6, 0.2, 0}, {0.6, 0.2}, 0});
    table.sky = {0.4, 0.6}, table.back = {0, 0.2};
    const std::vector<std::uint32_t> one = {0, 0};
    const SparseFactors merged = merge_rows(table, one, 1);
    EXPECT_DOUBLE_EQ(merged.row_values(0)[0], 0.3);  // (1 * 0.6 + 3 * 0.2) / 4
    EXPECT_DOUBLE_EQ(merged.sky[0], 0.55);
    EXPECT_DOUBLE_EQ(merged.back[0], 0.15);
    EXPECT_DOUBLE_EQ(merged.emittances[0], 0.8);
}

TEST(NodeTable, NamesSkyAndBackSurviveTheFile) {
    const TemporaryFolder folder;
    SparseFactors table = sparse_from({{1, 3}, {0.5, 0.9}, {0, 0.6, 0.2, 0}, {0.6, 0.2}, 0});
    table.sky = {0.4, 0.6}, table.back = {0, 0.2}, table.names = {"floor", "north wall"};
    ASSERT_TRUE(write_view_factors(folder / "F.h5", table, StopRequest()));
    const Result<SparseFactors> read = read_view_factors(folder / "F.h5");
    ASSERT_TRUE(read);
    EXPECT_EQ(read->names, table.names);
    EXPECT_EQ(read->sky, table.sky);
    EXPECT_EQ(read->back, table.back);
}

}  // namespace
}  // namespace exitance
