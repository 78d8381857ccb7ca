#include "exitance/io/view_factors/view_factor_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "exitance/io/solution/hdf5_file.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

SparseFactors written_factors() {
    return sparse_from({{1, 2}, {0.5, 0.25}, {0, 1.0 / 3, 1.0 / 6, 0}, {1.0 / 3, 1.0 / 6}, 0});
}

/// Text of a table in the format of this file name.
std::string written(const SparseFactors& table, const std::string& name) {
    const TemporaryFolder folder;
    EXPECT_TRUE(write_view_factors(folder / name, table, StopRequest()));
    std::ifstream file(folder / name);
    std::stringstream content;
    content << file.rdbuf();
    return content.str();
}

TEST(ViewFactorFile, CsvKeepsDoublesExactly) {
    std::istringstream in(written(written_factors(), "F.csv"));
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(line, "surface,area,row_sum,F_1,F_2");
    std::getline(in, line);
    EXPECT_EQ(line, "1,1,0.33333333333333331,0,0.33333333333333331");
    EXPECT_EQ(std::stod(line.substr(line.rfind(',') + 1)), 1.0 / 3);
}

TEST(ViewFactorFile, VfHoldsHeaderAreasRowsAndEmittances) {
    const std::string text = view_factors_vf(written_factors());
    EXPECT_EQ(text.find('\n'), 30u);
    std::istringstream in(text);
    std::string name, version;
    int out, encl, emit;
    std::size_t n;
    in >> name >> version >> out >> encl >> emit >> n;
    EXPECT_EQ(name, "View3D");
    EXPECT_EQ(n, 2u);
    double area[2], F[4], emittance[2];
    in >> area[0] >> area[1] >> F[0] >> F[1] >> F[2] >> F[3] >> emittance[0] >> emittance[1];
    ASSERT_TRUE(in);
    EXPECT_EQ(area[1], 2);
    EXPECT_NEAR(F[2], 1.0 / 6, 5e-7);  // written with six decimals
    EXPECT_EQ(emittance[1], 0.25);
}

TEST(ViewFactorFile, MatrixMarketHoldsNonzeroEntries) {
    std::istringstream in(written(written_factors(), "F.mtx"));
    std::string line, last;
    std::getline(in, line);
    EXPECT_EQ(line, "%%MatrixMarket matrix coordinate real general");
    while (std::getline(in, line) && line[0] == '%') last = line;
    EXPECT_EQ(last, "% 2 2");
    EXPECT_EQ(line, "2 2 2");
    std::getline(in, line);
    EXPECT_EQ(line, "1 2 0.33333333333333331");
    std::getline(in, line);
    EXPECT_EQ(line, "2 1 0.16666666666666666");
    EXPECT_FALSE(std::getline(in, line));
}

TEST(ViewFactorFile, Hdf5HoldsCompressedRows) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_view_factors(folder / "F.h5", written_factors(), StopRequest()));
    Result<Hdf5Reader> file = Hdf5Reader::open(folder / "F.h5");
    ASSERT_TRUE(file);
    EXPECT_EQ(file->read<std::int64_t>("view_factors/indptr"), (std::vector<std::int64_t>{0, 1, 2}));
    EXPECT_EQ(file->read<std::int32_t>("view_factors/indices"), (std::vector<std::int32_t>{1, 0}));
    EXPECT_EQ(file->read<double>("view_factors/data"), (std::vector<double>{1.0 / 3, 1.0 / 6}));
    EXPECT_EQ(file->read<double>("view_factors/areas"), (std::vector<double>{1, 2}));
    EXPECT_FALSE(file->failed());
}

TEST(ViewFactorFile, Hdf5IsReadBack) {
    const TemporaryFolder folder;
    SparseFactors table = written_factors();
    table.row_errors = {1e-3, 2e-3}, table.combined = true;
    ASSERT_TRUE(write_view_factors(folder / "F.h5", table, StopRequest()));
    const Result<SparseFactors> read = read_view_factors(folder / "F.h5");
    ASSERT_TRUE(read);
    EXPECT_EQ(read->starts, table.starts);
    EXPECT_EQ(read->columns, table.columns);
    EXPECT_EQ(read->values, table.values);
    EXPECT_EQ(read->row_errors, table.row_errors);
    EXPECT_TRUE(read->combined);
    EXPECT_FALSE(read_view_factors(folder / "absent.h5"));
}

TEST(ViewFactorFile, UnfinishedRowsAreOmittedFromCsvAndNamedInMatrixMarket) {
    SparseFactors table = written_factors();
    table.finished = {1, 0}, table.starts = {0, 1, 1}, table.columns.resize(1), table.values.resize(1);
    const std::string csv = written(table, "F.csv"), mtx = written(table, "F.mtx");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 2);
    EXPECT_NE(mtx.find("% 1 rows are not finished\n2 2 1\n"), std::string::npos) << mtx;
}

TEST(ViewFactorFile, AStopLeavesNoFileInAnyFormat) {
    const TemporaryFolder folder;
    StopRequest stop;
    stop.interrupt();
    for (const char* name : {"F.csv", "F.vf", "F.mtx", "F.h5"}) {
        const Result<void> written = write_view_factors(folder / name, written_factors(), stop);
        ASSERT_FALSE(written) << name;
        EXPECT_EQ(written.error().code, ErrorCode::limit);
        EXPECT_FALSE(std::filesystem::exists(folder / name));
    }
}

TEST(ViewFactorFile, IsWrittenWholeOrNotAtAll) {
    const auto folder = std::filesystem::temp_directory_path() / "exitance_view_factor_file";
    std::filesystem::create_directories(folder);
    const std::string path = (folder / "F.csv").string();
    ASSERT_TRUE(write_view_factors(path, written_factors(), StopRequest()));
    const Result<void> failed =
        write_view_factors((folder / "none" / "F.csv").string(), written_factors(), StopRequest());
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().code, ErrorCode::cannot_write);
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++files;
    EXPECT_EQ(files, 1u);
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace exitance
