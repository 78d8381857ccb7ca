#pragma once

#include <cstddef>
#include <vector>

namespace exitance {

/// What a forecast of another attempt rests on: what the last one took and found, where the method is to blame.
struct AttemptFacts {
    double row_rays = 0;          ///< Of the method,
    double gather_rays = 0;       ///< of all elements that light is gathered on, together,
    double certificate_rays = 0;  ///< and of the estimate.
    double method = 0;            ///< What of the error is not of the local pass,
    double wanted = 0;            ///< and what is wanted of it.
    double left = 0;              ///< Share of that part that one step of refinement leaves, as far as is known.
    double finer = 1;             ///< Share of it that finer elements of the method leave.
};

/// Rays of the two ways to the same error: steps of refinement on from what is delivered (`next_light`), each of which
/// gathers what changes, by an eighth of the rays, and is estimated; or finer elements, as many more of them as they
/// err less, with as many more rays each, and everything gathered anew.
struct AttemptForecast {
    double steps = 1;  ///< How many steps are to be taken; infinite where they do not lead there.
    double step_rays = 0, finer_rays = 0;
    bool takes_steps() const { return step_rays <= finer_rays; }
};

AttemptForecast forecast_attempt(const AttemptFacts& facts);

/// What an attempt may aim at, where the last one has left an error and another is asked for: that one, and where there
/// is no time for it, a little more, up to what is hardly better than what there is.
std::vector<double> attempt_aims(double asked, double error);

}  // namespace exitance
