#pragma once

#include <vector>

#include "exitance/direct/direct_light.hpp"

namespace exitance {

/// All convex pieces of all emitters as a binary tree of clusters, by place, orientation and power: a cluster is cut
/// across the widest of its six extents (three of place, three of normals, these times half its size) so that either
/// half has about half of its power. The same emitters give the same tree. Source: [Walter05]. O(n log^2 n) to make.
class EmitterTree {
  public:
    explicit EmitterTree(const DirectLight& direct);

    /// A convex piece of an emitter.
    struct Source {
        DirectLight::SourceName name;
        RegionId region;
        double area = 0;   ///< m^2
        double power = 0;  ///< Mean over bands, W.
    };
    /// Sources in the order of the tree: every cluster is a range of them.
    const std::vector<Source>& sources() const { return sources_; }
    /// Sum of the power of all sources before each, and of all: one more than there are sources.
    const std::vector<double>& power_before() const { return power_before_; }

    struct Node {
        Point centre;                       ///< Of power.
        double spread_squared = 0;          ///< Mean of the squared distance from it, by power, m^2.
        double radius = 0;                  ///< Of a ball about it, m.
        Vec3 normal;                        ///< The mean by power: shorter than 1 where normals differ.
        double normal_spread = 0;           ///< RMS departure of normals from it.
        Normal axis;                        ///< All normals are
        double cosine = 1, sine = 0;        ///< within an angle of this that has these.
        double power = 0;                   ///< Mean over bands, W;
        double power_squares = 0;           ///< of the single sources: sum of squares.
        Spectrum colour;                    ///< Power by band, relative to their mean.
        std::uint32_t first = 0, last = 0;  ///< Its sources.
        std::uint32_t left = 0, right = 0;  ///< 0 of a single source.

        bool is_leaf() const { return left == 0; }
    };
    const std::vector<Node>& nodes() const { return nodes_; }  ///< The whole is the first; none: no emitter.

    /// A cluster as seen from a place.
    struct Term {
        std::uint32_t node = 0;
        double light = 0;  ///< What it brings if nothing stands in between, mean over bands, W/m^2;
        double error = 0;  ///< about how far that may be off.
    };
    /// Clusters, none within another, that together make up all emitters. Room to use again.
    struct Cut {
        std::vector<Term> terms;  ///< Those that may bring light, in the order of the tree.
        double light = 0;         ///< Sum over terms, W/m^2.
        double error = 0;         ///< Root of the sum of squares where errors fall either way; what counts as
                                  ///< nothing adds up.

        std::vector<Term> next;  ///< Room.
    };
    /// Opens the clusters that are worst known until the error of all is below max(relative light, absolute), or there
    /// are about `most_terms` of them. About 100 ns a term.
    void cut(const Receiver& at, double relative, double absolute, Cut& out) const;
    static constexpr std::size_t most_terms = 4096;

    /// As many sources of equal light as would leave as much to chance as those of a cut do: (sum L)^2 / sum L^2.
    double effective_sources(const Cut& cut) const;

  private:
    Node make_node(std::uint32_t first, std::uint32_t last) const;
    std::uint32_t middle_of(const Node& node);
    Term look_at(std::uint32_t node, const Receiver& at) const;
    void open(const Term& term, const Receiver& at, double most, std::vector<Term>& out) const;
    double exact(const Node& leaf, const Receiver& at) const;

    const DirectLight* direct_;
    std::vector<Source> sources_;
    std::vector<double> power_before_;
    std::vector<Node> nodes_;
};

}  // namespace exitance
