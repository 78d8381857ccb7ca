#pragma once

#include <array>
#include <vector>

#include "exitance/links/kept_link.hpp"
#include "exitance/mesh/solve_mesh.hpp"
#include "exitance/solution/light_form.hpp"
#include "exitance/solve/relaxation.hpp"

namespace exitance {

/// What a method hands on: the light that every element reflects, constant on each leaf of its mesh.
struct GlobalLight {
    ElementTree tree = {};
    LeafNumbering numbering = {};
    /// By leaf number, W/m^2: mean irradiance by emitters, and by everything else.
    std::vector<Spectrum> direct = {}, indirect = {};
    /// By leaf number, where the method holds polynomials: `indirect` at the corners of the leaf's patch, W/m^2.
    std::vector<std::array<Spectrum, 4>> indirect_corners = {};
    /// By leaf number, where the method's leaves are not those of the projection: the projected direct light likewise.
    std::vector<std::array<Spectrum, 4>> direct_corners = {};
    /// Are the polynomials of `indirect_corners` as good as what is asked for, so that nothing has to gather again?
    bool delivers = false;
    /// By leaf number, W/m^2: b = rho (E_dir + E_ind), reflected radiosity.
    std::vector<Spectrum> reflected = {};
    /// Is `tree` the mesh of the direct projection, leaf for leaf?
    bool on_projection = false;
    /// Of `indirect`, W/m^2, where the method is a random one; empty otherwise.
    std::vector<Spectrum> standard_error = {};

    /// c of `find_direct_share` as the method used it: its elements agree with b + c M. Zero where it did not.
    Spectrum direct_share = {};

    /// True when the method carried the emitters' own light through its elements: then `indirect` is all light that
    /// arrives, and `direct` is zero.
    bool holds_direct = false;

    /// By leaf number, where the method saw to it that no light is lost but what escapes: the share of what leaves it
    /// that arrives at some front. Empty otherwise.
    std::vector<double> kept = {};

    /// Did the method stop refining for want of memory?
    bool limited_by_memory = false;

    SolveReport report = {};
    std::size_t rays = 0, form_factors = 0, links = 0, link_memory_bytes = 0;
    /// Of a hierarchy's elements, as far down as links come to them, and the light that they hold; and how many those
    /// are at each depth.
    std::size_t element_memory_bytes = 0;
    std::vector<std::size_t> elements_by_level = {};

    /// Of a hierarchy, where they are asked for: links by receiver, then by source.
    std::vector<KeptLink> kept_links = {};

    /// The light in the method's own representation, where it has one (growing cells): all of it with `holds_direct`,
    /// else the indirect light. `indirect` is its projection.
    LightFormPointer own_form = {};

    /// Mean over all bands and a surface of `surface_area`, which is all that reflects, W/m^2.
    double mean_reflected(double surface_area) const;
};

/// Reflectance of every leaf, by leaf number.
std::vector<Spectrum> leaf_reflectances(const Scene& scene, const ElementTree& tree, const LeafNumbering& numbering);

}  // namespace exitance
