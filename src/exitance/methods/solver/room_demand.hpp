#pragma once

#include <span>
#include <vector>

#include "exitance/solution/solution.hpp"

namespace exitance {

struct GlobalLight;
struct Stage;

/// Light of the rooms by which errors are judged, and the errors that attempts allow in them. The arrays are empty if
/// the scene is one room.
class RoomDemand {
  public:
    /// Sets the light of the rooms, and the errors allowed in proportion to it.
    void set_light(const Stage& stage, const GlobalLight& light);
    /// Replaces the light of the rooms by that of delivered light, W/m^2. `mean_light`: that of the method, W/m^2.
    void correct_light(const std::vector<double>& delivered, double mean_light, const Stage& stage);
    /// Allows errors in proportion to the light of each room, however bright it is.
    void allow_by_light() { allowed_in_ = light_in_; }

    /// Prepares another attempt, whose settings multiply the allowed noise by `step`. If that is less than 1, the rooms
    /// that are accurate enough keep their noise. `whole_error`: error of all rooms together. `target`: sufficient
    /// error of the whole and of a room.
    void keep_noise_of_accurate(std::span<const RoomError> errors, std::size_t rooms, double whole_error, double target,
                                double step);

    const std::vector<double>& light_in() const { return light_in_; }      ///< Light over the mean light of all rooms.
    const std::vector<double>& allowed_in() const { return allowed_in_; }  ///< See `allowed_by_room`.
    const std::vector<double>& noise_in() const { return noise_in_; }      ///< See `LocalPassDemand::noise_in`.

    template <class Archive>
    void archive_state(Archive& a) {
        a(light_in_, allowed_in_, noise_in_);
    }

  private:
    std::vector<double> light_in_, allowed_in_, noise_in_;
};

}  // namespace exitance
