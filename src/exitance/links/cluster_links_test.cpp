#include "exitance/links/cluster_links.hpp"

#include <gtest/gtest.h>

#include "exitance/base/parallel.hpp"
#include "exitance/links/cluster_refiner.hpp"
#include "exitance/links/link_refiner.hpp"
#include "exitance/transport/piece_groups.hpp"
#include "support/built_scene.hpp"
#include "support/lit_elements.hpp"

namespace exitance {
namespace {

/// Links of a scene with clusters, whose elements reflect b(x); refined until each error is below `tolerance`.
struct Clustered : LitElements {
    ClusterTree clusters;
    ClusterRefiner far;
    LinkRefiner near;

    template <class Light>
    Clustered(const Scene& scene, HierarchyBasis kind, double tolerance, const Light& light)
        : LitElements(scene, kind, light),
          clusters(tree, find_piece_groups(stage, tree, 1).of_root),
          far(sites, clusters),
          near(tree, sites) {
        Progress silent;
        StopRequest never;
        const LinkTolerance allowed{.error = tolerance, .interpolation = tolerance, .min_area = 1e-6};
        near.refine(far.refine(b, allowed, never), b, {}, allowed, silent, never);
    }

    NodalField gathered() const {
        NodalField E(sites);
        near.make_links().gather(b, E);
        far.make_links().add_to(E, b);
        E.push();
        return E;
    }
    /// Error estimate of the links, as a mean over the surfaces of reflectance `rho`.
    double estimate(double rho) const { return std::hypot(near.error(), far.error()) / std::sqrt(stage.area) / rho; }
};

/// A closed room of 4 m x 4 m x 2 m at the given position, with 24 cubes of 10 cm in the air.
void add_furnished_room(SceneDescription& d, const Point& at) {
    const auto add_box = [&](const Point& from, const Vec3& size, bool inwards) {
        const auto first = static_cast<std::uint32_t>(d.points.size());
        for (const double z : {0.0, 1.0})
            for (const Vec2 xy : {Vec2{0, 0}, {1, 0}, {1, 1}, {0, 1}})
                d.points.push_back(from + Vec3{xy.x * size.x, xy.y * size.y, z * size.z});
        for (std::vector<std::uint32_t> face : std::vector<std::vector<std::uint32_t>>{
                 {0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}}) {
            if (!inwards) std::reverse(face.begin(), face.end());
            for (std::uint32_t& c : face) c += first;
            d.faces.push_back({face, 0, 0, static_cast<int>(d.faces.size() + 1)});
        }
    };
    add_box(at, {4, 4, 2}, true);
    for (int i = 0; i < 24; ++i)
        add_box(at + Vec3{0.4 + 0.6 * (i % 6), 0.4 + 0.9 * (i / 6), 0.4 + 0.05 * i}, {0.1, 0.1, 0.1}, false);
}

Scene furnished(const std::vector<Point>& rooms) {
    SceneDescription d;
    d.file = "rooms.obj";
    d.materials = {{"wall", Spectrum(0.8), Spectrum()}};
    d.groups = {"rooms"};
    for (const Point& at : rooms) add_furnished_room(d, at);
    CheckedScene checked = make_scene(std::move(d));
    EXI_CHECK(static_cast<bool>(checked.scene));
    return std::move(*checked.scene);
}

TEST(ClusterLinks, GiveOneEverywhereInAClosedRoomOfUniformLight) {
    const Scene room = furnished({{0, 0, 0}});
    for (const HierarchyBasis kind : {HierarchyBasis::haar, HierarchyBasis::multiwavelet2}) {
        const Clustered of(room, kind, 0.01, [](const Point&) { return 1.0; });
        EXPECT_GT(of.far.size(), 50u);
        const NodalField E = of.gathered();
        double sum = 0;
        for (ElementId e : of.tree.leaves())
            for (std::size_t k = 0; k < of.sites.nodes(); ++k)
                sum += of.tree.area(e) * of.sites.weight(e, k) * std::pow(E.node(e, k)[0] - 1, 2);
        const double error = std::sqrt(sum / of.stage.area);
        EXPECT_LT(error, of.estimate(0.8)) << static_cast<int>(kind);
        // limit: the sum of 150 links per receiver with errors of 0.01 each
        EXPECT_LT(error, 0.1) << static_cast<int>(kind);
    }
}

/// Sum of A x E over all pieces of a cluster: by a link to it, and by links between the centres of each pair of pieces.
std::pair<double, double> sums(const Clustered& of, ClusterId receiver, ClusterId source) {
    const Bodies bodies(of.sites, of.clusters);
    NodalField E(of.sites);
    ClusterLinks(bodies, {{receiver, source}}).add_to(E, of.b);
    double sum = 0, expected = 0;
    for (Body to : of.clusters.children(receiver)) {
        const ElementId p = to.element();
        sum += of.tree.area(p) * E.node(p, 0)[0];
        for (Body from : of.clusters.children(source)) {
            const ElementId q = from.element();
            const Vec3 d = of.sites.centre(q) - of.sites.centre(p);
            const double here = std::max(0.0, dot(of.sites.normal(p), d)),
                         there = std::max(0.0, -dot(of.sites.normal(q), d));
            expected += of.tree.area(p) * of.tree.area(q) * of.b.node(q, 0)[0] * here * there /
                        (pi * std::pow(squared_norm(d), 2));
        }
    }
    return {sum, expected};
}

TEST(ClusterLinks, AgreeWithTheirPiecesInTheFarField) {
    const Scene room = furnished({{0, 0, 0}});
    const Clustered of(room, HierarchyBasis::haar, 0.02, [](const Point& x) { return 1 + x.x; });
    std::vector<ClusterId> lowest;
    for (ClusterId c : of.clusters.ids()) {
        const auto children = of.clusters.children(c);
        if (std::none_of(children.begin(), children.end(), [](Body b) { return b.is_cluster(); })) lowest.push_back(c);
    }
    ASSERT_GT(lowest.size(), 10u);
    for (ClusterId receiver : lowest)
        for (ClusterId source : lowest) {
            const double r = norm(of.clusters.centre(source) - of.clusters.centre(receiver));
            const double reach = of.clusters.radius(source) + of.clusters.radius(receiver);
            if (reach > 0.15 * r) continue;
            const auto [sum, expected] = sums(of, receiver, source);
            // The relative error is at most the ratio of the bodies' size to their distance, by which links are judged.
            EXPECT_NEAR(sum, expected, reach / r * expected);
        }
}

TEST(ClusterLinks, LeakNothingThroughAWallOfAMillimetre) {
    const Scene rooms = furnished({{0, 0, 0}, {4.001, 0, 0}});
    for (const HierarchyBasis kind : {HierarchyBasis::haar, HierarchyBasis::multiwavelet2}) {
        const Clustered of(rooms, kind, 0.01, [](const Point& x) { return x.x < 4.0005 ? 1.0 : 0.0; });
        const NodalField E = of.gathered();
        for (ElementId e : of.tree.leaves())
            if (of.sites.centre(e).x > 4.0005) {
                EXPECT_LT(E.node(e, 0)[0], 1e-6) << static_cast<int>(kind);
            }
    }
}

TEST(PieceGroups, AreSeparatedByTheWallBetweenThem) {
    const Scene rooms = furnished({{0, 0, 0}, {4.001, 0, 0}});
    const Stage stage(rooms);
    const ElementTree tree = stage.make_elements({0.5, 0});
    const std::vector<std::uint32_t> room = find_piece_groups(stage, tree, 1).of_root;
    ASSERT_EQ(room.size(), tree.roots().size());
    const std::uint32_t first = room.front();
    for (std::size_t i = 0; i < room.size(); ++i)
        EXPECT_EQ(room[i] == first, tree.patch(tree.roots()[i]).centre().x < 4.0005);
    EXPECT_LT(*std::max_element(room.begin(), room.end()), 2u);
}

TEST(ClusterLinks, GrowLinearlyWithTheScene) {
    std::array<std::size_t, 2> links{};
    for (std::size_t i = 0; i < 2; ++i) {
        const Scene scene = built_scene("complex", {{"m", i == 0 ? "10" : "40"}});
        const Clustered of(scene, HierarchyBasis::haar, 0.02 * (i == 0 ? 1 : 2), [](const Point&) { return 1.0; });
        links[i] = of.far.size() + of.near.size();
    }
    // A room of four times the floor area contains four times as many objects, and a tolerance relative to all light
    // doubles. k^2 would be 16.
    EXPECT_LT(links[1], 5.0 * static_cast<double>(links[0]));
}

TEST(ClusterLinks, DoNotDependOnTheNumberOfThreads) {
    const Scene room = furnished({{0, 0, 0}});
    std::vector<double> before;
    for (const int count : {1, 2}) {
        set_threads(count);
        const Clustered of(room, HierarchyBasis::haar, 0.02, [](const Point& x) { return 1 + x.z; });
        const NodalField E = of.gathered();
        std::vector<double> now{static_cast<double>(of.far.size()), static_cast<double>(of.near.size())};
        for (ElementId e : of.tree.leaves()) now.push_back(E.node(e, 0)[0]);
        if (count > 1) {
            EXPECT_EQ(now, before);
        }
        before = now;
    }
    set_threads(0);
}

}  // namespace
}  // namespace exitance
