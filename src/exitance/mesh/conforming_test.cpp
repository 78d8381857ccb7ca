#include "exitance/mesh/conforming.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "exitance/base/random.hpp"
#include "exitance/mesh/pieces.hpp"
#include "exitance/mesh/planes.hpp"

namespace exitance {
namespace {

/// A floor of 4 m x 4 m in two materials that meet at x = 2.5, and an upright plate on it along x = 1 from y = 1 to 3.
Scene floor_and_plate() {
    SceneDescription d;
    d.points = {{0, 0, 0}, {2.5, 0, 0}, {2.5, 4, 0}, {0, 4, 0}, {4, 0, 0},
                {4, 4, 0}, {1, 1, 0},   {1, 3, 0},   {1, 3, 1}, {1, 1, 1}};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}, {"white", Spectrum(0.8), Spectrum(0.0)}};
    d.groups = {"all"};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1}, {{1, 4, 5, 2}, 1, 0, 2}, {{6, 7, 8, 9}, 0, 0, 3}};
    return std::move(*make_scene(std::move(d)).scene);
}

/// All pieces of the scene, split along contacts, then randomly in all supported ways.
ElementTree cut_at_random(const Scene& scene, const ContactLines& contacts, int cuts) {
    ElementTree tree;
    for (const Piece& piece : cut_into_pieces(scene)) tree.add_root(piece.region, piece.patch);
    cut_along_contacts(tree, tree.leaves(), contacts);
    RandomStream random(5, Stream::mesh);
    for (int i = 0; i < cuts; ++i) {
        const std::vector<ElementId> leaves = tree.leaves();
        const ElementId leaf = leaves[random.bits() % leaves.size()];
        if (tree.is_cell(leaf) || i % 9 == 4) {
            const Vec2 n = {random.uniform() - 0.5, random.uniform() - 0.5};
            tree.split_by_line(leaf, {n, dot(n, tree.centre(leaf))});
        } else {
            tree.split(leaf, static_cast<Cut>(1 + random.bits() % 3), 0.2 + 0.6 * random.uniform());
        }
    }
    return tree;
}

/// Value at a point of the floor of the function that equals `value[node]` at every node, on the side of `from`.
double value_at(const ElementTree& tree, const SharedNodes& nodes, const std::vector<double>& value, const Point& p) {
    for (ElementId root : tree.roots()) {
        const Vec2 uv = tree.patch(root).coordinates(p);
        if (tree.patch(root).normal().z < 0.9 || uv != into_shape(uv, tree.patch(root).shape)) continue;
        const ElementTree::Place place = tree.leaf_at(root, uv);
        const auto node = nodes.of(place.element, tree);
        const auto [u, v] = place.uv;
        if (node.size() == 3) return (1 - u - v) * value[node[0]] + u * value[node[1]] + v * value[node[2]];
        return (1 - u) * ((1 - v) * value[node[0]] + v * value[node[3]]) +
               u * ((1 - v) * value[node[1]] + v * value[node[2]]);
    }
    return NAN;
}

TEST(Conforming, TheOtherSideOfASheetCutsNoFans) {
    SceneDescription d;
    d.points = {{0, 0, 0}, {1, 0, 0.2}, {0, 1, 0.4}};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}};
    d.groups = {"all"};
    d.faces = {{{0, 1, 2}, 0, 0, 1}, {{2, 1, 0}, 0, 0, 2}};
    const Scene scene = std::move(*make_scene(std::move(d)).scene);
    ElementTree tree;
    for (const Piece& piece : cut_into_pieces(scene)) tree.add_root(piece.region, piece.patch);
    ASSERT_EQ(tree.leaves().size(), 2u);
    const SharedNodes nodes = make_conforming(tree, plane_of_regions(scene), ContactLines(scene));
    EXPECT_EQ(tree.leaves().size(), 2u);
    EXPECT_EQ(nodes.first_node.back(), 6u) << "three corners of each side";
}

