#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace exitance {

/// Triangulation of the faces between curves. Source: [Gatenby95], except for the last scheme, which needs no
/// construction edges.
enum class TriangulationScheme {
    longest,    ///< Joins the middle of the longest diagonal to all corners.
    shortest,   ///< Repeatedly cuts along the shortest diagonal.
    heuristic,  ///< Cuts along the diagonal that splits the angles at its ends most evenly.
    delaunay,   ///< Constrained Delaunay triangulation of the curves: maximizes the smallest angle.
};
/// Selects where discontinuity lines due to three edges are computed: where they may bound an umbra, everywhere, or
/// nowhere.
enum class ThreeEdgeEvents { automatic, on, off };
/// Order in which a face is split: along all curves at once, first along those that bound penumbrae, or by a coarse
/// grid before any curve.
enum class Premesh { off, penumbra_first, coarse };
/// Function on a triangle: one quadratic polynomial, or three cubic polynomials with matching tangent planes.
enum class MeshElement { quadratic, clough_tocher };
/// Data structure that finds the blockers of a source: the order of a scene BSP tree with shadow volumes, used one by
/// one or merged into one tree per source; or shafts and a tree of boxes (bvh).
enum class OccluderStructure : std::uint8_t { bsp, bvh, merged };
/// How triangles get a good shape: by additional points before light is evaluated, or by bisection alone.
enum class MeshQuality : std::uint8_t { delaunay, rivara };

inline constexpr std::array<std::pair<ThreeEdgeEvents, std::string_view>, 3> three_edge_names{{
    {ThreeEdgeEvents::automatic, "auto"},
    {ThreeEdgeEvents::on, "on"},
    {ThreeEdgeEvents::off, "off"},
}};
inline constexpr std::array<std::pair<Premesh, std::string_view>, 3> premesh_names{{
    {Premesh::off, "off"},
    {Premesh::penumbra_first, "penumbra-first"},
    {Premesh::coarse, "coarse"},
}};
inline constexpr std::array<std::pair<MeshElement, std::string_view>, 2> mesh_element_names{{
    {MeshElement::quadratic, "quadratic"},
    {MeshElement::clough_tocher, "clough-tocher"},
}};
inline constexpr std::array<std::pair<OccluderStructure, std::string_view>, 3> structure_names{{
    {OccluderStructure::bsp, "bsp"},
    {OccluderStructure::bvh, "bvh"},
    {OccluderStructure::merged, "bsp-merged"},
}};
inline constexpr std::array<std::pair<MeshQuality, std::string_view>, 2> mesh_quality_names{{
    {MeshQuality::delaunay, "delaunay"},
    {MeshQuality::rivara, "rivara"},
}};
inline constexpr std::array<std::pair<TriangulationScheme, std::string_view>, 4> triangulation_choices{{
    {TriangulationScheme::longest, "longest"},
    {TriangulationScheme::shortest, "shortest"},
    {TriangulationScheme::heuristic, "heuristic"},
    {TriangulationScheme::delaunay, "delaunay"},
}};

/// Surfaces whose reflected light causes shadows that are meshed, in descending order of their power: the first `count`
/// ones, or those of at least the given power.
struct SecondarySources {
    std::optional<std::size_t> count = {};
    std::optional<double> power = {};  ///< Minimum power, W, mean over bands.
};

/// Which of the curves where direct light changes its form become edges of the mesh.
struct ShadowLines {
    enum class Kind : std::uint8_t {
        automatic,   ///< Curves that the requested error needs.
        all,         ///< All that are found, of all sources.
        strongest,   ///< The `count` curves of `automatic` with the largest gain times length.
        on_surfaces  ///< All curves on surfaces whose material or object is one of `names`, and none elsewhere.
    };
    Kind kind = Kind::automatic;
    std::size_t count = 0;
    std::vector<std::string> names = {};
};

/// Options of a discontinuity mesh. Empty ones are chosen by the method.
struct DiscontinuityChoice {
    std::optional<SecondarySources> sources = {};
    std::optional<ThreeEdgeEvents> three_edges = {};
    std::optional<ShadowLines> lines = {};
    std::optional<double> largest_error = {};  ///< Largest error of the mesh, as a share of the brightest light.
    std::optional<TriangulationScheme> triangulation = {};
    std::optional<Premesh> premesh = {};
    std::optional<MeshQuality> quality = {};
    std::optional<MeshElement> element = {};
    std::optional<bool> layers = {};  ///< Use a separate mesh for each source.
    std::optional<OccluderStructure> structure = {};

    bool any() const {
        return sources || three_edges || lines || largest_error || triangulation || premesh || quality || element ||
               layers || structure;
    }
};

}  // namespace exitance
