#include "exitance/lab/bsp/bsp_tree.hpp"

#include <gtest/gtest.h>

#include <set>

#include "exitance/base/random.hpp"
#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/lab/bsp/source_orderings.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

Vec3 random_vector(RandomStream& random) {
    return {random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
}

/// Random triangles in a unit cube, which may intersect.
Scene random_triangles(std::uint64_t seed, std::uint32_t count) {
    RandomStream random(seed, Stream::mesh);
    SceneDescription d;
    d.file = "random.obj";
    d.materials = {{"grey", Spectrum(0.5), Spectrum(0.0)}, {"lamp", Spectrum(0.0), Spectrum(1.0)}};
    d.groups = {"all"};
    for (std::uint32_t i = 0; i < count; ++i) {
        const Point middle = random_vector(random);
        for (int k = 0; k < 3; ++k) d.points.push_back(middle + 0.6 * random_vector(random));
        d.faces.push_back({{3 * i, 3 * i + 1, 3 * i + 2}, i == 0 ? 1u : 0u, 0, static_cast<int>(i + 1)});
    }
    CheckedScene checked = make_scene(std::move(d));
    EXI_CHECK(static_cast<bool>(checked.scene));
    return std::move(*checked.scene);
}

double area_of(std::span<const Point> outline) {
    return norm(area_vector(outline));
}

/// Position at which a segment meets a convex polygon, as a fraction of the segment; infinite if it misses.
double meets(const Point& from, const Vec3& d, std::span<const Point> outline, const Plane& plane) {
    const double height = plane.signed_distance(from), rise = dot(plane.n, d);
    const double t = rise == 0 ? HUGE_VAL : -height / rise;
    if (!(t > 1e-6) || t > 1 - 1e-6) return HUGE_VAL;
    return contains(outline, plane.n, from + t * d) ? t : HUGE_VAL;
}

}  // namespace

TEST(BspTree, FragmentsCoverTheirPiecesAndLieOnTheirSideOfEveryNodeAbove) {
    const Scene scene = random_triangles(1, 40);
    const Occluders occluders(scene);
    const BspTree tree(occluders);
    Field<PieceId, double> area(occluders.pieces().size(), 0.0);
    for (const BspTree::Fragment& f : tree.fragments()) area[f.piece] += area_of(tree.outline(f));
    for (PieceId p : area.ids()) EXPECT_NEAR(area[p], area_of(occluders.corners(p)), 1e-6);
    EXPECT_GT(tree.fragments().size(), occluders.pieces().size()) << "some are cut";
    for (std::uint32_t n = 0; n < tree.nodes().size(); ++n)
        for (const BspTree::Fragment& f : tree.fragments(tree.nodes()[n]))
            for (std::uint32_t below = n, above = tree.nodes()[n].parent; above != BspTree::none;
                 below = above, above = tree.nodes()[above].parent)
                for (const Point& p : tree.outline(f))
                    EXPECT_NE(tree.side(tree.nodes()[above], p), tree.nodes()[above].front == below ? -1 : 1);
}

TEST(BspTree, OrderingsAreFrontToBack) {
    const Scene scene = random_triangles(2, 30);
    const Occluders occluders(scene);
    const BspTree tree(occluders);
    RandomStream random(7, Stream::mesh);
    for (int trial = 0; trial < 20; ++trial) {
        const Point from = 2.0 * random_vector(random);
        const SourceOrderings orderings(tree, std::span(&from, 1));
        ASSERT_EQ(orderings.order(0).size(), tree.nodes().size());
        for (int ray = 0; ray < 50; ++ray) {
            const Vec3 d = 4.0 * random_vector(random);
            std::vector<std::pair<double, std::uint32_t>> met;
            for (std::uint32_t n = 0; n < tree.nodes().size(); ++n)
                for (const BspTree::Fragment& f : tree.fragments(tree.nodes()[n]))
                    if (const double t = meets(from, d, tree.outline(f), tree.nodes()[n].plane); t < 1)
                        met.push_back({t, orderings.place(0, n)});
            std::sort(met.begin(), met.end());
            for (std::size_t i = 1; i < met.size(); ++i)
                if (met[i].first > met[i - 1].first + 1e-6) {
                    EXPECT_GT(met[i].second, met[i - 1].second);
                }
        }
    }
}

