#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exitance/mesh/solve_mesh.hpp"
#include "exitance/solve/published_light.hpp"
#include "exitance/solve/relaxation.hpp"

namespace exitance {

/// Contents of the elements of a method, which decide how they become the delivered light.
enum class MethodDelivery : std::uint8_t {
    gathered,     ///< Reflected light; a final gather of it is delivered.
    polynomials,  ///< Reflected light as polynomials that are as accurate as required: no gather is needed.
    /// The method transported the emitters' own light through its elements: `indirect` is all arriving light, and
    /// `direct` is zero. No gather follows.
    all_light,
    apart  ///< Reflected light as a function of a published form, which is delivered as it is or gathered once.
};

/// Resources that a method used.
struct MethodWork {
    std::size_t rays = 0, form_factors = 0, links = 0, link_memory_bytes = 0;
    /// For hierarchies: memory of the elements down to the deepest links, with the light that they hold, and the number
    /// of these elements at each depth.
    std::size_t element_memory_bytes = 0;
    std::vector<std::size_t> elements_by_level = {};
};

/// Result of a method: the light that every element reflects, constant on each leaf of its mesh.
struct GlobalLight {
    ElementTree tree = {};
    LeafNumbering numbering = {};
    /// Mean irradiance from emitters, and from all other surfaces, by leaf number, W/m^2.
    std::vector<Spectrum> direct = {}, indirect = {};
    /// `indirect` at the corners of each leaf's patch, W/m^2, by leaf number; empty unless the method's elements hold
    /// polynomials.
    std::vector<std::array<Spectrum, 4>> indirect_corners = {};
    /// Projected direct light at the corners of each leaf's patch, W/m^2, by leaf number; empty if the method's leaves
    /// are those of the projection.
    std::vector<std::array<Spectrum, 4>> direct_corners = {};
    MethodDelivery delivery = MethodDelivery::gathered;
    /// Reflected radiosity b = rho (E_dir + E_ind), by leaf number, W/m^2.
    std::vector<Spectrum> reflected = {};
    /// True if `tree` is the mesh of the direct projection, leaf for leaf.
    bool on_projection = false;
    /// Standard error of `indirect`, W/m^2, for Monte Carlo methods; empty otherwise.
    std::vector<Spectrum> standard_error = {};

    /// c of `find_direct_share` if the method used it, so that its elements are fine enough for b + c M; else 0.
    Spectrum direct_share = {};

    /// Share of the light leaving each leaf that arrives at some front, by leaf number; empty unless the method
    /// conserved light (`ConservingTransport`).
    std::vector<double> kept = {};

    /// True if the method stopped refining because of the memory limit.
    bool limited_by_memory = false;

    SolveReport report = {};
    MethodWork work = {};

    /// For hierarchies, if requested: links, sorted by receiver, then by source.
    std::vector<KeptLink> kept_links = {};

    /// For methods with a representation of their own (growing cells): the light in that form. It is all light with
    /// `all_light`, otherwise the indirect light; `indirect` is its projection.
    LightFormPointer own_form = {};

    /// Delivered light of published forms.
    std::optional<PublishedLight> published = {};

    bool delivers() const { return delivery == MethodDelivery::polynomials; }
    bool holds_direct() const { return delivery == MethodDelivery::all_light; }
    /// Mean of `reflected` over all bands and all reflecting surfaces, W/m^2. `surface_area`: their area, m^2.
    double mean_reflected(double surface_area) const;
};

/// Reflectance of every leaf, by leaf number.
std::vector<Spectrum> leaf_reflectances(const Scene& scene, const ElementTree& tree, const LeafNumbering& numbering);

}  // namespace exitance
