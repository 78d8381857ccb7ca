#pragma once

#include <array>
#include <vector>

#include "exitance/solution/solution.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Irradiance by what elements reflect where nothing stands between any two places: inside a convex room, before a few
/// plates in the open (`Occluders::has_nothing_inside`). No ray is needed there:
///
///     E(x) = sum over q of  F(x, q)  (sum over g of  K(x, y_g) b(y_g)) / (sum over g of  K(x, y_g))
///
/// over elements q of a hierarchy [Hanrahan91] with 4 of Gauss's points y_g each (3 on a triangle), K = cos cos / (pi
/// r^2), and F exact. On an element that is not a leaf b is the linear function nearest to what lies below. Each q is
/// the largest whose light is so even, or which is so small and far, that it misses less than a share of a first
/// estimate of E(x), band by band; leaves are cut further where their polynomials vary too much. So dim places are as
/// right as bright ones, and no light is missed, however small its solid angle. Some hundred elements a place, 25 ns
/// each: pieces of an element are evaluated four at a time, a lane each.
class ElementGather {
  public:
    /// `b`: W/m^2. Light of elements that other surfaces lie on is left out: nobody sees it.
    ElementGather(const Stage& stage, const ElementFunction& b);

    /// True if nothing stands between any two places. A gather begins at all pieces: whether they are few enough for
    /// it to take less than rays do, `forecast_ways` tells.
    static bool suits(const Stage& stage);

    class Workspace;
    /// Irradiance at x of region `own`, W/m^2; no element misses more than about `share` of it.
    Spectrum operator()(const Point& x, const Normal& n, RegionId own, double share, Workspace& workspace) const;

  private:
    static constexpr std::size_t lanes = 4;
    using Lanes = std::array<double, lanes>;
    static constexpr std::uint32_t none = 0xffffffffu;

    struct Node;
    class Builder;
    /// Light of up to four elements or parts of a leaf, a lane each. A lane to spare is dark and where the one before
    /// it is.
    struct Group {
        std::array<std::array<Lanes, 3>, 4> corners;  ///< Metres; a triangle's last one twice.
        std::array<Lanes, 3> centre;
        Lanes radius;                      ///< Of a ball about the centre, metres.
        Lanes inward;                      ///< How far from the centre towards the corners Gauss's points are;
        Lanes last;                        ///< the third and the fourth are one on a triangle: a half each.
        std::array<Lanes, bands> mean{};   ///< Of b, W/m^2.
        std::array<Lanes, bands> lean[4];  ///< What the nearest linear function has above the mean at each corner.
        std::array<Lanes, bands> slope{};  ///< The largest of those.
        std::array<Lanes, bands> rest{};   ///< How far b is from that function, about.
        std::array<std::uint32_t, lanes> below = {none, none, none, none};  ///< Groups of their pieces; none: quarters.
        bool more = false;  ///< Does the next group hold pieces of the same element?

        void set(std::size_t lane, const Node& node);
        Group quarters(std::size_t lane) const;
    };
    static void open_pieces(const Group& group, int uneven, int cuts, Workspace& w);

    std::vector<Group> groups_;                           ///< Those of the roots first.
    std::vector<std::array<RegionId, lanes>> of_region_;  ///< Of these.
};

/// Room for one gather; one a thread.
class ElementGather::Workspace {
    friend ElementGather;
    /// A group to be summed; none: the last of `parts_`.
    struct Open {
        std::uint32_t group;
        int cuts;  ///< Of a leaf, as far as it.
    };
    std::vector<Open> open_;
    std::vector<Group> parts_;
};

}  // namespace exitance
