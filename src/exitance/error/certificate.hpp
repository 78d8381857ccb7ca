#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "exitance/base/progress.hpp"
#include "exitance/error/batch_mean.hpp"
#include "exitance/error/direct_check.hpp"
#include "exitance/error/hidden_errors.hpp"
#include "exitance/gather/local_pass.hpp"
#include "exitance/gather/rough_places.hpp"
#include "exitance/scene/bodies.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/solve/global_light.hpp"

namespace exitance {

/// Light that the certificate sums over elements instead of casting rays. Only for scenes without occlusion
/// (`ElementGather::suits`).
struct SummedLight {
    std::vector<ElementGather> delivered;          ///< The delivered function's reflected light is the sum of these.
    std::span<const ElementGather> gathered = {};  ///< The light that the local pass gathered; empty: none.
    double share = 0;  ///< Error of one element, as a share of the irradiance at the receiver.
};

struct CertificateOptions {
    double error = 1;  ///< Relative error that must be resolved; determines the number of rays.
    std::uint64_t seed = 1;
    std::size_t points = points_for(0);  ///< Number of points that each call of `measure` adds.
    /// True if the scene is closed and absorbs as much of the delivered light as it emits. The mean error is then
    /// known.
    bool keeps_flux = false;
    bool direct_in_elements = false;  ///< True if the delivered function includes the emitters' light.
    int bounces = -1;                 ///< Number of reflections that the solution includes; -1: all.
    /// Returns the number of points for a delivered function with this many leaves: at least 1280, and one per 16
    /// leaves. In a large mesh, a few leaves may have most of the error.
    static std::size_t points_for(std::size_t leaves) { return std::max<std::size_t>(1280, leaves / 16); }
    /// Expected error and number of rays of every leaf of the delivered function, from the local pass. Points are
    /// denser where errors are expected, and their rays are proportional to those of the local pass. Null: no local
    /// pass.
    const Field<ElementId, LocalPassReport::Leaf>* leaves = nullptr;
    /// Places in the delivered function at which the error is measured; empty: all surfaces.
    std::vector<ElementTree::Place> places = {};
    /// The light that the local pass gathered. With it, the error is divided into that of the local pass and that of
    /// the method. Null: no local pass.
    const ReflectedLight* gathered = nullptr;
    /// Locator of the method's mesh; null: the certifier creates one.
    const ElementLocator* coarse = nullptr;
    /// Light to be summed over elements instead of casting rays; null: rays are cast.
    const SummedLight* summed = nullptr;
    /// Mean reflected light of every room divided by that of the scene; empty if the scene is one room.
    std::vector<double> light_in = {};
    /// Mean reflected light of every room, W/m^2, to be reported; empty: that of the method's elements.
    std::vector<double> delivered_in = {};
    /// Allowed error of every room, relative to the mean light of the scene. Weights the density of points and the
    /// parts `local` and `method`. Empty if the scene is one room.
    std::vector<double> allowed_in = {};
    /// Projection of direct light that `b` reads at ray hits, to be checked there; empty if `b` reads none.
    ProjectedDirect projected = {};
    /// Limit on the rays for measuring bodies; about as many more check the smooth part of the error by paths.
    std::size_t check_rays = 1 << 16;
    /// Bodies whose errors are reported; null: none.
    const SceneBodies* bodies = nullptr;
    /// Ends further measurements when it is requested. The first `measure` is always completed. Null: no stop.
    const StopRequest* stop = nullptr;
    Progress* progress = nullptr;  ///< Receives the progress of each step; null: no reports.
    bool is_stopped() const { return stop && stop->requested(); }
};

/// How far a delivered function is from the solution of the radiosity equation.
struct Certificate {
    double estimate = 0;     ///< Relative RMS error of B (the residual, propagated by a coarse solve).
    double uncertainty = 0;  ///< Standard error of `estimate`; large if a few points have most of the error.
    double bound = 0;        ///< Upper bound of the relative RMS error, at 95% confidence.
    /// Relative error that 99% of the area does not exceed; empty until `measure_p99` is called, and if
    /// noise hides the largest errors.
    std::optional<double> p99 = {};
    double residual = 0;  ///< Relative RMS of the residual r.
    /// Parts of the residual where `largest` is, relative RMS; 0 if the gathered light is unknown. `local`: delivered
    /// light minus an exact gather of the light that was gathered (noise of rays and interpolation). `method`: error of
    /// the gathered light itself (the method's elements). r = local + method.
    double local = 0, method = 0;
    /// Part of `local` at single points at which the error is a notable share of the allowed error, and these points.
    double rough = 0;
    std::vector<RoughPlace> rough_places = {};
    /// Factor by which `check_by_paths` multiplied the largest() error, since near surfaces reflect errors to each
    /// other and the coarse response misses that. 1: not checked, or nothing found.
    double again = 1;
    double constant = 1;        ///< Ratio of the error bound to ||r||.
    double mean_reflected = 0;  ///< Mean reflected radiosity over surfaces and bands, W/m^2; errors are relative to it.
    std::size_t points = 0, rays = 0;
    double worst_room = 0;        ///< Largest estimate of a room; `estimate` if the scene is one room.
    double room_uncertainty = 0;  ///< Standard error of `worst_room`.
    /// The room whose error is largest(); empty if that is the error of the whole scene. `largest_light`: light to
    /// which the largest error is relative, W/m^2.
    std::optional<std::size_t> largest_room = {};
    double largest_light = 0;
    std::optional<double> worst_body = {};  ///< Largest error of a body; set by `measure_each_body`.
    HiddenErrors hidden = {};               ///< Bodies whose error remained unknown; set by `measure_each_body`.
    /// Adds an error that is independent of what was measured, relative to the mean reflected light, in quadrature.
    void add_independent_error(double error) {
        for (double* known : {&estimate, &bound, &worst_room}) *known = std::hypot(*known, error);
    }
    /// Returns the larger of the errors of the whole scene and of the worst room.
    double largest() const { return std::max(estimate, worst_room); }
    /// Returns the upper confidence limit of the estimate: one-sided, at 95%.
    double upper_limit() const { return estimate + student_95 * uncertainty; }
    double largest_uncertainty() const { return estimate < worst_room ? room_uncertainty : uncertainty; }
};

/// Estimates the error of B = M + rho (E_dir + E_ind), E_dir exact, from its residual
///
///     r = M + rho H B - B = rho (E_dir + H b - E_dir - E_ind),     b = B - M,
///
/// at points that are stratified over all surfaces. They are denser where errors are expected and in gaps of little
/// area, and are weighted accordingly. At each point, two independent ray gathers over `b` give r1 and r2, so that E[r1
/// r2] = r^2 is free of the rays' noise. If `b` reads a projection of direct light, a share of the ray hits is checked
/// against the true direct light (`DirectCheck`), so that r does not depend on the quality of the projection.
///
/// The error is e = (I - rho H)^-1 r. Its rough part is r itself; its smooth part is the response of a coarse solve to
/// the mean residuals of the regions. Paths check that response (`check_by_paths`). The bound is the product of the
/// norm of (I - rho H)^-1, estimated as sqrt(C_1 C_inf) from two coarse solves with unit light, and Student's upper
/// confidence limit of ||r||. If light is summed over elements, the residual is summed too; only the check of the
/// projected light is then noisy.
/// Source: [Arvo94], part "residual"; [Lischinski94]. O(points x rays).
class Certifier {
  public:
    /// `light` provides the mesh and the direct light of the coarse solves. `b` must read the delivered function. All
    /// arguments must outlive the object.
    Certifier(const Stage& stage, const GlobalLight& light, const ElementFunction& indirect, const ReflectedLight& b,
              const CertificateOptions& options);
    ~Certifier();

