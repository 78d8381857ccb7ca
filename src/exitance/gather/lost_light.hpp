#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/gather/gather.hpp"
#include "exitance/mesh/solve_mesh.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Light that surfaces send and that reaches no front: it ends at backs, such as that of a lamp which is a single sheet
/// below a ceiling, or leaves the scene. In a bright room a small loss is a large part of all light that is absorbed,
/// and it varies within elements: a lamp shades the part of the ceiling from which it takes most. The product of the
/// mean light of an element and its mean loss is then wrong, so that the loss is measured on the delivered light.
class LostLight {
  public:
    /// Nothing is lost.
    LostLight() = default;

    /// Casts some 80,000 rays, in about 0.1 s. `power`: power that each leaf sends, by leaf number, W or any multiple;
    /// it distributes the rays, and the mean result does not depend on it. If a share of 1% of the sent light is lost,
    /// the standard error of that power is below 1% if a few backs take it. It is 6% if very many backs take it or if
    /// it leaves the scene: 330 rays are then lost.
    LostLight(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
              std::span<const double> power, std::uint64_t seed);

    /// Lost power of radiosity `factor(region)` times `b`, W per band. `factor` returns a Spectrum.
    template <class Factor>
    Spectrum power(const ReflectedLight& b, const Factor& factor) const {
        std::vector<Spectrum> value(ends_.size());
        b.read(ends_, value);
        Spectrum out;
        for (std::size_t k = 0; k < ends_.size(); ++k) out += areas_[k] * (factor(ends_[k].region) * value[k]);
        return out;
    }

    /// Lost power of radiosity `b(region)`, which is uniform over regions, W per band.
    template <class Radiosity>
    Spectrum uniform_power(const Radiosity& b) const {
        Spectrum out;
        for (std::size_t k = 0; k < ends_.size(); ++k) out += areas_[k] * b(ends_[k].region);
        return out;
    }

    bool is_zero() const { return ends_.empty(); }

  private:
    class Backs;

    void add_rays_from(const Stage& stage, const Backs& backs, std::uint64_t key);

    /// The lost power of b is the sum of areas_[k] b(ends_[k]).
    std::vector<RayEnd> ends_;
    std::vector<double> areas_;  ///< m^2.
};

}  // namespace exitance
