#pragma once

#include <span>
#include <vector>

#include "exitance/direct/direct_light.hpp"
#include "exitance/visibility/lit_part.hpp"

namespace exitance {

/// Light of sources that are small compared with a polygon, integrated over the polygon as seen from the sources.
///
/// The points of a quadrature rule can miss such light: a patch of sun behind a small window, the bright spot near a
/// lamp, or the shadow of a thin bar. Seen from the centre of the source, the hidden parts of the polygon can be
/// clipped away exactly, so that no part is missed:
///
///     mean E = 1/A sum over the lit fragments of  integral L(x) dA,
///
/// where L is the light of the unoccluded source. Sun, lamps, and lights without extent count as small on a polygon if
/// their penumbrae there are narrower than a quarter of the polygon: shadows then vary between the points of a rule,
/// and their borders, seen from the centre, are in the middle of the penumbrae. Error: second order in that ratio, and
/// about 1% of L close to a lamp.
class SmallSources {
  public:
    /// `direct` must outlive this object.
    explicit SmallSources(const DirectLight& direct) : direct_(&direct) {}

    /// A convex polygon of a region, and a quadrature rule on it.
    struct Polygon {
        std::span<const Point> outline;  ///< Outline, metres, counter-clockwise about n.
        Normal n;
        RegionId own;
        std::span<const Point> places;    ///< Points of the quadrature rule.
        std::span<const double> weights;  ///< Weights of these points; their sum is 1.
    };
    /// Irradiance, W/m^2, and the part of it that is parallel light or comes from the sun.
    struct Missed {
        Spectrum irradiance, parallel;
    };
    class Workspace;

    /// Returns the mean irradiance on the polygon by small sources, less that by the rule. Sources that cannot be
    /// missed, because the polygon sees them unoccluded from afar, are left out, and so are sources with more than
    /// `max_blockers` possible blockers. About 10 us per source and polygon.
    Missed missed(const Polygon& on, Workspace& room) const;

    /// Returns, for each small source that lights the polygon, the centre of the largest lit fragment. `on` needs no
    /// rule.
    std::vector<Point> lit_places(const Polygon& on, Workspace& room) const;

    static constexpr std::size_t max_blockers = 256;

  private:
    class Centre;

    void prepare(const Polygon& on, Workspace& room) const;
    template <class Visit>
    void visit_centres(const Polygon& on, Workspace& room, const Visit& visit) const;
    bool may_be_missed(const ReceiverLight::Source& source, const Polygon& on, const ReceiverLight& light) const;
    bool is_sharp(const ReceiverLight::Source& source, const Polygon& on, const ReceiverLight& light) const;
    Spectrum mean_of(const Centre& centre, const Polygon& on, std::span<const PieceId> blockers, Workspace& room) const;
    bool find_lit(const Centre& centre, const Polygon& on, std::span<const PieceId> blockers, Workspace& room) const;
    bool cut(const Centre& centre, const Polygon& on, PieceId blocker, Workspace& room) const;

    const DirectLight* direct_;
};

/// Temporary storage; one per thread.
class SmallSources::Workspace {
  private:
    friend SmallSources;
    std::vector<DirectLight::SourceName> named_;
    ReceiverLight light_;
    DirectLight::Workspace exact_;
    LitPart lit_;
    std::vector<Point> part_, rest_;
    std::vector<Vec3> corners_, planes_;
};

}  // namespace exitance
