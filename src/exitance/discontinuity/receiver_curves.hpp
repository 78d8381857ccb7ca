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

/// A receiving region in coordinates of its own, with the curves on it across which direct light changes its form.
struct ReceiverCurves {
    explicit ReceiverCurves(const Region& region);

    PlaneFrame frame;
    std::vector<std::vector<Vec2>> loops;  ///< Metres; as the region's.
    ReceiverLight light;                   ///< What shines on any of it.
    std::vector<FlatCurve> curves;         ///< Ready to be cut along.
    std::size_t wedges = 0, left_out = 0;  ///< Looked at; sources or curves that change too little.
    BlockerSearch::Counts searched;        ///< Work of the blocker search, where one is given.
};

/// A surface whose reflected light has shadows, too, in parts over which it is even.
struct SecondarySource {
    struct Part {
        std::vector<Point> outline;  ///< Convex, counter-clockwise seen from the front, metres.
        Spectrum radiosity;          ///< W/m^2
        double area = 0;             ///< m^2
    };
    RegionId region;
    std::vector<Part> parts;
};

/// Which lines of three edges are looked for.
enum class ConicCurves { none, at_umbras, all };

struct CurveOptions {
    double least_effect = 0;              ///< W/m^2 of rho E: sources that bring less than this have no curves.
    double least_area = 0;                ///< m^2: smaller regions have contacts alone.
    std::size_t most_curves = 1'000;      ///< On a region.
    double least_bend = 0;                ///< W/m^2 of rho E: sources that bring less than this have no D2 curves, but
    double least_narrow_bend = HUGE_VAL;  ///< along half-shadows that are long and narrow those of this have some.
    ConicCurves conics = ConicCurves::at_umbras;
    std::vector<SecondarySource> secondary = {};
    const StopRequest* stop = nullptr;      ///< Once it is requested, what is found is not complete.
    const WeakLight* weak = nullptr;        ///< If given, its strong sources alone are looked at.
    const BlockerSearch* search = nullptr;  ///< Finds what blocks sources; null: by shafts and a tree of boxes.
};

/// Finds D0, D1 and D2 curves of primary sources, and of secondary ones that are asked for: where other polygons touch
/// a region, and its VE, EV, NEV and EEE events.
class CurveFinder {
  public:
    /// Both must outlive it.
    CurveFinder(const Stage& stage, const BlockerEdges& edges, const CurveOptions& options)
        : stage_(&stage), edges_(&edges), options_(options) {}

    ReceiverCurves find(RegionId region) const;
    /// The light alone, no curves.
    ReceiverCurves look(RegionId region) const;

    /// Where no direct light comes there are no curves of it, but what is reflected jumps at contacts all the same:
    /// adds these to what was found of such a region.
    void add_contacts_in_the_dark(RegionId region, ReceiverCurves& out) const;

  private:
    void look_at_strong(RegionId region, ReceiverCurves& out, DirectLight::Workspace& workspace) const;
    void add_contacts(RegionId region, ReceiverCurves& out) const;
    void add_curves_behind(RegionId region, ReceiverCurves& out) const;
    /// What a source brings to a region, W/m^2 of rho E.
    struct Effect {
        double gain = HUGE_VAL;  ///< At most, anywhere.
        Point centre;            ///< Of a ball around the source.
        double radius = 0;       ///< Metres.
        double weight = 0;       ///< Its exitance times the region's reflectance; 0: `gain` is all there is to know.
        double area = 0;         ///< Of the source, m^2.
    };
    void add_events(RegionId region, ReceiverCurves& out) const;
    void add_events(RegionId region, const EventSource& source, const Effect& effect, std::span<const PieceId> blockers,
                    const WedgeLists* lists, ReceiverCurves& out) const;
    double effect_beyond(const BlockerEdges::Edge& edge, const EventSource& source, const Effect& effect,
                         const ReceiverCurves& receiver) const;
    void add_non_emitter_events(RegionId region, const EventSource& source, double gain, const WedgeLists* lists,
                                std::span<const std::uint32_t> edges, ReceiverCurves& out) const;
    void add_secondary(RegionId region, ReceiverCurves& out) const;
    double greatest_effect(RegionId region, const DirectLight::Emitter& emitter, std::uint32_t number,
                           const Effect& effect) const;
    double greatest_effect(RegionId region, const Effect& effect) const;

    const Stage* stage_;
    const BlockerEdges* edges_;
    CurveOptions options_;
};

}  // namespace exitance
