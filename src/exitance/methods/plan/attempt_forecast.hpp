#pragma once

#include <cstddef>
#include <vector>

namespace exitance {

/// Data of the last attempt, from which another one is forecast if the method's part of the error is too large.
struct AttemptFacts {
    double row_rays = 0;          ///< Rays of the method.
    double gather_rays = 0;       ///< Rays of the local pass for all its elements.
    double certificate_rays = 0;  ///< Rays of the certificate.
    double method = 0;            ///< Part of the error that is not due to the local pass.
    double wanted = 0;            ///< Required value of that part.
    double left = 0;              ///< Expected share of that part that remains after one refinement step.
    double finer = 1;             ///< Expected share of `method` that remains with finer elements of the method.
};

/// Rays of two ways to the same error. The first takes refinement steps on the delivered light (`next_light`); each of
/// them gathers the change of the light with an eighth of the rays, and runs the certificate. The second uses finer
/// elements: their number and the rays per element grow in inverse proportion to the error, and everything is gathered
/// again.
struct AttemptForecast {
    double steps = 1;  ///< Number of steps; infinite if steps do not reach the error.
    double step_rays = 0, finer_rays = 0;
    bool takes_steps() const { return step_rays <= finer_rays; }
};

AttemptForecast forecast_attempt(const AttemptFacts& facts);

/// Returns the errors at which another attempt may aim, given the error of the last one and the requested one. The
/// first is the requested error. Larger ones follow, for when time is short, up to the largest that is still a useful
/// improvement on `error`.
std::vector<double> attempt_aims(double asked, double error);

}  // namespace exitance
