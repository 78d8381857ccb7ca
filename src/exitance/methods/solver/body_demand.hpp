#pragma once

#include <span>
#include <vector>

#include "exitance/scene/bodies.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// Error that attempts allow on each body, and the attempts that were made because a body was too inaccurate.
class BodyDemand {
  public:
    /// Returns true if an attempt for bodies is worthwhile: if the error of some body exceeds `limit` by more than its
    /// noise. A second attempt is made only if the first one halved the excess of the worst body, whose error is
    /// `worst`. More attempts would cost more than the whole solve, for bodies whose errors are uncertain themselves.
    bool needs_attempt(std::span<const BodyError> errors, double worst, double limit) const;
    /// Records an attempt for bodies. Returns true if it is the first one.
    bool begin_attempt(double worst);

    /// Light whose error is reduced for the sake of a body.
    enum class Cause : std::uint8_t {
        gathered,  ///< The reflected light on the body itself, which the gather computes.
        seen       ///< The direct light on the elements that the body sees, whose error it receives.
    };
    /// Reduces the errors allowed on the bodies whose error exceeds `limit`.
    void tighten(std::span<const BodyError> errors, const SceneBodies& bodies, double limit, Cause cause);

    /// Sets the number of bodies. Keeps the errors that are allowed already.
    void resize(std::size_t bodies) { shares_.resize(bodies); }
    /// Returns the error of direct light that one element may have for the sake of each body, given `body_error`
    /// (`Knobs`).
    std::vector<double> allowed_on_seen_elements(double body_error) const;
    /// Multiplies the light of each body by the error that the gather may have on it.
    void allow_on_gathered(std::span<double> light_of_bodies, double body_error) const;

    template <class Archive>
    void archive_state(Archive& a) {
        a(attempts_, worst_before_, shares_);
    }

  private:
    /// Factors on the errors that a body may have.
    struct Shares {
        double gathered = 1, seen = 1;
    };
    int attempts_ = 0;
    double worst_before_ = 0;  ///< Error of the worst body before the last of these attempts; 0: there was none.
    std::vector<Shares> shares_;
};

}  // namespace exitance
