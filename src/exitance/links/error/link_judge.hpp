#pragma once

#include <limits>
#include <span>
#include <vector>

#include "exitance/links/error/link_oracle.hpp"
#include "exitance/links/error/near_row.hpp"
#include "exitance/links/error/pair_visibility.hpp"
#include "exitance/links/links.hpp"
#include "exitance/visibility/shaft.hpp"

namespace exitance {

/// What decides whether a link is good enough.
struct LinkTolerance {
    /// Of one link: root of the receiver's area times the RMS error of the radiosity that it causes there, W/m^2 m.
    double error = 0;
    double interpolation = 0;  ///< Of all links of a receiver: root of its area times the RMS departure, likewise.
    /// How much an error that is alike all over a receiver counts: it adds up from link to link and from reflection to
    /// reflection, where others cancel.
    double systematic = 1;
    /// How much of what a source's polynomial misses of its light may be missed by a receiver as near as it is large.
    double hidden = 0.5;
    /// When there are more links, sources and receivers are left as they are.
    std::size_t most_links = std::numeric_limits<std::size_t>::max();
    double least_area = 0;    ///< No element is cut below this, m^2.
    bool fractional = false;  ///< The share of rays that get through, for all nodes of a link; else each its own.
    bool quadrature = false;  ///< One ray from each node to each node, yes or no.
    /// Do rays correct what arrives in the mean? Then links that carry little may be constants, whatever the basis, and
    /// what peaks between the points that are looked at is left to rays.
    bool corrected = false;
    /// How much errors count on a receiver, squared, by element; null: alike everywhere.
    const Field<ElementId, double>* importance = nullptr;
    bool gives_up = false;  ///< Are pairs dropped once a stop is asked for? Else they are linked as they are.
    bool triage = true;     ///< Look for certain visibility before rays are cast.
    LinkOracle oracle = LinkOracle::transport;
    double strongest = 0;  ///< Of the other oracles: form factor or power (W) of a link.
    std::uint64_t seed = 1;

    double weight(ElementId receiver) const { return importance ? (*importance)[receiver] : 1; }
};

/// A pair of elements on its way to become a link, or several. What may stand in between is known or not.
struct LinkPair {
    ElementId receiver, source;
    View view = View::mixed;
    bool triaged = false;                ///< Has the pair, or one that holds it, been looked at?
    std::uint32_t first = 0, count = 0;  ///< Mixed and looked at: the candidates, in the round's pool.
};

/// Looks at pairs of elements, and decides. One a thread; keeps its memory.
///
/// The error of a link is that of the radiosity w E which it causes, w the receiver's reflectance:
/// - the rule: what its order leaves, and the source's departure from its own polynomial (`roughness`, by element, the
///   RMS of mean bands) where the kernel is no polynomial over it. Then the source is cut;
/// - visibility: the standard error of as many rays, where nothing is certain. Then the source is cut, or more are
/// cast;
/// - interpolation: light that the link sends to points between the receiver's nodes, against the nodes' polynomial.
///   This is judged for all links of a receiver together: near an edge each part of a wall sends light that varies
///   fast, while the whole of it hardly does.
/// Or links are judged by their strength alone (LinkOracle): where it is too large, the larger of the two is cut.
/// Source: the oracle of [Gortler93] and [Lischinski94], by samples; certain visibility of [Haines91] is inherited.
class LinkJudge {
  public:
    enum class Verdict : std::uint8_t { drop, accept, cut_source };
    /// Light at points between the receiver's nodes less the nodes' polynomial there, w E, W/m^2.
    using Departure = std::array<double, 5>;
    struct Result {
        Verdict verdict = Verdict::drop;
        Link link;
        bool near = false;  ///< The kernel stands in block().
        /// The receiver is to be cut whatever other links bring: by an oracle of strength, or for a peak between nodes.
        bool cuts_receiver = false;
        double squared_error = 0;  ///< Of rule and visibility: area times squared error, of an accepted link.
        double missed = 0;         ///< Between the points that were looked at, in the units of a tolerance.
        double light = 0;          ///< Of all of the receiver, in the open.
        Departure departure{};
        /// Where something stands in between: the light at the receiver's nodes, and the variance that rays leave.
        std::array<double, 9> shadowed{}, variance{};
    };

    LinkJudge(const LinkSites& sites, const NodalField& b, const Field<ElementId, double>& roughness,
              const LinkTolerance& tolerance);

    /// `pool` holds the pairs' candidates. For a pair to be cut, what its parts inherit is in candidates().
    Result judge(LinkPair& pair, std::span<const PieceId> pool);

