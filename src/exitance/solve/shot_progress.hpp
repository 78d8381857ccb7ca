#pragma once

#include <span>

#include "exitance/base/phase_times.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// Progress that is notified of every shot; shooting methods check for this type.
class ShotProgress : public Progress {
  public:
    /// Called before a patch shoots. `outline`: its corners, metres; `unshot`: share of power that is unshot.
    virtual void shot(std::span<const Point> outline, double unshot) = 0;
};

/// The ShotProgress that a run's progress is or wraps; null if there is none.
inline ShotProgress* find_shot_progress(Progress& progress) {
    if (auto* const times = dynamic_cast<PhaseTimes*>(&progress)) return find_shot_progress(times->inner());
    return dynamic_cast<ShotProgress*>(&progress);
}

}  // namespace exitance