    /// Measures the residual at `options.points` more points, and returns the estimate from all points so far. Its
    /// `rays` counts those of all calls. If a stop is requested during a further call, its points are dropped. `later`:
    /// number of calls that may follow, for the progress, which they continue.
    Certificate measure(std::size_t later = 0);

    /// Sets `p99` of the result of the last `measure`, and adds the rays cast to its `rays`. The points with the
    /// largest apparent errors are measured again, since these are mostly noise; after a stop, they keep that noise.
    void measure_p99(Certificate& certificate);

    /// Checks the smooth part of the error by paths at some of the points of `measure`; what it lacks is added to the
    /// estimate. Adds the rays cast to `rays`.
    void check_by_paths(Certificate& certificate);

    /// Measures the error of every body at additional points on it (`measure_bodies`) and sets `worst_body`. A single
    /// body has the error of the scene, so check_by_paths() comes first. Adds the rays cast to `rays`. After a stop,
    /// the remaining bodies get no error.
    void measure_each_body(Certificate& certificate);

    /// Returns the error of every body, in descending order of area; empty before `measure_each_body`.
    const std::vector<BodyError>& bodies() const;

    /// Returns the error of every room after the last `measure`, in descending order of area.
    const std::vector<RoomError>& rooms() const;
    /// Returns the error of every face after the last `measure`; empty if there was no light to measure. O(points +
    /// faces).
    std::vector<FaceError> surface_errors() const;

  private:
    struct Content;
    std::unique_ptr<Content> content_;
};

}  // namespace exitance
