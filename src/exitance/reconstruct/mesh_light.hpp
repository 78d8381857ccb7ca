#pragma once

#include "exitance/reconstruct/radiosity_function.hpp"

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
          triangles_(solution_.discontinuity, solution_.scene),
          layers_(solution_.layers, solution_.scene) {}

    bool empty() const { return solution_.discontinuity.empty(); }
    bool has_layers() const { return !solution_.layers.empty(); }
    /// Irradiance, W/m^2.
    Spectrum at(RegionId region, const Point& x) const {
        return has_layers() ? share_ * layers_.at(region, x) : triangles_.at(region, x);
    }

    const SixNodeMesh& mesh() const { return solution_.discontinuity; }
    const LightLayers& layers() const { return solution_.layers; }
    const Spectrum& layer_share() const { return share_; }  ///< Factor for the values of layers.

  private:
    const Solution& solution_;
    Spectrum share_;
    SixNodeLocator triangles_;
    LayerFunction layers_;
};

}  // namespace exitance
