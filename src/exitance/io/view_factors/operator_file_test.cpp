#include "exitance/io/view_factors/operator_file.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/solution/hdf5_file.hpp"
#include "exitance/io/view_factors/factor_rows_file.hpp"
#include "exitance/io/view_factors/view_factor_file.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

/// Three faces that see each other; the first row has a node with the other two.
FactorOperator small_operator() {
    FactorOperator out{FaceTree(std::vector<std::uint32_t>{0, 2, 1}), {}};
    out.rows.areas = {1, 2, 4}, out.rows.emittances = {0.5, 0.25, 1};
    out.rows.starts = {0, 1, 3, 5};
    out.rows.columns = {4, 0, 2, 0, 1};  // faces are 0 to 2, nodes 3 (all) and 4 (faces 2 and 1)
    out.rows.values = {0.9, 0.15, 0.85, 0.15, 0.425};
    out.rows.row_sums = {0.9, 1, 0.575}, out.rows.sky = {0.1, 0, 0.425}, out.rows.back = {0, 0, 0};
    out.rows.row_errors = {1e-3, 2e-3, 3e-3}, out.rows.dropped = {0, 0, 0}, out.rows.finished = {1, 1, 1};
    out.rows.combined = true;
    return out;
}

TEST(OperatorFile, ReadsWhatWasWritten) {
    const TemporaryFolder folder;
    FactorOperator F = small_operator();
    F.tree = FaceTree(std::vector<std::uint32_t>{1, 2, 0}), F.rows.columns[0] = 3;
    ASSERT_TRUE(write_factor_operator(folder / "F.h5", F, StopRequest()));
    const Result<FactorOperator> read = read_factor_operator(folder / "F.h5");
    ASSERT_TRUE(read) << read.error().message;
    const std::vector<double> x = {1, -2, 3};
    std::vector<double> expected(3), found(3);
    F.apply(x, expected), read->apply(x, found);
    EXPECT_EQ(found, expected);
    F.apply_transposed(x, expected), read->apply_transposed(x, found);
    EXPECT_EQ(found, expected);
    EXPECT_EQ(read->rows.row_errors, F.rows.row_errors);
    EXPECT_EQ(read->rows.sky, F.rows.sky);
    EXPECT_TRUE(read->rows.combined);
}

TEST(OperatorFile, IsToldFromATable) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_factor_operator(folder / "F.h5", small_operator(), StopRequest()));
    const SparseFactors table = sparse_from({{1, 2}, {0.5, 0.25}, {0, 1.0 / 3, 1.0 / 6, 0}, {1.0 / 3, 1.0 / 6}, 0});
    ASSERT_TRUE(write_view_factors(folder / "t.h5", table, StopRequest()));
    const auto as_operator = read_factors(folder / "F.h5"), as_table = read_factors(folder / "t.h5");
    ASSERT_TRUE(as_operator && as_table);
    EXPECT_TRUE(std::holds_alternative<FactorOperator>(*as_operator));
    EXPECT_TRUE(std::holds_alternative<SparseFactors>(*as_table));
    EXPECT_FALSE(read_view_factors(folder / "F.h5"));
    EXPECT_FALSE(read_factor_operator(folder / "t.h5"));
}

TEST(OperatorFile, RefusesWrongColumnsAndOrders) {
    const TemporaryFolder folder;
    FactorOperator F = small_operator();
    F.rows.columns[0] = 5;
    ASSERT_TRUE(write_factor_operator(folder / "column.h5", F, StopRequest()));
    EXPECT_EQ(read_factor_operator(folder / "column.h5").error().code, ErrorCode::bad_input);
    F = small_operator(), F.tree = FaceTree(std::vector<std::uint32_t>{0, 1, 1});
    ASSERT_TRUE(write_factor_operator(folder / "order.h5", F, StopRequest()));
    EXPECT_EQ(read_factor_operator(folder / "order.h5").error().code, ErrorCode::bad_input);
}

}  // namespace
}  // namespace exitance
