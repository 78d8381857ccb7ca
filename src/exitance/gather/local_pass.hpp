#pragma once

#include "exitance/base/checkpoint.hpp"
#include "exitance/gather/element_gather.hpp"
#include "exitance/gather/gather.hpp"
#include "exitance/gather/rough_places.hpp"
#include "exitance/gather/sampled_element.hpp"
#include "exitance/mesh/element_tree_archive.hpp"
#include "exitance/scene/bodies.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {

/// Accuracy at which indirect light is gathered.
struct LocalPassDemand {
    RayBudget rays;    ///< Initial rays per place; more are cast if the result is too noisy.
    double light = 0;  ///< Mean reflected light of the scene, W/m^2: much brighter places may be noisier. 0: none may.
    double noise = 0;  ///< Allowed RMS error of rho E_ind due to rays, W/m^2.
    double tolerance = 0;  ///< Allowed RMS error of rho E_ind due to interpolation, W/m^2.
    bool curved = false;   ///< Fit polynomials of second degree where they exceed their noise.
    /// Allowed error of interpolation relative to the light on an element, if elements are summed; 0: not limited.
    double relative_tolerance = 0;
    /// Parts of b whose light is summed from element to element, without rays, if the scene is suitable. Empty: all
    /// light is gathered by rays.
    std::span<const ElementGather> elements = {};
    double element_share = 0;  ///< Allowed error of one element in such a sum, as a share of the irradiance.
    int max_depth = 8;         ///< Limit on the rounds of refinement.
    /// Light of every room over the mean light: allowed errors are proportional to it. Empty if the scene is one room.
    std::span<const double> light_in = {};
    /// Factor on the noise allowed in every room, at least 1: rooms that are accurate enough already do not take the
    /// rays that others need. Empty: 1.
    std::span<const double> noise_in = {};
    /// RMS error that noise and interpolation may each have on every body, W/m^2. Not limited without bodies.
    const SceneBodies* bodies = nullptr;
    std::span<const double> allowed_on_body = {};
    /// b minus the light gathered last, if that is small. Only the change is then gathered, with as few rays as its
    /// noise requires, and added to the present result. Null: b was gathered last, or is unrelated to it.
    const ReflectedLight* change = nullptr;
    /// Points at which the last gather missed a feature. Elements there and along the feature are refined.
    std::span<const RoughPlace> rough_places = {};
};

struct LocalPassReport {
    std::size_t rays = 0;
    /// RMS error of rho E_ind over some surfaces, W/m^2, due to rays and, as estimated, to interpolation.
    struct Parts {
        double noise = 0, interpolation = 0;
    };
    Parts whole;               ///< Errors over all surfaces.
    std::vector<Parts> rooms;  ///< Errors over each room; empty if the scene is one room.
    /// Data of every leaf before it was made continuous; unused for inner elements.
    struct Leaf {
        double expected_error = 0;  ///< Expected error of rho E_ind, W/m^2.
        unsigned rays = 0;          ///< Rays that reduced the element's noise to the allowed value.
    };
    Field<ElementId, Leaf> leaves;
    /// Data of a leaf of the returned tree; a triangle of a fan has those of the element that was gathered.
    static const Leaf& known(const Field<ElementId, Leaf>& leaves, const ElementTree& tree, ElementId e) {
        return leaves[e.value < leaves.size() ? e : tree.parent(e)];
    }
    bool interrupted = false;  ///< True if a stop was requested before every element had a result.
};

/// Indirect irradiance by one gather of the light that a method found (the iterated or Sloan solution) [Lischinski93],
/// [Atkinson97]. E_ind = H b is evaluated at the nodes of a quadrature rule on the elements of an adaptive mesh
/// (`RuleOrder`: 3 x 3 on parallelograms, 16 that form no grid for polynomials of second degree) and fitted by a
/// polynomial in the least-squares sense. The gather smooths errors of b and doubles its order. There are more nodes
/// than degrees of freedom: the misfit, less the rays' noise, is the error of interpolation. Elements are split where
/// it exceeds their share of the tolerance, across a single direction if that suffices. Rays are doubled until the
/// noise is small enough. A polynomial of many nodes needs few rays per node, so that large elements make the gather
/// cheap. The result has linear elements in any case. O(elements x rays).
///
/// Mesh and gathers are kept. A call with a stricter demand improves only insufficient elements; if the light has
/// changed by little, only the change is gathered; other light is gathered from scratch on the present mesh.
class LocalPass {
  public:
    /// `mesh`: element size of the initial mesh. The stage must outlive the object.
    LocalPass(const Stage& stage, MeshSize mesh, std::uint64_t seed);

    /// Gathers b. `fresh`: b is not the light gathered last. `report.rays` counts the rays of this call. `safe_points`:
    /// saves the state beyond archive_state() between slices of the work.
    ElementFunction gather(const ReflectedLight& b, bool fresh, const LocalPassDemand& demand, LocalPassReport& report,
                           Progress& progress, const StopRequest& stop, SafePoints safe_points = {});

    /// Archives mesh and gathers for checkpoints.
    template <class Archive>
    void archive_state(Archive& a) {
        a(tree_, sampled_, mean_area_, noise_area_, mean_area_of_, is_crowd_, min_share_, spread_, suspect_);
    }