TEST(BspTree, EveryBlockerOfASourcePointIsACandidate) {  // the theorem of the youngest common ancestor
    std::size_t hidden = 0, left_out = 0;
    for (std::uint64_t seed = 10; seed < 18; ++seed) {
        const Scene scene = random_triangles(seed, 24);
        const Occluders occluders(scene);
        const BspTree tree(occluders, 4, seed);
        const std::span<const Point> source = scene.outline(scene.emitters()[0]);
        const SourceOrderings orderings(tree, source);
        RandomStream random(seed, Stream::mesh, 1);
        std::vector<std::vector<std::uint32_t>> candidates(tree.nodes().size());
        for (std::uint32_t n = 0; n < tree.nodes().size(); ++n) {
            candidates[n] = orderings.candidates(n);
            left_out += tree.nodes().size() - candidates[n].size();
        }
        for (int trial = 0; trial < 300; ++trial) {
            const double a = random.uniform(), b = random.uniform() * (1 - a);
            const Point s = source[0] + a * (source[1] - source[0]) + b * (source[2] - source[0]);
            const auto n = static_cast<std::uint32_t>(random.bits() % tree.nodes().size());
            if (tree.side(tree.nodes()[n], s) == 0) continue;  // the source itself
            const auto fragments = tree.fragments(tree.nodes()[n]);
            const Point x = centroid(tree.outline(fragments[random.bits() % fragments.size()]));
            for (std::uint32_t m = 0; m < tree.nodes().size(); ++m) {
                if (m == n) continue;
                for (const BspTree::Fragment& f : tree.fragments(tree.nodes()[m]))
                    if (meets(s, x - s, tree.outline(f), tree.nodes()[m].plane) < 1) {
                        ++hidden;
                        EXPECT_TRUE(std::binary_search(candidates[n].begin(), candidates[n].end(), m));
                    }
            }
        }
    }
    EXPECT_GT(hidden, 500u);
    EXPECT_GT(left_out, 500u) << "lists are shorter than the scene";
}

TEST(BspTree, RaysHitTheSameAsEmbree) {
    const Scene scene = built_scene("complex", {{"m", "2"}});
    const Occluders occluders(scene);
    const BspTree tree(occluders);
    const RayTracer tracer(scene);
    RandomStream random(3, Stream::mesh);
    std::size_t met = 0, other = 0;
    constexpr std::size_t rays = 20000;
    for (std::size_t i = 0; i < rays; ++i) {
        const Vec3 r = random_vector(random), size = scene.box().size();
        const Point origin = scene.box().centre() + 0.9 * Vec3{r.x * size.x, r.y * size.y, r.z * size.z};
        const Vec3 d = normalized(random_vector(random));
        RayHit expected;
        tracer.nearest(std::span(&d, 1), origin, RegionId(), std::span(&expected, 1));
        const BspTree::Hit hit = tree.nearest(origin, d);
        const bool same = hit.piece.is_none() ? expected.surface.is_none()
                                              : occluders.pieces()[hit.piece].region == expected.region &&
                                                    hit.front == expected.front &&
                                                    std::abs(hit.distance - expected.distance) < 1e-5 * scene.size();
        met += same;
        other += !same;
    }
    EXPECT_GT(met, 0.999 * rays) << other << " differ: beside edges Embree decides in single precision";
}

TEST(ConvexHull, OmitsReflexCornersAndPointsOnEdges) {
    const std::vector<Point> concave = {{0, 0, 1}, {2, 0, 1}, {4, 0, 1}, {4, 4, 1}, {2, 1, 1}, {0, 4, 1}};
    const std::vector<Point> hull = convex_hull(concave, {0, 0, 1});
    EXPECT_EQ(hull.size(), 4u);
    EXPECT_TRUE(is_convex(hull, {0, 0, 1}));
    EXPECT_NEAR(norm(area_vector(hull)), 16, 1e-12);
    EXPECT_GT(area_vector(hull).z, 0);
}

}  // namespace exitance
