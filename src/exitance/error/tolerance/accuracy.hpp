#pragma once

#include "exitance/mesh/solve_mesh.hpp"
#include "exitance/solve/solve_options.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {

/// The inner knobs of a solve, derived from the error asked for; a knob that the user set stands as it is.
struct Knobs {
    MeshSize solve_mesh;          ///< Of the elements that the method solves on.
    RayBudget solve_rays;         ///< Rays of a row, where rows are cast.
    double direct_tolerance = 0;  ///< Misfit of the projected direct light, relative to its mean.
    double residual = 0;          ///< Of the discrete system.
    std::size_t max_iterations = 1000;
    double link_error = 0;                 ///< Of all links together, relative to the mean reflected radiosity.
    bool links_deliver = true;             ///< If their polynomials can, with nothing gathered afterwards.
    MeshSize gather_mesh;                  ///< Of the elements that indirect light is gathered on, to begin with.
    RayBudget gather_rays;                 ///< Rays of a node.
    double gather_tolerance = 0;           ///< Error of interpolation, relative to the mean reflected radiosity.
    double gather_noise = 0;               ///< Error of the rays, likewise,
    bool gather_curved = false;            ///< By polynomials of second degree.
    double gather_relative_tolerance = 0;  ///< Error of interpolation where elements are summed, of the light there.
    double gather_element_share = 0;       ///< What an element may miss there, of the light there.
    bool refined = false;                  ///< What is summed is refined and summed once more (`refined_light`).
};

/// Knobs for a relative error, where the pieces of the scene are these. Rules of thumb that the certificate checks:
/// elements ~ 1/R, rays a node ~ R^(-4/3) (scrambled Sobol points), strips at concave edges until their share is R.
Knobs knobs_for_error(double error, const std::vector<Piece>& pieces, const SolveOptions& options);

/// The same where light is summed over elements (`ElementGather`). Nothing is lost to noise there, so that meshes for a
/// larger error do, and rougher ones still where what was summed is refined; below 1%, where places by themselves are
/// to be right, edges and their ends are graded further.
Knobs knobs_for_sums(const Knobs& knobs, double error, const std::vector<Piece>& pieces, const SolveOptions& options);

/// What an error is made of, RMS relative to the mean reflected light: the method's elements, and of the local pass the
/// noise of its rays and its interpolation.
struct ErrorParts {
    double method = 0, noise = 0, interpolation = 0;
};

/// Knobs for another attempt.
struct Tightened {
    Knobs knobs;
    bool method = false;  ///< The method has to solve again; otherwise the light that it found is good enough.
    double left = 1;      ///< The share of its part of the error that is left then.
    double work = 1;      ///< About how many times the last attempt's time the next one takes.
};

/// Knobs that bring the parts together below `target`: only those parts are tightened that are too large.
Tightened tightened(const Knobs& knobs, const ErrorParts& parts, double target, const SolveOptions& options);

/// Knobs for an attempt that leaves the method's knobs and light as they are but for a step of refinement, which leaves
/// a share `left` of the method's part. What is gathered but for its change stays, too, if the error is within `limit`
/// then; else the local pass is tightened as for `target`.
Tightened refined(const Knobs& knobs, const ErrorParts& parts, double left, double limit, double target,
                  const SolveOptions& options);

}  // namespace exitance
