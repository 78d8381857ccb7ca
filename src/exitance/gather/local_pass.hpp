#pragma once

#include "exitance/base/checkpoint.hpp"
#include "exitance/gather/element_gather.hpp"
#include "exitance/gather/gather.hpp"
#include "exitance/gather/sampled_element.hpp"
#include "exitance/mesh/element_tree_archive.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {

/// How finely indirect light is gathered.
struct LocalPassDemand {
    RayBudget rays;    ///< Of one place, to begin with; more where they turn out too noisy.
    double light = 0;  ///< Mean reflected light of the scene, W/m^2: places far lighter may be noisier. 0: none may.
    double noise = 0;  ///< RMS error of rho E_ind that the rays may leave, W/m^2.
    double tolerance = 0;  ///< RMS error of rho E_ind that interpolation may leave, W/m^2.
    bool curved = false;   ///< Fit polynomials of second degree, where they are larger than their noise.
    /// As much of the light there as interpolation may leave on an element that elements are summed for; 0: any.
    double relative_tolerance = 0;
    /// The same b, in parts to be summed over in place of rays, where that suits the scene; and what one element may
    /// miss. Empty: rays.
    std::span<const ElementGather> elements = {};
    double element_share = 0;
    int max_depth = 8;  ///< Rounds of cutting.
    /// The light of every room by the mean light: errors are allowed in proportion. Empty where all is one room.
    std::span<const double> light_in = {};
    /// b less what was gathered last, where that is small: it alone is gathered, by as few rays as its noise needs, and
    /// added to what there is. Null: b is what was gathered last, or nothing like it.
    const ReflectedLight* change = nullptr;
};

struct LocalPassReport {
    std::size_t rays = 0;
    /// RMS over the surfaces of the rays' error in rho E_ind, W/m^2; where there are several rooms, of the error by the
    /// room's light, all rooms alike, times the mean light.
    double noise = 0;
    double interpolation = 0;  ///< The same of the interpolation's error, as estimated.
    /// What is known of every leaf before it was joined to others; of inner elements: unused.
    struct Leaf {
        double expected_error = 0;  ///< Of rho E_ind, W/m^2.
        unsigned rays = 0;          ///< That the element took to bring its noise down to what is allowed.
    };
    Field<ElementId, Leaf> leaves;
    /// What is known of a leaf of the delivered tree: a triangle of a fan is a part of what was gathered.
    static const Leaf& known(const Field<ElementId, Leaf>& leaves, const ElementTree& tree, ElementId e) {
        return leaves[e.value < leaves.size() ? e : tree.parent(e)];
    }
    bool interrupted = false;  ///< By a request to stop, before anything at all was known of some elements.
};

/// Indirect irradiance everywhere, by one gather over the light that a method found: E_ind = H b at the places of a
/// quadrature rule on the elements of an adaptive mesh (`RuleOrder`: 3 x 3 on parallelograms, 16 that are no grid for
/// polynomials of second degree), and the polynomial nearest to them in the mean square. The gather smooths what is
/// rough in b and doubles its order (the iterated or Sloan solution) [Lischinski93], [Atkinson97]. The places outnumber
/// the polynomial's freedoms: what they leave over, less the rays' noise, is the error of interpolation, and elements
/// are cut where that has more than its share of the tolerance, across the one direction that it varies along where
/// that is enough. Rays are doubled until their noise is what is allowed: a polynomial of many places needs few from
/// each, which is why elements as large as light allows are what makes this cheap. What is delivered are straight
/// elements for all that. O(elements x rays).
///
/// Mesh and gathers stay: called again with a stricter demand, only what falls short of it is done again; with light
/// that has changed by little, the change is gathered; with other light, everything anew, on the mesh found so far.
class LocalPass {
  public:
    /// `mesh`: of the elements to begin with. The stage must outlive it.
    LocalPass(const Stage& stage, MeshSize mesh, std::uint64_t seed);

    /// Gathers b. `fresh`: b is not what was gathered last. `report.rays` counts those of this call. `safe_points`: its
    /// state beyond archive_state() can be kept between slices of the work.
    ElementFunction gather(const ReflectedLight& b, bool fresh, const LocalPassDemand& demand, LocalPassReport& report,
                           Progress& progress, const StopRequest& stop, SafePoints safe_points = {});

    /// Mesh and gathers, for checkpoints.
    template <class Archive>
    void archive_state(Archive& a) {
        a(tree_, sampled_, mean_area_, noise_area_, is_crowd_, least_share_, spread_);
    }

  private:
    /// Room for the gathers of one thread.
    struct Workspace {
        GatherWorkspace rays;
        ElementGather::Workspace elements;
        std::vector<GrowingGather> growing;  ///< One a place.
        std::vector<Gathered> gathered;
        std::vector<GatherPlace> short_places;  ///< Places that are short of rays,
        std::vector<GrowingGather*> short_of;   ///< and the gathers of these places.
    };

    /// Sums over all elements sampled so far of their area times what quarters and halves of their rays tell of the
    /// variance, (W/m^2)^2 m^2; to begin with of rays between chance and even light (`Gathered`), of no weight.
    struct Spread {
        double quarters = 1e-100, halves = 0.85e-100;  // given by the middle of gain()'s range, at next to no weight

        /// The variance of what is gathered in what quarters tell of it. A mean over elements, since one alone has too
        /// few places to tell.
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
    void look_between(ElementId e, SampledElement& sampled, const ReflectedLight& b, const LocalPassDemand& demand,
                      Workspace& workspace) const;
    double light_near(ElementId e, const LocalPassDemand& demand) const;
    double allowed_misfit(ElementId e, double light, const LocalPassDemand& demand) const;
    double noise_excess(ElementId e, const SampledElement& sampled, const LocalPassDemand& demand) const;
    double tolerated_misfit_squared(ElementId e, const SampledElement& sampled, const LocalPassDemand& demand) const;
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
    double noise_area_ = 0;  ///< In place of it where noise is dealt out.
    bool is_crowd_ = false;  ///< Are most elements whole polygons (`ErrorShare`)?
    /// Squared misfit that any element may have, by the squared light of its room, m^2; 0 but in crowds.
    double least_share_ = 0;
    Spread spread_;
};

}  // namespace exitance
