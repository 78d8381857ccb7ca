#pragma once

#include "exitance/evaluate/radiosity_function.hpp"

namespace exitance {

/// Piecewise polynomials that break where direct light does, as a function of place: those of a solution's
/// discontinuity mesh (all light), or, where it has layers, their sum (direct light times
/// RadiosityFunction::exact_share).
class MeshLight {
  public:
    /// Keeps a reference to the solution behind `light`.
    explicit MeshLight(const RadiosityFunction& light)
        : solution_(light.solution()),
          share_(light.exact_share()),
          triangles_(solution_.discontinuity, solution_.scene) {}

    bool empty() const { return solution_.discontinuity.empty(); }
    bool has_layers() const { return solution_.layers != nullptr; }
    /// Irradiance, W/m^2.
    Spectrum at(RegionId region, const Point& x) const {
        return has_layers() ? share_ * solution_.layers->at(solution_.scene, region, x) : triangles_.at(region, x);
    }

    const SixNodeMesh& mesh() const { return solution_.discontinuity; }
    /// Triangles of the layers, and each of them as its share of the light.
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
