#pragma once

#include <algorithm>
#include <memory>
#include <optional>

#include "exitance/error/direct_check.hpp"
#include "exitance/gather/local_pass.hpp"
#include "exitance/scene/bodies.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/solve/global_light.hpp"

namespace exitance {

/// Light as elements to be summed, where nothing stands between (`ElementGather::suits`).
struct SummedLight {
    std::vector<ElementGather> delivered;          ///< What the delivered function reflects is the sum of these.
    std::span<const ElementGather> gathered = {};  ///< What the local pass gathered, where there was one.
    double share = 0;                              ///< What an element may miss.
};

struct CertificateOptions {
    double error = 1;  ///< The relative error that is to be resolved: it sets the number of rays.
    std::uint64_t seed = 1;
    std::size_t points = points_for(0);  ///< How many the residual is measured at by one look.
    /// Is as much absorbed of the delivered function as is emitted, in a closed scene? Then the error is known on
    /// average.
    bool keeps_flux = false;
    bool direct_in_elements = false;  ///< Does the delivered function hold the emitters' light too?
    int bounces = -1;                 ///< Reflections that are counted; -1: all.
    /// Enough for a delivered function of so many leaves: where they are many, few of them may hold most of the error.
    static std::size_t points_for(std::size_t leaves) { return std::max<std::size_t>(1280, leaves / 16); }
    /// What the local pass knows of the leaves of the delivered function: points gather where it expects errors, with
    /// rays in proportion to those that it took. Null when there was none.
    const Field<ElementId, LocalPassReport::Leaf>* leaves = nullptr;
    /// Where the error is to be measured, in the delivered function; empty: all over the surfaces.
    std::vector<ElementTree::Place> places = {};
    /// What the local pass gathered, where there was one: tells its error from the method's.
    const ReflectedLight* gathered = nullptr;
    /// Of the method's mesh; null: made anew.
    const ElementLocator* coarse = nullptr;
    /// In place of rays. Null where those are cast.
    const SummedLight* summed = nullptr;
    /// The light of every room by the mean light; empty where all is one room.
    std::vector<double> light_in = {};
    /// What errors rooms may have, in proportion: by which points are dealt out, and the parts of the error counted.
    std::vector<double> allowed_in = {};
    /// The projection of direct light that `b` reads at hits; it is checked there. None where `b` reads no projection.
    ProjectedDirect projected = {};
    /// Rays that may be spent on bodies and on paths.
    std::size_t check_rays = 1 << 16;
    /// Errors are told by body, too; null: not by body.
    const SceneBodies* bodies = nullptr;
};

/// How far a delivered function is from the solution of the radiosity equation.
struct Certificate {
    double estimate = 0;     ///< Relative RMS error of B, the defect propagated by a coarse solve,
    double uncertainty = 0;  ///< and its standard error: large where few points hold most of it.
    double bound = 0;        ///< The same, as an upper bound at 95% confidence.
    /// What the error is below on 99% of the area, relative likewise, once `tell_p99` has told it.
    std::optional<double> p99 = {};
    double residual = 0;  ///< Relative RMS of the residual r.
    /// Parts of the residual, relative RMS, when it is known what was gathered: how far the delivered light is from the
    /// gather of that (rays' noise and interpolation), and how far what was gathered is from what should have been (the
    /// method's elements). r = local + method.
    double local = 0, method = 0;
    double constant = 1;  ///< The factor from ||r|| to the bound on the error.
    double mean_reflected =
        0;  ///< Mean reflected radiosity over surfaces and bands, W/m^2: what errors are relative to.
    std::size_t points = 0, rays = 0;
    /// Where rooms are judged apart: the estimate of the worst one, and the root of the mean of the rooms' squares,
    /// each by what it may have, which `local` and `method` are parts of. As the estimate, where all is one room.
    double worst_room = 0, of_rooms = 0;
    double room_uncertainty = 0;            ///< Of `worst_room`, as `uncertainty` is of `estimate`.
    std::optional<double> worst_body = {};  ///< The estimate of the worst body, once `look_at_bodies` has found it.
    /// Of the whole and of every room.
    double largest() const { return std::max(estimate, worst_room); }
    double largest_uncertainty() const { return estimate < worst_room ? room_uncertainty : uncertainty; }
};

/// Estimates the error of B = M + rho (E_dir + E_ind), E_dir exact, from its residual
///
///     r = M + rho H B - B = rho (E_dir + H b - E_dir - E_ind),     b = B - M,
///
/// at points stratified over all surfaces, denser where the error is expected and in gaps too small to count by
/// area, and weighted accordingly. At each, two independent ray gathers over `b` give r1 and r2, so that
/// E[r1 r2] = r^2 without the rays' noise. Where `b` reads a projection of direct light, a share of the hits is checked
/// against the true direct light (`DirectCheck`), so that r does not depend on how good the projection is.
///
/// The error e = (I - rho H)^-1 r: its rough part is r itself, its smooth part is the response of a coarse solve to the
/// regions' mean residuals. That response is checked by paths (`look_at_bodies`). The bound takes the norm of (I - rho
/// H)^-1, sqrt(C_1 C_inf) from two coarse solves with unit light, and Student's upper limit of ||r||. Where light is
/// summed over elements, so is the residual; only the check of projected light has noise there.
/// Source: [Arvo94], part "residual"; [Lischinski94]. O(points x rays).
class Certifier {
  public:
    /// `light` gives mesh and direct light for the coarse solves; `b` must read the delivered function. All must
    /// outlive it.
    Certifier(const Stage& stage, const GlobalLight& light, const ElementFunction& indirect, const ReflectedLight& b,
              const CertificateOptions& options);
    ~Certifier();

    /// Measures at `options.points` more places, and tells what all of them so far say. `rays` counts all of them, too.
    Certificate look();

    /// What the error is below on 99% of the area: sets `p99` of the last look's result, and counts the rays that it
    /// takes. The points whose errors seem largest are measured again, since by few rays those are mostly noise.
    void tell_p99(Certificate& certificate);

    /// Measures every body by points of its own (`measure_bodies`) and sets `worst_body`. Paths check the smooth part
    /// of the error at some of the points of the whole; what it misses is added to the estimate. Counts the rays.
    void look_at_bodies(Certificate& certificate);

    /// The error of every body, the largest body first, once `look_at_bodies` was called.
    const std::vector<BodyError>& bodies() const;

    /// As of the last look: every room's error, the largest room first.
    const std::vector<RoomError>& rooms() const;
    /// As of the last look: every face's error; none when there was no light to measure. O(points + faces).
    std::vector<FaceError> surface_errors() const;

  private:
    struct Content;
    std::unique_ptr<Content> content_;
};

}  // namespace exitance
