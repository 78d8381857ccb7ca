#include "exitance/measure/pictures/mesh_view.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

/// The unit square as two triangles along the diagonal from (0, 0) to (1, 1), which is an edge of the given order.
SixNodeMesh square(CurveOrder diagonal) {
    SixNodeMesh mesh;
    mesh.points = {{0, 0, 0},   {1, 0, 0},     {1, 1, 0},   {0, 1, 0},  {0.5, 0, 0},
                   {1, 0.5, 0}, {0.5, 0.5, 0}, {0.5, 1, 0}, {0, 0.5, 0}};
    mesh.values.resize(mesh.points.size());
    mesh.nodes = {{0, 1, 2, 4, 5, 6}, {0, 2, 3, 6, 7, 8}};
    mesh.region = {RegionId(0), RegionId(0)};
    mesh.edge_order = {{CurveOrder::border, CurveOrder::border, diagonal},
                       {diagonal, CurveOrder::border, CurveOrder::border}};
    mesh.shadow = {ShadowClass::lit, ShadowClass::umbra};
    return mesh;
}

TEST(MeshView, TheEdgeBetweenTwoPointsIsTheOneThatTheirLineCrosses) {
    for (const CurveOrder order : {CurveOrder::d0, CurveOrder::d1, CurveOrder::d2, CurveOrder::none}) {
        const SixNodeMesh mesh = square(order);
        EXPECT_EQ(order_between(mesh, 0, {0.8, 0.2, 0}, 1, {0.2, 0.8, 0}), order);
        EXPECT_EQ(order_between(mesh, 1, {0.45, 0.5, 0}, 0, {0.55, 0.5, 0}), order);
    }
}

TEST(MeshView, PixelsHaveEdgesWhereTheirNeighboursShowOtherTriangles) {
    const SixNodeMesh mesh = square(CurveOrder::d1);
    const RegionId floor(0), other(1);
    MeshView view{{3, 2}, {}};
    view.pixels = {{floor, 0, {0.8, 0.5, 0}}, {floor, 0, {0.7, 0.5, 0}}, {floor, 1, {0.3, 0.5, 0}},
                   {floor, 0, {0.8, 0.4, 0}}, {floor, 0, {0.7, 0.4, 0}}, {other, 0, {0, 0, 1}}};
    const auto edges = mesh_edges(mesh, view);
    const std::vector<std::optional<CurveOrder>> expected = {std::nullopt, CurveOrder::d1,     CurveOrder::border,
                                                             std::nullopt, CurveOrder::border, std::nullopt};
    EXPECT_EQ(edges, expected);
}

}  // namespace
}  // namespace exitance
