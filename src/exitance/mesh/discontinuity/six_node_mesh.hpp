#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/base/ids.hpp"
#include "exitance/base/spectrum.hpp"
#include "exitance/mesh/discontinuity/clough_tocher.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Order of the derivative that is discontinuous across a curve on a receiver. `d0`: value; `d1`: slope; `d2`:
/// curvature; `eee`: curvature, along a section of a conic on which edges of three polygons appear to meet in one
/// point.
enum class CurveOrder : std::uint8_t { border = 0, d0 = 1, d1 = 2, d2 = 3, eee = 4, none = 255 };

/// Cause of a curve. `contact`: touching surfaces. `vertex_edge`: a source's corner over a blocker's edge.
/// `edge_vertex`: a source's edge over a blocker's corner. `blocker_edge`: a blocker's corner over another blocker's
/// edge. `three_edges`: an edge of the source and two blocker edges in one line of sight.
enum class CurveCause : std::uint8_t { contact, vertex_edge, edge_vertex, blocker_edge, three_edges };

/// A segment of a curve on a region. `source`: the emitting region; none for contacts.
struct DiscontinuityCurve {
    RegionId region;
    Point a, b;  ///< Metres.
    CurveOrder order = CurveOrder::d1;
    CurveCause cause = CurveCause::contact;
    RegionId source;
};

/// Part of the primary sources that all points of a face see: everything, parts, or nothing.
enum class ShadowClass : std::uint8_t { lit, penumbra, umbra };

/// Irradiance as one quadratic polynomial per triangle, given by its values at six nodes: corners 0, 1, 2, then the
/// middles of the edges 0-1, 1-2, 2-0. The triangles of a region share nodes, so that the function is continuous,
/// except across lines of discontinuity, where each side has nodes of its own. W/m^2.
///
///     E(L) = sum_corners E_i L_i (2 L_i - 1) + sum_edges E_ab 4 L_a L_b,   L the barycentric coordinates
///
/// If slopes are given, each triangle is a Clough-Tocher element instead. Tangent planes are then continuous across
/// every edge except those with a discontinuity of value or slope; the values at edge middles are those of the element.
struct SixNodeMesh {
    using Slope = std::array<float, bands>;  ///< W/m^3

    std::vector<Point> points;                     ///< Positions of the nodes, metres.
    std::vector<std::array<float, bands>> values;  ///< Per node.
    /// Six nodes of each triangle, counter-clockwise seen from the front.
    std::vector<std::array<std::uint32_t, 6>> nodes;
    std::vector<RegionId> region;  ///< Per triangle.
    /// Orders of the edges of each triangle; entry i is the edge from corner i to the next.
    std::vector<std::array<CurveOrder, 3>> edge_order;
    std::vector<ShadowClass> shadow;  ///< Per triangle.
    std::vector<DiscontinuityCurve> curves;
    // For Clough-Tocher elements; otherwise empty.
    std::vector<std::array<Slope, 3>> gradients;            ///< Gradient along x, y, z, within the region's plane.
    std::vector<std::array<std::uint32_t, 3>> gradient_of;  ///< Per triangle: index of the gradient at each corner.
    /// Per triangle: slope at the middle of edge i, perpendicular to it, inwards.
    std::vector<std::array<Slope, 3>> slopes;

    bool is_clough_tocher() const { return !slopes.empty(); }
    CloughTocher element(std::uint32_t triangle, std::size_t band) const;
    bool empty() const { return nodes.empty(); }
    std::size_t size() const { return nodes.size(); }
    Spectrum value(std::uint32_t node) const;
    /// Value at barycentric coordinates (1 - s - t, s, t).
    Spectrum at(std::uint32_t triangle, Vec2 st) const;
    Spectrum mean(std::uint32_t triangle) const;
    double area(std::uint32_t triangle) const;
    Point centre(std::uint32_t triangle) const;
    /// Ratio of inscribed to circumscribed circle radius (0 to 0.5), averaged over all triangles.
    double mean_radius_ratio() const;
};

/// Weights of the six nodes in the quadratic polynomial at (1 - s - t, s, t).
std::array<double, 6> six_node_weights(Vec2 st);

/// Finds the triangle of a region that contains a point. Construction: O(triangles log triangles).
class SixNodeLocator {
  public:
    SixNodeLocator(const SixNodeMesh& mesh, const Scene& scene);

    struct Place {
        std::uint32_t triangle = none;
        Vec2 st;
    };
    static constexpr std::uint32_t none = 0xffffffffu;
    /// Returns the triangle that contains the projection of p, or else the nearest of those whose boxes contain p; none
    /// if the region has no triangle there.
    Place find(RegionId region, const Point& p) const;
    Spectrum at(RegionId region, const Point& p) const;

  private:
    const SixNodeMesh* mesh_;
    Field<RegionId, Bvh> trees_;
    Field<RegionId, std::uint32_t> first_;
    std::vector<std::uint32_t> order_;  ///< Triangles, sorted by region.
    double slack_;                      ///< Tolerance, metres.
};

}  // namespace exitance
