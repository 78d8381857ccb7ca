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

/// How much of a function breaks across a curve on a receiver: its value, its slope, its curvature; `eee`: its
/// curvature along a stretch of a conic, where edges of three polygons are seen in one line.
enum class CurveOrder : std::uint8_t { border = 0, d0 = 1, d1 = 2, d2 = 3, eee = 4, none = 255 };

/// What makes a curve: surfaces that touch, a source's corner seen over a blocker's edge, a source's edge seen over a
/// blocker's corner, a blocker's corner seen over another's edge, an edge of the source and two of blockers in one line
/// of sight.
enum class CurveCause : std::uint8_t { contact, vertex_edge, edge_vertex, blocker_edge, three_edges };

/// A stretch of a curve, on a region; `source` is the emitting region, none for contacts.
struct DiscontinuityCurve {
    RegionId region;
    Point a, b;  ///< Metres.
    CurveOrder order = CurveOrder::d1;
    CurveCause cause = CurveCause::contact;
    RegionId source;
};

/// How much of the primary sources every point of a face sees: all of each, parts, nothing.
enum class ShadowClass : std::uint8_t { lit, penumbra, umbra };

/// Irradiance as one quadratic polynomial a triangle, by its values at six nodes: corners 0 1 2, then the middles of
/// the edges 0-1, 1-2, 2-0. Triangles of a region share nodes, so that the function is continuous, except across lines
/// where light jumps: there each side has nodes of its own. W/m^2.
///
///     E(L) = sum_corners E_i L_i (2 L_i - 1) + sum_edges E_ab 4 L_a L_b,   L the barycentric coordinates
///
/// Or, with slopes, as one of Clough and Tocher's elements a triangle, whose tangent planes agree across every edge but
/// those where light jumps or has a kink; the values at the middles of edges are what it has there.
struct SixNodeMesh {
    using Slope = std::array<float, bands>;  ///< W/m^3

    std::vector<Point> points;                          ///< Of nodes, metres.
    std::vector<std::array<float, bands>> values;       ///< Of nodes.
    std::vector<std::array<std::uint32_t, 6>> nodes;    ///< Of triangles; counter-clockwise seen from the front.
    std::vector<RegionId> region;                       ///< Of triangles.
    std::vector<std::array<CurveOrder, 3>> edge_order;  ///< Of the edge from corner i to the next.
    std::vector<ShadowClass> shadow;                    ///< Of triangles.
    std::vector<DiscontinuityCurve> curves;
    // Of Clough and Tocher's elements; else empty.
    std::vector<std::array<Slope, 3>> gradients;            ///< Along x, y, z, within the region's plane.
    std::vector<std::array<std::uint32_t, 3>> gradient_of;  ///< Of triangles' corners.
    std::vector<std::array<Slope, 3>> slopes;               ///< Of triangles: at the middle of edge i, at a right
                                                            ///< angle to it, inwards.

    bool is_clough_tocher() const { return !slopes.empty(); }
    CloughTocher element(std::uint32_t triangle, std::size_t band) const;
    bool empty() const { return nodes.empty(); }
    std::size_t size() const { return nodes.size(); }
    Spectrum value(std::uint32_t node) const;
    /// At barycentric coordinates (1 - s - t, s, t).
    Spectrum at(std::uint32_t triangle, Vec2 st) const;
    Spectrum mean(std::uint32_t triangle) const;
    double area(std::uint32_t triangle) const;
    Point centre(std::uint32_t triangle) const;
    /// Of the inscribed circle's radius to the circumscribed one's, 0 to 0.5, over all triangles.
    double mean_radius_ratio() const;
};

/// The quadratic polynomial's weights of the six nodes at (1 - s - t, s, t).
std::array<double, 6> six_node_weights(Vec2 st);

/// Finds the triangle of a region that holds a point. O(triangles log triangles) to make.
class SixNodeLocator {
  public:
    SixNodeLocator(const SixNodeMesh& mesh, const Scene& scene);

    struct Place {
        std::uint32_t triangle = none;
        Vec2 st;
    };
    static constexpr std::uint32_t none = 0xffffffffu;
    /// The triangle that holds the point's foot, or the nearest by of those whose boxes do; none where the region has
    /// no triangle there.
    Place find(RegionId region, const Point& p) const;
    Spectrum at(RegionId region, const Point& p) const;

  private:
    const SixNodeMesh* mesh_;
    Field<RegionId, Bvh> trees_;
    Field<RegionId, std::uint32_t> first_;
    std::vector<std::uint32_t> order_;  ///< Triangles, by region.
    double slack_;                      ///< Metres.
};

}  // namespace exitance
