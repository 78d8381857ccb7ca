#include "exitance/methods/solver/room_demand.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

const std::vector<RoomError> accurate_and_not{{.error = 0.01}, {.error = 0.05}};

TEST(RoomDemand, AccurateRoomsKeepTheirNoiseWhenSettingsAreTightened) {
    RoomDemand demand;
    demand.keep_noise_of_accurate(accurate_and_not, 2, 0.012, 0.014, 0.5);
    EXPECT_EQ(demand.noise_in(), (std::vector<double>{2, 1}));
    demand.keep_noise_of_accurate(accurate_and_not, 2, 0.012, 0.014, 0.5);
    EXPECT_EQ(demand.noise_in(), (std::vector<double>{4, 1})) << "the noise of the settings is a quarter by now";
}

TEST(RoomDemand, NoRoomKeepsItsNoiseIfTheWholeIsInaccurate) {
    RoomDemand demand;
    demand.keep_noise_of_accurate(accurate_and_not, 2, 0.03, 0.014, 0.5);
    EXPECT_EQ(demand.noise_in(), (std::vector<double>{1, 1}));
}

TEST(RoomDemand, NoiseIsUnchangedIfSettingsAre) {
    RoomDemand demand;
    demand.keep_noise_of_accurate(accurate_and_not, 2, 0.012, 0.014, 0.5);
    demand.keep_noise_of_accurate(accurate_and_not, 2, 0.03, 0.014, 1);
    EXPECT_EQ(demand.noise_in(), (std::vector<double>{2, 1}));
    demand.keep_noise_of_accurate(accurate_and_not, 2, 0.012, 0.014, 2);
    EXPECT_EQ(demand.noise_in(), (std::vector<double>{1, 1})) << "coarser settings apply to all rooms";
}

}  // namespace
}  // namespace exitance
