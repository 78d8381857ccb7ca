#pragma once

#include <functional>
#include <vector>

#include "exitance/transport/hemisphere.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Reflected radiosity b at a point of a region, W/m^2: what a ray reads where it hits.
using RadiosityAt = std::function<Spectrum(RegionId, const Point&)>;

/// Room for the rays of one gather; one a thread.
struct GatherWorkspace {
    std::vector<Point> origins;  ///< One: where all rays begin.
    std::vector<Vec3> directions;
    std::vector<RayHit> hits;
    std::vector<std::uint8_t> quarter;  ///< Of the points' order that a ray comes from.
    std::vector<std::uint32_t> filled;  ///< Rays in each cell so far.
};

/// An estimate and how far it may be off.
struct Gathered {
    Spectrum irradiance;  ///< W/m^2
    /// Of `irradiance`, from the spread of four quarters of the rays, each stratified by itself. The whole is
    /// stratified more finely: error ~ rays^-3/4 makes its variance half of what independent quarters would leave.
    Spectrum variance;
};

/// Irradiance at x by what surfaces reflect, E(x) = int G V b dA, by `rays` rays (a power of two, at least 4) with
/// density cos / pi around n: E = mean of b at their first hits. `own` is the region that x lies on, or none. The
/// directions are scrambled Sobol points named by `key`. Unbiased; error ~ rays^-3/4.
Gathered gather_reflected(const Stage& stage, const Point& x, const Normal& n, RegionId own, unsigned rays,
                          std::uint64_t key, const RadiosityAt& b, GatherWorkspace& workspace);

/// Its two steps, for those who read several functions with the same rays: cast them, then read b where they hit.
void cast_gather(const Stage& stage, const Point& x, const Normal& n, RegionId own, unsigned rays, std::uint64_t key,
                 GatherWorkspace& workspace);
Gathered read_gather(const Stage& stage, const RadiosityAt& b, const GatherWorkspace& workspace);

}  // namespace exitance
