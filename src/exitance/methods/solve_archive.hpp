#pragma once

#include "exitance/base/archive.hpp"
#include "exitance/error/certificate.hpp"
#include "exitance/gather/local_pass.hpp"
#include "exitance/mesh/element_tree_archive.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {

// Serialization of a solve's state between its phases, for checkpoints. Structured bindings name every member, so that
// a new member causes a compile error until it is added here.

template <class Archive>
void archive(Archive& a, LeafNumbering& numbering) {
    a(numbering.leaves, numbering.number);
}

template <class Archive>
void archive(Archive& a, ElementFunction& function) {
    auto& [tree, first_value, values] = function;
    a(tree, first_value, values);
}

template <class Archive>
void archive(Archive& a, DirectProjection& projection) {
    auto& [tree, fit] = projection;
    a(tree, fit);
}

template <class Archive>
void archive(Archive& a, LightFormPointer& form) {
    std::string kind, bytes;
    if (!Archive::reads && form) kind = form->kind(), bytes = form->packed();
    a(kind, bytes);
    if constexpr (Archive::reads) form = unpack_light_form(kind, bytes);
}

template <class Archive>
void archive(Archive& a, SixNodeMesh& mesh) {
    auto& [points, values, nodes, region, edge_order, shadow, curves, gradients, gradient_of, slopes] = mesh;
    a(points, values, nodes, region, edge_order, shadow, curves, gradients, gradient_of, slopes);
}

/// Forms that refuse to solve are not saved.
template <class Archive>
void archive(Archive& a, PublishedLight& light) {
    auto& [irradiance, mesh, counts, elements, leaf_elements, figures, visibility_seconds, form_factor_seconds,
           refusal] = light;
    a(irradiance, mesh, counts, elements, leaf_elements, figures, visibility_seconds, form_factor_seconds);
}

template <class Archive>
void archive(Archive& a, MethodWork& work) {
    auto& [rays, form_factors, links, link_memory_bytes, element_memory_bytes, elements_by_level] = work;
    a(rays, form_factors, links, link_memory_bytes, element_memory_bytes, elements_by_level);
}

template <class Archive>
void archive(Archive& a, GlobalLight& light) {
    auto& [tree, numbering, direct, indirect, indirect_corners, direct_corners, delivery, reflected, on_projection,
           standard_error, direct_share, kept, limited_by_memory, report, work, kept_links, own_form, published] =
        light;
    a(tree, numbering, direct, indirect, indirect_corners, direct_corners, delivery, reflected, on_projection);
    a(standard_error, direct_share, kept, limited_by_memory, report, work, kept_links, own_form, published);
}

template <class Archive>
void archive(Archive& a, KeptLinks& kept) {
    auto& [elements, links] = kept;
    a(elements, links);
}

template <class Archive>
void archive(Archive& a, LocalPassReport& report) {
    auto& [rays, whole, rooms, leaves, interrupted] = report;
    a(rays, whole, rooms, leaves, interrupted);
}

template <class Archive>
void archive(Archive& a, Certificate& certificate) {
    auto& [estimate, uncertainty, bound, p99, residual, local, method, rough, rough_places, again, constant,
           mean_reflected, points, rays, worst_room, room_uncertainty, largest_room, largest_light, worst_body,
           hidden] = certificate;
    a(estimate, uncertainty, bound, p99, residual, local, method, rough, rough_places, again, constant, mean_reflected);
    a(points, rays, worst_room, room_uncertainty, largest_room, largest_light, worst_body);
    a(hidden.bodies, hidden.first, hidden.at_most);
}

template <class Archive>
void archive(Archive& a, SolveStatistics& statistics) {
    auto& [method, basis, schedule, threads, processes, surfaces, elements, leaf_elements, links, rays, form_factors,
           iterations, refinement_steps, converged, residual, estimate, bound, p99, interpolant, rooms, worst_room,
           bodies, worst_body, surface_errors, standard_error, energy, seconds, peak_memory_bytes, link_memory_bytes,
           element_memory_bytes, elements_by_level, warnings, discontinuity, figures, stopped_by] = statistics;
    a(method, basis, schedule, threads, processes, surfaces, elements, leaf_elements, links, rays, form_factors);
    a(iterations, refinement_steps, converged, residual, estimate, bound, p99, interpolant, rooms, worst_room, bodies,
      worst_body, surface_errors, standard_error, energy, seconds, peak_memory_bytes, link_memory_bytes);
    a(element_memory_bytes, elements_by_level, warnings, figures, stopped_by);
}

}  // namespace exitance
