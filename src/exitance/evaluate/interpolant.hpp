#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {

struct InterpolantOptions {
    double tolerance = 0;  ///< Required RMS error of rho E over all surfaces, W/m^2.
    int max_depth = 12;    ///< Limit on the rounds of refinement.
    /// The result may have `max_growth` times as many elements as the direct and the indirect light together, or
    /// `always_allowed`, whichever is more. Sharp borders of sunlight would be split without end; the error that
    /// remains is reported.
    double max_growth = 4;
    std::size_t always_allowed = 20'000;
    /// Light of each room, to which its allowed error is proportional, like in LocalPassDemand.
    std::span<const double> light_in = {};
    std::uint64_t seed = 1;        ///< Selects the places at which the error is measured.
    Progress* progress = nullptr;  ///< Receives the progress of the fits; null: no reports.
};

struct InterpolantReport {
    double error = 0;  ///< Error of the interpolant, measured by `interpolant_error`, W/m^2; 0 if interrupted.
    bool interrupted = false;
};

/// Direct and indirect irradiance together on plain elements, for files and other uses without exact direct light.
/// Adds, on each leaf of the direct projection, the projected direct light (less the share of it that `indirect`
/// contains) and the least-squares polynomial of the indirect light. Leaves are split while their total misfit exceeds
/// the tolerance, those with the largest shares first, and while the elements are not too many. The result is
/// continuous except at discontinuities of the light
/// (`nearest_continuous`). O(elements x nodes), plus exact direct light for new leaves.
ElementFunction make_interpolant(const Stage& stage, const DirectProjection& direct, const ElementFunction& indirect,
                                 const Spectrum& direct_share, const InterpolantOptions& options,
                                 InterpolantReport& report, const StopRequest& stop);

}  // namespace exitance
