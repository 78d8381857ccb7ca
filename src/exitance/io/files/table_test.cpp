#include "exitance/io/files/table.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

TEST(Table, IsReadAsWritten) {
    const TemporaryFolder folder;
    Table table{{"row", "error"}, {}};
    table.add_row();
    table.set("row", "Haar, \"exact\"\nvisibility");
    table.set("error", field(0.125));
    table.add_row();
    table.set("new", "x");
    ASSERT_TRUE(write_csv(folder / "t.csv", table));
    const Result<Table> read = read_csv(folder / "t.csv");
    ASSERT_TRUE(read);
    EXPECT_EQ(read->columns, table.columns);
    EXPECT_EQ(read->rows, table.rows);
    EXPECT_EQ(read->number(0, "error"), 0.125);
    EXPECT_TRUE(std::isnan(read->number(1, "error")));
    EXPECT_EQ(read->text(0, "nowhere"), "");
}

TEST(Table, WritesTheColumnsThatAreAskedFor) {
    const TemporaryFolder folder;
    Table table{{"a", "b"}, {{"1", "2"}}};
    ASSERT_TRUE(write_csv(folder / "t.csv", table, {"b", "c"}));
    const Result<Table> read = read_csv(folder / "t.csv");
    ASSERT_TRUE(read);
    EXPECT_EQ(read->columns, (std::vector<std::string>{"b", "c"}));
    EXPECT_EQ(read->rows, (std::vector<std::vector<std::string>>{{"2", ""}}));
}

TEST(Table, ARowWithTooFewFieldsIsAnError) {
    const Result<Table> table = parse_csv("a,b\n1,2\n3\n", "t.csv");
    ASSERT_FALSE(table);
    EXPECT_EQ(table.error().where, "t.csv:3");
}

TEST(Table, LinesOfBlanksAndAByteOrderMarkAreSkipped) {
    const Result<Table> table = parse_csv(
        "\xef\xbb\xbf"
        "a,b\r\n1,2\r\n\r\n3,\"4\n5\"\n \t\n\n",
        "t.csv");
    ASSERT_TRUE(table) << table.error().message;
    EXPECT_EQ(table->columns, (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(table->rows, (std::vector<std::vector<std::string>>{{"1", "2"}, {"3", "4\n5"}}));
    const Result<Table> single = parse_csv("a\n1\n\"\"\n\n", "t.csv");
    ASSERT_TRUE(single) << single.error().message;
    EXPECT_EQ(single->rows, (std::vector<std::vector<std::string>>{{"1"}, {""}}));
}

TEST(Table, AnEmptyFieldAloneInItsLineIsKept) {
    const TemporaryFolder folder;
    const Table table{{"a"}, {{"1"}, {""}, {"2"}, {""}}};
    ASSERT_TRUE(write_csv(folder / "t.csv", table));
    const Result<Table> read = read_csv(folder / "t.csv");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->rows, table.rows);
}

TEST(Table, AnOpenQuoteIsAnErrorThatNamesItsLine) {
    const Result<Table> table = parse_csv("a,b\n\"1\n2\",3\n\"4,5\n6,7\n", "t.csv");
    ASSERT_FALSE(table);
    EXPECT_EQ(table.error().where, "t.csv:4");
    EXPECT_EQ(table.error().message, "a quote is not closed");
}

TEST(Table, ColumnsOfOneNameAreCounted) {
    const Result<Table> table = parse_csv("a,b,a\n1,2,3\n", "t.csv");
    ASSERT_TRUE(table);
    EXPECT_EQ(table->count("a"), 2u);
    EXPECT_EQ(table->count("b"), 1u);
    EXPECT_EQ(table->count("c"), 0u);
}

TEST(Table, AppendsByTheNamesOfColumns) {
    Table table{{"a", "b"}, {{"1", "2"}}};
    table.append(Table{{"b", "c"}, {{"3", "4"}}});
    EXPECT_EQ(table.columns, (std::vector<std::string>{"a", "b", "c"}));
    EXPECT_EQ(table.rows[1], (std::vector<std::string>{"", "3", "4"}));
}

}  // namespace
}  // namespace exitance
