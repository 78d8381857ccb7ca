#pragma once

#include <array>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Reflected radiosity b at a point of a region, W/m^2: what a ray reads where it hits.
using RadiosityAt = std::function<Spectrum(RegionId, const Point&)>;

/// Where a ray hit the front of a surface.
struct HitPoint {
    RegionId region;
    Point y;
};

/// The same for many rays at once: what lies under their hits is found together.
class ReflectedLight {
  public:
    virtual ~ReflectedLight() = default;
    /// values[i] = b at hits[i], W/m^2; as many values as hits.
    virtual void read(std::span<const HitPoint> hits, std::span<Spectrum> values) const = 0;
};

/// A function of one point as light for many rays.
class PointwiseLight final : public ReflectedLight {
  public:
    explicit PointwiseLight(RadiosityAt b) : b_(std::move(b)) {}
    void read(std::span<const HitPoint> hits, std::span<Spectrum> values) const override {
        for (std::size_t i = 0; i < hits.size(); ++i) values[i] = b_(hits[i].region, hits[i].y);
    }

  private:
    RadiosityAt b_;
};

/// A place of a region to gather at, and the name of its directions.
struct GatherPlace {
    Point x;
    std::uint64_t key;
};

/// Sums of b over the four quarters of a place's rays.
using QuarterSums = std::array<Spectrum, 4>;

/// Room for the rays of places that are gathered at together; one a thread.
struct GatherWorkspace {
    std::array<std::vector<double>, 2> coordinates;  ///< Of one place's points of the unit square in their own order;
    std::array<std::vector<double>, 2> sorted;       ///< of all, packet by packet, and what rays they stand for.
    std::vector<Point> origins;
    std::vector<Vec3> directions;
    std::vector<RayHit> hits;
    std::vector<std::uint32_t> quarter;  ///< 4 times the place that a ray comes from, and the quarter of its points.
    std::vector<HitPoint> fronts;        ///< What there is to read,
    std::vector<std::uint32_t> share;    ///< the quarter that it counts in,
    std::vector<double> counts;          ///< as how many rays, where some are aimed at openings (`PortalAim`),
    std::vector<Spectrum> values;        ///< what was read,
    std::vector<QuarterSums> sums;       ///< and what it makes for each place.
    std::vector<std::uint32_t> filled;   ///< Rays in each cell so far.
};

/// An estimate and how far it may be off.
struct Gathered {
    Spectrum irradiance;  ///< W/m^2
    /// Of `irradiance`, from the spread of four quarters of the rays, and of two halves, as if those were independent.
    /// The whole is stratified more finely. Where variance ~ rays^-p, p = 1 by chance and 3/2 where light is even,
    /// quarters tell 4^(p - 1) times the variance and halves 2^(p - 1) times: it is halves^2 / quarters.
    Spectrum quarters, halves;
};

/// Irradiance at x by what surfaces reflect, E(x) = int G V b dA, by `rays` rays (a power of two, at least 4) with
/// density cos / pi around n: E = mean of b at their first hits. `own` is the region that x lies on, or none. The
/// directions are scrambled Sobol points named by `key`. Unbiased; error ~ rays^-3/4.
Gathered gather_reflected(const Stage& stage, const Point& x, const Normal& n, RegionId own, unsigned rays,
                          std::uint64_t key, const ReflectedLight& b, GatherWorkspace& workspace);
Gathered gather_reflected(const Stage& stage, const Point& x, const Normal& n, RegionId own, unsigned rays,
                          std::uint64_t key, const RadiosityAt& b, GatherWorkspace& workspace);

/// Its two steps, for those who read several functions with the same rays: cast them, then read b where they hit.
void cast_gather(const Stage& stage, const Point& x, const Normal& n, RegionId own, unsigned rays, std::uint64_t key,
                 GatherWorkspace& workspace);
Gathered read_gather(const ReflectedLight& b, GatherWorkspace& workspace);

/// A gather that can go on where its variance turns out too large: n rays, then the next n, then the next 2 n, are the
/// same gather as 4 n at once.
class GrowingGather {
  public:
    /// Adds the next `more` rays: as many as there are, or the first.
    void add(const QuarterSums& fresh, unsigned more);
    unsigned rays() const { return rays_; }
    Gathered gathered() const;

  private:
    unsigned rays_ = 0;
    QuarterSums quarter_{};
};

/// Casts the rays that each place of a plane is missing to `rays` in all: a power of two, at least 4. `growing[i]`
/// belongs to places[i]; all of them have as many rays so far. Rays of like directions are traced together, whichever
/// place they come from.
void grow_together(const Stage& stage, std::span<const GatherPlace> places, const Normal& n, RegionId own,
                   unsigned rays, const ReflectedLight& b, std::span<GrowingGather* const> growing,
                   GatherWorkspace& workspace);

}  // namespace exitance
