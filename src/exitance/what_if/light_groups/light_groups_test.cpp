#include "exitance/what_if/light_groups/light_groups.hpp"

#include <gtest/gtest.h>

#include "exitance/base/sanitizers.hpp"
#include "exitance/error/area_samples.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/measure/light_maps/light_map.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/reference/reference_points.hpp"
#include "exitance/what_if/light_groups/light_change_words.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

/// A closed box of 2 x 2 x 2 m, two lamps of one material under its ceiling, a red and a white wall.
SceneDescription two_lamps() {
    SceneDescription d;
    d.points = {{0, 0, 0},       {2, 0, 0},       {2, 2, 0},       {0, 2, 0},       {0, 0, 2},       {2, 0, 2},
                {2, 2, 2},       {0, 2, 2},       {0.2, 0.2, 1.9}, {0.6, 0.2, 1.9}, {0.6, 0.6, 1.9}, {0.2, 0.6, 1.9},
                {1.4, 1.4, 1.9}, {1.8, 1.4, 1.9}, {1.8, 1.8, 1.9}, {1.4, 1.8, 1.9}};
    d.materials = {
        {"wall", Spectrum(0.7), Spectrum()}, {"side", Spectrum(0.3), Spectrum()}, {"lamp", Spectrum(0), Spectrum(20)}};
    d.groups = {"room", "left", "right"};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 1},   {{4, 7, 6, 5}, 0, 0, 2},    {{0, 4, 5, 1}, 1, 0, 3},
               {{1, 5, 6, 2}, 0, 0, 4},   {{2, 6, 7, 3}, 0, 0, 5},    {{3, 7, 4, 0}, 0, 0, 6},
               {{8, 11, 10, 9}, 2, 1, 7}, {{12, 15, 14, 13}, 2, 2, 8}};
    return d;
}

/// Requested error of tests of accuracy. Tests run ten times as long with the address sanitizer, for which any light
/// does.
constexpr double fine = has_address_sanitizer ? 0.04 : 0.01;
constexpr double coarse = 0.1;  ///< requested error of tests that do not depend on accuracy

struct Lit {
    Solution solution;
    LightGroups groups;
};
Lit lit(double error, SceneDescription d = two_lamps()) {
    part_emitters_by_group(d);
    const CheckedScene scene = make_scene(std::move(d));
    EXPECT_TRUE(scene.scene);
    Progress silent;
    const StopRequest stop;
    const SolveOptions options{.error = error};
    Result<Solution> solution = solve_scene(*scene.scene, options, silent, stop);
    EXPECT_TRUE(solution);
    Result<LightGroups> groups = solve_light_groups(*solution, options, silent, stop);
    EXPECT_TRUE(groups) << groups.error().message;
    return {std::move(*solution), std::move(*groups)};
}

/// Light of a new solve of a changed scene, at 400 points of the surfaces.
ReferencePoints new_solve(const Scene& changed) {
    Progress silent;
    const StopRequest stop;
    const Result<Solution> fresh = solve_scene(changed, {.error = fine / 2}, silent, stop);
    EXPECT_TRUE(fresh);
    ReferencePoints reference{points_uniform_in_area(changed, 400, 3), {}, {}};
    reference.irradiance = irradiance_at(*fresh, reference.points);
    return reference;
}

}  // namespace

TEST(LightGroupsOfTwoLamps, AddUpToTheSolution) {
    const Lit whole = lit(coarse);
    ASSERT_EQ(whole.groups.groups.size(), 2u);
    EXPECT_EQ(whole.groups.groups[0].emitters.name, "left");
    Lit same = whole;
    ASSERT_TRUE(change_light(same.solution, same.groups, {}));
    for (std::size_t i = 0; i < same.solution.indirect.values.size(); ++i)
        for (std::size_t band = 0; band < bands; ++band)
            EXPECT_NEAR(same.solution.indirect.values[i][band], whole.solution.indirect.values[i][band],
                        1e-5F * whole.solution.indirect.values[i][band]);
    EXPECT_EQ(same.solution.statistics.relative_error_estimate, whole.solution.statistics.relative_error_estimate);
}

