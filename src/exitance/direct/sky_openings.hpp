#pragma once

#include <optional>
#include <span>
#include <vector>

#include "exitance/direct/sky_search.hpp"

namespace exitance {

/// Openings through which rooms see the sky, such as windows without panes, and how much light of the sky and of suns a
/// few rays miss. If a room has a small window, only one unaimed ray in thousands would find the sky.
///
/// Rays to the sky are cast from places all over the scene. A ray that escapes from a place that sees little of the sky
/// passes through an opening. The search walks along the ray to a point in front of the opening, from where the
/// directions in which the sky is seen are bounded by the opening's rim. A rectangle around the rim covers the opening.
/// The rectangle need not cover the opening completely: unaimed rays find the rest.
///
/// Rays of a part of the scene are not aimed at an opening if no ray from the part's places has reached the sky through
/// it.
///
/// The same places give the light that a few rays miss: if the first n rays found nothing, it is the light that the
/// next n rays find. It is known for parts of the scene with some hundred places each, since a small room in a large
/// scene misses more than the mean of all places.
class SkyOpenings {
  public:
    /// Casts up to a million rays, on the calling thread alone.
    SkyOpenings(const Occluders& occluders, const RayTracer& tracer, const SkyTree& sky, std::span<const SunDisc> suns);

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
        std::vector<bool> is_hidden = {};  ///< Per opening: true if no place of this part sees the sky through it.
    };
    /// A node of the tree that divides the scene: places below `at` along the axis belong to the child `first`, others
    /// to the next one. A leaf has no axis; `first` is then the number of its part.
    struct Division {
        std::optional<std::size_t> axis = {};
        double at = 0;
        std::uint32_t first = 0;
    };
    std::vector<PortalCell> find_openings(SkySearch& search, std::span<const SearchPlace> places);
    std::vector<bool> hidden_openings(SkySearch& search, std::span<SearchPlace> places,
                                      std::span<const PortalCell> openings, std::size_t every) const;
    void divide(std::uint32_t node, std::span<SearchPlace> places, std::vector<std::span<SearchPlace>>& places_of_part);

    std::vector<PortalCell> cells_;
    std::vector<std::uint32_t> opening_of_cell_;
    std::vector<Division> divisions_ = {{}};
    std::vector<ScenePart> parts_ = {{}};
};

}  // namespace exitance
