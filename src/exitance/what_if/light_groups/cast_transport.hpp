#pragma once

#include "exitance/transport/ray_rows.hpp"
#include "exitance/transport/stage.hpp"
#include "exitance/what_if/light_groups/kept_transport.hpp"

namespace exitance {

/// How finely transport is kept.
struct CastDemand {
    RayBudget rays;          ///< Of one place of a receiver.
    double form_factor = 0;  ///< Below it what lies on one element together is that element's.
    std::uint64_t seed = 1;
};

/// The largest elements of `indirect` on which it is bilinear (linear) but for an RMS of rho E of at most `straight`,
/// W/m^2.
std::vector<std::uint32_t> choose_receivers(const Solution& solution, double straight);

/// Transport to these receivers, by rays: as many from each place of a rule on the receiver, so that what they meet is
/// gathered by the polynomial nearest to it. Rays that meet elements side by side count on the one above them while
/// all of them are met, as far as so few rays can tell, and their form factor together is below the demand. `layout`:
/// of the solution and the receivers. O(rays log rays). Rows stay empty once a stop is asked for.
KeptTransport cast_transport(const Stage& stage, const Solution& solution, std::vector<std::uint32_t> receivers,
                             const TransportLayout& layout, const CastDemand& demand, const StopRequest& stop);

}  // namespace exitance
