#include "exitance/error/mean_residuals.hpp"

#include <algorithm>

namespace exitance {
namespace {

/// Residuals of the samples of one element beyond the mean of what it is a part of.
struct Beyond {
    Spectrum sum, square;  ///< Weighted; of the squares of that.
    double weight = 0;
    double count = 0;

    void add(double w, const Spectrum& residual) {
        sum += w * residual, square += w * w * residual * residual;
        weight += w, ++count;
    }
};

/// How much of what a sample has beyond the mean another one of the same element has too: products of different samples
/// by squares of single ones.
class Agreement {
  public:
    void count(const Beyond& element) {
        if (element.count < 2) return;
        common_ += mean(element.sum * element.sum - element.square) / (element.count - 1);
        all_ += mean(element.square);
    }
    /// The mean of an element's samples, drawn towards zero as far as they do not agree.
    Spectrum drawn(const Beyond& element) const {
        const double share = all_ > 0 ? std::clamp(common_ / all_, 0.0, 1.0) : 0;
        return share * element.count / (1 + share * (element.count - 1)) / element.weight * element.sum;
    }

  private:
    double common_ = 0, all_ = 0;
};

/// Means of groups, drawn towards zero.
std::vector<Spectrum> means_of_groups(std::size_t groups, std::span<const LeafResidual> samples) {
    constexpr double without = 4;  // samples that a group has besides, without residual
    std::vector<Spectrum> out(groups);
    std::vector<double> count(groups, without);
    for (const LeafResidual& s : samples) out[s.group] += s.weight * s.residual, count[s.group] += s.weight;
    for (std::size_t g = 0; g < groups; ++g) out[g] = out[g] / count[g];
    return out;
}

/// The elements from a root down to a leaf.
std::vector<ElementId> way_to(const ElementTree& tree, ElementId leaf) {
    std::vector<ElementId> out;
    for (ElementId e = leaf; !e.is_none(); e = tree.parent(e)) out.push_back(e);
    std::reverse(out.begin(), out.end());
    return out;
}

}  // namespace

std::vector<Spectrum> mean_residuals(const ElementTree& tree, const LeafNumbering& numbering,
                                     std::span<const std::uint32_t> group_of_leaf, std::size_t groups,
                                     std::span<const LeafResidual> samples) {
    const std::vector<Spectrum> of_group = means_of_groups(groups, samples);
    std::vector<std::vector<ElementId>> ways;
    std::vector<Spectrum> known;  // of each sample, the mean of the smallest part that it lies in and that has one
    std::size_t depth = 0;
    for (const LeafResidual& s : samples) {
        depth = std::max(depth, ways.emplace_back(way_to(tree, numbering.leaves[s.leaf])).size());
        known.push_back(of_group[s.group]);
    }
    // Elements that samples lie in, and what each has beyond what it is a part of.
    constexpr std::uint32_t none = 0xffffffffu;
    Field<ElementId, std::uint32_t> place(tree.size(), none);
    std::vector<Beyond> met;
    std::vector<Spectrum> beyond;
    for (std::size_t level = 0; level < depth; ++level) {
        const std::size_t first = met.size();
        for (std::size_t k = 0; k < samples.size(); ++k) {
            if (level >= ways[k].size()) continue;
            std::uint32_t& at = place[ways[k][level]];
            if (at == none) at = static_cast<std::uint32_t>(met.size()), met.emplace_back();
            met[at].add(samples[k].weight, samples[k].residual - known[k]);
        }
        Agreement agreement;
        for (std::size_t i = first; i < met.size(); ++i) agreement.count(met[i]);
        for (std::size_t i = first; i < met.size(); ++i) beyond.push_back(agreement.drawn(met[i]));
        for (std::size_t k = 0; k < samples.size(); ++k)
            if (level < ways[k].size()) known[k] += beyond[place[ways[k][level]]];
    }
    std::vector<Spectrum> out(numbering.leaves.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = of_group[group_of_leaf[i]];
        for (ElementId e = numbering.leaves[i]; !e.is_none(); e = tree.parent(e))
            if (place[e] != none) out[i] += beyond[place[e]];
    }
    return out;
}

}  // namespace exitance
