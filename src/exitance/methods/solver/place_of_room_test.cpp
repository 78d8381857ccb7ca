#include "exitance/methods/solver/place_of_room.hpp"

#include <gtest/gtest.h>

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
        EXPECT_TRUE(place.starts_with("of ")) << place;
        for (const char* part : {" m^2 between (", ") and (", ") with '"})
            EXPECT_NE(place.find(part), std::string::npos) << place;
    }
}

}  // namespace
}  // namespace exitance
