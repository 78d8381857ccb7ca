#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "exitance/scene/bodies.hpp"
#include "exitance/transport/direct_projection.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// The surroundings that each body of a scene sees: the hits of cosine-weighted rays from points on it. The share of a
/// body's rays that hit an element is the form factor from the body to the element. It shows where an error in the
/// light of a large surface matters to a small body near it. An average over all surfaces hides this.
class BodyViews {
  public:
    /// A ray's hit on the front of a surface.
    struct Hit {
        std::uint32_t body;
        RegionId region;
        Point y;
        double distance;  ///< Length of the ray, metres.
        double weight;    ///< The body's reflectance, mean over bands, over its number of rays.
    };

    /// Casts `rays_per_body` rays from every body. `bodies` must outlive the object. Deterministic on any number of
    /// threads.
    BodyViews(const Stage& stage, const SceneBodies& bodies, std::uint64_t seed);

    std::span<const Hit> hits() const { return hits_; }
    const SceneBodies& bodies() const { return *bodies_; }

    /// Derived from tolerances of 2%: ten rays hit a cell that has such a share of a body's view.
    static constexpr std::uint32_t rays_per_body = 512;

  private:
    const SceneBodies* bodies_;
    std::vector<Hit> hits_;  ///< Sorted by body.
};

/// Errors that the projected direct light may have on each element, so that its light is accurate on every body.
///
/// Let m_e be the RMS error of the projection on element e, and w_c = rho_k F_kc the weight of each of nine cells of
/// the element in the light that body k reflects. That light is wrong by at most m_e sqrt(9 sum of w_c^2) (Cauchy's
/// inequality), which may be at most `tolerance` times the body's reflected light. Besides the misfit of its
/// polynomial, an element may have an error that no node of its fit shows: a feature between the nodes, at most a ninth
/// of its area, which counts where the body sees most of it.
class BodyNeeds {
  public:
    /// `light`: projected direct light, with the tree of its elements. `tolerance`: per body, the error that one
    /// element may cause, relative to the light that the body reflects: direct light and light that was reflected once
    /// before. If that light is less than a tenth of the mean light of the body's room, a tenth of that mean replaces
    /// it. `light_of_room`: mean of w E_dir per room; one value, for all surfaces, if the scene is one room; W/m^2.
    BodyNeeds(const Stage& stage, const BodyViews& views, const DirectProjection& light,
              std::span<const double> tolerance, std::span<const double> light_of_room);

    /// Allowed mean square of w (E - polynomial) on a leaf, (W/m^2)^2; infinite if no body sees it.
    double allowed_squared(ElementId e) const;
    /// True if a feature of the light between the nodes of a leaf's fit could make the light of a body too inaccurate.
    bool hides_too_much(ElementId e, const DirectFit& fit, const Spectrum& weight) const;
    /// Updates the leaves of `tree` that the bodies' rays hit. To be called after leaves were split.
    void follow(const ElementTree& tree);

  private:
    struct ElementLimits;
    void find_limits(const ElementTree& tree);
    std::vector<ElementLimits> limits_of_body(const ElementTree& tree, std::uint32_t first, std::uint32_t last) const;

    const BodyViews& views_;
    std::size_t regions_;
    std::vector<ElementTree::Place> at_;  ///< Place of every hit.
    std::vector<double> allowed_;         ///< Allowed error of each body, W/m^2; infinite for bodies without light.
    std::vector<double> room_light_;      ///< Light of each body's room, W/m^2.
    /// Allowed errors of an element.
    struct Limits {
        /// RMS over the element, W/m^2.
        double everywhere = std::numeric_limits<double>::infinity();
        /// Error in one of the nine cells of the element, the one that has the largest share of a body's view, W/m^2.
        double in_a_cell = std::numeric_limits<double>::infinity();
        /// Like in_a_cell, but only for views from nearer than the element's width, and divided by the mean light of
        /// the body's room.
        double in_a_near_cell = std::numeric_limits<double>::infinity();
    };
    struct ElementLimits {
        ElementId e;
        Limits limits;
    };
    Field<ElementId, Limits> max_;
};

}  // namespace exitance
