#pragma once

#include <array>
#include <vector>

#include "exitance/solution/solution.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Irradiance from the light that elements reflect, for scenes without occlusion between any two points: inside a
/// convex room, or before a few plates in the open (`Occluders::has_nothing_inside`). Needs no rays:
///
///     E(x) = sum over q of  F(x, q)  (sum over g of  K(x, y_g) b(y_g)) / (sum over g of  K(x, y_g))
///
/// over elements q of a hierarchy [Hanrahan91]. Each has 4 Gauss points y_g (3 on a triangle), K = cos cos / (pi r^2),
/// and F is exact. On an element that is not a leaf, b is the least-squares linear function. Each q is the largest
/// element whose light is uniform enough, or which is small and far enough, that its error is less than a share of a
/// first estimate of E(x), band by band. Leaves are split further where their polynomials vary too much. Dark places
/// are therefore as accurate as bright ones, and no light is missed, however small its solid angle. Some hundred
/// elements per place, 25 ns each: the pieces of an element are evaluated four at a time, one per SIMD lane.
class ElementGather {
  public:
    /// `b`: W/m^2. The light of elements that other surfaces cover is omitted, as it reaches no other surface.
    ElementGather(const Stage& stage, const ElementFunction& b);

    /// True if no surface is between any two places. A gather visits all pieces; `forecast_delivery` decides whether
    /// they are few enough for it to be faster than rays.
    static bool suits(const Stage& stage);

    class Workspace;
    /// Irradiance at x of region `own`, W/m^2; no element's error is more than about `share` of it.
    Spectrum operator()(const Point& x, const Normal& n, RegionId own, double share, Workspace& workspace) const;

  private:
    static constexpr std::size_t lanes = 4;
    using Lanes = std::array<double, lanes>;
    static constexpr std::uint32_t none = 0xffffffffu;

    struct Node;
    class Builder;
    /// Light of up to four elements or parts of a leaf, one per lane. An unused lane is dark and has the geometry of
    /// another one.
    struct Group {
        std::array<std::array<Lanes, 3>, 4> corners;  ///< Corners, metres; a triangle has its last corner twice.
        std::array<Lanes, 3> centre;
        Lanes radius;  ///< Radius of a ball about the centre that contains the element, metres.
        Lanes inward;  ///< Position of the Gauss points between the centre (0) and the corners (1).
        Lanes last;    ///< Weight of the third and fourth Gauss points: a half each on a triangle, where they coincide.
        std::array<Lanes, bands> mean{};   ///< Mean of b, W/m^2.
        std::array<Lanes, bands> lean[4];  ///< Least-squares linear function minus the mean, at each corner.
        std::array<Lanes, bands> slope{};  ///< Largest absolute value of `lean`.
        std::array<Lanes, bands> rest{};   ///< Approximate distance of b from the linear function.
        /// Groups of the pieces of each element; none: a leaf, to be split into quarters.
        std::array<std::uint32_t, lanes> below = {none, none, none, none};
        bool more = false;  ///< True if the next group has further pieces of the same element.

        void set(std::size_t lane, const Node& node);
        Group quarters(std::size_t lane) const;
    };
    Spectrum sum(const Point& x, const Normal& n, RegionId own, double share, Workspace& workspace) const;
    static void open_pieces(const Group& group, int uneven, int cuts, Workspace& w);

    std::vector<Group> groups_;                           ///< The groups of the roots come first.
    std::vector<std::array<RegionId, lanes>> of_region_;  ///< Per group of root elements: the regions of its elements.
};

/// Workspace of one gather at a time; one per thread.
class ElementGather::Workspace {
    friend ElementGather;
    /// A group to be summed; none: the last group of `parts_`.
    struct Open {
        std::uint32_t group;
        int cuts;  ///< Number of times that the leaf was split to get this group.
    };
    std::vector<Open> open_;
    std::vector<Group> parts_;
};

}  // namespace exitance
