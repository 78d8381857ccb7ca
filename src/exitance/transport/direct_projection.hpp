#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/direct/small_sources.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

class BodyViews;

struct DirectProjectionOptions {
    MeshSize mesh;
    double tolerance = 0;  ///< RMS error of rho E_dir over all surfaces, relative to the mean of rho E_dir.
    int max_depth = 8;     ///< Levels of refinement below the initial mesh.
    /// Smallest area of an element that is split, m^2; empty: only `tolerance` limits splitting.
    std::optional<double> min_area = {};
    std::size_t max_elements = SIZE_MAX;  ///< No element is split once the tree has that many.
    /// On a stop request: if true, return an empty tree at once; if false, estimate the remaining elements by rays, so
    /// that there is a result.
    bool may_give_up = false;
    /// The surroundings that bodies see, if the light that they receive must be accurate (BodyNeeds); null: only the
    /// error of the whole matters.
    const BodyViews* bodies = nullptr;
    /// Error by one element, for every body, relative to the light that the body reflects.
    std::span<const double> body_tolerance = {};
    Progress* progress = nullptr;  ///< Receives the progress of the fits; null: no reports.
};

/// Exact direct irradiance on one element, and its least-squares polynomial.
struct DirectFit {
    std::array<Spectrum, 4> corners;
    Spectrum mean;              ///< W/m^2
    Spectrum parallel;          ///< Part of the mean that is parallel light, W/m^2.
    double misfit_squared = 0;  ///< Mean of (w (E - polynomial))^2, see light_weight().
    /// Part of it that is noise of rays, (W/m^2)^2: more rays reduce it, smaller elements do not.
    double noise_squared = 0;
    std::array<double, 2> misfit_along =
        {};  ///< Parts of the misfit that vary along one coordinate only, noise included (basis/misfit_along.hpp).
};

/// Direct irradiance projected onto elements, for consumers that evaluate it often, such as rays.
///
/// Each leaf of an adaptive mesh holds the least-squares polynomial of exact values at the nodes of a quadrature rule.
/// Its mean is exact, also where the nodes miss a patch of light, and shadow edges are resolved to the size of the
/// elements. A method that solves on the same mesh gets elements that follow the shadows.
struct DirectProjection {
    ElementTree tree;
    Field<ElementId, DirectFit> fit;  ///< Fit of every leaf. An inner element keeps its fit from before it was split.

    Spectrum at(ElementTree::Place place) const;
};

/// Weight of an irradiance error on a surface: its reflectance, but at least 0.1, since irradiance is also viewed on
/// black surfaces.
Spectrum light_weight(const Material& material);

/// Workspace of one thread.
struct DirectFitRoom {
    PlaceLight::Workspace place;
    SmallSources::Workspace small;
    std::vector<PlaceLight::Estimate> found;
};

/// Adds the light of small sources that the nodes of a fit's rule miss (`SmallSources`), so that the fit's mean is
/// right, and counts it as misfit, so that the element is split until the nodes see it.
void add_missed_light(const DirectLight& direct, const ElementTree& tree, ElementId e, SmallSources::Workspace& room,
                      DirectFit& fit);

/// Fits direct light on one element from values at the nodes of its fine rule: exact ones, or by rays where these are
/// cheaper (`PlaceLight`); and from the mean light of small sources.
/// `allowed`: largest mean square of w (E - polynomial) due to noise, (W/m^2)^2. Noise that the polynomial keeps counts
/// as misfit; the rest of it does not.
DirectFit fit_direct_light(const Stage& stage, const ElementTree& tree, ElementId e, double allowed,
                           DirectFitRoom& room);

/// Restricts the fit of an element's parent to the element, for work that is stopped early.
DirectFit inherited_fit(const ElementTree& tree, ElementId e, const DirectFit& parent);

/// Fits direct light on all leaves of a given tree. O(elements x nodes x visible emitters).
DirectProjection direct_light_on(const Stage& stage, const ElementTree& tree);

/// Projects direct light onto an adaptive mesh. O(elements x nodes x visible emitters).
DirectProjection project_direct_light(const Stage& stage, const DirectProjectionOptions& options,
                                      const StopRequest& stop);

}  // namespace exitance
