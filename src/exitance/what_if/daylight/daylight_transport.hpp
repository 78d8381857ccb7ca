#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/scene/sky/sky_patches.hpp"
#include "exitance/transport/stage.hpp"
#include "exitance/visibility/glass/pane_groups.hpp"

namespace exitance {

/// Number of independent estimates of reflected light. Each uses its share of the rays, from the transport to the
/// sensors, so that the spread of any result of them is the noise of that result.
constexpr std::size_t daylight_replicates = 8;

/// Places that the rays of an element or of a sensor reach: how many of them end in each leaf of the mesh and in each
/// patch of the sky.
struct RayCounts {
    struct End {
        std::uint32_t number = 0, count = 0;
    };
    std::uint32_t rays = 0;
    std::vector<End> leaves;   ///< Fronts of elements, by leaf number, ascending.
    std::vector<End> patches;  ///< Patches of the sky, ascending.
    std::vector<End> finer;    ///< Finer patches of the sky; empty if there are none.

    /// Ends of the rays that crossed certain panes on their way.
    struct Through {
        std::vector<End> leaves, patches;
    };
    /// One entry per group of panes, for rays that crossed panes of that group. Then two more entries: for rays that
    /// crossed panes of any group, and of at least two groups. Empty without groups.
    std::vector<Through> through = {};
};

template <class Archive>
void archive(Archive& a, RayCounts& ends) {
    a(ends.rays, ends.leaves, ends.patches, ends.finer);
}

/// Rays of a sensor, one set per replicate.
using SensorRays = std::array<RayCounts, daylight_replicates>;

/// Right-hand sides of the transport: each is the light of one patch, or of a sky.
class SkyColumns {
  public:
    /// A column per patch, each the light of a patch with luminance 1.
    static SkyColumns of_patches(std::size_t patches);
    /// Adds a column: the light of the patches with these luminances.
    void add(std::vector<double> luminances) { columns_.push_back({std::move(luminances), false}); }
    /// Adds a column: the light of the finer patches with these luminances.
    void add_finer(std::vector<double> luminances) { columns_.push_back({std::move(luminances), true}); }

    std::size_t count() const { return unit_patches_ > 0 ? unit_patches_ : columns_.size(); }
    /// Adds the irradiance by the rays that end in the sky to `out`, one value per column.
    void add_light(const RayCounts& ends, std::span<float> out) const;
    /// Adds the irradiance by the rays that crossed panes; `rays`: number of all rays. For columns without finer
    /// patches.
    void add_light(const RayCounts::Through& ends, std::uint32_t rays, std::span<float> out) const;

  private:
    struct Column {
        std::vector<double> luminances;
        bool is_finer = false;
    };
    void add_light(std::span<const RayCounts::End> patches, std::span<const RayCounts::End> finer, std::uint32_t rays,
                   std::span<float> out) const;

    std::size_t unit_patches_ = 0;  ///< Number of patches, if each patch has a column of its own.
    std::vector<Column> columns_;
};

/// Reflected light rho E on the leaves of the mesh: a row per leaf, a column per right-hand side, for each replicate.
struct ElementLight {
    std::size_t columns = 0;
    std::array<std::vector<float>, daylight_replicates> reflected;

    /// Computes the reflected light at a sensor from its rays, one value per column.
    void gather(std::size_t replicate, const RayCounts& ends, std::span<float> out) const;
    /// Adds the light at the `ends` of some rays, divided by the number of all `rays`, times `sign`.
    void add(std::size_t replicate, std::span<const RayCounts::End> ends, std::uint32_t rays, float sign,
             std::span<float> out) const;
};

/// Transport of light from the patches of the sky between the elements of a scene:
///
///     E = S + F rho E,     S: light of the sky on elements, F: transport between elements, both by the same rays,
///
/// for each replicate by rays of its own. More rays can be added to those that were cast before; the result is
/// independent of the steps. The scene's emitters are off, and its light from outside is replaced by the patches.
/// Several processes divide the replicates, and each has the rays of its own ones only.
class DaylightTransport {
  public:
    /// `finer`: further patches of the sky in which the ends of rays are counted; may be null. Both must outlive the
    /// transport. `groups`: panes whose light is also computed separately.
    DaylightTransport(Scene scene, const SkyPatches& patches, const SkyPatches* finer, std::uint64_t seed,
                      PaneGroups groups = {});

    /// Meshes the scene with about `count` elements and discards all rays. Deterministic.
    void make_elements(double count);
    std::size_t leaves() const;
    /// Returns the number of the leaf of a region that contains a point (metres); none outside of the elements.
    std::optional<std::size_t> leaf_at(RegionId region, const Point& x) const;
    /// Returns the centre of a leaf.
    SurfacePoint leaf_centre(std::size_t leaf) const;
    /// Casts rays until all replicates together have this average number per element, those of the replicates of this
    /// process. O(new rays).
    void cast_rows(double rays_an_element);
    /// Frees the memory of the rays of elements.
    void forget_rows();
    /// Solves for rho E by Jacobi iteration over all columns at once, until a sweep changes it by at most 2e-4
    /// (relative RMS). Collective. O(sweeps x rays x columns).
    ElementLight solve(const SkyColumns& columns) const;
    const PaneGroups& pane_groups() const { return groups_; }
    /// Solves for the part of `total` that has crossed panes of a group at least once,
    ///
    ///     E_g = S_g + F_g rho E + (F - F_g) rho E_g,     S_g, F_g: by the rays that cross the group,
    ///
    /// with the rays of solve(), so that E_g has the noise of E.
    ElementLight solve_through(const SkyColumns& columns, const ElementLight& total, std::size_t group) const;
    /// Solves for the part of `total` that has crossed panes of groups at least twice. Panes of one group that one ray
    /// crosses count once. Needs the columns of solve(), without finer patches.
    ElementLight solve_twice(const SkyColumns& columns, const ElementLight& total, const ElementLight& any) const;
    /// Number of the set of rays, after those of the groups, that cross panes of any group.
    std::size_t any_group() const { return groups_.count(); }
    std::size_t two_groups() const { return groups_.count() + 1; }

    /// Casts rays from a sensor until all replicates together have `rays` (a power of two). `number`: of the sensor,
    /// for its random points.
    void cast_sensor(const SurfacePoint& sensor, std::size_t number, unsigned rays, SensorRays& out) const;
    const Stage& stage() const { return stage_; }

  private:
    struct Elements;
    struct Found;
    template <class Place>
    void cast(std::uint32_t until, std::uint64_t key, RegionId own, RegionId sides, const Normal& n, const Place& place,
              Found& found, RayCounts& ends) const;
    PaneGroups::Mask crossed(const RayHit& hit, const Point& origin, const Vec3& direction) const;
    template <class Gather>
    std::vector<float> iterate(std::size_t columns, const Gather& gather) const;
    template <class Gather>
    ElementLight iterate_all(const SkyColumns& columns, const Gather& gather) const;

    Scene scene_;
    Stage stage_;
    const SkyPatches& patches_;
    const SkyPatches* finer_;
    PaneGroups groups_;
    std::array<std::uint64_t, daylight_replicates> seeds_{};
    struct Deleter {
        void operator()(Elements* elements) const;
    };
    std::unique_ptr<Elements, Deleter> elements_;
    std::array<std::vector<RayCounts>, daylight_replicates> rows_;
};

}  // namespace exitance
