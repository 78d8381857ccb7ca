#pragma once

#include "exitance/evaluate/radiosity_function.hpp"

namespace exitance {

/// Piecewise polynomials aligned with discontinuities of direct light, as a function of place: those of a solution's
/// discontinuity mesh (all light), or the sum of its layers if it has any (direct light times
/// RadiosityFunction::exact_share).
class MeshLight {
  public:
    /// Keeps a reference to the solution behind `light`.
    explicit MeshLight(const RadiosityFunction& light)
        : solution_(light.solution()),
          share_(light.exact_share()),
          triangles_(solution_.discontinuity, solution_.scene) {}

    bool empty() const { return solution_.discontinuity.empty(); }  ///< True if there is no single mesh.
    bool has_layers() const { return solution_.layers != nullptr; }
    /// Irradiance, W/m^2.
    Spectrum at(RegionId region, const Point& x) const {
        return has_layers() ? share_ * solution_.layers->at(solution_.scene, region, x) : triangles_.at(region, x);
    }

    const SixNodeMesh& mesh() const { return solution_.discontinuity; }
    /// Number of triangles of the layers, and one of them with its values multiplied by the share of direct light.
    std::size_t layer_triangle_count() const { return has_layers() ? solution_.layers->triangle_count() : 0; }
    QuadraticTriangle layer_triangle(std::size_t i) const {
        return solution_.layers->triangle(solution_.scene, i, share_);
    }

  private:
    const Solution& solution_;
    Spectrum share_;
    SixNodeLocator triangles_;
};

}  // namespace exitance