  private:
    /// Workspace of one thread.
    struct Workspace {
        GatherWorkspace rays;
        ElementGather::Workspace elements;
        std::vector<GrowingGather> growing;  ///< Gathers under way, one per place.
        std::vector<Gathered> gathered;
        std::vector<bool> hidden;               ///< For each place, whether it cannot be seen (`is_hidden`).
        std::vector<GatherPlace> short_places;  ///< Places that need more rays.
        std::vector<GrowingGather*> short_of;   ///< Entries of `growing` for `short_places`.
    };

    /// Sums over all sampled elements of area times the variance estimated from quarters and from halves of their rays,
    /// (W/m^2)^2 m^2. Initially as for rays between random and uniform light (`Gathered`), with negligible weight.
    struct Spread {
        double quarters = 1e-100, halves = 0.85e-100;  // derived from the range of gain(): the middle of the range

        /// Ratio of the actual variance to its estimate from quarters. A mean over elements, since one element has too
        /// few places.
        double gain() const {
            const double ratio = std::clamp(halves / quarters, std::sqrt(0.5), 1.0);
            return ratio * ratio;
        }
    };

    SampledElement sample(ElementId e, const ReflectedLight& b, const LocalPassDemand& demand, bool may_cut,
                          Workspace& workspace) const;
    SampledElement changed(ElementId e, const LocalPassDemand& demand, Workspace& workspace) const;
    unsigned gather_at(ElementId e, const std::vector<WeightedPlace>& places, const ReflectedLight& b, unsigned rays,
                       bool more, const LocalPassDemand& demand, Workspace& workspace) const;
    SampledElement fitted(ElementId e, const std::vector<WeightedPlace>& places, bool curved,
                          Workspace& workspace) const;
    bool is_hidden(ElementId e, const Point& x, const Gathered& gathered) const;
    bool is_minor(ElementId e, double small_area, const ReflectedLight& b) const;
    /// Gathers the small elements among `active` with a mean, and a slope where it exceeds its noise, by rays that
    /// start all over them and are traced together for neighbours. Returns the other elements, and those that turn out
    /// to need places: their light varies, or they are hidden in part.
    std::vector<ElementId> gather_together(const std::vector<ElementId>& active, const ReflectedLight& b,
                                           const LocalPassDemand& demand, LocalPassReport& report, Progress& progress,
                                           const StopRequest& stop);
    void check_between_nodes(ElementId e, SampledElement& sampled, const ReflectedLight& b,
                             const LocalPassDemand& demand, Workspace& workspace) const;
    bool is_suspect(ElementId e) const;
    void check_strips(ElementId e, SampledElement& sampled, const ReflectedLight& b, const LocalPassDemand& demand,
                      Workspace& workspace) const;
    std::vector<ElementId> beside(ElementId e, const ElementLocator& locator) const;
    std::size_t follow_rough_places(const ReflectedLight& b, const LocalPassDemand& demand);
    double light_near(ElementId e, const LocalPassDemand& demand) const;
    double noise_factor_in(ElementId e, const LocalPassDemand& demand) const;
    std::uint32_t body_of(ElementId e, const LocalPassDemand& demand) const;
    void divide_among_bodies(const LocalPassDemand& demand);
    double noise_for_body(ElementId e, const LocalPassDemand& demand) const;
    double misfit_for_body(ElementId e, const LocalPassDemand& demand) const;
    double allowed_misfit(ElementId e, double light, const LocalPassDemand& demand) const;
    double noise_excess(ElementId e, const SampledElement& sampled, const LocalPassDemand& demand) const;
    double tolerated_misfit_squared(ElementId e, const SampledElement& sampled, const LocalPassDemand& demand) const;
    void record_parts(LocalPassReport& report) const;
    bool is_too_rough(ElementId e, const SampledElement& sampled, const LocalPassDemand& demand) const;
    double share_in_crowd(const LocalPassDemand& demand) const;
    std::vector<ElementId> split_where_needed(const std::vector<ElementId>& candidates, const LocalPassDemand& demand);
    std::vector<ElementId> to_gather_again(std::vector<ElementId> leaves, const LocalPassDemand& demand);
    std::size_t rays_of(std::span<const ElementId> elements) const;
    SampledElement part_of(ElementId whole, ElementId part) const;
    bool inherit();
    ElementFunction finished(const LocalPassDemand& demand, LocalPassReport& report) const;

    const Stage& stage_;
    std::uint64_t seed_;
    ElementTree tree_;
    Field<ElementId, SampledElement> sampled_;
    double mean_area_ = 0;
    double noise_area_ = 0;  ///< Mean area that shares out the allowed noise, m^2 (mean_area_ does so for the misfit).
    /// Mean area of the first elements of every body, and the `even_noise_area` of its present ones, m^2.
    std::vector<double> mean_area_of_, noise_area_of_;
    bool is_crowd_ = false;  ///< True if most elements are whole polygons (`ErrorShare`).
    /// Squared misfit allowed on any element over the squared light of its room, m^2; 0 unless is_crowd_.
    double min_share_ = 0;
    Spread spread_;
    /// Elements that were examined for large errors at single points; their children are marked as well.
    Field<ElementId, std::uint8_t> suspect_;
};

}  // namespace exitance
