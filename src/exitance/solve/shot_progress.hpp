#pragma once

#include <span>

#include "exitance/base/phase_times.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// Progress that wants to see who shoots; methods that shoot look for it.
class ShotProgress : public Progress {
  public:
    /// A patch is about to shoot: its corners, metres, and the share of power that is unshot.
    virtual void shot(std::span<const Point> outline, double unshot) = 0;
};

/// The one that a run's progress stands for; null where nobody wants to see.
inline ShotProgress* find_shot_progress(Progress& progress) {
    if (auto* const times = dynamic_cast<PhaseTimes*>(&progress)) return find_shot_progress(times->inner());
    return dynamic_cast<ShotProgress*>(&progress);
}

}  // namespace exitance
