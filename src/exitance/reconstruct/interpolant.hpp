#pragma once

#include "exitance/core/progress.hpp"
#include "exitance/reconstruct/solution.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

struct InterpolantOptions {
    double edge = 0;          ///< Longest edge of an element to begin with, metres.
    double tolerance = 0;     ///< RMS error of rho E over all surfaces that is aimed at, W/m^2.
    int max_depth = 12;       ///< Cuts below the first mesh.
    std::size_t max_elements = 2'000'000;
    bool add_direct = true;   ///< Exact direct light on top of `indirect`, or is it in there already?
};

struct InterpolantReport {
    double error = 0;  ///< Estimated RMS over all surfaces of rho (E_dir + E_ind - interpolant), W/m^2.
    bool interrupted = false;
};

/// Direct and indirect irradiance together as plain elements, for files and for readers that hold no exact direct
/// light: on each leaf the polynomial nearest in the mean square to E_dir + E_ind at the points of a quadrature rule (3
/// x 3 Gauss on parallelograms, 7 points on triangles). A leaf is cut while its misfit has more than its share of the
/// tolerance. O(elements x points x visible emitters).
ElementFunction make_interpolant(const Stage& stage, const ElementFunction& indirect,
                                 const InterpolantOptions& options, InterpolantReport& report, const StopRequest& stop);

}  // namespace exitance
