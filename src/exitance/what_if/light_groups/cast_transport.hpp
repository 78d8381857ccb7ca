#pragma once

#include "exitance/transport/ray_rows.hpp"
#include "exitance/transport/stage.hpp"
#include "exitance/what_if/light_groups/kept_transport.hpp"

namespace exitance {

/// Accuracy of the stored transport.
struct CastDemand {
    RayBudget rays;          ///< Rays from one sample point of a receiver.
    double form_factor = 0;  ///< Sources of one parent element are merged if their total form factor is below this.
    std::uint64_t seed = 1;
};

/// Returns the largest elements of `indirect` on which it is bilinear (linear on triangles) up to an RMS of rho E of at
/// most `straight`, W/m^2.
std::vector<std::uint32_t> choose_receivers(const Solution& solution, double straight);

/// Computes transport to receivers by rays. Equal numbers of rays start from each point of a rule on the receiver, and
/// the light that they meet is fitted by the nearest polynomial. Rays that hit sibling elements are attributed to the
/// parent if all siblings are hit, as far as few rays can show, and their total form factor is below the demand.
/// `layout`: of the solution and the receivers. Rows stay empty after a request to stop. O(rays log rays).
KeptTransport cast_transport(const Stage& stage, const Solution& solution, std::vector<std::uint32_t> receivers,
                             const TransportLayout& layout, const CastDemand& demand, const StopRequest& stop);

}  // namespace exitance
