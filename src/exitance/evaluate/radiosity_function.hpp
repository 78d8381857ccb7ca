#pragma once

#include <memory>
#include <span>

#include "exitance/base/progress.hpp"
#include "exitance/direct/clustered_light.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/scene/place_finder.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

struct Stage;
struct GatherWorkspace;

/// Which light is asked for.
enum class Component { total, direct, indirect };

/// Light at one point.
struct Light {
    Spectrum irradiance;  ///< E, W/m^2
    Spectrum radiosity;   ///< B = M + rho E, W/m^2; meaningless where `on_surface` is false.
    bool on_surface = false;
    bool is_between_sides = false;  ///< Does the point lie on a border of several sides? See PlaceFinder.
};

/// A place to measure at: a point and the normal of the plane to measure on.
struct ProbePoint {
    Point x;
    Normal n;
};

/// A solution as a function of place: B(x) = M + rho (E_dir(x) + E_ind(x)), direct light evaluated from the
/// polygons (exactly, or where many small emitters shine to `point_accuracy()`), indirect light read from the
/// solution's elements (less the share of direct light that they hold).
class RadiosityFunction {
  public:
    /// Keeps a reference: the solution must outlive it.
    explicit RadiosityFunction(const Solution& solution);
    ~RadiosityFunction();

    /// Light at each point (all cores), at the place that `places()` finds for it; a point on no surface is measured by
    /// the direct light and by rays that read the solution where they hit. About 5 us a point and visible emitter.
    std::vector<Light> at(std::span<const ProbePoint> points, Component component = Component::total) const;

    /// The same values, in steps of about half a second; after a stop the result ends with the last finished step.
    std::vector<Light> at_until(const StopRequest& stop, std::span<const ProbePoint> points,
                                Component component = Component::total) const;

    /// The same from the elements that `export` writes, without exact direct light; zero off the surfaces.
    std::vector<Light> interpolant_at(std::span<const ProbePoint> points) const;

    /// E(x) = elements(x) + exact_share() E_dir(x) on a region: what the elements hold there,
    Spectrum elements(RegionId region, const Point& x) const {
        if (solution_.delivers_own_form) return solution_.own_form->at(solution_.scene, region, x);
        return solution_.indirect.at(indirect_locator_.find(region, x));
    }
    /// and how much of exact direct light comes on top of it.
    Spectrum exact_share() const {
        return solution_.direct_in_elements ? Spectrum() : Spectrum(1) - solution_.direct_share;
    }

    /// E_ind by a gather of its own in place of the elements: rays that read what surfaces reflect, by the solution's
    /// interpolant. See gather_reflected. Zero where the solution has no bounces.
    Spectrum gathered(const ProbePoint& point, RegionId own, unsigned rays, std::uint64_t key,
                      GatherWorkspace& workspace) const;

    const Solution& solution() const { return solution_; }
    const PlaceFinder& places() const { return places_; }
    const Stage& stage() const { return *stage_; }

  private:
    /// Light at a part of `points`, whose places among them name their random numbers.
    void evaluate(std::span<const ProbePoint> points, std::size_t first, Component component,
                  std::span<Light> out) const;
    Spectrum interpolated(RegionId region, const Point& x) const;
    Spectrum irradiance_on(RegionId region, const Point& x, Component component,
                           ClusteredLight::Workspace& workspace) const;

    const Solution& solution_;
    PlaceFinder places_;
    ElementLocator indirect_locator_, interpolant_locator_;
    SixNodeLocator triangles_;  ///< Of the discontinuity mesh, where there is one.
    std::unique_ptr<Stage> stage_;
    LightAccuracy accuracy_;  ///< Of direct light where emitters are many and small.
};

}  // namespace exitance
