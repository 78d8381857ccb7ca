#pragma once

#include <memory>
#include <span>

#include "exitance/mesh/element_locator.hpp"
#include "exitance/reconstruct/solution.hpp"
#include "exitance/scene/locator.hpp"
#include "exitance/transport/direct_light.hpp"

namespace exitance {

struct Stage;

/// Which light is asked for.
enum class Component { total, direct, indirect };

/// Light at one point.
struct Light {
    Spectrum irradiance;  ///< E, W/m^2
    Spectrum radiosity;   ///< B = M + rho E, W/m^2; meaningless where `on_surface` is false.
    bool on_surface = false;
};

/// A place to measure at: a point and the normal of the plane to measure on.
struct ProbePoint {
    Point x;
    Normal n;
};

/// A place that is known to lie on a region and to be in the open: what a ray of free space met.
struct SeenPoint {
    Point x;
    RegionId region;
};

/// A solution as a function of place: B(x) = M + rho (E_dir(x) + E_ind(x)), direct light evaluated exactly from the
/// polygons, indirect light read from the solution's elements (less the share of direct light that they hold).
class RadiosityFunction {
  public:
    /// Keeps a reference: the solution must outlive it.
    explicit RadiosityFunction(const Solution& solution);
    ~RadiosityFunction();

    /// Light at each point (all cores); a point on no surface is measured by the direct light and by rays that read the
    /// solution where they hit. About 5 us a point and visible emitter.
    std::vector<Light> at(std::span<const ProbePoint> points, Component component = Component::total) const;

    /// The same where it is known what the points lie on: neither surfaces nor what covers them are searched.
    std::vector<Light> at(std::span<const SeenPoint> points, Component component = Component::total) const;

    /// The same from the elements that `export` writes, without exact direct light; zero off the surfaces.
    std::vector<Light> interpolant_at(std::span<const ProbePoint> points) const;

  private:
    Spectrum irradiance_on(const SeenPoint& point, Component component, DirectLight::Workspace& workspace) const;
    bool has_direct_share() const { return squared(solution_.direct_share) > 0; }
    Spectrum indirect_in_free_space(const ProbePoint& point, std::size_t index) const;

    const Solution& solution_;
    Locator locator_;
    ElementLocator indirect_locator_, interpolant_locator_;
    std::unique_ptr<Stage> stage_;
};

}  // namespace exitance
