#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {

struct InterpolantOptions {
    double tolerance = 0;  ///< RMS error of rho E over all surfaces that is to be held, W/m^2.
    int max_depth = 12;    ///< Rounds of cutting.
    std::size_t max_elements = 2'000'000;
    std::span<const double> light_in = {};  ///< As in LocalPassDemand: errors are allowed in proportion.
    std::uint64_t seed = 1;                 ///< Of the places at which the error is measured.
};

struct InterpolantReport {
    double error = 0;  ///< Of the interpolant, measured as `interpolant_error` does; 0 if interrupted. W/m^2
    bool interrupted = false;
};

/// Direct and indirect irradiance together as plain elements, for files and for readers that hold no exact direct
/// light: the direct projection (less the share of it that `indirect` holds), plus on each of its leaves the polynomial
/// nearest to the indirect light. Leaves are cut while their misfits together exceed the tolerance, those with the
/// largest shares first. Continuous but where light jumps (`nearest_continuous`). O(elements x places), and exact
/// direct light for the leaves that are new.
ElementFunction make_interpolant(const Stage& stage, const DirectProjection& direct, const ElementFunction& indirect,
                                 const Spectrum& direct_share, const InterpolantOptions& options,
                                 InterpolantReport& report, const StopRequest& stop);

}  // namespace exitance
