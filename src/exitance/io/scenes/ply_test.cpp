#include "exitance/io/scenes/ply.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>

#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

ReadScene read_ply_text(const std::string& bytes) {
    const TemporaryFolder folder;
    std::ofstream(folder / "s.ply", std::ios::binary) << bytes;
    return read_ply(folder / "s.ply");
}

std::string header(const std::string& format, const std::string& more_of_vertices = "") {
    return "ply\nformat " + format + " 1.0\ncomment by hand\nelement vertex 4\nproperty float x\nproperty float y\n" +
           more_of_vertices +
           "property float z\nelement face 2\nproperty list uchar int vertex_indices\nproperty uchar "
           "flags\nend_header\n";
}

template <class T>
void put(std::string& bytes, T value, bool big_endian) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (big_endian) std::reverse(raw, raw + sizeof value);
    bytes.append(raw, sizeof value);
}

std::string binary_body(bool big_endian) {
    std::string body;
    for (const float v : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 2.5f}) put(body, v, big_endian);
    const auto face = [&](std::initializer_list<std::int32_t> corners) {
        put(body, static_cast<std::uint8_t>(corners.size()), big_endian);
        for (const std::int32_t c : corners) put(body, c, big_endian);
        put(body, std::uint8_t(7), big_endian);
    };
    face({0, 1, 2}), face({0, 1, 2, 3});
    return body;
}

void expect_two_faces(const ReadScene& scene) {
    ASSERT_TRUE(scene.findings.empty()) << scene.findings[0].message;
    ASSERT_EQ(scene.description.faces.size(), 2u);
    EXPECT_EQ(scene.description.faces[0].corners, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(scene.description.faces[1].corners, (std::vector<std::uint32_t>{0, 1, 2, 3}));
    ASSERT_EQ(scene.description.points.size(), 4u);
    EXPECT_EQ(scene.description.points[3].z, 2.5);
}

TEST(Ply, TriangleStripsBecomeTrianglesOfOneOrientation) {
    const std::string begin =
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
        "property float z\nelement tristrips 1\nproperty list int int vertex_indices\n"
        "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n";
    const ReadScene scene = read_ply_text(begin + "9 0 1 2 3 -1 2 3 4 4\n");
    ASSERT_TRUE(scene.findings.empty()) << scene.findings[0].message;
    ASSERT_EQ(scene.description.faces.size(), 3u) << "the last one repeats a corner";
    EXPECT_EQ(scene.description.faces[0].corners, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(scene.description.faces[1].corners, (std::vector<std::uint32_t>{2, 1, 3}));
    EXPECT_EQ(scene.description.faces[2].corners, (std::vector<std::uint32_t>{2, 3, 4}));
    EXPECT_FALSE(read_ply_text(begin + "3 0 1 9\n").findings.empty()) << "there is no corner 9";
    std::string longest = begin + "20002 0";
    for (int k = 0; k < 20000; ++k) longest += " 1";
    EXPECT_EQ(read_ply_text(longest + " 2\n").findings.size(), 0u) << "a strip may be longer than a face";
}

TEST(Ply, TextAndBothByteOrdersGiveTheSameScene) {
    const ReadScene text = read_ply_text(header("ascii") + "0 0 0\n1 0 0\n1 1 0\n0 1 2.5\n3 0 1 2 7\n4 0 1 2 3 7\n");
    expect_two_faces(text);
    EXPECT_EQ(text.description.faces[0].line, 16);
    expect_two_faces(read_ply_text(header("binary_little_endian") + binary_body(false)));
    expect_two_faces(read_ply_text(header("binary_big_endian") + binary_body(true)));
}

TEST(Ply, SkipsPropertiesThatItDoesNotUseAndWarnsOfColours) {
    const ReadScene scene = read_ply_text(header("ascii", "property uchar red\n") +
                                          "0 0 255 0\n1 0 255 0\n1 1 255 0\n0 1 255 2.5\n3 0 1 2 7\n4 0 1 2 3 7\n");
    ASSERT_EQ(scene.findings.size(), 1u);
    EXPECT_EQ(scene.findings[0].kind, Finding::Kind::warning);
    EXPECT_EQ(scene.description.points[3].z, 2.5);
}

TEST(Ply, RowsWithoutContentTakeNoTime) {
    const ReadScene scene = read_ply_text(
        "ply\nformat ascii 1.0\nelement junk 9000000000000000000\nelement vertex 0\nelement face 0\n"
        "end_header\n");
    EXPECT_TRUE(scene.findings.empty());
}

TEST(Ply, BrokenFilesAreErrors) {
    const std::string rows = "0 0 0\n1 0 0\n1 1 0\n0 1 2.5\n";
    for (const std::string& bytes :
         {std::string(), std::string("hello\n"), std::string("ply\nformat ascii 1.0\n"),
          std::string("ply\nelement vertex 0\nend_header\n"), header("ascii") + rows + "3 0 1 2 7\n",
          header("ascii") + rows + "3 0 1 9 7\n3 0 1 2 7\n", header("ascii") + rows + "3 0 1 -1 7\n3 0 1 2 7\n",
          header("ascii") + "0 0 nan\n1 0 0\n1 1 0\n0 1 2\n3 0 1 2 7\n3 0 1 2 7\n", header("ascii") + "0 0 x\n",
          header("utf8") + rows, header("binary_little_endian") + binary_body(false).substr(0, 60),
          std::string("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nelement face 0\n"
                      "end_header\n1 2\n"),
          std::string("ply\nformat ascii 1.0\nelement vertex -1\nend_header\n"),
          std::string("ply\nformat ascii 2.0\nelement vertex 0\nelement face 0\nend_header\n"),
          std::string("ply\nformat ascii 1.0\nelement vertex 0\nelement vertex 0\nelement face 0\nend_header\n"),
          header("ascii") + rows + "3 0 1 1.5 7\n3 0 1 2 7\n",
          std::string("ply\nformat ascii 1.0\nproperty float x\nend_header\n")}) {
        const ReadScene scene = read_ply_text(bytes);
        ASSERT_FALSE(scene.findings.empty()) << bytes;
        EXPECT_EQ(scene.findings[0].kind, Finding::Kind::error) << bytes;
    }
}

}  // namespace
}  // namespace exitance
