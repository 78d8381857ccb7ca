#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/gather/gather.hpp"
#include "exitance/measure/light_maps/curved_faces.hpp"

namespace exitance {

/// Largest distance of the nodes at which CurvedLight gathers reflected light, in texels. Derived from the solve's
/// elements: reflected light varies slowly, and a node costs as much as some ten texels.
constexpr int node_texels = 8;

/// Irradiance of a solution on curved surfaces, which the solve replaced by flat faces.
///
/// Direct light is evaluated at the place on the curved patch with the interpolated normal, as at a point in free
/// space: the patch is in front of the faces, so they do not block light above its horizon. Reflected light is gathered
/// there by rays that read the solution, at nodes of a lattice on each triangle, and interpolated linearly. All nodes
/// use the same directions relative to their normals, so the error of the rays varies as smoothly as the light.
class CurvedLight {
  public:
    class Workspace;

    /// `spacing`: maximum distance of lattice nodes, metres; a triangle always has nodes at its corners. Keeps
    /// references to `light` and `faces`. O(nodes); 0.1 ms per node.
    CurvedLight(const RadiosityFunction& light, const CurvedFaces& faces, double spacing, const StopRequest& stop);

    bool is_curved(RegionId region) const { return faces_.is_curved(region); }

    /// Returns the point on the curved patch over a place of a curved region, far enough off the face for rays, and the
    /// interpolated normal there.
    ProbePoint above(const MeasuredPlace& place) const;

    struct Mean {
        Spectrum irradiance;     ///< Irradiance of the component, W/m^2.
        std::size_t places = 0;  ///< Number of places that were evaluated; these are the first ones in the list.
    };
    /// Returns the mean irradiance at places of a curved region that are not covered. The first two and the first four
    /// must be well distributed; if all light at them differs by less than 1% and the noise of rays, the others are not
    /// evaluated.
    /// is_whole  true if places 0 and 1 are mirror images about the middle
    Mean mean_at(std::span<const MeasuredPlace> places, bool is_whole, Component component, Workspace& workspace) const;

  private:
    struct Lattice {
        std::size_t first = 0;  ///< Index of its first node in `reflected_`.
        int steps = 1;          ///< Number of intervals along each side.
    };
    /// A node's gathered light; not known if the node is covered or inside a body.
    struct NodeLight {
        std::array<float, bands> irradiance{};  ///< W/m^2
        bool is_known = false;
    };

    void gather_nodes(std::size_t triangle, Workspace& workspace);
    /// Irradiance at a place, W/m^2.
    struct PlaceParts {
        Spectrum all, component;
        double variance = 0;  ///< Variance of the mean over bands from rays of direct light, (W/m^2)^2; 0: exact.
    };
    PlaceParts at(const MeasuredPlace& place, Component component, Workspace& workspace) const;
    Spectrum reflected(const CurvedPlace& place, Workspace& workspace) const;
    Point off_face(const Point& on_face, const CurvedPlace& place, RegionId region) const;
    NodeLight gather(std::size_t triangle, const std::array<double, 3>& weight, Workspace& workspace) const;

    const RadiosityFunction& light_;
    const CurvedFaces& faces_;
    LightAccuracy accuracy_;            ///< Accuracy of direct light by rays.
    std::vector<Lattice> lattices_;     ///< One lattice per triangle of `faces_`.
    std::vector<NodeLight> reflected_;  ///< Light at the nodes, lattice by lattice, row by row.
};

/// Temporary storage; one per thread.
class CurvedLight::Workspace {
  private:
    friend CurvedLight;
    PlaceLight::Workspace direct_;
    GatherWorkspace gather_;
};

}  // namespace exitance
