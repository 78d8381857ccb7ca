#pragma once

#include <vector>

#include "exitance/reconstruct/gather.hpp"
#include "exitance/reconstruct/radiosity_function.hpp"

namespace exitance {

/// What one pixel shows of one region.
struct Spot {
    RegionId region;
    std::uint32_t block = 0;             ///< Pixels of one block lie side by side.
    std::uint32_t pixel = 0;             ///< Names the random numbers of its gather.
    std::uint32_t first = 0, count = 0;  ///< Of the points seen, in an order in which the first four are well spread.
    Spectrum irradiance = {};            ///< Mean over the points, W/m^2.
};

/// Light on the spots of a picture's tile, as take_picture describes it. One a thread; keeps its memory.
class TileLight {
  public:
    /// `gather` rays a point, 0 for none. Keeps a reference to `light`.
    TileLight(const RadiosityFunction& light, unsigned gather, std::uint64_t seed)
        : light_(light), gather_(gather), seed_(seed) {}

    /// Fills in the irradiance of every spot and brings the spots into an order of its own. `points` are places in the
    /// open on the spots' regions, metres.
    void evaluate(std::span<const Point> points, std::vector<Spot>& spots);

  private:
    bool prepare(std::span<const Spot> spots, RegionId region, const ReceiverLight* whole, ReceiverLight& out);
    Spectrum irradiance(const Spot& spot, const ReceiverLight* direct);
    Spectrum elements(const Spot& spot, std::uint32_t i);
    bool looks_small(const Spot& spot, const ReceiverLight& direct, const Point& middle) const;

    const RadiosityFunction& light_;
    unsigned gather_;
    std::uint64_t seed_;
    std::span<const Point> points_;
    std::vector<Point> outline_;
    ReceiverLight whole_, part_;
    DirectLight::Workspace visibility_;
    GatherWorkspace gathering_;
};

}  // namespace exitance