    std::span<const float> block() const { return block_; }  ///< nodes() x nodes(), receiver first.
    std::span<const PieceId> candidates() const { return candidates_; }
    std::size_t rays() const { return visible_.rays(); }
    std::size_t form_factors() const { return form_factors_; }

  private:
    /// What each node of the source sends to a point of the receiver, in the open, for b = 1 there.
    using Row = std::array<double, 9>;
    bool may_see(ElementId p, ElementId q) const;
    void set_source(ElementId q, const Spectrum& weight);
    Row row(const Point& x, const Normal& n);
    Row kernel_row(const Point& x, const Normal& n) const;  ///< By Gauss's rule, be it near or not.
    Row mean_row(const Patch& receiver, const Normal& n, Departure& light);
    double light(const Row& row) const;
    /// Fills rows and light at the nodes, and the departure; returns the error of the rule.
    double send(ElementId p, ElementId q, double allowed, Departure& departure);
    double ratio_of(ElementId p, ElementId q) const;
    /// What of an element lies before a plane.
    struct Part {
        Plane plane;
        std::vector<Point> outline;
        Point middle;
        double area = 0, radius = 0;

        double thickness() const { return area / (2 * radius); }  ///< Of a long one the width, m.
        Point drawn_in(const Point& x, double share) const;
    };
    void set_part(ElementId e, const Plane& plane, Part& out) const;
    double missed_peak(ElementId p, ElementId q, bool open);
    double missed_at(const Point& x, double gap, ElementId p, bool open);
    double missed_fall(ElementId p, double allowed);
    double said_at(const Point& x, ElementId p) const;
    /// What one number sends: the mean form factor over the receiver, the error of the rule, and how light departs from
    /// the mean.
    struct Even {
        double form_factor = 0, rule_error = 0;
        Departure departure{};
    };
    Even send_evenly(ElementId p, ElementId q, double b, double allowed);
    bool judge_as_constant(LinkPair& pair, std::span<const PieceId> pool, double allowed, Result& out);
    /// Finds what may stand in between, once for each pair that is judged; of a pair that hardly counts, what is known.
    void look_between(LinkPair& pair, std::span<const PieceId> pool, bool tiny);
    void triage(LinkPair& pair, std::span<const PieceId> pool);
    /// Rays between the two, a few or more if the error is not to be above `allowed`; returns the standard error of the
    /// light that arrives.
    double cast(ElementId p, ElementId q, bool few, double allowed);
    double cast_once(ElementId p, ElementId q, unsigned times, bool few);
    enum class Cut { nothing, source, receiver };
    Cut what_to_cut(ElementId p, ElementId q, bool mixed) const;
    /// By how much the kernel of orders 2 and 3 is to be scaled, so that even light arrives exactly in the mean over
    /// the receiver. Constants have rays to correct them.
    double scale_of_rule(ElementId p, ElementId q);
    static double scale_to(double exact, double rule);
    double error_of_kernel(ElementId p, ElementId q);
    void set_block();
    void hand_over(bool open, Result& out);

    struct Checks {
        std::vector<Vec2> at;
        std::vector<double> factors;  ///< A row of nodes() a point.
    };
    const Checks& checks(Patch::Shape shape) const { return shape == Patch::Shape::triangle ? triangle_ : square_; }
    Checks make_checks(Patch::Shape shape) const;

    const LinkSites& sites_;
    const NodalField& b_;
    const Field<ElementId, double>& roughness_;
    const LinkTolerance& tolerance_;
    std::size_t n_;
    Checks square_, triangle_;

    Shaft shaft_;
    std::vector<PieceId> candidates_;
    std::vector<float> block_;
    std::vector<Point> outline_;
    Part receiver_part_, source_part_;
    NearRow near_row_;
    PairVisibility visible_;
    Normal source_normal_;
    double source_area_ = 0, source_roughness_ = 0;
    std::array<double, 9> source_light_{}, source_weight_{};
    double source_mean_ = 0;  ///< Of source_light_.
    std::array<Point, 9> source_node_;
    std::array<double, 9> node_light_{};  ///< Light in the open at the receiver's nodes.
    double brightest_ = 0;                ///< Of light in the open, wherever it is looked at.
    std::array<Row, 9> rows_;             ///< From the receiver's nodes.
    bool looked_between_ = false;
    bool near_ = false;         ///< Are rows those of NearRow?
    bool keeps_block_ = false;  ///< Are they handed over?
    double kernel_scale_ = 1;   ///< Of near rows that are not.
    double ratio_ = 0;          ///< Size of the source to its distance.
    double form_factor_ = 0;    ///< From the receiver's first node.
    std::size_t form_factors_ = 0;
};

}  // namespace exitance
