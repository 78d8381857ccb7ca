#include "exitance/io/scenes/honeybee/honeybee_states.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

HoneybeeModel model_with(std::vector<HoneybeeDynamic> dynamic) {
    HoneybeeModel out;
    out.modifiers = {{"void", "glass", "clear", {}, {0.9, 0.9, 0.9}},
                     {"void", "glass", "tinted", {}, {0.3, 0.3, 0.3}},
                     {"void", "plastic", "wood", {}, {0.3, 0.3, 0.3, 0, 0}}};
    out.dynamic = std::move(dynamic);
    return out;
}

const std::vector<HoneybeeState> two_states{{"clear"}, {"tinted"}};

std::string fault_of(std::vector<HoneybeeState> states) {
    const Result<HoneybeeStates> found = find_honeybee_states(model_with({{"w", "g", std::move(states)}}), "g", false);
    return found ? "" : found.error().message;
}

}  // namespace

TEST(HoneybeeStates, OfGlassAreFactorsOfTheirTransmittance) {
    const HoneybeeModel model =
        model_with({{"a", "south", two_states}, {"b", "south", two_states}, {"c", "", {{"clear"}, {"clear"}}}});
    const Result<HoneybeeStates> south = find_honeybee_states(model, "south", false);
    ASSERT_TRUE(south);
    EXPECT_EQ(south->objects, (std::vector<std::string>{"a", "b"}));
    ASSERT_EQ(south->factors.size(), 2u);
    EXPECT_EQ(south->factors[0], 1);
    // T = t (1 - r)^2 / (1 - r^2 t^2) with r = (0.52 / 2.52)^2: the quotient is t2 / t1 but for the denominators.
    const double r = 0.52 * 0.52 / (2.52 * 2.52);
    EXPECT_NEAR(south->factors[1], 0.3 / 0.9 * (1 - r * r * 0.81) / (1 - r * r * 0.09), 1e-9);
    const Result<HoneybeeStates> one = find_honeybee_states(model, "c", false);
    ASSERT_TRUE(one);
    EXPECT_EQ(one->objects, std::vector<std::string>{"c"});
}

TEST(HoneybeeStates, WithShadesHaveScenesOfTheirOwn) {
    const HoneybeeSheet awning{"awning", "wood", {{{{0, 0, 2}, {5, 0, 2}, {5, 2, 2}}}}};
    const HoneybeeModel model = model_with(
        {{"w", "g", {{"clear"}, {"tinted"}, {"tinted", {awning}}, {"clear", {awning}}, {"tinted", {awning}}}}});
    const Result<HoneybeeStates> windows = find_honeybee_states(model, "g", false);
    ASSERT_TRUE(windows);
    EXPECT_FALSE(windows->has_shades);
    EXPECT_EQ(windows->scene, (std::vector<std::size_t>{0, 0, 2, 3, 2}));
    EXPECT_LT(windows->factors[1], 0.5);
    EXPECT_EQ(windows->factors[2], 1) << "the scene has the tinted glass";
    EXPECT_EQ(windows->choices(4), (HoneybeeChoices{{"w", 2}}));

    HoneybeeModel of_shades = model_with({{"shelf", "g", {{"wood"}, {"clear"}}, true}});
    const Result<HoneybeeStates> shelf = find_honeybee_states(of_shades, "g", false);
    ASSERT_TRUE(shelf);
    EXPECT_TRUE(shelf->has_shades);
    EXPECT_EQ(shelf->scene, (std::vector<std::size_t>{0, 1}));
    of_shades.dynamic.push_back({"other", "g", {{"wood"}}, true});
    EXPECT_FALSE(find_honeybee_states(of_shades, "g", false)) << "the number of states differs";
}

TEST(HoneybeeStates, ThatAreNoFactorsAreErrors) {
    EXPECT_EQ(fault_of({{"clear"}, {"wood"}}), "the material 'wood' of state 1 of 'w' is not clear glass");
    EXPECT_EQ(fault_of({{"tinted"}, {"clear"}}), "state 1 of 'w' passes more light than its first state");
    EXPECT_FALSE(find_honeybee_states(model_with({}), "g", false));
    const HoneybeeModel other = model_with({{"a", "g", two_states}, {"b", "g", {{"clear"}, {"clear"}}}});
    EXPECT_FALSE(find_honeybee_states(other, "g", false));
    const Result<HoneybeeStates> objects = find_honeybee_states(other, "g", true);
    ASSERT_TRUE(objects);
    EXPECT_EQ(objects->objects.size(), 2u);
}

}  // namespace exitance
