#pragma once

#include <array>
#include <vector>

#include "exitance/reconstruct/solution.hpp"
#include "exitance/transport/form_factor_batch.hpp"
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
/// estimate of E(x), band by band; leaves are cut further where their polynomials ask for it. So dim places are as
/// right as bright ones, and no light is missed, however small its solid angle. Some hundred elements a place, 50 ns
/// each.
class ElementGather {
  public:
    /// `b`: W/m^2. Light of elements that other surfaces lie on is left out: nobody sees it.
    ElementGather(const Stage& stage, const ElementFunction& b);

    /// Is this the way to gather: does nothing stand in between, and are there few enough pieces to begin from?
    static bool suits(const Stage& stage);

    class Workspace;
    /// Irradiance at x of region `own`, W/m^2; no element misses more than about `share` of it.
    Spectrum operator()(const Point& x, const Normal& n, RegionId own, double share, Workspace& workspace) const;

  private:
    /// Light of an element, or of a part of a leaf.
    struct Node {
        std::array<Point, 4> corners;  ///< A triangle's last one twice.
        Point centre;
        double radius = 0;  ///< Of a ball about the centre, metres.
        bool triangle = false;
        Spectrum mean;                   ///< Of b, W/m^2.
        std::array<Spectrum, 4> lean{};  ///< What the nearest linear function has above the mean at each corner.
        Spectrum slope;                  ///< The largest of those.
        Spectrum rest;                   ///< How far b is from that function, about.
    };
    struct Part {
        Node node;
        ElementId leaf;
        std::array<Vec2, 4> uv;  ///< Corners in the leaf's coordinates.
    };
    /// A whole element, or the part of that number in the workspace.
    struct Item {
        ElementId element;
        std::uint32_t part;
    };
    static constexpr std::uint32_t whole = 0xffffffffu;

    Part part_of(ElementId leaf, const std::array<Vec2, 4>& uv) const;
    Node leaf_node(ElementId e) const;
    Node inner_node(ElementId e);
    void set_lean(Node& node, ElementId e, const std::array<Vec3, bands>& moment) const;
    static Spectrum mean_seen(const Node& node, const Point& x, const Normal& n);
    void add_element(ElementId e, Workspace& w) const;
    void add_pieces(Item item, Workspace& w) const;

    ElementFunction b_;
    Field<ElementId, Node> nodes_;
    Field<ElementId, std::array<Vec3, bands>> moments_;  ///< 1/A int (b - mean) (y - centre) dA, W/m.
    Field<ElementId, std::uint8_t> is_quad_;             ///< No more than four corners.
    Field<ElementId, std::uint8_t> is_dark_;             ///< Nothing leaves it.
};

/// Room for one gather; one a thread.
class ElementGather::Workspace {
    friend ElementGather;
    std::vector<Item> level_, next_;
    std::vector<Part> parts_;
    QuadBatch quads_;
    std::vector<double> F_;
};

}  // namespace exitance
