#include "exitance/methods/solver/body_demand.hpp"

#include <algorithm>

#include "exitance/calibration/error_budget.hpp"

namespace exitance {

bool BodyDemand::needs_attempt(std::span<const BodyError> errors, double worst, double limit) const {
    constexpr int max_attempts = 2;
    const bool is_above = std::any_of(errors.begin(), errors.end(),
                                      [&](const BodyError& body) { return body.error && body.at_least > limit; });
    const bool helps = worst_before_ == 0 || worst - limit < 0.5 * (worst_before_ - limit);
    return is_above && helps && attempts_ < max_attempts;
}

bool BodyDemand::begin_attempt(double worst) {
    worst_before_ = worst;
    return ++attempts_ == 1;
}

void BodyDemand::tighten(std::span<const BodyError> errors, const SceneBodies& bodies, double limit, Cause cause) {
    for (const BodyError& body : errors) {
        if (!body.error || *body.error <= limit) continue;
        Shares& shares = shares_[bodies.body[body.first]];
        (cause == Cause::gathered ? shares.gathered : shares.seen) *= ErrorBudget(limit).next_attempt() / *body.error;
    }
}

std::vector<double> BodyDemand::allowed_on_seen_elements(double body_error) const {
    std::vector<double> out;
    for (const Shares& share : shares_) out.push_back(ErrorBudget::seen_element_share * share.seen * body_error);
    return out;
}

void BodyDemand::allow_on_gathered(std::span<double> light_of_bodies, double body_error) const {
    for (std::size_t i = 0; i < light_of_bodies.size(); ++i) light_of_bodies[i] *= shares_[i].gathered * body_error;
}

}  // namespace exitance
