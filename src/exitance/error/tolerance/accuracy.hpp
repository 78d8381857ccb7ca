#pragma once

#include "exitance/mesh/solve_mesh.hpp"
#include "exitance/solve/solve_options.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {

/// The internal settings of a solve, derived from the requested error. Settings given by the user are not changed.
struct Knobs {
    MeshSize solve_mesh;          ///< Mesh of the elements on which the method solves.
    RayBudget solve_rays;         ///< Rays per matrix row, if rows are sampled by rays.
    double direct_tolerance = 0;  ///< RMS error of the projected direct light, relative to its mean.
    /// Error of the projected direct light of one element and, in the local pass, of noise and of interpolation, on any
    /// body, relative to the light that the body reflects.
    double body_error = 0;
    double residual = 0;  ///< Residual of the discrete system.
    std::size_t max_iterations = 1000;
    double link_error = 0;  ///< Error of all links together, relative to the mean reflected radiosity.
    /// Deliver the polynomials of the links, if accurate enough, without a gather afterwards.
    bool links_deliver = true;
    MeshSize gather_mesh;                  ///< Initial mesh of the elements on which indirect light is gathered.
    RayBudget gather_rays;                 ///< Rays per gather point.
    double gather_tolerance = 0;           ///< Error of interpolation, relative to the mean reflected radiosity.
    double gather_noise = 0;               ///< Error by the noise of rays, relative to the mean reflected radiosity.
    bool gather_curved = false;            ///< Fit polynomials of second degree in the gather.
    double gather_relative_tolerance = 0;  ///< Error of interpolation of summed light, relative to the local light.
    double gather_element_share = 0;       ///< Allowed error of one element in the sum, relative to the local light.
    bool corrects_sums = false;            ///< Correct the summed light, and sum once more (`corrected_sums`).
};

/// Returns the settings for a relative error and the lit pieces of a scene. Rules of thumb, verified afterwards by the
/// certificate (R: the error): elements ~ 1/R, rays per point ~ R^(-4/3) (scrambled Sobol points), strips along concave
/// edges until their share of the error is R. The number of elements is multiplied by `lit.multiplicity`.
Knobs knobs_for_error(double error, const LitSpaces& lit, const SolveOptions& options);

/// Returns the settings for light that is summed over elements (`ElementGather`) instead of sampled by rays. Sums have
/// no noise, so that coarser meshes are sufficient, and still coarser ones if the summed light is refined. Below an
/// error of 1%, where the light must be accurate at every point, edges and their ends are graded further.
Knobs knobs_for_sums(const Knobs& knobs, double error, const LitSpaces& lit, const SolveOptions& options);

/// The parts of an error, RMS relative to the mean reflected light: the elements of the method, and the noise and
/// interpolation of the local pass.
struct ErrorParts {
    double method = 0, noise = 0, interpolation = 0;
};

/// Settings for another attempt.
struct Tightened {
    Knobs knobs;
    bool method = false;  ///< The method must solve again; otherwise its solution is accurate enough.
    double left = 1;      ///< Expected factor on the method's part of the error.
    double work = 1;      ///< Expected time, as a multiple of the last attempt's.
};

/// Returns settings that bring the total error below `target`. Tightens only the parts that are too large.
Tightened tightened(const Knobs& knobs, const ErrorParts& parts, double target, const SolveOptions& options);

/// Returns settings for an attempt that only adds a refinement step to the method's solution, which multiplies the
/// method's part of the error by `left`. If the total is then within `limit`, the gathered light is kept as well,
/// except for its change; else the local pass is tightened as for `target`.
Tightened tightened_for_step(const Knobs& knobs, const ErrorParts& parts, double left, double limit, double target,
                             const SolveOptions& options);

}  // namespace exitance