TEST(LightGroupsOfTwoLamps, DimmedLightIsTheSumOfGroups) {
    const Lit whole = lit(coarse);
    Lit dim = whole;
    ASSERT_TRUE(change_light(dim.solution, dim.groups, {.dim = {{"left", 0.25}, {"right", 3}}}));
    const auto expect_sum = [&](const CornerValues& values, CornerValues LightGroup::*of) {
        for (std::size_t i = 0; i < values.size(); ++i)
            for (std::size_t band = 0; band < bands; ++band) {
                const double left = static_cast<double>((whole.groups.groups[0].*of)[i][band]),
                             right = static_cast<double>((whole.groups.groups[1].*of)[i][band]);
                const double sum = 0.25 * left + 3 * right;
                EXPECT_NEAR(static_cast<double>(values[i][band]), sum, 1.2e-7 * std::abs(sum));  // single precision
            }
    };
    expect_sum(dim.solution.indirect.values, &LightGroup::indirect);
    expect_sum(dim.solution.interpolant.values, &LightGroup::interpolant);
}

TEST(LightGroupsOfTwoLamps, DimmedLightAgreesWithANewSolve) {
    const Lit whole = lit(fine);
    Lit dim = whole;
    ASSERT_TRUE(change_light(dim.solution, dim.groups, {.dim = {{"left", 0}, {"right", 0.5}}}));
    EXPECT_EQ(dim.solution.scene.emitters().size(), 1u);
    const double off = error_against(dim.solution, new_solve(dim.solution.scene)).relative_rms_error;
    EXPECT_LT(off, 1.2 * fine);  // includes the reference's error of half as much
    ASSERT_TRUE(dim.solution.statistics.relative_error_estimate);
    // The estimate is from some hundred points; the measured error includes that of the reference.
    EXPECT_LT(off, 1.5 * *dim.solution.statistics.relative_error_estimate + fine / 2);
    EXPECT_LT(*dim.solution.statistics.relative_error_estimate, 3 * off + fine / 2);
    ASSERT_TRUE(change_light(dim.solution, dim.groups, {.dim = {{"left", 1}, {"right", 1}}}));
    EXPECT_EQ(dim.solution.scene.emitters().size(), 2u);
    EXPECT_NEAR(dim.solution.indirect.values[0][0], whole.solution.indirect.values[0][0], 1e-4F);
}

TEST(LightGroupsOfTwoLamps, RepaintedLightAgreesWithANewSolve) {
    const Lit whole = lit(fine);
    Lit painted = whole;
    ASSERT_TRUE(change_light(painted.solution, painted.groups, {.reflectance = {{"side", Spectrum(0.8)}}}));
    const ReferencePoints exact = new_solve(painted.solution.scene);
    const double off = error_against(painted.solution, exact).relative_rms_error;
    EXPECT_LT(off, 1.2 * fine);  // equal to the limit for dimming
    ASSERT_TRUE(painted.solution.statistics.relative_error_estimate);
    EXPECT_LT(off, 1.5 * *painted.solution.statistics.relative_error_estimate + fine / 2);
    // Without repainting, the error would be about 8%.
    Lit left = whole;
    left.solution.scene = painted.solution.scene;
    EXPECT_GT(error_against(left.solution, exact).relative_rms_error, 0.03);
    // Restoring the reflectance restores the light: the result does not depend on earlier changes.
    ASSERT_TRUE(change_light(painted.solution, painted.groups, {.reflectance = {{"side", Spectrum(0.3)}}}));
    EXPECT_NEAR(painted.solution.indirect.values[0][0], whole.solution.indirect.values[0][0], 1e-4F);
}

TEST(LightGroupsOfTwoLamps, DimmingAndRepaintingCommute) {
    const Lit whole = lit(coarse);
    Lit once = whole, twice = whole;
    ASSERT_TRUE(
        change_light(once.solution, once.groups, {.dim = {{"left", 0.2}}, .reflectance = {{"side", Spectrum(0.6)}}}));
    ASSERT_TRUE(change_light(twice.solution, twice.groups, {.reflectance = {{"side", Spectrum(0.6)}}}));
    ASSERT_TRUE(change_light(twice.solution, twice.groups, {.dim = {{"left", 0.2}}}));
    EXPECT_EQ(once.solution.indirect.values, twice.solution.indirect.values);
    EXPECT_EQ(once.solution.interpolant.values, twice.solution.interpolant.values);
}

