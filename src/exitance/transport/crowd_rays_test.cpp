#include "exitance/transport/crowd_rays.hpp"

#include <gtest/gtest.h>

#include "support/built_scene.hpp"

namespace exitance {
namespace {

TEST(CrowdRays, AreFewerOnlyInACrowdOfEvenLight) {
    const Scene few = built_scene("tree", {{"leaves", "300"}}), many = built_scene("tree", {{"leaves", "8000"}});
    const auto factor = [](const Scene& scene, bool is_even) {
        const Stage stage(scene);
        ElementTree tree;
        for (const Piece& piece : stage.pieces) tree.add_root(piece.region, piece.patch);
        const LeafNumbering numbering(tree);
        std::vector<Spectrum> reflected(numbering.leaves.size(), Spectrum(is_even ? 1.0 : 0.0));
        for (std::size_t i = 0; i < reflected.size(); ++i)
            if (tree.area(numbering.leaves[i]) > 0.9) reflected[i] = Spectrum(1.0);
        if (!is_even) reflected.back() = Spectrum(1e6);
        return fewer_rays_in_crowd(stage, tree, numbering, reflected);
    };
    EXPECT_EQ(factor(few, true), 1);
    EXPECT_EQ(factor(few, false), 1);
    EXPECT_LT(factor(many, true), 0.6);
    EXPECT_EQ(factor(many, false), 1);
}

}  // namespace
}  // namespace exitance
