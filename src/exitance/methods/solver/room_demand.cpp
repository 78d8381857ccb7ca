#include "exitance/methods/solver/room_demand.hpp"

#include "exitance/calibration/numbers.hpp"
#include "exitance/methods/light/light_functions.hpp"

namespace exitance {

void RoomDemand::set_light(const Stage& stage, const GlobalLight& light) {
    light_in_ = light_by_room(stage, light);
    allowed_in_ = allowed_by_room(stage, light_in_, calibrated::whole_beyond_rooms);
}

void RoomDemand::correct_light(const std::vector<double>& delivered, double mean_light, const Stage& stage) {
    if (light_in_.empty()) return;
    for (std::size_t room = 0; room < delivered.size(); ++room)
        if (delivered[room] > 0) light_in_[room] = delivered[room] / mean_light;
    raise_dark_rooms(light_in_);
    allowed_in_ = allowed_by_room(stage, light_in_, calibrated::whole_beyond_rooms);
}

void RoomDemand::keep_noise_of_accurate(std::span<const RoomError> errors, std::size_t rooms, double whole_error,
                                        double target, double step) {
    if (step == 1) return;
    noise_in_.resize(rooms, 1);
    for (std::size_t room = 0; room < rooms; ++room) {
        const bool is_accurate = whole_error <= target && errors[room].error <= target && step < 1;
        noise_in_[room] = is_accurate ? noise_in_[room] / step : 1;
    }
}

}  // namespace exitance