TEST(LightGroupsOfTwoLamps, LightMapsAreAdditive) {
    const Lit whole = lit(coarse);
    const auto baked = [](const Solution& solution) {
        Progress silent;
        return *bake_light_maps(RadiosityFunction(solution), {.density = 4}, silent, StopRequest());
    };
    const auto alone = [&](double left, double right) {
        Lit dim = whole;
        EXPECT_TRUE(change_light(dim.solution, dim.groups, {.dim = {{"left", left}, {"right", right}}}));
        return baked(dim.solution);
    };
    const LightMaps all = baked(whole.solution), left = alone(1, 0), right = alone(0, 1);
    ASSERT_EQ(left.maps.size(), all.maps.size());
    double largest = 0, off = 0, squares = 0, count = 0;
    for (std::size_t m = 0; m < all.maps.size(); ++m) {
        ASSERT_EQ(left.maps[m].source, all.maps[m].source) << "the charts are the same";
        for (std::size_t i = 0; i < all.maps[m].size.texels(); ++i) {
            if (all.maps[m].source[i] != LightMap::Source::computed) continue;
            const Spectrum sum = left.maps[m].at(i) + right.maps[m].at(i);
            largest = std::max(largest, max(all.maps[m].at(i)));
            const double apart = std::abs(sum[0] - all.maps[m].at(i)[0]);
            off = std::max(off, apart), squares += apart * apart, ++count;
        }
    }
    // At a shadow edge of one lamp, a texel needs fewer points for the other lamp's light than for both.
    EXPECT_LT(off, 1e-2 * largest);
    EXPECT_LT(std::sqrt(squares / count), 5e-4 * largest);
}

TEST(LightGroupsOfTwoLamps, UnknownNamesAreRejected) {
    Lit same = lit(coarse);
    const auto refused = change_light(same.solution, same.groups, {.dim = {{"middle", 1}}});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().hint, "there are left, right");
    EXPECT_FALSE(change_light(same.solution, same.groups, {.dim = {{"left", -1}}}));
    EXPECT_FALSE(change_light(same.solution, same.groups, {.reflectance = {{"side", Spectrum(1)}}}));
    EXPECT_FALSE(change_light(same.solution, same.groups, {.reflectance = {{"roof", Spectrum(0.5)}}}));
}

/// Writes a solution with its groups, and reads the groups.
void write_and_read(const Lit& whole, const std::string& path, LightGroups& groups) {
    ASSERT_TRUE(write_solution(path, whole.solution, &whole.groups));
    const Result<Solution> solution = load_solution(path, Rehearsed::not_yet, &groups);
    ASSERT_TRUE(solution) << solution.error().message;
}

TEST(LightGroupsOfTwoLamps, AreRestoredFromAFile) {
    const Lit whole = lit(coarse);
    const TemporaryFolder folder;
    LightGroups groups;
    write_and_read(whole, folder / "s.h5", groups);
    ASSERT_EQ(groups.groups.size(), 2u);
    EXPECT_EQ(groups.transport.source, whole.groups.transport.source);
    EXPECT_EQ(groups.transport.weight, whole.groups.transport.weight);
    EXPECT_EQ(groups.transport.error, whole.groups.transport.error);
    EXPECT_EQ(groups.groups[1].indirect, whole.groups.groups[1].indirect);
    EXPECT_EQ(groups.groups[1].emitters.materials, whole.groups.groups[1].emitters.materials);
    EXPECT_TRUE(load_solution(folder / "s.h5")) << "who does not ask for them";
}

TEST(LightGroupsOfTwoLamps, AreRestoredFromAFileIfNothingReflects) {
    SceneDescription d = two_lamps();
    for (Material& m : d.materials) m.reflectance = Spectrum(0);
    const Lit whole = lit(coarse, std::move(d));
    const TemporaryFolder folder;
    LightGroups groups;
    write_and_read(whole, folder / "s.h5", groups);
    ASSERT_EQ(groups.groups.size(), 2u);
    EXPECT_EQ(groups.groups[1].interpolant, whole.groups.groups[1].interpolant);
}

TEST(LightChangeWords, AreParsed) {
    LightChange change;
    EXPECT_TRUE(read_dim("desk=left=0.5", change));
    EXPECT_EQ(change.dim[0], (std::pair<std::string, double>("desk=left", 0.5)));
    EXPECT_TRUE(read_reflectance("wall=0.5", change));
    EXPECT_EQ(change.reflectance[0].second[bands - 1], 0.5);
    for (const char* wrong : {"", "left", "=1", "left=", "left=x", "left=nan"})
        EXPECT_FALSE(read_dim(wrong, change)) << wrong;
    for (const char* wrong : {"wall=0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8", "wall=,", "wall"})
        EXPECT_FALSE(read_reflectance(wrong, change)) << wrong;
}

}  // namespace exitance
