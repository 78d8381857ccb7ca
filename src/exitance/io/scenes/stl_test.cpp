#include "exitance/io/scenes/stl.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

ReadScene read_stl_text(const std::string& bytes) {
    const TemporaryFolder folder;
    std::ofstream(folder / "s.stl", std::ios::binary) << bytes;
    return read_stl(folder / "s.stl");
}

std::string triangle(float last) {
    const float numbers[12] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 2, last};
    std::string bytes(50, '\0');
    std::memcpy(bytes.data(), numbers, sizeof numbers);
    return bytes;
}

std::string binary(const std::string& header, std::uint32_t count, const std::string& triangles) {
    std::string bytes = header;
    bytes.resize(84, ' ');
    std::memcpy(bytes.data() + 80, &count, sizeof count);
    return bytes + triangles;
}

TEST(Stl, AsciiFacetsBecomeTrianglesAndSolidsGroups) {
    const std::string facet =
        "  facet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1e0 0 0\n vertex 0 2 0\n endloop\n endfacet\n";
    const ReadScene scene =
        read_stl_text("solid one thing\n" + facet + facet + "endsolid\nsolid\n" + facet + "endsolid\n");
    EXPECT_TRUE(scene.findings.empty());
    ASSERT_EQ(scene.description.faces.size(), 3u);
    EXPECT_EQ(scene.description.groups, (std::vector<std::string>{"one thing", "default"}));
    EXPECT_EQ(scene.description.faces[2].group, 1u);
    EXPECT_EQ(scene.description.faces[0].line, 3);
    EXPECT_EQ(scene.description.points[2].y, 2);
}

TEST(Stl, BinaryIsDetectedByItsLengthEvenIfItBeginsLikeText) {
    const ReadScene scene =
        read_stl_text(binary("solid from a program that ought to know better", 2, triangle(3) + triangle(4)));
    EXPECT_TRUE(scene.findings.empty());
    ASSERT_EQ(scene.description.faces.size(), 2u);
    EXPECT_EQ(scene.description.points[5].z, 4);
}

TEST(Stl, BrokenFilesAreErrors) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const std::string& bytes :
         {binary("x", 3, triangle(0)), binary("x", 1, triangle(nan)), std::string("hello"), std::string(),
          std::string("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\n"),
          std::string("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"),
          std::string("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"), std::string("solid s\ncube 1\n")}) {
        const ReadScene scene = read_stl_text(bytes);
        ASSERT_FALSE(scene.findings.empty()) << bytes;
        EXPECT_EQ(scene.findings[0].kind, Finding::Kind::error);
    }
}

}  // namespace
}  // namespace exitance
