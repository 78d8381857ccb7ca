#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/direct/direct_light.hpp"
#include "exitance/direct/sky_tree.hpp"
#include "exitance/direct/source_point.hpp"
#include "exitance/visibility/portal_cells.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// A sun's disc, so far away that its direction is the same from every place.
struct SunDisc {
    const SeenPolygon* seen;  ///< Polygon of the disc.
    Point from;               ///< Viewpoint of `seen`.
};

/// A place from which the sky is looked for.
struct SearchPlace {
    Point x;
    Normal n;
    RegionId own;
    std::uint64_t sky = 0;  ///< Bit k: ray k to the sky arrives.
    std::uint64_t sun = 0;  ///< Bit k: ray k to a sun arrives.
};

/// Casts the rays of the search for openings to the sky (SkyOpenings). All arguments must outlive it.
class SkySearch {
  public:
    /// Number of rays of a place to the sky; as many go to all suns together.
    static constexpr std::uint32_t rays_of_place = 64;

    SkySearch(const Occluders& occluders, const RayTracer& tracer, const SkyTree& sky, std::span<const SunDisc> suns)
        : occluders_(occluders), tracer_(tracer), sky_(sky), suns_(suns), size_(occluders.scene().size()) {}

    /// Returns places on all polygons: half of them spread by area, half of them evenly over polygons.
    std::vector<SearchPlace> places(std::size_t count) const;
    void cast_to_sky(SearchPlace& place, std::uint32_t rays);
    void cast_to_suns(SearchPlace& place);
    /// Direction of ray k to the sky from a place.
    Vec3 direction(const SearchPlace& place, std::uint32_t k);

    /// A ray from a place to the sky.
    struct Escape {
        Point from;
        Vec3 direction;
    };
    /// The opening through which a ray escapes; of area 0 if its rim is not found.
    PortalCell opening(const Escape& way);

    /// Rays through an opening.
    struct Seen {
        double rays = 0;     ///< Number of rays that were cast.
        double arrived = 0;  ///< Number of them that reached the sky.
    };
    /// Casts a ray from a place through each of up to 64 openings that are before it, and counts those that arrive.
    void cast_through(const SearchPlace& place, std::span<const PortalCell> openings, std::span<Seen> out);

  private:
    static std::uint64_t key(const SearchPlace& place, std::uint64_t of);
    double reach(const Point& x) const { return 2 * (size_ + norm(x - occluders_.middle())); }
    std::uint64_t arriving(std::size_t count);
    double seen_share(const Point& at);
    Point before_opening(const Escape& way);
    template <class IsOpen>
    std::vector<Vec3> rim(const Point& from, const Frame& frame, const IsOpen& is_open);

    const Occluders& occluders_;
    const RayTracer& tracer_;
    const SkyTree& sky_;
    std::span<const SunDisc> suns_;
    double size_;
    SkyTree::Aim aim_;
    std::vector<RayEnd> from_, to_;
    std::vector<std::uint32_t> number_;
    std::vector<RayHit> hits_;
    std::array<bool, rays_of_place> blocked_{};
};

}  // namespace exitance
