#pragma once

#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/discontinuity/blocker_search.hpp"
#include "exitance/discontinuity/weak_light.hpp"
#include "exitance/mesh/discontinuity/curve_arrangement.hpp"
#include "exitance/shadow_lines/blocker_edges.hpp"
#include "exitance/shadow_lines/shadow_events.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// A receiving region in its own plane coordinates, with the curves on it across which direct light changes its form.
struct ReceiverCurves {
    explicit ReceiverCurves(const Region& region);

    PlaneFrame frame;
    std::vector<std::vector<Vec2>> loops;  ///< The region's outlines, metres.
    ReceiverLight light;            ///< The sources that can be seen from the region, and their candidate blockers.
    std::vector<FlatCurve> curves;  ///< Arranged so that the mesh can be cut along them.
    /// Wedges examined; sources and curves omitted because they change light too little.
    std::size_t wedges = 0, left_out = 0;
    BlockerSearch::Counts searched;  ///< Work of the blocker search, if one is given.
};

/// A surface whose reflected light casts shadows as well, divided into parts of uniform radiosity.
struct SecondarySource {
    struct Part {
        std::vector<Point> outline;  ///< Outline of the part: convex, counter-clockwise seen from the front, metres.
        Spectrum radiosity;          ///< W/m^2
        double area = 0;             ///< m^2
    };
    RegionId region;
    std::vector<Part> parts;
};

/// Which events of three edges (conic curves) are found.
enum class ConicCurves { none, at_umbras, all };

struct CurveOptions {
    double min_effect = 0;           ///< W/m^2 of rho E. Weaker sources get no curves.
    double min_area = 0;             ///< Smaller regions get contact curves only, m^2.
    std::size_t max_curves = 1'000;  ///< Limit on the curves of a region.
    std::size_t max_edges = 400;     ///< With more blockers' edges, pairs are not searched for NEV and EEE events.
    /// Regions that get curves; others get contact curves only. Null: all regions.
    const Field<RegionId, std::uint8_t>* regions = nullptr;
    double min_bend = 0;                ///< W/m^2 of rho E: weaker sources get no D2 curves.
    double min_narrow_bend = HUGE_VAL;  ///< W/m^2 of rho E: lower limit for long, narrow penumbras.
    ConicCurves conics = ConicCurves::at_umbras;
    std::vector<SecondarySource> secondary = {};
    const StopRequest* stop = nullptr;      ///< After a request to stop, the results are incomplete.
    const WeakLight* weak = nullptr;        ///< If not null, only its strong sources get curves.
    const BlockerSearch* search = nullptr;  ///< Finds the blockers of sources; null: shafts and a tree of boxes.
};

/// Finds the D0, D1 and D2 curves of primary sources, and of the secondary sources given in the options: contacts with
/// other polygons, and VE, EV, NEV and EEE events.
class CurveFinder {
  public:
    /// `stage` and `edges` must outlive this object.
    CurveFinder(const Stage& stage, const BlockerEdges& edges, const CurveOptions& options)
        : stage_(&stage), edges_(&edges), options_(options) {}

    ReceiverCurves find(RegionId region) const;
    /// Finds the light only, without curves.
    ReceiverCurves look(RegionId region) const;

    /// Adds contacts to the curves of a region without direct light, which `find` gives none: reflected light jumps
    /// there, too.
    void add_contacts_in_the_dark(RegionId region, ReceiverCurves& out) const;

  private:
    void look_at_strong(RegionId region, ReceiverCurves& out, DirectLight::Workspace& workspace) const;
    void add_contacts(RegionId region, ReceiverCurves& out) const;
    void add_curves_behind(RegionId region, ReceiverCurves& out) const;
    /// Bounds on the light that a source brings to a region, W/m^2 of rho E.
    struct Effect {
        double gain = HUGE_VAL;  ///< Upper bound of the light at any point of the region.
        Point centre;            ///< Centre of a ball around the source.
        double radius = 0;       ///< Radius of the ball, metres.
        /// The source's exitance times the region's reflectance, W/m^2; 0: only `gain` is available.
        double weight = 0;
        double area = 0;  ///< Area of the source, m^2.
    };
    void add_events(RegionId region, ReceiverCurves& out) const;
    void add_events(RegionId region, const EventSource& source, const Effect& effect, std::span<const PieceId> blockers,
                    const WedgeLists* lists, ReceiverCurves& out) const;
    double effect_beyond(const BlockerEdges::Edge& edge, const EventSource& source, const Effect& effect,
                         const ReceiverCurves& receiver) const;
    void add_non_emitter_events(RegionId region, const EventSource& source, double gain, const WedgeLists* lists,
                                std::span<const std::uint32_t> edges, ReceiverCurves& out) const;
    void add_secondary(RegionId region, ReceiverCurves& out) const;
    double max_effect(RegionId region, const DirectLight::Emitter& emitter, std::uint32_t number,
                      const Effect& effect) const;
    double max_effect(RegionId region, const Effect& effect) const;

    const Stage* stage_;
    const BlockerEdges* edges_;
    CurveOptions options_;
};

}  // namespace exitance
