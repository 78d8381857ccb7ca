#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace exitance {

/// Triangulation of the faces between curves. Source: [Gatenby95], except for the last scheme, which needs no
/// construction edges.
enum class TriangulationScheme {
    longest,    ///< Joins the middle of the longest diagonal to all corners.
    shortest,   ///< Repeatedly cuts along the shortest diagonal.
    heuristic,  ///< Cuts along the diagonal that divides the angles at its ends best.
    delaunay,   ///< Constrained Delaunay triangulation of the curves: maximizes the smallest angle.
};
/// Lines of three edges: where they may bound an umbra, everywhere, nowhere.
enum class ThreeEdgeEvents { automatic, on, off };
/// In which order a face is cut: all curves at once, those that bound half-shadows first, or a coarse grid before all.
enum class Premesh { off, penumbra_first, coarse };
/// The function on a triangle: one quadratic polynomial, or three cubic ones whose tangent planes agree.
enum class MeshElement { quadratic, clough_tocher };
/// By what is found what may hide a source: a scene BSP tree's orderings with shadow volumes, one by one or merged into
/// one tree a source, or shafts and a tree of boxes.
enum class OccluderStructure : std::uint8_t { bsp, bvh, merged };
/// How triangles get their shape: by points that are added for it before light is looked at, or as bisection leaves it.
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

/// Surfaces whose reflected light has shadows of its own to cut along: so many, or those that send out so much, in
/// order of their power.
struct SecondarySources {
    std::optional<std::size_t> count = {};
    std::optional<double> power = {};  ///< W, in the mean of the bands.
};

/// How a discontinuity mesh is made. What is empty is as the method would have it.
struct DiscontinuityChoice {
    std::optional<SecondarySources> sources = {};
    std::optional<ThreeEdgeEvents> three_edges = {};
    std::optional<TriangulationScheme> triangulation = {};
    std::optional<Premesh> premesh = {};
    std::optional<MeshQuality> quality = {};
    std::optional<MeshElement> element = {};
    std::optional<bool> layers = {};  ///< One mesh a source.
    std::optional<OccluderStructure> structure = {};

    bool any() const {
        return sources || three_edges || triangulation || premesh || quality || element || layers || structure;
    }
};

}  // namespace exitance
