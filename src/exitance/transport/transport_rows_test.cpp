#include <gtest/gtest.h>

#include "exitance/base/parallel.hpp"
#include "exitance/transport/patch_transfer.hpp"
#include "exitance/transport/ray_rows.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// Form factor between opposite faces of a cube, in closed form.
constexpr double opposite = 0.1998248956983874;

/// Area-weighted mean irradiance of each face if only the ceiling (face 1) has radiosity 1.
std::vector<double> light_from_the_ceiling(const Stage& stage, const TransportOperator& F, const ElementTree& tree,
                                           const LeafNumbering& numbering) {
    std::vector<Spectrum> b(F.size()), E(F.size());
    for (std::size_t i = 0; i < b.size(); ++i)
        if (tree.region(numbering.leaves[i]) == RegionId(1)) b[i] = Spectrum(1.0);
    F.gather(b, E);
    std::vector<double> face(6);
    for (std::size_t i = 0; i < b.size(); ++i)
        face[tree.region(numbering.leaves[i]).value] += tree.area(numbering.leaves[i]) * E[i][0];
    EXPECT_EQ(stage.scene.regions().size(), 6u);
    return face;
}

struct Cube {
    Scene scene = box_scene(1, 1, 1, 0.5, 1);
    Stage stage{scene};
    ElementTree tree = stage.make_elements({.edge = 0.25, .grading_levels = 1});
    LeafNumbering numbering{tree};
    ElementLocator locator{tree, 6};
    RayRows rows(double rays) const {
        return RayRows(stage, {tree, numbering, locator}, {{.average = rays, .min = 16, .max = 1024}, 1});
    }
};

TEST(RayRows, SumToOneInAClosedScene) {
    const Cube cube;
    const RayRows F = cube.rows(64);
    const std::vector<Spectrum> ones(F.size(), Spectrum(1.0));
    // rounding of a sum of ones
    for (std::size_t i = 0; i < F.size(); ++i) EXPECT_NEAR(F.gather_at(i, ones)[0], 1, 1e-14);
}

TEST(RayRows, AgreeWithTheClosedForm) {
    const Cube cube;
    const std::vector<double> face = light_from_the_ceiling(cube.stage, cube.rows(256), cube.tree, cube.numbering);
    // 100 elements of 256 stratified rays per face: a standard error below 0.001.
    EXPECT_NEAR(face[0], opposite, 0.003);
    EXPECT_NEAR(face[1], 0, 1e-15);
    for (std::size_t wall = 2; wall < 6; ++wall) EXPECT_NEAR(face[wall], (1 - opposite) / 4, 0.003);
}

/// Compares the error of the irradiance of whole faces, with light from the ceiling only.
TEST(RayRows, OfOneSequencePerPieceAreMoreAccurateTogether) {
    const Cube cube;
    const auto square_error = [&](Dealing dealing) {
        std::vector<double> squares(6, 0.0);
        for (std::uint64_t seed = 1; seed <= 40; ++seed) {
            const RayRows F(cube.stage, {cube.tree, cube.numbering, cube.locator},
                            {{.average = 8, .min = 8, .max = 8}, seed, dealing});
            const std::vector<double> face = light_from_the_ceiling(cube.stage, F, cube.tree, cube.numbering);
            squares[0] += std::pow(face[0] - opposite, 2);
            for (std::size_t wall = 2; wall < 6; ++wall) squares[1] += std::pow(face[wall] - (1 - opposite) / 4, 2);
        }
        return squares[0] + squares[1];
    };
    EXPECT_LT(square_error(Dealing::by_piece), 0.7 * square_error(Dealing::by_element));
}

TEST(RayRows, AreTheSameOnAnyNumberOfThreads) {
    const Cube cube;
    std::vector<Spectrum> b(cube.numbering.leaves.size());
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = Spectrum(1.0 / static_cast<double>(i + 1));
    std::vector<Spectrum> once(b.size()), again(b.size());
    set_threads(1);
    cube.rows(64).gather(b, once);
    set_threads(2);
    cube.rows(64).gather(b, again);
    EXPECT_EQ(once, again);
}

TEST(DenseTransport, AgreesWithTheClosedForm) {
    const Cube cube;
    Progress progress;
    const StopRequest stop;
    for (int levels : {0, 1}) {
        const PatchLevel patches(cube.tree, cube.numbering, levels);
        const PatchTransfer transfer(cube.stage, cube.tree, 16, 1);
        const DenseTransport F(transfer, cube.numbering, patches, progress, stop);
        const std::vector<double> face = light_from_the_ceiling(cube.stage, F, cube.tree, cube.numbering);
        // Exact towards each patch; the error is that of the midpoint rule on elements of 0.25 m.
        EXPECT_NEAR(face[0], opposite, 0.002);
        for (std::size_t wall = 2; wall < 6; ++wall) EXPECT_NEAR(face[wall], (1 - opposite) / 4, 0.004);
    }
}

TEST(PatchTransfer, OneSampleIsOneRayFromMiddleToMiddle) {
    const Scene scene = built_scene("blocker", {{"h", "0.7"}});
    const Stage stage(scene);
    const ElementTree tree = stage.make_elements({.edge = 0.5, .grading_levels = 1});
    const PatchTransfer transfer(stage, tree, 1, 1);
    PatchTransfer::Workspace w;
    std::size_t open = 0, hidden = 0;
    for (ElementId source : tree.leaves()) {
        if (!scene.material(tree.region(source)).emits()) continue;
        for (ElementId receiver : tree.leaves()) {
            const double whole = transfer.form_factor_in_the_open(receiver, source);
            if (!(whole > 0)) continue;
            const double F = transfer.form_factor(receiver, source, w);
            EXPECT_TRUE(F == 0 || F == whole);
            (F > 0 ? open : hidden) += 1;
        }
    }
    EXPECT_GT(open, 0u);
    EXPECT_GT(hidden, 0u);
    EXPECT_EQ(w.rays, open + hidden);
}

TEST(PatchLevel, PullsMeansOverItsPatches) {
    const Cube cube;
    const PatchLevel patches(cube.tree, cube.numbering, 1);
    EXPECT_LT(patches.patches.size(), cube.numbering.leaves.size() / 2);
    double share = 0;
    for (double s : patches.share) share += s;
    EXPECT_NEAR(share, static_cast<double>(patches.patches.size()), 1e-10);
    const std::vector<Spectrum> ones(cube.numbering.leaves.size(), Spectrum(1.0));
    for (const Spectrum& mean : patches.pull(ones)) EXPECT_NEAR(mean[0], 1, 1e-12);
}

}  // namespace
}  // namespace exitance
