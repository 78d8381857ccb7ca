#include "exitance/transport/direct_projection.hpp"

#include <gtest/gtest.h>

#include "support/built_scene.hpp"

namespace exitance {

TEST(DirectProjection, SplitsNoElementBeyondItsLimit) {
    const Scene scene = built_scene("cornell");
    const Stage stage(scene);
    const StopRequest never;
    DirectProjectionOptions options{.mesh = {0.5, 0}, .tolerance = 0.01};
    const std::size_t whole = project_direct_light(stage, options, never).tree.size();
    options.max_elements = whole / 2;
    const DirectProjection limited = project_direct_light(stage, options, never);
    EXPECT_GE(limited.tree.size(), whole / 2);
    EXPECT_LT(limited.tree.size(), whole / 2 + 4) << "the last element is split into at most four";
    options.max_elements = 0;
    const DirectProjection coarse = project_direct_light(stage, options, never);
    EXPECT_EQ(coarse.tree.size(), stage.make_elements(options.mesh).size()) << "only the initial mesh";
}

}  // namespace exitance
