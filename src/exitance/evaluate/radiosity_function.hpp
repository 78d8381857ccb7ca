#pragma once

#include <memory>
#include <span>

#include "exitance/base/progress.hpp"
#include "exitance/direct/place_light.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/scene/place_finder.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

struct Stage;
struct GatherWorkspace;

/// Part of the light that is evaluated.
enum class Component { total, direct, indirect };

/// Light at one point.
struct Light {
    Spectrum irradiance;      ///< E, W/m^2
    Spectrum radiosity;       ///< B = M + rho E, W/m^2; undefined if `on_surface` is false.
    Spectrum standard_error;  ///< Standard error of E from the rays of direct light, W/m^2; 0: exact direct light.
    bool on_surface = false;
    bool is_between_sides = false;  ///< True if the point is on a border of several sides, see PlaceFinder.
};

/// A point and the normal of the plane on which light is measured there.
struct ProbePoint {
    Point x;
    Normal n;
};

/// How direct light is evaluated at points.
enum class DirectBy : std::uint8_t {
    cheaper,       ///< Closed forms or rays, whichever is cheaper at `point_accuracy()` (PlaceLight).
    closed_forms,  ///< Closed forms; only light that panes mirror is estimated.
};

/// A solution as a function of place: B(x) = M + rho (E_dir(x) + E_ind(x)). Direct light is evaluated from the
/// polygons, exactly or, where that is expensive, by rays. Indirect light is read from the solution's
/// elements, less the share of direct light that they contain.
class RadiosityFunction {
  public:
    /// Keeps a reference to the solution, which must outlive the object.
    explicit RadiosityFunction(const Solution& solution, DirectBy direct = DirectBy::cheaper);
    ~RadiosityFunction();

    /// Light at each point, computed on all cores, at the place that `places()` finds for it. At a point off all
    /// surfaces indirect light is gathered by rays that read the solution at their hits. About 5 us per point and
    /// visible emitter.
    std::vector<Light> at(std::span<const ProbePoint> points, Component component = Component::total) const;

    /// Like at(), in steps of about half a second; after a stop request the result ends with the last finished step.
    /// Several processes divide the points. Collective.
    std::vector<Light> at_until(const StopRequest& stop, std::span<const ProbePoint> points,
                                Component component = Component::total) const;

    /// Light of the exported elements, without exact direct light; zero off the surfaces.
    std::vector<Light> interpolant_at(std::span<const ProbePoint> points) const;

    /// The elements' part of the irradiance on a region, W/m^2: E(x) = elements(x) + exact_share() E_dir(x).
    Spectrum elements(RegionId region, const Point& x) const {
        if (solution_.delivers_own_form) return solution_.own_form->at(solution_.scene, region, x);
        return solution_.indirect.at(indirect_locator_.find(region, x));
    }
    /// Factor of exact direct light in E(x), per band.
    Spectrum exact_share() const {
        return solution_.direct_in_elements ? Spectrum() : Spectrum(1) - solution_.direct_share;
    }

    /// E_ind by a separate gather instead of the elements: rays read the light that surfaces reflect from the
    /// solution's interpolant, see gather_reflected. Zero if the solution has no bounces.
    Spectrum gathered(const ProbePoint& point, RegionId own, unsigned rays, std::uint64_t key,
                      GatherWorkspace& workspace) const;

    /// Direct light at a point of region `own` (none: in free space), W/m^2, at the accuracy of at().
    Spectrum direct_at(const ProbePoint& point, RegionId own, PlaceLight::Workspace& workspace) const;

    const Solution& solution() const { return solution_; }
    const PlaceFinder& places() const { return places_; }
    const Stage& stage() const { return *stage_; }

  private:
    /// Light at points[first...], one after the other; indices of `points` select the random numbers.
    void evaluate(std::span<const ProbePoint> points, std::size_t first, Component component,
                  std::span<Light> out) const;
    Spectrum interpolated(RegionId region, const Point& x) const;
    Light light_on(RegionId region, const Material& material, const Point& x, Component component,
                   PlaceLight::Workspace& workspace) const;

    const Solution& solution_;
    PlaceFinder places_;
    ElementLocator indirect_locator_, interpolant_locator_;
    SixNodeLocator triangles_;  ///< Locates triangles of the discontinuity mesh, if there is one.
    std::unique_ptr<Stage> stage_;
    LightAccuracy accuracy_;  ///< Accuracy of direct light by rays; 0: closed forms.
};

}  // namespace exitance
