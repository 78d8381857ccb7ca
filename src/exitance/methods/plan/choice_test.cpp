#include "exitance/methods/plan/choice.hpp"

#include <gtest/gtest.h>

#include "support/built_scene.hpp"

namespace exitance {
namespace {

TEST(MethodChoice, KeepsTheUsersChoice) {
    const Scene scene = built_scene("tube");
    const Stage stage(scene);
    const MethodChoice choice = choose_method(stage, {.method = Method::progressive, .error = 0.001});
    EXPECT_EQ(choice.options.method, Method::progressive);
    EXPECT_TRUE(choice.why.empty());
}

TEST(MethodChoice, DependsOnOcclusionAndError) {
    const Scene tube = built_scene("tube"), room = built_scene("cornell");
    const Stage open(tube), cluttered(room);
    const auto chosen = [](const Stage& stage, double error) {
        const MethodChoice choice = choose_method(stage, {.error = error});
        EXPECT_FALSE(choice.why.empty());
        return choice.options.method;
    };
    EXPECT_EQ(chosen(open, 0.02), Method::matrix);
    EXPECT_EQ(chosen(open, 0.001), Method::wavelet);
    EXPECT_EQ(chosen(cluttered, 0.001), Method::matrix);
}

TEST(MethodChoice, UsesLinksForImportanceAndMatrixForLimitedReflections) {
    const Scene scene = built_scene("cornell");
    const Stage stage(scene);
    SolveOptions options;
    options.importance = {{{1, 1, 0}, {0, 0, 1}}};
    EXPECT_EQ(choose_method(stage, options).options.method, Method::hierarchical);
    EXPECT_EQ(choose_method(stage, {.method = Method::wavelet, .bounces = 2}).options.method, Method::matrix);
}

TEST(MethodChoice, IsAwareOfSeveralProcesses) {
    EXPECT_TRUE(runs_over_processes(Method::matrix, {}));
    EXPECT_TRUE(runs_over_processes(Method::hierarchical, {.keep_links = true}));
    EXPECT_FALSE(runs_over_processes(Method::hierarchical, {.clusters = true}));
    EXPECT_FALSE(runs_over_processes(Method::hierarchical, {.oracle = LinkOracle::form_factor}));
    EXPECT_FALSE(runs_over_processes(Method::wavelet, {})) << "may judge links one by one, as the scene is";
    EXPECT_FALSE(runs_over_processes(Method::progressive, {}));
}

}  // namespace
}  // namespace exitance
