#include "exitance/io/files/probe_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

class ProbeFiles : public testing::Test {
  protected:
    std::string file(const std::string& name, const std::string& content) const {
        std::ofstream(folder / name) << content;
        return folder / name;
    }
    TemporaryFolder folder;
};

TEST_F(ProbeFiles, MayHaveColumnsInAnyOrderAmongOthers) {
    const auto read = load_probe_points(file("p.csv",
                                             "\xef\xbb\xbfname, z,y,x ,\"nz\",ny,nx,E_r\r\n"
                                             "\"a,b\",3,2,1,1,0,0,\r\n"
                                             "\r\n# a comment\r\nc,6,5,+4e0,0,0,-2,7\r\n"));
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->size(), 2u);
    EXPECT_EQ(read->points[0], (Point{1, 2, 3}));
    EXPECT_EQ(read->normals[0], (Normal{0, 0, 1}));
    EXPECT_EQ(read->points[1], (Point{4, 5, 6}));
    EXPECT_EQ(read->normals[1], (Normal{-1, 0, 0}));
}

TEST_F(ProbeFiles, MayBePlainLinesOfSixNumbers) {
    const std::string text = "# Radiance's order\n1 2 3 0 0 1\n\t4  5 6\t0 -1 0 and more\n7 8 9 1 0 0";
    for (const char* name : {"p.pts", "p.txt"}) {
        const auto read = load_probe_points(file(name, text));
        ASSERT_TRUE(read) << read.error().message;
        ASSERT_EQ(read->size(), 3u);
        EXPECT_EQ(read->points[1], (Point{4, 5, 6}));
        EXPECT_EQ(read->normals[1], (Normal{0, -1, 0}));
        EXPECT_EQ(read->points[2], (Point{7, 8, 9}));
    }
}

TEST_F(ProbeFiles, CanBeReadInBatches) {
    std::string text = "x,y,z,nx,ny,nz\n";
    for (int i = 0; i < 1000; ++i) text += std::to_string(i) + ",0,0,0,0,1\n";
    Result<ProbeReader> reader = ProbeReader::open(file("p.csv", text));
    ASSERT_TRUE(reader);
    ProbePoints some;
    int count = 0;
    do {
        ASSERT_TRUE(reader->next(some, 64));
        for (const Point& p : some.points) EXPECT_EQ(p.x, count++);
    } while (some.size() > 0);
    EXPECT_EQ(count, 1000);
}

TEST_F(ProbeFiles, ReportTheLineOfAnError) {
    const std::string header = "x,y,z,nx,ny,nz\n1,2,3,0,0,1\n";
    const struct {
        std::string name, text, where, message;
    } cases[] = {
        {"a.csv", header + "1,2,3,0,0\n", "a.csv:3", "column nz is empty"},
        {"b.csv", header + "1,2,3,0,zero,1\n", "b.csv:3", "column ny holds \"zero\", not a finite number"},
        {"c.csv", header + "1,nan,3,0,0,1\n", "c.csv:3", "column y holds \"nan\", not a finite number"},
        {"d.csv", header + "1,1e999,3,0,0,1\n", "d.csv:3", "column y holds \"1e999\", not a finite number"},
        {"e.csv", header + "1,2,3,0,0,0\n", "e.csv:3", "the normal has no direction"},
        {"f.csv", "x,y,z,nx,ny\n", "f.csv:1", "the header has no column nz"},
        {"g.csv", "", "g.csv", "holds no points"},
        {"h.csv", "1,2,3,0,0,1\n", "h.csv:1", "the header has no column x"},
        {"s.csv", "x;y;z;nx;ny;nz\n1,5;2;3;0;0;1\n", "s.csv:1", "the header has no column x"},
        {"i.pts", "1 2 3 0 0 1\n1 2 3 0 0\n", "i.pts:2", "the line does not begin with six numbers"},
        {"j.pts", "1 2 3 0 0 0\n", "j.pts:1", "the normal has no direction"},
    };
    for (const auto& c : cases) {
        const auto read = load_probe_points(file(c.name, c.text));
        ASSERT_FALSE(read) << c.name;
        EXPECT_EQ(read.error().code, ErrorCode::bad_input);
        EXPECT_EQ(read.error().where, folder / c.where);
        EXPECT_EQ(read.error().message, c.message);
    }
    EXPECT_NE(load_probe_points(folder / "s.csv").error().hint.find("commas"), std::string::npos);
    EXPECT_EQ(load_probe_points(folder / "none.csv").error().code, ErrorCode::cannot_read);
    EXPECT_EQ(load_probe_points(fs::path(folder / "").parent_path().string()).error().code, ErrorCode::cannot_read);
}

TEST_F(ProbeFiles, LinesMayBeLongerThanABlock) {
    const auto read = load_probe_points(
        file("p.csv", "x,y,z,nx,ny,nz,note\n1,2,3,0,0,1," + std::string(1 << 20, 'n') + "\n4,5,6,0,0,1,\n"));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->points[1], (Point{4, 5, 6}));
}

TEST_F(ProbeFiles, AreReadBackAsWritten) {
    if (bands != 3) return;
    const std::string path = folder / "o.csv";
    Result<ProbeWriter> writer = ProbeWriter::create(path, {.radiosity = true, .standard_errors = true});
    ASSERT_TRUE(writer);
    Spectrum e, b, se;
    for (std::size_t i = 0; i < bands; ++i) e[i] = 1.0 / double(3 + i), b[i] = 1e-7 * double(i), se[i] = 12345.0;
    const Point p = {0.1, -1e-17, 1 / 3.0};
    const Normal n = normalized({1, 2, 3});
    writer->add(p, n, e, b, se);
    writer->add(p, n, e, {}, se);
    ASSERT_TRUE(writer->commit());

    std::ifstream in(path);
    std::string header, first, second;
    std::getline(in, header), std::getline(in, first), std::getline(in, second);
    EXPECT_EQ(header, "x,y,z,nx,ny,nz,E_r,E_g,E_b,B_r,B_g,B_b,se_r,se_g,se_b");
    EXPECT_TRUE(first.ends_with(",0.3333333333,0.25,0.2,0,1e-07,2e-07,12345,12345,12345")) << first;
    EXPECT_TRUE(second.ends_with(",0.3333333333,0.25,0.2,,,,12345,12345,12345")) << second;

    const auto read = load_probe_reference(path);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->probes.points[0], p);
    EXPECT_EQ(read->probes.normals[0], n);
    EXPECT_NEAR(read->irradiance[0][0], e[0], 1e-10);  // written with 10 digits
    EXPECT_EQ(read->standard_errors[1], se);
}

TEST_F(ProbeFiles, ReferencesNeedIrradianceButNoErrors) {
    if (bands != 3) return;
    const auto read = load_probe_reference(file("r.csv", "x,y,z,nx,ny,nz,E_r,E_g,E_b\n1,2,3,0,0,1,4,5,6\n"));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->irradiance[0][2], 6);
    EXPECT_TRUE(read->standard_errors.empty());
    EXPECT_FALSE(load_probe_reference(file("s.csv", "x,y,z,nx,ny,nz,E_r,E_g\n1,2,3,0,0,1,4,5\n")));
    EXPECT_FALSE(load_probe_reference(file("t.csv", "x,y,z,nx,ny,nz,E_r,E_g,E_b\n")));
}

}  // namespace
}  // namespace exitance
