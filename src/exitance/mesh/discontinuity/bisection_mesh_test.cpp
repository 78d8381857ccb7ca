#include "exitance/mesh/discontinuity/bisection_mesh.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

BisectionMesh square_with_jump() {
    const std::vector<std::vector<Vec2>> loops = {{{0, 0}, {2, 0}, {2, 1}, {0, 1}}};
    const LabelledSegment lines[] = {
        {{0.5, 0.2}, {1.2, 0.2}, 1}, {{1.2, 0.2}, {1.2, 0.7}, 1}, {{0.1, 0.9}, {1.9, 0.1}, 3}};
    BisectionMesh mesh(1e-6);
    mesh.add(labelled_triangles(loops, lines), PlaneFrame({0, 0, 3}, {0, 0, 1}));
    return mesh;
}

double area(const BisectionMesh& mesh) {
    double sum = 0;
    for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) sum += mesh.area(t);
    return sum;
}

TEST(BisectionMesh, TrianglesStayConformingAndShareNodesAfterManyBisections) {
    BisectionMesh mesh = square_with_jump();
    RandomStream random(1, Stream::mesh);
    for (int i = 0; i < 500; ++i) mesh.bisect(static_cast<std::uint32_t>(random.bits() % mesh.triangles().size()));
    EXPECT_GT(mesh.triangles().size(), 500u);
    EXPECT_NEAR(area(mesh), 2, 1e-12);
    for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
        const auto& now = mesh.triangles()[t];
        for (std::size_t i = 0; i < 3; ++i) {
            const Point a = mesh.nodes()[now.corner[i]].at, b = mesh.nodes()[now.corner[(i + 1) % 3]].at;
            EXPECT_LT(norm(mesh.nodes()[now.middle[i]].at - 0.5 * (a + b)), 1e-15);
            EXPECT_LT(norm(mesh.nodes()[now.quarter[i][0]].at - (0.75 * a + 0.25 * b)), 1e-15);
            if (now.neighbor[i] == BisectionMesh::none) continue;
            const auto& other = mesh.triangles()[now.neighbor[i]];
            const auto j = static_cast<std::size_t>(std::find(other.neighbor.begin(), other.neighbor.end(), t) -
                                                    other.neighbor.begin());
            ASSERT_LT(j, 3u);
            EXPECT_EQ(mesh.nodes()[other.corner[j]].at, b);
            EXPECT_EQ(other.middle[j], now.middle[i]);
            EXPECT_EQ(other.quarter[j][0], now.quarter[i][1]);
            EXPECT_EQ(other.order[j], now.order[i]);
        }
    }
}

TEST(BisectionMesh, EachSideOfADiscontinuityHasItsOwnNodesEvaluatedFromThere) {
    const BisectionMesh mesh = square_with_jump();
    for (const auto& t : mesh.triangles())
        for (std::size_t i = 0; i < 3; ++i) {
            if (t.order[i] != CurveOrder::d0) continue;
            EXPECT_EQ(t.neighbor[i], BisectionMesh::none);
            const auto& node = mesh.nodes()[t.middle[i]];
            const Point centre = (1.0 / 3) * (mesh.nodes()[t.corner[0]].at + mesh.nodes()[t.corner[1]].at +
                                              mesh.nodes()[t.corner[2]].at);
            EXPECT_GT(dot(node.seen_from - node.at, centre - node.at), 0);
        }
}

}  // namespace
}  // namespace exitance
