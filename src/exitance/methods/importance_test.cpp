#include "exitance/methods/importance.hpp"

#include <gtest/gtest.h>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/reference/path_reference.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// Two separate closed rooms of 2 m x 2 m x 2 m, each with a lamp and two boards.
Scene two_rooms() {
    std::vector<test::Face> faces;
    for (double x : {0.0, 3.0}) {
        for (const test::Face& face : test::closed_box({x, 0, 0}, {2, 2, 2})) faces.push_back(face);
        faces.push_back({{{x + 0.7, 0.7, 1.9}, {x + 0.7, 1.3, 1.9}, {x + 1.3, 1.3, 1.9}, {x + 1.3, 0.7, 1.9}}, 10});
        for (double y : {0.5, 1.4}) {
            const std::vector<Point> board{{x + 0.4, y, 0.2}, {x + 1.5, y, 0.2}, {x + 1.5, y, 1.1}, {x + 0.4, y, 1.1}};
            faces.push_back({board});
            faces.push_back({{board.rbegin(), board.rend()}});
        }
    }
    return test::make(faces);
}

const std::vector<ImportantPoint> on_the_first_floor{
    {{0.2, 0.3, 0}, {0, 0, 1}}, {{1, 1, 0}, {0, 0, 1}}, {{1.8, 1.7, 0}, {0, 0, 1}}, {{1.2, 0.3, 0}, {0, 0, 1}}};

Solution solved_by_importance(const Scene& scene, const SolveOptions& options) {
    Progress progress;
    const StopRequest stop;
    Result<Solution> solution = solve_scene(scene, options, progress, stop);
    EXI_CHECK(static_cast<bool>(solution));
    return std::move(*solution);
}

std::size_t links_in_second_room(const Solution& solution) {
    const ElementTree& tree = solution.links.elements.tree;
    return static_cast<std::size_t>(
        std::count_if(solution.links.links.begin(), solution.links.links.end(),
                      [&](const KeptLink& link) { return tree.patch(link.receiver).centre().x > 2.5; }));
}

}  // namespace

TEST(Importance, IsAtSurfacePointsAndAtRayHitsOfFreePoints) {
    const Scene scene = two_rooms();
    const Stage stage(scene);
    const ElementTree tree = stage.make_elements({0.5, 0});
    const LeafNumbering numbering(tree);
    std::vector<ImportantPoint> points = on_the_first_floor;
    double sum = 0;
    const std::vector<Spectrum> w = importance_at(stage, tree, numbering, points, 1);
    for (std::size_t i = 0; i < w.size(); ++i) sum += w[i][0] * tree.area(numbering.leaves[i]);
    EXPECT_NEAR(sum, stage.area, 1e-9 * stage.area) << "mean 1";

    const std::vector<Spectrum> free = importance_at(stage, tree, numbering, {{{4, 1, 1.5}, {0, 0, -1}}}, 1);
    sum = 0;
    for (std::size_t i = 0; i < free.size(); ++i) {
        const ElementId e = numbering.leaves[i];
        sum += free[i][0] * tree.area(e);
        EXPECT_TRUE(free[i][0] == 0 || tree.patch(e).centre().x >= 3 - 1e-9) << "nothing of the other room";
    }
    EXPECT_NEAR(sum, 0.5 * stage.area, 1e-9 * stage.area) << "all that is met reflects a half";
    EXPECT_EQ(places_of(stage, tree, points).size(), 4u);
    EXPECT_TRUE(places_of(stage, tree, {{{4, 1, 1.5}, {0, 0, -1}}}).empty());
}

TEST(Importance, TheOtherRoomGetsFewerLinksAtTheSameAccuracy) {
    const Scene scene = two_rooms();
    std::vector<ProbePoint> points;
    for (const auto& [at, normal] : on_the_first_floor) points.push_back({at, normal});
    Progress progress;
    const StopRequest stop;
    const auto reference = reference_light(scene, points, 16384, 1, progress, stop);
    const auto error = [&](const Solution& solution) {
        const auto light = RadiosityFunction(solution).at(points);
        double off = 0, whole = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            off += squared(light[i].irradiance - reference[i].irradiance);
            whole += squared(reference[i].irradiance);
        }
        return std::sqrt(off / whole);
    };
    for (Method method : {Method::hierarchical, Method::wavelet}) {
        const SolveOptions everywhere{.method = method, .epsilon = 0.002, .keep_links = true};
        SolveOptions here = everywhere;
        here.importance = on_the_first_floor;
        const Solution all = solved_by_importance(scene, everywhere), some = solved_by_importance(scene, here);
        EXPECT_LT(10 * links_in_second_room(some), links_in_second_room(all)) << name_in(method_names, method);
        // The remaining error is that of the local pass, about 1%, and of the reference, 0.3%.
        EXPECT_LT(error(some), std::max(0.015, 1.3 * error(all))) << name_in(method_names, method);
    }
}

}  // namespace exitance
