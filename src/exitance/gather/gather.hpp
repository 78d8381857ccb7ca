#pragma once

#include <array>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/gather/bright_places.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Reflected radiosity b at a point of a region, W/m^2, which a ray evaluates at its hit.
using RadiosityAt = std::function<Spectrum(RegionId, const Point&)>;

/// Reflected radiosity at many ray hits in one call, so that leaf lookups are batched.
class ReflectedLight {
  public:
    virtual ~ReflectedLight() = default;
    /// values[i] = b at hits[i], which are on fronts of surfaces, W/m^2; as many values as hits.
    virtual void read(std::span<const RayEnd> hits, std::span<Spectrum> values) const = 0;

    /// Places at which rays that gather this light are aimed; null: at the openings of the stage only. They change the
    /// noise, not the expected result. `places` must outlive this object.
    const BrightPlaces* bright_places() const { return bright_places_; }
    void aim_at(const BrightPlaces& places) { bright_places_ = &places; }

  private:
    const BrightPlaces* bright_places_ = nullptr;
};

/// Adapts a function of one point to ReflectedLight.
class PointwiseLight final : public ReflectedLight {
  public:
    explicit PointwiseLight(RadiosityAt b) : b_(std::move(b)) {}
    void read(std::span<const RayEnd> hits, std::span<Spectrum> values) const override {
        for (std::size_t i = 0; i < hits.size(); ++i) values[i] = b_(hits[i].region, hits[i].x);
    }

  private:
    RadiosityAt b_;
};

/// A place of a region at which light is gathered. `key` selects the directions of its rays.
struct GatherPlace {
    Point x;
    std::uint64_t key;
};

/// Sums of b over the four quarters of a place's rays.
using QuarterSums = std::array<Spectrum, 4>;

/// Workspace for places that are gathered together; one per thread.
struct GatherWorkspace {
    /// One place's points in the unit square, in the order of its sequence.
    std::array<std::vector<double>, 2> coordinates;
    std::array<std::vector<double>, 2> sorted;  ///< Points of all places, sorted into packets of similar directions.
    std::vector<Point> origins;
    std::vector<Vec3> directions;
    std::vector<RayHit> hits;
    /// Per ray: 4 times the index of its place, plus the quarter (0 to 3) of its point.
    std::vector<std::uint32_t> quarter;
    std::vector<RayEnd> fronts;         ///< Hits at which b is evaluated.
    std::vector<std::uint32_t> share;   ///< Entry of `quarter` for each hit.
    std::vector<double> counts;         ///< Weight of each hit if rays are aimed at openings (`PortalAim`); else empty.
    std::vector<Spectrum> colours;      ///< Factors of panes on each hit's bands (`GlassColours`); empty: all are 1.
    std::vector<Spectrum> values;       ///< b at each hit, times its `colours`.
    std::vector<QuarterSums> sums;      ///< Resulting sums for each place.
    std::vector<std::uint32_t> filled;  ///< Number of rays in each cell so far.
};

/// An estimate and its variance.
struct Gathered {
    Spectrum irradiance;  ///< W/m^2
    /// Variance of `irradiance` as estimated from four quarters of the rays and from two halves, as if these were
    /// independent. All rays together are stratified more finely. If the variance is proportional to rays^-p, with p =
    /// 1 for random points and 3/2 for uniform light, quarters overestimate it by 4^(p - 1) and halves by 2^(p - 1).
    /// The actual variance is then halves^2 / quarters.
    Spectrum quarters, halves;
};

/// Irradiance at x from the light that surfaces reflect, E(x) = int G V b dA, as the mean of b at the first hits of
/// `rays` rays (a power of two, at least 4) with density cos / pi around n. `own`: the region that contains x, or none.
/// `key`: selects the directions, which are scrambled Sobol points. Unbiased; error ~ rays^-3/4.
Gathered gather_reflected(const Stage& stage, const Point& x, const Normal& n, RegionId own, unsigned rays,
                          std::uint64_t key, const ReflectedLight& b, GatherWorkspace& workspace);
Gathered gather_reflected(const Stage& stage, const Point& x, const Normal& n, RegionId own, unsigned rays,
                          std::uint64_t key, const RadiosityAt& b, GatherWorkspace& workspace);

/// The two steps of gather_reflected, for reading several functions with the same rays: cast them, then read b at the
/// hits. `bright`: see `ReflectedLight::bright_places`.
void cast_gather(const Stage& stage, const Point& x, const Normal& n, RegionId own, unsigned rays, std::uint64_t key,
                 const BrightPlaces* bright, GatherWorkspace& workspace);
Gathered read_gather(const ReflectedLight& b, GatherWorkspace& workspace);

/// A gather that can be continued if its variance is too large: n rays, then the next n, then the next 2 n give the
/// same result as 4 n rays at once.
class GrowingGather {
  public:
    /// Adds the next `more` rays: the first ones, or as many as there are already.
    void add(const QuarterSums& fresh, unsigned more);
    unsigned rays() const { return rays_; }
    Gathered gathered() const;

  private:
    unsigned rays_ = 0;
    QuarterSums quarter_{};
};

/// Casts the rays that places of one plane lack to have `rays` rays each: a power of two, at least 4. `growing[i]`
/// belongs to places[i]; all of them must have the same number of rays. Rays with similar directions are traced
/// together, regardless of their place.
void grow_together(const Stage& stage, std::span<const GatherPlace> places, const Normal& n, RegionId own,
                   unsigned rays, const ReflectedLight& b, std::span<GrowingGather* const> growing,
                   GatherWorkspace& workspace);

}  // namespace exitance
