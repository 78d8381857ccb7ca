#include "exitance/methods/light/nodal_light.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

struct OneElement {
    ElementTree tree;
    ElementId e;

    explicit OneElement(Patch::Shape shape)
        : e(tree.add_root(RegionId(0), {{1, 2, 3}, {2, 0, 0.5}, {0.3, 1, 0}, shape})) {}
};

TEST(KeepPositive, ReducesSlopesUntilTheLowestCornerIsDarkAndKeepsTheMean) {
    for (const Patch::Shape shape : {Patch::Shape::parallelogram, Patch::Shape::triangle}) {
        const OneElement one(shape);
        const std::size_t count = shape == Patch::Shape::triangle ? 3 : 4;
        std::array<Spectrum, 4> corners = {Spectrum(3), Spectrum(1), Spectrum(-1), Spectrum(2)};
        double before = 0, after = 0, lowest = 1;
        for (std::size_t k = 0; k < count; ++k) before += corners[k][0];
        keep_positive(one.tree, one.e, corners);
        for (std::size_t k = 0; k < count; ++k) after += corners[k][0], lowest = std::min(lowest, corners[k][0]);
        EXPECT_NEAR(after, before, 1e-12);
        EXPECT_NEAR(lowest, 0, 1e-12);
        EXPECT_GT(corners[0][0], corners[1][0]);  // the slopes keep their signs
    }
}

TEST(KeepPositive, DoesNotChangeLightThatIsPositiveOnTheElement) {
    const OneElement one(Patch::Shape::parallelogram);
    const std::array<Spectrum, 4> positive = {Spectrum(3), Spectrum(1), Spectrum(0), Spectrum(2)};
    std::array<Spectrum, 4> corners = positive;
    keep_positive(one.tree, one.e, corners);
    EXPECT_EQ(corners, positive);
    // Beyond a diagonal of the patch is another element: on this one, the polynomial is positive.
    OneElement halved(Patch::Shape::parallelogram);
    const ElementId first = halved.tree.split_by_line(halved.e, {{1, 1}, 1});
    ASSERT_FALSE(first.is_none());
    ASSERT_TRUE(halved.tree.is_cell(first));
    const std::array<Spectrum, 4> beyond = {Spectrum(3), Spectrum(0), Spectrum(-3), Spectrum(0)};
    corners = beyond;
    keep_positive(halved.tree, first, corners);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(corners[k][0], beyond[k][0], 1e-9);
}

TEST(KeepPositive, DarkensElementsWithoutLight) {
    const OneElement one(Patch::Shape::triangle);
    std::array<Spectrum, 4> corners = {Spectrum(-3), Spectrum(1), Spectrum(-1), Spectrum(0)};
    keep_positive(one.tree, one.e, corners);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(corners[k], Spectrum(0));
}

}  // namespace
}  // namespace exitance
