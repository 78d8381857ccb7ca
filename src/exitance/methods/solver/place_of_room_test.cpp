#include "exitance/methods/solver/place_of_room.hpp"

#include <gtest/gtest.h>

#include "exitance/scene/sky/sky_model.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

TEST(PlaceOfRoom, HasAreaBoxAndObjects) {
    const Scene scene = built_scene("office", {{"nx", "2"}, {"ny", "1"}});
    Stage stage(scene);
    stage.rooms = find_light_rooms(stage, 1, StopRequest());
    ASSERT_EQ(stage.rooms.count(), 2u);
    const std::string first = place_of_room(stage, 0), second = place_of_room(stage, 1);
    EXPECT_NE(first, second);
    for (const std::string& place : {first, second}) {
        EXPECT_TRUE(place.starts_with("room of ")) << place;
        for (const char* part : {" m^2 between (", ") and (", ") with '"})
            EXPECT_NE(place.find(part), std::string::npos) << place;
    }
}

TEST(PlaceOfRoom, SurroundingsAreNamedByTheirBodies) {
    SceneDescription d;
    d.groups = {"ground", "house", "shed"};
    d.materials = {{"grey", Spectrum(0.3), {}}};
    const auto add = [&](const std::vector<Point>& outline, std::uint32_t group) {
        SceneDescription::Face face;
        for (const Point& p : outline) {
            face.corners.push_back(static_cast<std::uint32_t>(d.points.size()));
            d.points.push_back(p);
        }
        face.group = group;
        d.faces.push_back(face);
    };
    const auto add_box = [&](Point lo, Point hi, std::uint32_t group) {
        add({{lo.x, lo.y, hi.z}, {hi.x, lo.y, hi.z}, {hi.x, hi.y, hi.z}, {lo.x, hi.y, hi.z}}, group);
        add({{lo.x, lo.y, lo.z}, {hi.x, lo.y, lo.z}, {hi.x, lo.y, hi.z}, {lo.x, lo.y, hi.z}}, group);
        add({{hi.x, hi.y, lo.z}, {lo.x, hi.y, lo.z}, {lo.x, hi.y, hi.z}, {hi.x, hi.y, hi.z}}, group);
        add({{hi.x, lo.y, lo.z}, {hi.x, hi.y, lo.z}, {hi.x, hi.y, hi.z}, {hi.x, lo.y, hi.z}}, group);
        add({{lo.x, hi.y, lo.z}, {lo.x, lo.y, lo.z}, {lo.x, lo.y, hi.z}, {lo.x, hi.y, hi.z}}, group);
    };
    add({{-300, -300, 0}, {300, -300, 0}, {300, 300, 0}, {-300, 300, 0}}, 0);
    add_box({-6, -5, 0}, {6, 5, 7}, 1), add_box({100, 0, 0}, {106, 5, 5}, 2);
    d.distant.domes.push_back({uniform_sky(), Spectrum(100.0)});
    const Scene scene = std::move(*make_scene(std::move(d)).scene);
    Stage stage(scene);
    stage.rooms = find_light_rooms(stage, 1, StopRequest());
    ASSERT_EQ(stage.rooms.count(), 2u);
    EXPECT_FALSE(stage.rooms.is_surroundings(0));
    EXPECT_TRUE(stage.rooms.is_surroundings(1));
    EXPECT_TRUE(place_of_room(stage, 0).starts_with("room of "));
    EXPECT_TRUE(place_of_room(stage, 1).starts_with("surroundings of 'house' and 'shed', ")) << place_of_room(stage, 1);
}

}  // namespace
}  // namespace exitance