TEST(Conforming, NodesMakeFunctionsContinuousExceptAcrossContacts) {
    const Scene scene = floor_and_plate();
    const ContactLines contacts(scene);
    for (const int cuts : {0, 3, 60}) {
        ElementTree tree = cut_at_random(scene, contacts, cuts);
        const SharedNodes nodes = make_conforming(tree, plane_of_regions(scene), contacts);
        RandomStream random(8, Stream::mesh);
        std::vector<double> value(nodes.first_node.back());
        for (double& v : value) v = random.uniform();
        // Leaves are wider than one or two millimetres, so a continuous function changes little across a micrometre.
        constexpr double step = 1e-6, steepest = 1e4;
        int jumps = 0;
        for (int i = 0; i < 20000; ++i) {
            // Half of the steps cross the contact line or the border between the materials.
            const double x = i % 4 == 0 ? 1 - step / 2 : i % 4 == 1 ? 2.5 - step / 2 : 4 * random.uniform();
            const Point p{x, 4 * random.uniform(), 0}, q = p + Vec3{step, 0, 0};
            const double jump = std::abs(value_at(tree, nodes, value, q) - value_at(tree, nodes, value, p));
            const bool crosses_plate = p.x < 1 && q.x > 1 && p.y > 1 && p.y < 3;
            if (crosses_plate)
                jumps += jump > steepest * step;
            else
                EXPECT_LT(jump, steepest * step) << p.x << " " << p.y << " after " << cuts;
        }
        EXPECT_GT(jumps, 1000);
    }
}

/// A floor of 4 m x 4 m with an upright wall from side to side near x = 1.1, whose corners deviate by `tilt` metres as
/// numbers in a file of single precision do; everything scaled and turned about the vertical.
Scene floor_and_wall(double tilt, double scale, double angle) {
    SceneDescription d;
    const double c = scale * std::cos(angle), s = scale * std::sin(angle);
    for (const Point& p : {Point{0, 0, 0},
                           {4, 0, 0},
                           {4, 4, 0},
                           {0, 4, 0},
                           {1.1, 0, -0.01},
                           {1.1 + tilt, 4, -0.01},
                           {1.1 + tilt, 4, 1},
                           {1.1, 0, 1}})
        d.points.push_back({c * p.x - s * p.y, s * p.x + c * p.y, scale * p.z});
    d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}};
    d.groups = {"all"};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1}, {{4, 5, 6, 7}, 0, 0, 2}};
    return std::move(*make_scene(std::move(d)).scene);
}

TEST(Conforming, NodesAreNotSharedAcrossAWallThatIsNearlyParallelToTheMesh) {
    for (const double tilt : {0.0, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-3})
        for (const double scale : {0.1, 1.0, 30.0})
            for (const double angle : {0.0, 0.4, 2.0}) {
                const Scene scene = floor_and_wall(tilt, scale, angle);
                const ContactLines contacts(scene);
                ElementTree tree;
                for (const Piece& piece : cut_into_pieces(scene)) tree.add_root(piece.region, piece.patch);
                for (int i = 0; i < 3; ++i)
                    for (ElementId leaf : tree.leaves()) tree.split(leaf, Cut::both, 0.5);
                cut_along_contacts(tree, tree.leaves(), contacts);
                const SharedNodes nodes = make_conforming(tree, plane_of_regions(scene), contacts);
                std::vector<std::uint32_t> left, right, both;
                for (ElementId leaf : tree.leaves()) {
                    if (tree.patch(leaf).normal().z < 0.9) continue;
                    const Point middle = tree.patch(leaf).at(tree.centre(leaf));
                    const double x = (std::cos(angle) * middle.x + std::sin(angle) * middle.y) / scale;
                    const double y = (std::cos(angle) * middle.y - std::sin(angle) * middle.x) / scale;
                    const double from_wall = x - 1.1 - tilt * y / 4;
                    if (std::abs(from_wall) < 2e-5) continue;  // a sliver may be on either side
                    std::vector<std::uint32_t>& side = from_wall < 0 ? left : right;
                    for (const std::uint32_t node : nodes.of(leaf, tree)) side.push_back(node);
                }
                std::sort(left.begin(), left.end()), std::sort(right.begin(), right.end());
                std::set_intersection(left.begin(), left.end(), right.begin(), right.end(), std::back_inserter(both));
                EXPECT_TRUE(both.empty())
                    << both.size() << " nodes, tilt " << tilt << " scale " << scale << " " << angle;
            }
}

TEST(Conforming, PlanesGroupCoplanarRegionsThatReceiveLightAlike) {
    const Field<RegionId, std::uint32_t> plane = plane_of_regions(floor_and_plate());
    ASSERT_EQ(plane.size(), 3u);
    EXPECT_EQ(plane[RegionId(0)], plane[RegionId(1)]);
    EXPECT_NE(plane[RegionId(0)], plane[RegionId(2)]);
}

}  // namespace
}  // namespace exitance
