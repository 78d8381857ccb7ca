#pragma once

#include <span>
#include <vector>

#include "exitance/direct/ray_light.hpp"

namespace exitance {

class MirroredLight;

/// Direct light at places, by the cheaper one of two estimators: exact visible parts (DirectLight), or rays (RayLight).
///
/// Light that comes straight from a source and is mirrored by a pane is part of direct light; it is always estimated by
/// samples (MirroredLight).
///
/// The rays that reach the required accuracy are counted in advance (RayLight::rays_for). At a single place exact light
/// counts its work while it is computed, and gives up when it exceeds the cost of these rays. If the first
/// rays then show that many more are needed, as in penumbrae, exact light is tried again, up to a quarter of it: a
/// place never costs more than twice as much as by the cheaper estimator. For places of one polygon the blockers of the
/// whole polygon are counted, up to the cost of the rays; the rays of its middle place determine whether exact light is
/// tried again. The choice depends on the places and the accuracy alone.
class PlaceLight {
  public:
    /// Both arguments must outlive this object.
    PlaceLight(const DirectLight& direct, const RayTracer& tracer);
    ~PlaceLight();

    using SourceName = DirectLight::SourceName;
    using Estimate = RayLight::Estimate;
    class Workspace;

    /// Returns the light at x on region `own` (none: in free space), W/m^2. It is exact if the variance is 0.
    Estimate at(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy, Workspace& room) const;

    /// Like at(), by rays. `known`: see RayLight::at().
    Estimate by_rays(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy, Workspace& room,
                     const RayLight::Spreads* known = nullptr) const;

    /// Places of a convex polygon of a region.
    struct Polygon {
        std::span<const Point> outline;  ///< Outline, metres, counter-clockwise about n.
        Normal n;
        RegionId own;
        std::span<const Point> places;
    };
    /// Computes the light at the places. Exact if `accuracy` allows no error.
    void at_places(const Polygon& on, const LightAccuracy& accuracy, Workspace& room, std::vector<Estimate>& out) const;

    /// Computes the exact light of the given sources (null: of all, and of punctual lights) at the places, and all
    /// light that panes mirror. Returns false if rays, for all sources together, are cheaper.
    bool exact_at_places(const Polygon& on, const std::vector<SourceName>* named, const LightAccuracy& accuracy,
                         Workspace& room, std::vector<Estimate>& out) const;

    const RayLight& rays() const { return rays_; }
    /// Returns the work of finding the blockers of all sources for a polygon, in rays.
    double work_of_preparing() const { return preparing_; }
    /// Returns the number of blockers of a source above which exact light at a place takes more than `work`.
    static DirectLight::WorthCounting worth_counting(double work);
    /// Returns light of sun and lamps without extent that panes mirror onto a receiver, by at most `most` mirror images
    /// chosen by `key`, W/m^2. Unbiased.
    Spectrum mirrored_images(const SurfacePoint& at, std::size_t most, std::uint64_t key) const;
    /// True if panes mirror direct light, which has no closed form: light at places then has noise.
    bool is_mirrored() const { return mirrored_ != nullptr; }

  private:
    std::optional<Spectrum> exact_within(const Point& x, const Normal& n, RegionId own, double work,
                                         Workspace& room) const;
    double work_of(const Workspace& room, double limit) const;
    bool exact_within(const Polygon& on, const std::vector<SourceName>* named, double work,
                      const LightAccuracy& accuracy, Workspace& room, std::vector<Estimate>& out) const;
    double forecast_work(const Polygon& on, const std::vector<SourceName>* named, const LightAccuracy& accuracy,
                         Workspace& room) const;
    double preparing_a_place(const Polygon& on, const std::vector<SourceName>* named) const;
    double rays_needed_at(const Point& x, const Normal& n, RegionId own, double work, const LightAccuracy& accuracy,
                          Workspace& room, double& tried) const;
    void add_mirrored(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy,
                      Estimate& out) const;
    bool prepare(const Polygon& on, double work, const std::vector<SourceName>* named, Workspace& room) const;
    double exact_work(const ReceiverLight& light) const;

    const DirectLight* direct_;
    RayLight rays_;
    double preparing_ = 0;                           ///< Work of preparing all sources for a polygon, in rays.
    double max_work_ = 0;                            ///< Upper bound on the work of exact light at a place.
    std::unique_ptr<const MirroredLight> mirrored_;  ///< Light that panes mirror; null: they mirror nothing.
};

/// Temporary storage; one per thread.
class PlaceLight::Workspace : public RayLight::Workspace {
  private:
    friend PlaceLight;
    ReceiverLight light_;
};

}  // namespace exitance
