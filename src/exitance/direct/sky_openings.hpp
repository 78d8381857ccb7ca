#pragma once

#include <optional>
#include <span>
#include <vector>

#include "exitance/direct/direct_light.hpp"
#include "exitance/direct/sky_tree.hpp"
#include "exitance/direct/source_point.hpp"
#include "exitance/visibility/portal_cells.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Openings through which rooms see the sky, such as windows without panes, and how much light of the sky and of suns a
/// few rays miss. If a room has a small window, only one unaimed ray in thousands would find the sky.
///
/// Rays to the sky are cast from places all over the scene. A ray that escapes from a place that sees little of the sky
/// passes through an opening. The search walks along the ray to a point in front of the opening, from where the
/// directions in which the sky is seen are bounded by the opening's rim. A rectangle around the rim covers the opening.
/// The rectangle need not cover the opening completely: unaimed rays find the rest.
///
/// The same places give the light that a few rays miss: if the first n rays found nothing, it is the light that the
/// next n rays find. It is known for parts of the scene with some hundred places each, since a small room in a large
/// scene misses more than the mean of all places.
class SkyOpenings {
  public:
    /// A sun's disc, as seen from every place.
    struct Sun {
        const SeenPolygon* seen;  ///< Polygon of the disc; must outlive the constructor.
        Point from;               ///< Viewpoint of `seen`.
    };

    /// Casts up to a million rays, on the calling thread alone.
    SkyOpenings(const Occluders& occluders, const RayTracer& tracer, const SkyTree& sky, std::span<const Sun> suns);

    /// Parallelograms that cover the openings, with normals that point outdoors.
    std::span<const PortalCell> cells() const { return cells_; }
    /// Chooses the parallelograms at which rays from x should be aimed, at most PortalAim::max_targets; those near x
    /// are cut into parts. Returns the sum of the form factors of the others, to which unaimed rays must lead.
    double choose(const Point& x, const Normal& n, std::vector<PortalCell>& out) const;

    /// Number of the part of the scene that contains a point. Rays miss about as much light at all places of a part.
    std::uint32_t part_at(const Point& x) const;
    /// Root mean square of the share of the sky's light that arrives outside of all openings, at places of a part of
    /// the scene where the first n rays found nothing.
    double hidden_sky(std::uint32_t part, std::uint32_t n) const { return parts_[part].sky.after(n); }
    /// Like hidden_sky(), for a sun's disc.
    double hidden_sun(std::uint32_t part, std::uint32_t n) const { return parts_[part].sun.after(n); }

  private:
    /// Shares found after 2^k rays that found nothing.
    struct Hidden {
        std::vector<double> rms;
        double after(std::uint32_t n) const;
    };
    struct ScenePart {
        Hidden sky, sun;
    };
    /// A node of the tree that divides the scene: places below `at` along the axis belong to the child `first`, others
    /// to the next one. A leaf has no axis; `first` is then the number of its part.
    struct Division {
        std::optional<std::size_t> axis = {};
        double at = 0;
        std::uint32_t first = 0;
    };
    /// A place of the search: bits of the rays that arrive outside of the openings.
    struct Arrivals {
        Point x;
        std::uint64_t sky = 0, sun = 0;
    };
    /// Divides the scene below a node. `all`: what rays miss at all places together.
    void divide(std::uint32_t node, std::span<Arrivals> places, const ScenePart& all);

    std::vector<PortalCell> cells_;
    std::vector<Division> divisions_ = {{}};
    std::vector<ScenePart> parts_ = {{}};
};

}  // namespace exitance
